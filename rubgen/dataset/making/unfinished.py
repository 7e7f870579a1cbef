"""A data set that was begun and is not finished."""

from dataclasses import dataclass
from pathlib import Path

from rubgen.dataset.layout import Layout
from rubgen.dataset.making.generate import finished_runs
from rubgen.errors import UserError
from rubgen.io.json_read import read_json


@dataclass(frozen=True, kw_only=True)
class Unfinished:
    """Name and number of runs of its recipe, and how many runs are kept."""

    name: str
    runs: int
    kept: int


def unfinished(directory: Path) -> Unfinished | None:
    """What an interrupted `generate` left in `directory`; None where it left nothing or the set is finished.

    Raises UserError where it cannot be read.
    """
    layout = Layout(directory)
    if (layout.manifest.exists() and layout.digest.exists()) or not layout.identity.exists():
        return None
    try:
        recipe = read_json(layout.identity.read_bytes())["recipe"]
        return Unfinished(name=str(recipe["name"]), runs=int(recipe["runs"]), kept=finished_runs(directory))
    except (OSError, ValueError, TypeError, LookupError):
        raise UserError(f"{layout.identity}: cannot be read; give the directory of another data set") from None
