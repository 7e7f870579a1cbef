"""Machines from TOML files: the presets that come with rubgen, and the user's own of the same form."""

from __future__ import annotations

import tomllib
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from rubgen.errors import UserError
from rubgen.machine.machine import Machine

PRESETS = Path(__file__).parent / "presets"


def preset_names() -> list[str]:
    """Names of the machines that come with rubgen, sorted."""
    return sorted(path.stem for path in PRESETS.glob("*.toml"))


def load_machine(name_or_path: str) -> Machine:
    """The preset of that name, or the machine in that TOML file.

    Raises UserError with file, key, value and what is allowed when there is none, or when it is not a valid machine.
    """
    path = PRESETS / f"{name_or_path}.toml"
    if name_or_path not in preset_names():
        path = Path(name_or_path)
        if path.suffix != ".toml":
            presets = ", ".join(preset_names())
            raise UserError(
                f"machine = {name_or_path!r}: no such preset; give one of {presets}, or the path of a machine .toml"
            )
    return TypeAdapter(Machine).validate_python(read_toml(path)) if path.parent == PRESETS else _user_machine(path)


def read_toml(path: Path) -> dict[str, object]:
    """The content of a TOML file; a UserError of one line when it is missing or not TOML."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise UserError(f"{path}: there is no such file; check the path") from None
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{path}: cannot be read ({error}); give a readable TOML file") from None
    except tomllib.TOMLDecodeError as error:
        raise UserError(f"{path}: not TOML ({error}); mend the line that is named") from None


def first_problem(path: Path, error: ValidationError) -> UserError:
    """A validation error as one line: file, key, value, what is allowed."""
    problem = error.errors()[0]
    key = ".".join(str(part) for part in problem["loc"])
    value = problem.get("input")
    shown = "" if isinstance(value, dict) or problem["type"] == "extra_forbidden" else f" = {value!r}"
    return UserError(f"{path}: {key}{shown}: {problem['msg']}")


def _user_machine(path: Path) -> Machine:
    try:
        return TypeAdapter(Machine).validate_python(read_toml(path))
    except ValidationError as error:
        raise first_problem(path, error) from None
