"""How the runs of a set ended: counts of rub and of classes of motion, and why some failed."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rubgen.dataset.layout import Layout
from rubgen.errors import UserError
from rubgen.io.files import read_json
from rubgen.io.parquet.read import read_table

COLUMNS = ["run_id", "status", "reason", "rub", "motion"]


@dataclass(frozen=True, kw_only=True)
class Failure:
    """The runs that failed in one way; `reason` is the shortest of theirs, `run_id` the run that has it."""

    status: str
    count: int
    run_id: str
    reason: str


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Of the runs with status ok: how many `rub`, how many do not, and how many have which class of `motion`.

    `failures` has one entry for each other status, the most frequent first.
    """

    rub: int
    no_rub: int
    motion: dict[str, int]
    failures: tuple[Failure, ...]


def outcome_of(layout: Layout) -> Outcome:
    """The outcome of a set whose `runs.parquet` is written."""
    rows = read_table(layout.runs, COLUMNS).to_pylist()
    good = [row for row in rows if row["status"] == "ok"]
    rubbing = sum(bool(row["rub"]) for row in good)
    return Outcome(
        rub=rubbing,
        no_rub=len(good) - rubbing,
        motion=dict(Counter(row["motion"] for row in good).most_common()),
        failures=tuple(_failures(row for row in rows if row["status"] != "ok")),
    )


def _failures(rows: Iterable[dict[str, Any]]) -> list[Failure]:
    failed: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        failed.setdefault(row["status"], []).append(row)
    found = []
    for status, mine in failed.items():
        shortest = min(mine, key=lambda row: (len(row["reason"]), row["run_id"]))
        found.append(Failure(status=status, count=len(mine), run_id=shortest["run_id"], reason=shortest["reason"]))
    return sorted(found, key=lambda failure: (-failure.count, failure.status))


@dataclass(frozen=True, kw_only=True)
class Unfinished:
    """Name and number of runs of its recipe, and how many runs are kept."""

    name: str
    runs: int
    kept: int


def finished_runs(out: Path | str) -> int:
    """How many runs of an unfinished set are kept."""
    return len(list((Layout(Path(out)).staging / "runs").glob("run-*[0-9].parquet")))


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
