"""Which runs of a set are missing, and the jobs that make them. The coordinator holds numbers and names alone."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from math import ceil
from pathlib import Path

from rubgen.dataset.layout import Layout
from rubgen.dataset.making.close import close_shard
from rubgen.dataset.making.keep import kept_runs
from rubgen.dataset.making.make_runs import make_runs
from rubgen.dataset.shards import Shard, shards_of
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import run_id_of

MOST_RUNS_A_JOB = 8
JOBS_PER_WORKER = 4
"""Least number of jobs for each worker, so that a small set uses all of them to the end."""
Job = tuple[Path, str, Shard, tuple[int, ...]]


@dataclass(frozen=True)
class Part:
    """Part `number` of `count` equal parts of a set, from 1, for one job of an array of jobs."""

    number: int = 1
    count: int = 1

    def __str__(self) -> str:
        return f"{self.number}/{self.count}"


def part_of(text: str) -> Part:
    """Return the part that a text such as "17/200" names. Raises UserError for any other text."""
    number, _, count = str(text).partition("/")
    if not (number.isdecimal() and count.isdecimal() and 1 <= int(number) <= int(count)):
        raise UserError(f"--shard {text}: give number/count, the number from 1 to the count, such as 17/200")
    return Part(int(number), int(count))


@dataclass(frozen=True)
class PartOfSet:
    """The runs of a set, or of one part of it, by shard, and which of them are missing.

    No file of a closed shard is read: only the folder of closed shards is listed. All is as it was when it was first
    looked at.
    """

    recipe: Recipe
    layout: Layout
    part: Part = field(default_factory=Part)
    only: frozenset[str] | None = None
    """Names of the shards to make; None makes all."""
    _missing: dict[str, tuple[int, ...]] = field(default_factory=dict, init=False, repr=False)
    """The missing runs of the shards that were looked at, by name of the shard."""

    def shards(self) -> Iterator[tuple[Shard, tuple[int, ...]]]:
        """Yield the shards of this part, each with the numbers of its runs that are of this part, missing or not.

        Each shard is of one part. Where there are fewer shards than parts, several parts share the runs of a shard. If
        `only` is set, other shards are left out.
        """
        for place, shard in enumerate(shards_of(self.recipe)):
            if self.only is not None and shard.name not in self.only:
                continue
            if self._shares_shards:
                runs = self.runs_of(shard)
                if runs:
                    yield shard, runs
            elif place % self.part.count == self.part.number - 1:
                yield shard, shard.indexes

    def runs_of(self, shard: Shard) -> tuple[int, ...]:
        """Return the numbers of the shard's runs that are of this part: all of them, where parts share no shard."""
        if not self._shares_shards:
            return shard.indexes
        count, runs = self.part.count, self.recipe.runs
        return tuple(index for index in shard.indexes if index * count // runs == self.part.number - 1)

    def missing_of(self, shard: Shard) -> tuple[int, ...]:
        """Return the numbers of the runs of this part that the shard lacks. A closed shard lacks none.

        A run is lacking if it is not kept, or if it is good and one of its own files is not there.
        """
        if shard.name in self.closed:
            return ()
        if shard.name not in self._begun:
            return self.runs_of(shard)
        if shard.name not in self._missing:
            good = {
                index for index, kept in kept_runs(self.layout, shard.name).items() if self._is_whole(index, kept.good)
            }
            self._missing[shard.name] = tuple(index for index in self.runs_of(shard) if index not in good)
        return self._missing[shard.name]

    @cached_property
    def closed(self) -> frozenset[str]:
        """Names of the closed shards."""
        return frozenset(path.stem for path in self.layout.closed("").parent.glob("*.json"))

    @cached_property
    def _begun(self) -> frozenset[str]:
        return frozenset(path.name for path in self.layout.kept("").glob("*"))

    @cached_property
    def _shares_shards(self) -> bool:
        """Whether there are fewer shards than parts."""
        return self.part.count > 1 and sum(1 for _ in shards_of(self.recipe)) < self.part.count

    def _is_whole(self, index: int, good: bool) -> bool:
        """Return whether the files of a kept run are there."""
        formats = run_formats(self.recipe.output.formats) if good else []
        return all(self.layout.export(each.name, run_id_of(index)).exists() for each in formats)


class Plan:
    """The jobs that make the missing runs of a part of a set, in order."""

    def __init__(self, part: PartOfSet, session: str) -> None:
        """Count what is there. `session` is the name of this call of `generate`."""
        self._part, self._session = part, session
        self.done = self.total = 0
        self.first_missing = -1
        """Number of the first run to make; -1 where none is missing."""
        self._urgent: deque[Job] = deque()
        self._left: dict[str, int] = {}
        for shard, runs in part.shards():
            self.total += len(runs)
            missing = part.missing_of(shard)
            self.done += len(runs) - len(missing)
            if missing and self.first_missing < 0:
                self.first_missing = missing[0]

    @property
    def missing(self) -> int:
        """Number of runs to make."""
        return self.total - self.done

    def kept_now(self) -> int:
        """Return the number of runs kept so far in the shards that are at work."""
        return sum(len(kept_runs(self._part.layout, name)) for name in self._left)

    def jobs(self, workers: int) -> Iterator[Job]:
        """Yield the jobs, as the arguments of `do`, for `workers` workers.

        `ended` may add jobs: take one after each result.
        """
        size = max(1, min(MOST_RUNS_A_JOB, ceil(self.missing / (JOBS_PER_WORKER * workers))))
        return _Queue(self._urgent, self._jobs(size))

    def ended(self, shard: Shard) -> None:
        """Note that a job that made runs of this shard has ended. Do not call it for a job that closes a shard.

        After the shard's last job, a job that closes it is added if all runs of the shard are of this part.
        """
        self._left[shard.name] -= 1
        if not self._left[shard.name]:
            del self._left[shard.name]
            self._close(shard)

    def _jobs(self, size: int) -> Iterator[Job]:
        for shard, _ in self._part.shards():
            missing = self._part.missing_of(shard)
            pieces = [missing[start : start + size] for start in range(0, len(missing), size)]
            if pieces:
                self._left[shard.name] = len(pieces)
                yield from (self._job(shard, piece) for piece in pieces)
            elif shard.name not in self._part.closed:
                self._close(shard)
                while self._urgent:
                    yield self._urgent.popleft()

    def _close(self, shard: Shard) -> None:
        """Ask for the closing of a shard, if all its runs are of this part: another part may be at work on the rest."""
        if len(self._part.runs_of(shard)) == len(shard.indexes):
            self._urgent.append(self._job(shard, ()))

    def _job(self, shard: Shard, indexes: tuple[int, ...]) -> Job:
        return self._part.layout.root.resolve(), self._session, shard, indexes


class _Queue(Iterator[Job]):
    """Jobs in order, urgent ones first. After its end it may have more."""

    def __init__(self, urgent: deque[Job], rest: Iterator[Job]) -> None:
        self._urgent, self._rest = urgent, rest

    def __next__(self) -> Job:
        return self._urgent.popleft() if self._urgent else next(self._rest)


def do(root: Path, session: str, shard: Shard, indexes: tuple[int, ...]) -> tuple[Shard, int]:
    """Do one job: make these runs of a shard. Return the shard and the number of runs made.

    - root: directory of the set.
    - session: name of the call of `generate`.
    - shard: the shard.
    - indexes: numbers of the runs. If there are none, the shard is closed and the number is 0.
    """
    if not indexes:
        close_shard(root, shard)
    return shard, make_runs(root, shard.name, session, indexes) if indexes else 0
