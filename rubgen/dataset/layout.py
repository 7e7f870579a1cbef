"""Paths of the files of a data set. Nothing is read or written here."""

from collections.abc import Iterable
from pathlib import Path

from rubgen.errors import UserError
from rubgen.formats import format_of
from rubgen.io.places import place_of
from rubgen.scenario.run_id import index_of

SPLIT = "train"
"""The split of a recipe without splits."""
RUNS_PER_ROW_GROUP = 4
"""Measured on 16 runs of the recipe `laboratory`: 2.1 % larger than with 8, and one channel of a group is read in
0.4 to 0.7 of the time."""
RUNS_PER_FOLDER = 1000
"""Number of files of single runs in a folder: more are slow to list on the file systems of clusters."""


class Layout:
    """Paths of the files of a data set in the directory `root`."""

    def __init__(self, root: Path | str, staging: str = ".staging") -> None:
        """Derive all paths from `root`, a directory or a URL; `staging` names the folder of an unfinished set.

        Raises UserError for what is no path, and for a URL that cannot be used.
        """
        try:
            root = place_of(root)
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
        self.sensors = root / "sensors.parquet"
        """The sensors, their values as numbers."""
        self.card = root / "README.md"
        """The data-set card."""
        self.croissant = root / "croissant.json"
        """The description for machine-learning tools."""
        self.staging = root / staging
        """Kept runs and closed shards until the set is complete."""
        self.identity = self.staging / "identity.json"
        """The identity of an unfinished set."""
        self.decided = self.staging / "decided.parquet"
        """Rows of runs that have the candidates of an unfinished set: those of the set with other sensors."""

    def kept(self, shard: str) -> Path:
        """Return the folder of the finished runs of an open shard."""
        return self.staging / "kept" / shard

    def closed(self, shard: str) -> Path:
        """Return the path of the record of a closed shard. Where it exists, all files of the shard are complete."""
        return self.staging / "closed" / f"{shard}.json"

    def staged(self, table: str, shard: str) -> Path:
        """Return the path of a closed shard's file of a table in the staging folder of an unfinished set."""
        return self.staging / table / f"{shard}.parquet"

    def shard(self, table: str, shard: str) -> Path:
        """Return the path of a shard's file of a table in the complete set."""
        return self.root / table / f"{shard}.parquet"

    def export(self, kind: str, run_id: str) -> Path:
        """Return the path of a run's file in the format `kind`, which is also the file's ending and its top folder.

        It is in a subfolder with up to RUNS_PER_FOLDER runs. Raises ValueError for a text that is no name of a run.
        """
        return self.root / kind / f"{index_of(run_id) // RUNS_PER_FOLDER:04d}" / f"{run_id}.{kind}"

    def folders(self, names: Iterable[str]) -> list[Path]:
        """Return the folders of the formats `names`: `signals` for Parquet, else the folder with the format's name."""
        return [self.root / (name if format_of(name).one_file_a_run else "signals") for name in names]
