"""A data set at a URL: finished files go up whole, the manifest last, so that half a set is never taken for one."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from rubgen.brief import counted
from rubgen.dataset.files import write_json
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.claim import check_same
from rubgen.dataset.manifest import FileEntry, Identity, Manifest, read_identity, read_manifest
from rubgen.errors import UserError
from rubgen.io.places import answered, is_there, is_url, url_problems


class Store:
    """The files of one data set at a URL.

    Until the set is complete, `.staging/identity.json` there contains its identity.
    """

    def __init__(self, url: str) -> None:
        """Take the URL. Raises UserError where it cannot be used."""
        self.layout = Layout(url)
        root: Any = self.layout.root
        if not is_url(root):
            raise UserError(f"{url}: is no URL of an object store; give one such as s3://bucket/set")
        self._files, self._root = root.fs, root.path.rstrip("/")
        self._marked = False

    def sizes(self) -> dict[str, int]:
        """Return the size in bytes of each file at the URL, by its path in the set."""
        self._files.invalidate_cache()
        found = answered(self.layout.root, lambda: self._files.find(self._root, detail=True))
        start = len(self._root) + 1
        return {name[start:]: int(facts["size"] or 0) for name, facts in found.items()}

    def check_sizes(self, manifest: Manifest) -> None:
        """Check that the files in the manifest of a finished set are there with their sizes.

        Derived files only have to be there. Raises UserError with the first wrong file.
        """
        there = self.sizes()
        wrong = [
            f"{entry.path}: has {there[entry.path]:,} bytes, the manifest says {entry.bytes:,}"
            if entry.path in there
            else f"{entry.path}: listed in the manifest, but not there"
            for entry in manifest.files
            if there.get(entry.path) != entry.bytes
        ]
        wrong += [f"{name}: listed in the manifest, but not there" for name in manifest.derived if name not in there]
        if wrong:
            root = self.layout.root
            raise UserError(
                f"{root}: {wrong[0]} ({counted(len(wrong), 'problem')} in all); copy it again from a directory with "
                f"this set: rubgen push DIRECTORY {root}"
            )

    def begin(self, identity: Identity, *, grows: bool = True) -> dict[str, int]:
        """Reserve the URL for the set of this identity. Return the files that were there before, as `sizes`.

        Raises UserError where the URL has a set of another recipe or of other package versions, a finished set with
        more runs, an unfinished set with another number of runs, or other files, and where it cannot be written. With
        `grows` False, any finished set is refused.
        """
        layout, there = self.layout, self.sizes()
        marker = self._name(layout.identity)
        if marker in there:
            check_same(layout, read_identity(layout), identity, versions=True)
        elif layout.digest.name in there:
            self._check_grows(identity)
            if not grows:
                raise UserError(
                    f"{layout.root}: holds a finished set with fewer runs, which grows only in a directory; make it "
                    f"there, then: rubgen push DIRECTORY {layout.root}"
                )
        elif there:
            raise UserError(f"{layout.root}: not empty and no data set of rubgen; give a new place")
        if marker not in there:
            with TemporaryDirectory() as folder:
                file = Path(folder) / layout.identity.name
                write_json(file, identity.model_dump(mode="json"))
                answered(layout.root, lambda: self.put(file, marker))
            self._marked = True
        return there

    def abandon(self) -> None:
        """Remove the identity that `begin` wrote, if no other file is at the URL."""
        marker = self._name(self.layout.identity)
        if self._marked:
            with suppress(UserError):
                self.remove([marker] if list(self.sizes()) == [marker] else [])

    def _check_grows(self, identity: Identity) -> None:
        before = read_manifest(self.layout).identity
        runs = int(identity.recipe["runs"])
        if int(before.recipe["runs"]) > runs and before.with_runs(runs).same_recipe(identity):
            raise UserError(
                f"{self.layout.root}: holds {before.recipe['runs']} runs of this recipe, here are {runs}; it only grows"
            )
        check_same(self.layout, before.with_runs(runs), identity, versions=True)

    def put(self, file: Path, name: str) -> None:
        """Upload `file` to the path `name` in the set. The object is there completely or not at all."""
        with url_problems(self.layout.root):
            self._files.put_file(str(file), f"{self._root}/{name}")

    def get(self, name: str, file: Path) -> None:
        """Download the object at the path `name` in the set to `file`, which appears completely or not at all."""
        part = file.with_name(f"{file.name}.part")
        with url_problems(self.layout.root):
            self._files.get_file(f"{self._root}/{name}", str(part))
        part.replace(file)

    def remove(self, names: Iterable[str]) -> None:
        """Delete the objects at these paths in the set. Missing objects are ignored."""
        for name in names:
            with url_problems(self.layout.root), suppress(FileNotFoundError):
                self._files.rm_file(f"{self._root}/{name}")

    def complete(self, source: Layout, manifest: Manifest, there: dict[str, int]) -> None:
        """Upload the manifest and last its digest, then delete the files of the unfinished state.

        - source: paths of the local set.
        - manifest: its manifest.
        - there: the other files at the URL, as from `sizes`.
        """
        if manifest.derived:
            self.put(source.derived, source.derived.name)
        self.put(source.manifest, source.manifest.name)
        self.put(source.digest, source.digest.name)
        self.remove([*self.staged(there), self._name(self.layout.identity)])

    def staged(self, there: Iterable[str]) -> list[str]:
        """Return the paths in `there` that exist only while the set is not complete."""
        return sorted(name for name in there if name.startswith(f"{self.layout.staging.name}/"))

    def open_again(self, entries: dict[str, FileEntry]) -> None:
        """Delete digest and manifest of a finished set at the URL, and its files whose content differs from `entries`.

        `entries` are the files of the new set by path. The manifest is deleted last: after an interruption, the same
        call still knows the content. Nothing is done where there is no manifest.
        """
        manifest, digest = (self.layout.root / name for name in (self.layout.manifest.name, self.layout.digest.name))
        if not is_there(manifest):
            return
        self.remove([digest.name])
        with url_problems(self.layout.root):
            before = Manifest.model_validate_json(manifest.read_bytes())
        mine = {path: entry.sha256 for path, entry in entries.items()}
        self.remove(each.path for each in before.files if mine.get(each.path) != each.sha256)
        self.remove([manifest.name])

    def _name(self, path: Path) -> str:
        return str(path)[len(str(self.layout.root)) + 1 :]
