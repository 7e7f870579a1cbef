"""The shards of a data set: groups of runs of one split. A shard is the unit of work, and one file of each table."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from rubgen.scenario import Recipe

RUNS_PER_SHARD = 128
"""About 80 MB of signals of one second, and some six minutes of one core. Half as many runs double the number of files
of a large set; twice as many double the work that one close of a shard repeats."""


@dataclass(frozen=True)
class Shard:
    """Up to RUNS_PER_SHARD runs of one split, failed runs included.

    Only the last shard of a split has fewer runs; in a merged set, the last shard of a split in each source.
    """

    split: str
    number: int
    """Its place among the shards of the split, from 0."""
    indexes: tuple[int, ...]
    """Numbers of its runs, ascending."""

    @property
    def name(self) -> str:
        """Name of its files without the ending. It stays the same when runs are added to the set."""
        return f"{self.split}-{self.number:05d}"

    @property
    def full(self) -> bool:
        """Whether no run can be added."""
        return len(self.indexes) == RUNS_PER_SHARD


def shards_of(recipe: Recipe) -> Iterator[Shard]:
    """Yield the shards of the recipe's set: full shards in the order of their last runs, then the last of each split.

    A merged set has the shards of its sources, one source after the other. Memory does not grow with the number of
    runs.
    """
    yield from (shard for _, _, shard in source_shards(recipe))


def source_shards(recipe: Recipe) -> Iterator[tuple[int, Shard, Shard]]:
    """Yield for each shard of each source: the source's number, the shard there, and the shard in the merged set.

    Runs are numbered in the source there, and in the merged set here. A set that is not merged is its only source.
    """
    before = Counter[str]()
    for number, (first, source) in enumerate(recipe.sources):
        mine = Counter[str]()
        for shard in _shards(source):
            mine[shard.split] += 1
            place, indexes = before[shard.split] + shard.number, tuple(index + first for index in shard.indexes)
            yield number, shard, Shard(shard.split, place, indexes)
        before += mine


def _shards(recipe: Recipe) -> Iterator[Shard]:
    waiting: dict[str, list[int]] = {}
    numbers: dict[str, int] = {}
    machine, split = -1, ""
    for index in range(recipe.runs):
        if recipe.machine_number(index) != machine:
            machine, split = recipe.machine_number(index), recipe.split_of(index)
        mine = waiting.setdefault(split, [])
        mine.append(index)
        if len(mine) == RUNS_PER_SHARD:
            yield Shard(split, numbers.setdefault(split, 0), tuple(waiting.pop(split)))
            numbers[split] += 1
    for name, left in waiting.items():
        yield Shard(name, numbers.get(name, 0), tuple(left))
