"""Paths of the files of a data set."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from rubgen.formats import format_of

SPLIT = "train"
"""The only split: splits go by machine, never by run, and a recipe has one machine."""
RUNS_PER_SHARD = 256
"""About 160 MB of signals of one second."""
RUNS_PER_ROW_GROUP = 8
"""Measured on 32 runs of 1 s: as small (634 kB a run; 723 with 1) and as fast to stream as 16, and one run is read in
20 ms (35 with 16, 6 with 1)."""


@dataclass(frozen=True)
class Layout:
    """Paths in the directory `root` of a data set."""

    root: Path

    @property
    def manifest(self) -> Path:
        """Recipe, seed, versions and the sha256 of every file."""
        return self.root / "manifest.json"

    @property
    def digest(self) -> Path:
        """The sha256 of the manifest."""
        return self.root / "manifest.json.sha256"

    @property
    def derived(self) -> Path:
        """Sizes and sha256 of the derived files, of this writing."""
        return self.root / "derived.json"

    @property
    def runs(self) -> Path:
        """All runs, failed ones too, without signals."""
        return self.root / "runs.parquet"

    @property
    def card(self) -> Path:
        """The data-set card."""
        return self.root / "README.md"

    @property
    def croissant(self) -> Path:
        """The description for machine-learning tools."""
        return self.root / "croissant.json"

    @property
    def data(self) -> Path:
        """Folder of the Parquet files with signals."""
        return self.root / "data"

    @property
    def staging(self) -> Path:
        """Finished runs until the set is complete."""
        return self.root / ".staging"

    @property
    def identity(self) -> Path:
        """The identity of an unfinished set."""
        return self.staging / "identity.json"

    def staged(self, run_id: str) -> Path:
        """The finished run: its existence proves that all its files are complete."""
        return self.staging / "runs" / f"{run_id}.parquet"

    def staged_section(self, run_id: str) -> Path:
        """The compact record of a finished run."""
        return self.staging / "sections" / f"{run_id}.parquet"

    @property
    def sections(self) -> Path:
        """Folder of the compact records, from which labels can be made again."""
        return self.root / "sections"

    def section_shard(self, number: int, count: int) -> Path:
        """A file of the compact records of as many runs as a data file has."""
        return self.sections / f"{SPLIT}-{number:05d}-of-{count:05d}.parquet"

    def export(self, kind: str, run_id: str) -> Path:
        """The file of a run in a format. The format's name is its folder and its ending."""
        return self.root / kind / f"{run_id}.{kind}"

    def folders(self, names: Iterable[str]) -> list[Path]:
        """The folders of these formats: `data` for Parquet, else the folder of its name."""
        return [self.root / name if format_of(name).one_file_a_run else self.data for name in names]

    def shard(self, number: int, count: int) -> Path:
        """A data file."""
        return self.data / f"{SPLIT}-{number:05d}-of-{count:05d}.parquet"

    def number_of_shards(self, good_runs: int) -> int:
        """Number of data files, and of files of sections, for this number of good runs: at least one."""
        return max(1, math.ceil(good_runs / RUNS_PER_SHARD))

    def shards(self) -> list[Path]:
        """The existing data files, in order."""
        return sorted(self.data.glob("*.parquet"))
