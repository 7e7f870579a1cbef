"""The caches: compiled kernels and reduced blisks, which would otherwise be made again by each process.

rubgen works without caches. If their folder cannot be used, a private temporary folder takes its place. A damaged file
is made again. If no file can be written at all, each process makes everything. One warning says what is done.
"""

import atexit
import hashlib
import multiprocessing
import os
import shutil
import stat
import tempfile
import uuid
from contextlib import suppress
from functools import cache
from pathlib import Path

import platformdirs

from rubgen.errors import warn

CACHE_VARIABLE = "RUBGEN_CACHE_DIR"
FOLDERS = ("kernels", "reduction")
_DIGEST_BYTES = hashlib.sha256().digest_size

pending_warnings: list[str] = []
"""Warnings of a worker process about its caches; its parent process shows them."""


def wanted_root() -> Path:
    """Return the folder that should hold all caches: $RUBGEN_CACHE_DIR, or rubgen's folder in the user's cache folder.

    The folder need not exist, and may not be usable.
    """
    root = Path(os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_dir("rubgen"))
    with suppress(RuntimeError):  # there is no home folder
        root = root.expanduser()
    return root


def cache_folder(name: str) -> Path | None:
    """Return the folder called `name` of the caches, such as one of FOLDERS, or None if none can be written anywhere.

    The folder need not exist. It lies below `wanted_root()`, or else below a temporary folder of this process. A
    warning then says so. Child processes use the same folder: $RUBGEN_CACHE_DIR is set to the path of a temporary one.
    """
    root = _settled_root(wanted_root())
    return None if root is None else root / name


def problem_of(root: Path) -> str:
    """Try to write caches in the folder `root` and its subfolders. Return the reason if that fails, or an empty text.

    The subfolders are `kernels` and `reduction`. Missing folders are made. A folder that belongs to another user, or
    that all users may write to, is refused: anyone could put code there.
    """
    if str(root).startswith("~"):
        return "there is no home folder"
    try:
        for folder in (root, *(root / name for name in FOLDERS)):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            if _is_foreign(folder.stat()):
                return f"{folder} belongs to another user, or every user may write to it"
            with tempfile.TemporaryFile(dir=folder) as file:
                file.write(bytes(4096))
    except OSError as error:
        return f"{error.filename or root}: {error.strerror or error}"
    return ""


def write_cached(path: Path, content: bytes) -> None:
    """Write `content` to a cache file, after its SHA-256. The file is written completely or not at all.

    A failure is only a warning.
    """
    part = path.with_name(f"{path.name}.{uuid.uuid4().hex[:12]}.tmp")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(hashlib.sha256(content).digest() + content)
        part.replace(path)
    except OSError as error:
        _say_once(f"nothing more can be kept in the cache {wanted_root()} ({error.strerror or error})")
        with suppress(OSError):
            part.unlink(missing_ok=True)


def read_cached(path: Path) -> bytes | None:
    """Return the content that `write_cached` wrote to `path`, or None if it must be made again. Raises no OSError.

    None is returned if there is no file. It is also returned, with one warning, if the file cannot be read, is damaged,
    belongs to another user, or may be written by every user.
    """
    try:
        with open(path, "rb", opener=_at_once) as file:
            foreign, content = _is_foreign(os.fstat(file.fileno())), file.read()
    except (FileNotFoundError, IsADirectoryError):  # `write_cached` says that a folder is in the way
        return None
    except OSError as error:
        _say_once(f"the cache {wanted_root()} cannot be read ({error.strerror or error})")
        return None
    if foreign or hashlib.sha256(content[_DIGEST_BYTES:]).digest() != content[:_DIGEST_BYTES]:
        _say_once(f"files in the cache {wanted_root()} are damaged or another user's, and are made anew")
        return None
    return content[_DIGEST_BYTES:]


@cache
def _settled_root(wanted: Path) -> Path | None:
    problem = problem_of(wanted)
    if not problem:
        return wanted
    try:
        temporary = Path(tempfile.mkdtemp(prefix="rubgen-cache-"))
        atexit.register(_remove, temporary, os.getpid())
    except OSError:
        temporary = None
    usable = temporary is not None and not problem_of(temporary)
    use = "a temporary folder is used" if usable else "nothing is kept, and every process compiles for itself"
    if multiprocessing.parent_process() is None:
        _say_once(f"the cache {wanted} cannot be used ({problem}); {use}")
    if temporary is None or not usable:
        return None
    os.environ[CACHE_VARIABLE] = str(temporary)
    return temporary


def _remove(folder: Path, owner: int) -> None:
    if os.getpid() == owner:  # a process that was forked from it runs this too
        shutil.rmtree(folder, ignore_errors=True)


def _at_once(name: str, flags: int) -> int:
    """Open a file without waiting: in its place there may be a pipe."""
    return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))


def _is_foreign(status: os.stat_result) -> bool:
    return hasattr(os, "geteuid") and (status.st_uid != os.geteuid() or bool(status.st_mode & stat.S_IWOTH))


@cache
def _say_once(message: str) -> None:
    line = f"{message}; {CACHE_VARIABLE} names another folder"
    if multiprocessing.parent_process() is None:
        warn(line)
    else:
        pending_warnings.append(line)
