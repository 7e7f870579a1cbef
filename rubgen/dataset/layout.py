"""Paths of the files of a data set. Nothing is read or written here."""

import math
from collections.abc import Iterable
from pathlib import Path

from rubgen.errors import UserError
from rubgen.formats import format_of

SPLIT = "train"
"""The only split: splits go by machine, never by run, and a recipe has one machine."""
RUNS_PER_SHARD = 256
"""About 160 MB of signals of one second."""
RUNS_PER_ROW_GROUP = 8
"""Measured on 32 runs of 1 s: as small (634 kB a run; 723 with 1) and as fast to stream as 16, and one run is read in
20 ms (35 with 16, 6 with 1)."""


class Layout:
    """Paths of the files of a data set in the directory `root`."""

    def __init__(self, root: Path | str) -> None:
        """Derive all paths from `root`. Raises UserError for what is no path."""
        try:
            root = Path(root)
        except TypeError:
            raise UserError(
                f"{root!r:.200}: is no path; give the directory of a data set as a text or a Path"
            ) from None
        self.root = root
        self.manifest = root / "manifest.json"
        """Recipe, seed, versions and the sha256 of every file."""
        self.digest = root / "manifest.json.sha256"
        """The sha256 of the manifest."""
        self.derived = root / "derived.json"
        """Sizes and sha256 of the derived files, of this writing."""
        self.runs = root / "runs.parquet"
        """All runs, failed ones too, without signals."""
        self.card = root / "README.md"
        """The data-set card."""
        self.croissant = root / "croissant.json"
        """The description for machine-learning tools."""
        self.data = root / "data"
        """Folder of the Parquet files with signals."""
        self.sections = root / "sections"
        """Folder of the compact records, from which labels can be made again."""
        self.staging = root / ".staging"
        """Finished runs until the set is complete."""
        self.identity = self.staging / "identity.json"
        """The identity of an unfinished set."""

    def staged(self, run_id: str) -> Path:
        """Return the path of a finished run's row. Its existence proves that all files of the run are complete."""
        return self.staged_row("runs", run_id)

    def staged_row(self, table: str, run_id: str) -> Path:
        """Return the path of a finished run's row in the table of that name."""
        return self.staging / table / f"{run_id}.parquet"

    def export(self, kind: str, run_id: str) -> Path:
        """Return the path of a run's file in the format `kind`, whose name is its folder and its ending."""
        return self.root / kind / f"{run_id}.{kind}"

    def folders(self, names: Iterable[str]) -> list[Path]:
        """Return the folders of the formats `names`: `data` for Parquet, else the folder with the format's name."""
        return [self.root / name if format_of(name).one_file_a_run else self.data for name in names]

    def shard(self, table: str, number: int, count: int) -> Path:
        """Return the path of file `number`, from 0, of the `count` files of a table, of up to RUNS_PER_SHARD runs."""
        return self.root / table / f"{SPLIT}-{number:05d}-of-{count:05d}.parquet"

    def number_of_shards(self, good_runs: int) -> int:
        """Return the number of data files, and of files of sections, for this number of good runs: at least one."""
        return max(1, math.ceil(good_runs / RUNS_PER_SHARD))
