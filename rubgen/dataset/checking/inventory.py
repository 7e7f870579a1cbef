"""Compare the files of a data set with its manifest: good, damaged, missing, or not listed."""

import os
import stat
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from rubgen.dataset.files import is_system_file, sha256_of
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import FileEntry, Manifest, read_derived
from rubgen.errors import UserError

REPORT = "report.html"
REPORT_MARK = b'<meta name="generator" content="rubgen report">'
"""In the head of every page of `rubgen report`."""
HEAD_BYTES = 2000
REPAIRING = ".repair"
"""Folder where `repair` makes shards again. After a stop it goes on there."""


class Kind(Enum):
    """Which files a finding concerns: DATA, DERIVED (files that can be made again), or UNLISTED.

    The value is the remedy.
    """

    DATA = "make the set again"
    DERIVED = "rubgen repair"
    UNLISTED = "move it away"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """A problem of a set, in one line that names the file or the run."""

    text: str
    kind: Kind = Kind.DATA
    path: str = ""
    """Of a file that is not what was written; empty where the content of whole files is wrong."""
    closed: bool = False
    """Whether the file must not be opened: there is none, it is no regular file, or it is outside of the set."""


def file_findings(layout: Layout, manifest: Manifest, chosen: Callable[[str], bool]) -> Iterator[Finding]:
    """Yield a finding for every listed file that is missing, unreadable, outside of the set or changed.

    The manifest lists the files. Sizes are compared, and the sha256 of paths for which `chosen` returns True.
    Sizes and sha256 of derived files (.rrd) are in derived.json. Problems of derived.json are yielded too.
    """
    for entry in manifest.files:
        kind, read = _kind(layout, entry.path), chosen(entry.path)
        yield from _entry_findings(layout.root, entry.path, entry, "the manifest", kind, read=read)
    digests, found = derived_digests(layout, manifest)
    yield from found
    for name in manifest.derived:
        known, read = digests.get(name), chosen(name)
        yield from _entry_findings(layout.root, name, known, layout.derived.name, Kind.DERIVED, read=read)


def size_findings(layout: Layout, manifest: Manifest) -> Iterator[Finding]:
    """Yield a finding for every listed file that is missing or has another size. No file is read.

    The sizes of derived files are not compared.
    """
    for entry in manifest.files:
        yield from _entry_findings(
            layout.root, entry.path, entry, "the manifest", _kind(layout, entry.path), read=False
        )
    for name in manifest.derived:
        yield from _entry_findings(layout.root, name, None, layout.derived.name, Kind.DERIVED)


def _kind(layout: Layout, path: str) -> Kind:
    made = (layout.card.name, layout.croissant.name, layout.sensors.name)
    return Kind.DERIVED if path in made else Kind.DATA


def derived_digests(layout: Layout, manifest: Manifest) -> tuple[dict[str, FileEntry], list[Finding]]:
    """Return size and sha256 of each derived file by path, as listed in derived.json, and the problems of derived.json.

    If derived.json has problems, the dict is empty. Derived files are the files that `repair` can make again.
    """
    name = layout.derived.name
    if not manifest.derived:
        return {}, []
    try:
        _check_within(layout.root, layout.derived)
        digests = read_derived(layout)
    except (OSError, UserError) as error:
        return {}, [Finding(text=f"{name}: {_reason(error)}", kind=Kind.DERIVED, path=name)]
    if sorted(digests) != sorted(manifest.derived):
        return {}, [Finding(text=f"{name}: lists other files than the manifest", kind=Kind.DERIVED, path=name)]
    return digests, []


def _entry_findings(
    root: Path, name: str, entry: FileEntry | None, where: str, kind: Kind, *, read: bool = True
) -> Iterator[Finding]:
    path = root / name
    try:
        size = _check_within(root, path)
        if entry is not None and size != entry.bytes:
            yield Finding(text=f"{name}: has {size:,} bytes, {where} says {entry.bytes:,}", kind=kind, path=name)
        elif read and entry is not None and sha256_of(path) != entry.sha256:
            yield Finding(text=f"{name}: its sha256 is not the one in {where}", kind=kind, path=name)
    except (OSError, UserError) as error:
        yield Finding(text=f"{name}: {_reason(error)}", kind=kind, path=name, closed=True)


def _check_within(root: Path, path: Path) -> int:
    """Return the size of a regular file in the set itself. Raises UserError or OSError for anything else."""
    try:
        real = path.resolve(strict=True)
    except RuntimeError:
        raise UserError("is a link to itself") from None
    if not real.is_relative_to(root.resolve()):
        raise UserError("is a link out of the set; put the file itself there")
    found = real.stat()
    if not stat.S_ISREG(found.st_mode):
        raise UserError("is no regular file")
    return found.st_size


def _reason(error: OSError | UserError) -> str:
    if isinstance(error, FileNotFoundError):
        return "listed in the manifest, but not there"
    if isinstance(error, OSError):
        return f"cannot be read ({error.strerror or error})"
    return str(error).rpartition(": ")[2]


def unlisted_files(layout: Layout, manifest: Manifest) -> Iterator[Finding]:
    """Yield a finding for every file or folder in the set's directory that does not belong to the set.

    A file belongs to it if the manifest lists it. The content of a foreign folder is not listed. A folder that cannot
    be read has a finding too. Ignored are files of the operating system, and pages of `rubgen report`, known by their
    name and mark. Also ignored are `.staging` and its lock, which a stop of `generate` at its very end leaves, and
    `.repair`, which a stop of `repair` leaves: the next call continues there.
    """
    known = {entry.path for entry in manifest.files} | set(manifest.derived)
    known |= {layout.manifest.name, layout.digest.name}
    known |= {layout.derived.name} if manifest.derived else set()
    folders = {parent.as_posix() for name in known for parent in Path(name).parents}
    folders |= {folder.name for folder in layout.folders(manifest.identity.recipe["output"]["formats"])}
    unreadable: list[OSError] = []
    for folder, inner, names in os.walk(layout.root, onerror=unreadable.append):
        here = Path(folder).relative_to(layout.root)
        for name in _own(inner):
            if (here / name).as_posix() not in folders and not _is_left(layout, here / name):
                yield _unlisted((here / name).as_posix())
        inner[:] = [name for name in _own(inner) if (here / name).as_posix() in folders]
        for name in _own(names):
            path = (here / name).as_posix()
            if path not in known and not _is_left(layout, here / name) and not _is_report(layout.root, path):
                yield _unlisted(path)
    for error in unreadable:
        yield Finding(text=f"{Path(error.filename).name}: cannot be read ({error.strerror})", kind=Kind.UNLISTED)


def _own(names: Iterable[str]) -> list[str]:
    return sorted(name for name in names if not is_system_file(name))


def _is_left(layout: Layout, path: Path) -> bool:
    return path.parent == Path() and path.name.startswith((layout.staging.name, REPAIRING))


def _unlisted(path: str) -> Finding:
    return Finding(text=f"{path}: not listed in the manifest", kind=Kind.UNLISTED)


def _is_report(root: Path, name: str) -> bool:
    path = root / name
    try:
        if name != REPORT or not stat.S_ISREG(path.lstat().st_mode):
            return False
        with path.open("rb") as stream:
            return REPORT_MARK in stream.read(HEAD_BYTES)
    except OSError:
        return False
