"""Claim an output directory for one process, and tell whether it is empty, unfinished, finished or foreign."""

import errno
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import BaseFileLock, FileLock, SoftFileLock, Timeout

from rubgen.dataset.files import is_system_file, remove_parts, write_json
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.grow import prepare_growth
from rubgen.dataset.manifest import Identity, read_identity, read_manifest
from rubgen.dataset.tables import RUNS, TABLES
from rubgen.errors import UserError, warn
from rubgen.format_names import FORMAT_NAMES
from rubgen.io.files import PART, sync_directory
from rubgen.io.places import is_there, set_around

STAGED = ("kept", "closed", *(table.name for table in (RUNS, *TABLES)))
"""Folders of `.staging`."""
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EINVAL)
"""Errors of file systems without locks, such as NFS without its lock daemon."""


def acquired(path: Path, wait_s: float = 0.0) -> BaseFileLock | None:
    """Take the lock at `path`, waiting up to `wait_s` seconds. Return the lock, or None if another process has it.

    The caller releases it. On a file system without locks, a file that only one process can create is the lock. A
    warning then says so.
    """
    try:
        return _acquired(FileLock(path, timeout=wait_s))
    except NotImplementedError as error:
        reason: object = error
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
        reason = error.strerror
    soft = soft_lock(path)
    warn(f"{path.parent}: no file locks there ({reason}); {soft.name} is made instead, delete it after a kill")
    return _acquired(SoftFileLock(soft, timeout=wait_s))


def soft_lock(path: Path) -> Path:
    """Return the path of the file that replaces the lock at `path` where the file system has no locks."""
    return path.with_name(f"{path.name}.soft")


def _acquired(lock: BaseFileLock) -> BaseFileLock | None:
    try:
        lock.acquire()
    except Timeout:
        return None
    return lock


def finished(layout: Layout, identity: Identity) -> bool:
    """Return whether the directory holds the finished data set with this identity.

    A set with fewer runs of the same recipe is not finished: more runs can be added. Package versions are ignored.
    Raises UserError where the directory holds the finished set of another recipe, or a set of this recipe with more
    runs, or where the manifest there is damaged.
    """
    if not (is_there(layout.manifest) and is_there(layout.digest)):
        return False
    there = read_manifest(layout).identity
    asked, has = int(identity.recipe["runs"]), int(there.recipe["runs"])
    if asked != has and there.with_runs(asked).same_recipe(identity):
        if asked < has:
            held = f"holds {has} runs of this recipe, asked for {asked}"
            raise UserError(f"--out {layout.root}: {held}; it can only grow: ask for --runs {has} or more")
        return False
    check_same(layout, there, identity)
    return True


@contextmanager
def claimed(layout: Layout, identity: Identity, *, wait_s: float = 0.0) -> Iterator[None]:
    """Lock the output directory, so that only this process writes there in the block. It is made if it does not exist.

    If another process has the lock, this process waits for at most `wait_s` seconds. The state of the directory may
    have changed since a check before the block. A directory that was made here is removed if it stays empty, its
    parents are not. Sets of other recipes are refused by `finished` and `begun`, not here. `identity` is that of the
    set to be made: if another process keeps the lock and makes another set there, the error says so. Raises UserError
    where the directory lies in another data set or has content that is no data set, or another process keeps the lock;
    OSError where the directory cannot be made.
    """
    root = layout.root
    _check_place(layout)
    new = not root.exists()
    root.mkdir(parents=True, exist_ok=True)
    lock = acquired(_lock(layout), wait_s)
    if lock is None:
        check_begun(layout, identity)
        raise UserError(f"--out {root}: another rubgen is writing there; wait for it or choose another")
    try:
        yield
    finally:
        try:
            if not layout.staging.exists():  # all is done, or nothing was begun
                for left in (_lock(layout), soft_lock(_lock(layout))):  # a kill leaves them too
                    with suppress(OSError):
                        left.unlink()
        finally:
            lock.release()
        if new:
            with suppress(OSError):  # it holds the set
                root.rmdir()


@contextmanager
def begun(layout: Layout, identity: Identity) -> Iterator[None]:
    """Make the folders of an unfinished data set for the block, which fills them. Call it within `claimed`.

    The runs of a finished set of the recipe with fewer runs are taken over (`prepare_growth`). Incomplete files are
    removed. `.staging` appears in one step with the identity in it, so that the same recipe can continue after any
    stop. Raises UserError where the set there has another recipe or other package versions, or the directory has other
    content. After the block `.staging` is still there; `remove_staging` deletes it. But if the block raises a UserError
    before the first run is finished, everything is removed.
    """
    if not layout.identity.exists():
        _begin(layout, identity)
    check_begun(layout, identity)
    remove_parts(layout.root)
    sync_directory(layout.root)
    try:
        yield
    except UserError:
        if not any(any((layout.staging / name).iterdir()) for name in ("kept", "closed")):
            remove_staging(layout)
            _remove_empty(layout.folders(identity.recipe["output"]["formats"]))
        raise


def has_remains(layout: Layout, identity: Identity) -> bool:
    """Return whether `.staging` or a lock remains beside the finished set of this identity, after a late interruption.

    It is False where `.staging` belongs to another identity: then a set with more runs was begun.
    """
    with suppress(FileNotFoundError, UserError):
        if read_identity(layout) != identity:
            return False
    return any(layout.root.glob(f"{layout.staging.name}*"))


def remove_staging(layout: Layout) -> None:
    """Delete the staging folder of a complete set, and a half-made staging folder that a kill may leave."""
    for folder in (layout.staging, _unborn(layout)):
        if folder.exists():
            shutil.rmtree(folder)


def _begin(layout: Layout, identity: Identity) -> None:
    grows = layout.digest.exists()
    if not (grows or _holds_nothing(layout)):
        raise _not_ours(layout)
    remove_staging(layout)
    for name in STAGED:
        (_unborn(layout) / name).mkdir(parents=True)
    if grows:
        before = read_manifest(layout)
        check_same(layout, before.identity.with_runs(int(identity.recipe["runs"])), identity, versions=True)
        prepare_growth(Layout(layout.root, _unborn(layout).name), before, identity.recorded())
    write_json(_unborn(layout) / layout.identity.name, identity.model_dump(mode="json"))
    _unborn(layout).rename(layout.staging)
    sync_directory(layout.root)


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove folders of single runs that hold nothing yet."""
    for folder in (inner for outer in folders for inner in (*outer.glob("*"), outer)):
        with suppress(OSError):  # it holds what is not ours, or is not there
            folder.rmdir()


def _unborn(layout: Layout) -> Path:
    return layout.staging.with_name(f"{layout.staging.name}{PART}")


def _lock(layout: Layout) -> Path:
    return layout.staging.with_name(f"{layout.staging.name}.lock")


def _check_place(layout: Layout) -> None:
    """Raise UserError, before anything is written, where the directory surely has other content."""
    root = layout.root
    if "\0" in str(root):
        raise UserError(f"--out {str(root)!r}: has a NUL character in it; give another directory")
    if root.is_symlink() and not root.exists():
        raise UserError(f"--out {root}: is a link to {root.readlink()}, which is not there; give another directory")
    if root.exists() and not root.is_dir():
        raise UserError(f"--out {root}: is a file; give a new or empty directory")
    data_set = set_around(root)
    if data_set:
        raise UserError(f"--out {root}: lies in the data set {data_set}; choose a directory outside of it")
    if not (_is_ours(layout) or not root.exists() or _holds_nothing(layout) or _is_ours(layout)):
        raise _not_ours(layout)


def _is_ours(layout: Layout) -> bool:
    # In this order: who finishes a set writes the digest before the identity goes.
    return layout.identity.exists() or layout.digest.exists()


def _not_ours(layout: Layout) -> UserError:
    return UserError(f"--out {layout.root}: not empty and no data set of rubgen; give a new or empty directory")


def _holds_nothing(layout: Layout) -> bool:
    """Return whether the directory has only files of the operating system, and remains of a stop at the start."""
    try:
        return all(_is_nothing(layout, path) for path in layout.root.iterdir())
    except FileNotFoundError:  # it vanished meanwhile: another rubgen is at work, the lock will tell
        return True


def _is_nothing(layout: Layout, path: Path) -> bool:
    if is_system_file(path.name) or path == _unborn(layout) or path.name.startswith(_lock(layout).name):
        return True
    folders = {layout.staging.name, *STAGED}
    folders |= {folder.name for folder in layout.folders(FORMAT_NAMES)}
    if path.name not in folders or path.is_symlink() or not path.is_dir():
        return False
    files = (below for below in path.rglob("*") if not (below.name in folders and below.is_dir()))
    return all(is_system_file(file.name) or file.name == "lock" or PART in file.name for file in files)


def check_begun(layout: Layout, asked: Identity) -> None:
    """Raise UserError if the directory has an unfinished set of another recipe or of other package versions.

    `asked` is the identity of the set that is to be made. Nothing is raised for a directory without an unfinished set.
    """
    with suppress(FileNotFoundError):  # not begun yet, or just finished
        check_same(layout, read_identity(layout), asked, versions=True)


def check_same(layout: Layout, there: Identity, asked: Identity, *, versions: bool = False) -> None:
    """Check that two identities are of the same recipe. Raises UserError with the first key that differs.

    - layout: paths of the directory, for the message.
    - there: identity of the set in the directory.
    - asked: identity of the set that is to be made.
    - versions: compare the versions of packages too.
    """
    if not there.same_recipe(asked):
        key, old, new = _first_difference(there, asked)
        raise UserError(
            f"--out {layout.root}: holds the output of another recipe ({key} = {old!r}, asked for {new!r}); "
            "give another directory"
        )
    if versions and there.packages != asked.packages:
        names = sorted(name for name in asked.packages if there.packages.get(name) != asked.packages[name])
        name = names[0] if names else "packages"
        raise UserError(
            f"--out {layout.root}: begun with {name} {there.packages.get(name)}, now it is {asked.packages.get(name)}; "
            "finish it with the old version or give another directory"
        )


def _first_difference(there: Identity, asked: Identity) -> tuple[str, object, object]:
    for part in ("recipe", "machine", "sensors", "split_sensors"):
        old, new = (_flat({part: getattr(each, part)}) for each in (there, asked))
        for key in [*new, *old]:
            if old.get(key) != new.get(key):
                return key.removeprefix("recipe."), old.get(key), new.get(key)
    return "identity.sources", [each.digits for each in there.sources], [each.digits for each in asked.sources]


def _flat(values: dict[str, object], prefix: str = "") -> dict[str, object]:
    flat: dict[str, object] = {}
    for key, each in values.items():
        value = _by_name(each) if isinstance(each, list) else each
        flat |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat


def _by_name(listed: list[object]) -> object:
    """Return a list of tables as a table by their names or numbers; any other list unchanged."""
    tables = [each for each in listed if isinstance(each, dict)]
    return {str(each.get("name", i)): each for i, each in enumerate(tables)} if len(tables) == len(listed) else listed
