"""Load machines from TOML files: the presets of rubgen, and the user's own in the same form."""

import hashlib
import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from pydantic import TypeAdapter

from rubgen.errors import UserError
from rubgen.machine.machine import Machine
from rubgen.machine.problems import nearest, validated
from rubgen.machine.toml_file import check_kind, named_toml, names_toml, read_toml, toml_path

PRESETS = Path(__file__).parent / "presets"
FOR_COMPARISON = "zeng2019-as-computed"
"""The preset that repeats the paper's discretisation; a recipe that names it is told that it is not for data."""
ABOUT_MACHINE = re.compile(r"(?:^|: )machine .*?: (its .*)|^((?:disk|blades|casing|disk_support|damping)\.\w+ = .*)")


def preset_names() -> list[str]:
    """Return the names of the machines that come with rubgen, sorted."""
    return sorted(path.stem for path in PRESETS.glob("*.toml"))


def load_machine(name_or_path: str, folder: Path | None = None) -> Machine:
    """Load the preset with the given name, or the machine in a TOML file: a text that ends with .toml is a path.

    A relative path starts from `folder`; None is the current directory. `~` is the home directory. Raises UserError
    with file, key, value and what is allowed where the machine does not exist or is not valid.
    """
    if name_or_path in preset_names():
        return _machine_from(PRESETS / f"{name_or_path}.toml")
    if not names_toml(name_or_path):
        hint = nearest(name_or_path, preset_names())
        raise UserError(f"machine = {name_or_path!r:.200}: no such preset; {hint}, or the path of a machine .toml")
    return _machine_from(named_toml("machine", name_or_path, folder))


@contextmanager
def file_named(name_or_path: str, folder: Path | None = None) -> Iterator[None]:
    """Name the machine's file in a UserError of the block: "machine <name>: its ...", or one that begins with its key.

    It is raised as "<file>: its ...", without the text before, or as "<file>: casing.nodes = ...". The code that builds
    the model of a machine knows no file. For a preset, and for any other text, the error is unchanged. `name_or_path`
    and `folder` are the arguments that `load_machine` got.
    """
    try:
        yield
    except UserError as error:
        about = ABOUT_MACHINE.search(str(error))
        if not about or not names_toml(name_or_path):
            raise
        raise UserError(f"{toml_path(name_or_path, folder)}: {about[1] or about[2]}") from error


def machine_id(machine: Machine) -> str:
    """Return twelve hexadecimal digits that identify the values of the machine: from the sha256 of its sorted JSON.

    Default values are left out, so that a key added by a later version changes no existing `machine_id`.
    """
    values = TypeAdapter(Machine).dump_python(machine, mode="json", exclude_defaults=True)
    return hashlib.sha256(json.dumps(values, sort_keys=True).encode()).hexdigest()[:12]


def _machine_from(path: Path) -> Machine:
    data = read_toml(path)
    check_kind(path, data, "machine")
    return validated(path, data, TypeAdapter(Machine))
