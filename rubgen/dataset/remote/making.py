"""Make a set whose place is a URL: in a local folder, from which each shard goes up when it is closed."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

from rubgen.cache_root import cache_folder
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.close import ClosedShard, read_closed
from rubgen.dataset.manifest import Identity, read_manifest
from rubgen.dataset.remote.store import Store
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import UserError, warn


class RemoteMaking:
    """The local folder in which a set for a URL is made, and the store to which its closed shards are uploaded.

    The record and the rows of `runs` of each closed shard are kept in both places. From `.staging` in the store,
    another computer, or this computer after its folder is lost, knows which shards are done. All other files of a shard
    are deleted in the local folder after their upload.
    """

    def __init__(self, url: str, part: str = "") -> None:
        """Take the URL, and the part of the set that is made in a folder of its own.

        Raises UserError where the URL cannot be used or the cache folder cannot be written.
        """
        self.store = Store(url)
        folder = cache_folder("sets")
        if folder is None:
            raise UserError(f"--out {url}: a set is made in the cache folder first, which cannot be written")
        name = sha256(f"{self.store.layout.root} {part}".encode()).hexdigest()[:16]
        self.layout = Layout(folder / name)

    @contextmanager
    def folder(self) -> Iterator[None]:
        """Make the parent of the local folder.

        Delete the local folder after the block, unless the block raises an error. After a UserError the reservation
        that `begin` made at the URL is removed, if nothing else is there. A warning names the folder, since a large set
        needs space there.
        """
        self.layout.root.parent.mkdir(parents=True, exist_ok=True)
        warn(f"{self.store.layout.root}: made in {self.layout.root}, from which finished shards go up and are deleted")
        try:
            yield
        except UserError:
            self.store.abandon()
            raise
        shutil.rmtree(self.layout.root, ignore_errors=True)

    def begin(self, identity: Identity, formats: tuple[str, ...]) -> None:
        """Reserve the place at the URL for this set, and bring URL and local folder to the same closed shards.

        - identity: recipe, machine, sensors and versions of the set.
        - formats: formats of its files.

        Records of shards that were uploaded before are downloaded, so that these shards are not made again. Shards that
        were closed in the local folder and not uploaded before an interruption are uploaded now. Raises UserError where
        the URL has other files, another set or a finished set, and where it cannot be read or written.
        """
        store = self.store
        there = store.begin(identity, grows=False)
        prefix = f"{self.layout.staging.name}/closed/"
        done = {Path(name).stem for name in there if name.startswith(prefix)}
        here = {path.stem for path in self.layout.closed("").parent.glob("*.json")}
        for name in sorted(done - here):
            self.layout.staged(RUNS.name, name).parent.mkdir(parents=True, exist_ok=True)
            store.get(self._inner(self.layout.staged(RUNS.name, name)), self.layout.staged(RUNS.name, name))
            store.get(self._inner(self.layout.closed(name)), self.layout.closed(name))
        for name in sorted(here - done):
            self.put_shard(name, formats)
        for name in sorted(here & done):
            self._delete(name, formats, read_closed(self.layout, name))

    def put_shard(self, name: str, formats: tuple[str, ...]) -> None:
        """Upload the files of the closed shard `name`, then its rows of `runs` and last its record.

        Then delete its local files.
        """
        layout, record = self.layout, read_closed(self.layout, name)
        for table, entry in zip(tables_of(formats), record.tables, strict=True):
            self.store.put(layout.staged(table.name, name), entry.path)
        for entry in (*record.exports, *record.derived):
            self.store.put(layout.root / entry.path, entry.path)
        for path in (layout.staged(RUNS.name, name), layout.closed(name)):
            self.store.put(path, self._inner(path))
        self._delete(name, formats, record)

    def finish(self) -> None:
        """Upload the files that belong to the whole set, the manifest and its digest last."""
        layout = self.layout
        for path in (layout.runs, layout.sensors, layout.card, layout.croissant):
            self.store.put(path, self._inner(path))
        self.store.complete(layout, read_manifest(layout), self.store.sizes())

    def _delete(self, name: str, formats: tuple[str, ...], record: ClosedShard) -> None:
        for table in tables_of(formats):
            self.layout.staged(table.name, name).unlink(missing_ok=True)
        for entry in (*record.exports, *record.derived):
            (self.layout.root / entry.path).unlink(missing_ok=True)

    def _inner(self, path: Path) -> str:
        return path.relative_to(self.layout.root).as_posix()
