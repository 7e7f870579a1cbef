"""Count how the runs of a data set ended: with or without rub, in which class of motion, with which failure."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rubgen.dataset.layout import Layout
from rubgen.errors import UserError
from rubgen.io.files import read_json
from rubgen.io.parquet.read import read_table
from rubgen.io.parquet.words import with_words

COLUMNS = ["run_id", "status", "reason", "rub", "motion"]


@dataclass(frozen=True, kw_only=True)
class Failure:
    """The runs with one status of failure."""

    status: str
    """The status."""
    count: int
    """Number of runs with it."""
    run_id: str
    """The run with the shortest reason."""
    reason: str
    """That reason."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """Counts of the runs with status ok, and the failures."""

    rub: int
    """Number of runs with rub."""
    no_rub: int
    """Number of runs without rub."""
    motion: dict[str, int]
    """Number of runs with each class of motion."""
    failures: tuple[Failure, ...]
    """One entry for each other status, the most frequent first."""


def outcome_of(layout: Layout) -> Outcome:
    """Count the runs of a data set whose `runs.parquet` is written: rub, classes of motion, failures."""
    rows = with_words(read_table(layout.runs, COLUMNS)).to_pylist()
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
    """An unfinished data set: name and number of runs of its recipe, and the number of finished runs (`kept`)."""

    name: str
    runs: int
    kept: int


def finished_runs(out: Path | str) -> int:
    """Count the finished runs of an unfinished data set in the directory `out`."""
    return len(list((Layout(Path(out)).staging / "runs").glob("run-*[0-9].parquet")))


def unfinished(directory: Path) -> Unfinished | None:
    """Return what an interrupted `generate` left in `directory`; None where there is no set or it is finished.

    Raises UserError where its identity cannot be read.
    """
    layout = Layout(directory)
    if (layout.manifest.exists() and layout.digest.exists()) or not layout.identity.exists():
        return None
    try:
        recipe = read_json(layout.identity.read_bytes())["recipe"]
        return Unfinished(name=str(recipe["name"]), runs=int(recipe["runs"]), kept=finished_runs(directory))
    except (OSError, ValueError, TypeError, LookupError):
        raise UserError(f"{layout.identity}: cannot be read; give the directory of another data set") from None
