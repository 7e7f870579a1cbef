"""Files that a command writes: refused before any work where they cannot be, then complete or not there at all."""

from collections.abc import Callable
from pathlib import Path

from rubgen.errors import UserError, write_problems


def check_new_file(option: str, path: Path, endings: tuple[str, ...], *, force: bool = False) -> None:
    """Raise UserError for another ending, a folder that does not exist, or a file that does, unless by `force`."""
    if path.suffix not in endings:
        allowed = endings[0] if len(endings) == 1 else f"{', '.join(endings[:-1])} or {endings[-1]}"
        raise UserError(f"{option} {path}: unknown kind of file; end the name in {allowed}")
    if not path.parent.is_dir():
        raise UserError(f"{option} {path}: there is no directory {path.parent}; make it first")
    if path.exists() and not path.is_file():
        raise UserError(f"{option} {path}: exists already and is no file; choose another name")
    if path.exists() and not force:
        raise UserError(f"{option} {path}: exists already; choose another name, or replace it with --force")


def write_file(option: str, path: Path, write: Callable[[Path], object]) -> None:
    """Write under a temporary name, then rename: a file that was there stays whole until then."""
    from rubgen.io.durable import write_durably

    with write_problems(path, named=f"{option} {path}"):
        write_durably(path, write)
