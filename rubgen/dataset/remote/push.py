"""Copy a finished data set to a URL."""

from pathlib import Path

from rubgen.brief import in_shell
from rubgen.dataset.files import sha256_of
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import FileEntry, read_manifest
from rubgen.dataset.remote.store import Store
from rubgen.errors import UserError
from rubgen.io.places import is_there, url_problems
from rubgen.progress import count, step


def push(directory: Path | str, url: str) -> int:
    """Copy the finished data set in `directory` to a URL such as s3://bucket/set. Return the number of files copied.

    Files are uploaded one by one. The manifest and its digest, which are not counted, are the last: an incomplete set
    cannot be opened. The same call after an interruption copies files that are missing or have another size. If the URL
    has a set with fewer runs of the same recipe, the new runs are added. Raises UserError where the directory has no
    finished set or a damaged file, the URL cannot be written, or the URL has other files, another set, or the same set
    with more runs or of other package versions.
    """
    source, store = Layout(directory), Store(url)
    manifest = read_manifest(source)
    with url_problems(store.layout.root):
        whole = is_there(store.layout.digest) and store.layout.digest.read_bytes() == source.digest.read_bytes()
    there = store.sizes() if whole else store.begin(manifest.identity)
    entries = {entry.path: entry for entry in manifest.files}
    if not whole:
        store.open_again(entries)
        there = store.sizes()
    missing = [name for name, entry in entries.items() if there.get(name) != entry.bytes]
    missing += [name for name in manifest.derived if not whole or name not in there]
    with step("push", "files", long=True):
        for number, name in enumerate(missing):
            count(number, len(missing))
            _check_whole(source.root / name, entries.get(name))
            store.put(source.root / name, name)
    if missing or not whole or store.staged(there):
        store.complete(source, manifest, there)
    return len(missing)


def _check_whole(file: Path, entry: FileEntry | None) -> None:
    """Check a file before it goes up, so that a damaged set does not spread."""
    try:
        good = entry is None or sha256_of(file) == entry.sha256
    except OSError as error:
        raise UserError(f"{file}: cannot be read ({error.strerror}); check the set: rubgen verify") from None
    if not good:
        raise UserError(
            f"{file}: its sha256 is not the one in the manifest; mend it: rubgen repair {in_shell(file.parents[1])}"
        )
