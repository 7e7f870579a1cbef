"""What comes with rubgen, by name: recipes, machines, sensor sets, faults."""

import re
from itertools import takewhile
from pathlib import Path

from rubgen.errors import UserError
from rubgen.machine.faults.registry import FAULTS
from rubgen.machine.load import PRESETS
from rubgen.machine.problems import nearest
from rubgen.scenario.load import DEFAULT_RECIPE, RECIPES
from rubgen.sensors.load import SETS

FOLDERS = {"recipe": RECIPES, "machine": PRESETS, "sensors": SETS}
"""Where the files of each kind are."""
DEFAULTS = {"recipe": DEFAULT_RECIPE.stem, "machine": "zeng2019", "sensors": "default"}
"""The file of each kind that is taken where none is named."""


def offered(kind: str) -> dict[str, str]:
    """Return the names of the files of a kind that come with rubgen, each with the first sentence of its comment.

    A sentence ends at its first colon too. `kind` is recipe, machine or sensors.
    """
    return {path.stem: _first_sentence(path) for path in sorted(FOLDERS[kind].glob("*.toml"))}


def offered_faults() -> dict[str, str]:
    """Return the kinds of fault, each with the first sentence of its description, which ends at its first colon too."""
    return {kind: _sentence(" ".join((fault.__doc__ or "").split())) for kind, fault in FAULTS.items()}


def file_of(kind: str, name: str) -> Path:
    """Return the path of rubgen's file of the given kind (recipe, machine or sensors) and name.

    Raises UserError, with the nearest name, if none exists.
    """
    if name not in offered(kind):
        raise UserError(f"--from {name!r:.200}: no such {kind} comes with rubgen; {nearest(name, list(offered(kind)))}")
    return FOLDERS[kind] / f"{name}.toml"


def _first_sentence(path: Path) -> str:
    lines = takewhile(lambda line: line.startswith("#"), path.read_text(encoding="utf-8").splitlines())
    return _sentence(" ".join(line.removeprefix("# ") for line in lines if not line.startswith("#:")))


def _sentence(text: str) -> str:
    """Return the text up to the end of its first sentence, or up to its first colon."""
    return re.split(r"(?<!\bal)[.:](?=\s|$)", text, maxsplit=1)[0]
