"""Count how the runs of a data set ended: with or without rub, in which class of motion, with which failure."""

from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from rubgen.dataset.layout import Layout
from rubgen.dataset.making.close import ClosedShard
from rubgen.dataset.making.keep import kept_runs
from rubgen.errors import UserError
from rubgen.io.files import read_json
from rubgen.io.parquet.read import row_groups
from rubgen.io.parquet.words import with_words
from rubgen.io.places import is_there

COLUMNS = ["run_id", "status", "reason", "rub", "motion"]


@dataclass(frozen=True, kw_only=True)
class Failure:
    """The runs with one of the statuses of failure."""

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
    """Count the runs in `runs.parquet` of a data set: with and without rub, by class of motion, and failures by status.

    A few thousand rows are in memory at a time.
    """
    rub: Counter[bool] = Counter()
    motion: Counter[str] = Counter()
    failed: dict[str, Failure] = {}
    for group in row_groups(layout.runs, columns=COLUMNS):
        for row in with_words(group).to_pylist():
            if row["status"] == "ok":
                rub[bool(row["rub"])] += 1
                motion[row["motion"]] += 1
            else:
                failed[row["status"]] = _with(failed.get(row["status"]), row)
    failures = sorted(failed.values(), key=lambda failure: (-failure.count, failure.status))
    return Outcome(rub=rub[True], no_rub=rub[False], motion=dict(motion.most_common()), failures=tuple(failures))


def _with(before: Failure | None, row: dict[str, Any]) -> Failure:
    """Count one more failed run. The shortest reason stands for all, of equal ones that of the first run."""
    mine = Failure(status=row["status"], count=1, run_id=row["run_id"], reason=row["reason"])
    if before is None:
        return mine
    shortest = min(before, mine, key=lambda failure: (len(failure.reason), failure.run_id))
    return replace(shortest, count=before.count + 1)


@dataclass(frozen=True, kw_only=True)
class Unfinished:
    """An unfinished data set: name and number of runs of its recipe, and the number of finished runs (`kept`)."""

    name: str
    runs: int
    kept: int


def finished_runs(out: Path | str) -> int:
    """Return the number of finished runs, failed ones included, of an unfinished data set in the directory `out`.

    It is 0 without an unfinished set. Nothing is changed.
    """
    layout = Layout(out)
    closed = [path.stem for path in layout.closed("").parent.glob("*.json")]
    begun = {path.name for path in layout.kept("").glob("*")} - set(closed)
    return sum(_closed_runs(layout.closed(name)) for name in closed) + sum(
        len(kept_runs(layout, name)) for name in begun
    )


def _closed_runs(path: Path) -> int:
    """Return the number of runs of a closed shard; 0 where its record is damaged, so that its runs are made again."""
    try:
        return ClosedShard.model_validate(read_json(path.read_bytes())).runs
    except (FileNotFoundError, ValueError):  # a ValidationError is a ValueError
        return 0


def unfinished(directory: Path) -> Unfinished | None:
    """Return name and numbers of runs of the unfinished set in `directory`; None without a set or for a finished set.

    Raises UserError where its identity cannot be read.
    """
    layout = Layout(directory)
    if (is_there(layout.manifest) and is_there(layout.digest)) or not is_there(layout.identity):
        return None
    try:
        recipe = read_json(layout.identity.read_bytes())["recipe"]
        name, runs = str(recipe["name"]), int(recipe["runs"])
    except (OSError, ValueError, TypeError, LookupError) as error:
        reason = f"{type(error).__name__}: {error}"
        raise UserError(
            f"{layout.identity}: cannot be read ({reason}); give the directory of another data set"
        ) from None
    return Unfinished(name=name, runs=runs, kept=finished_runs(directory))
