"""The output directory: whose it is, and the pieces kept in it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from filelock import FileLock, Timeout

from rubgen.errors import UserError, write_problems
from rubgen.io.durable import write_durably
from validation.piece import Arrays, Piece

MARK = ".zeng2019"
"""File by which a directory is known as ours."""


class Store:
    """Pieces in `root/pieces`, one file each; a file that cannot be read counts as missing."""

    def __init__(self, root: Path) -> None:
        self.root, self._read = root, dict[str, Arrays]()

    @contextmanager
    def claimed(self) -> Iterator[None]:
        """Hold the directory for this process.

        Raises UserError for a file, for a directory that holds something else or cannot be written, for a full disk,
        and where another process is at work there.
        """
        root = self.root
        named, advice = f"--out {root}", "give a directory you may write to"
        with write_problems(root, named=named, advice=advice, kept="pieces are kept"):
            _check(root)
            self._pieces.mkdir(parents=True, exist_ok=True)
            (root / MARK).touch()
            try:
                lock = FileLock(root / f"{MARK}.lock", timeout=0).acquire()
            except Timeout:
                raise UserError(f"{named}: another rubgen works there; wait for it or choose another") from None
            with lock:
                for part in self._pieces.glob("*.part.npz"):
                    part.unlink()
                yield

    def __call__(self, piece: Piece) -> Arrays:
        """The arrays of a piece that is kept."""
        arrays = self._load(piece.key)
        if arrays is None:
            raise KeyError(f"{piece} has not been made")
        return arrays

    def holds(self, piece: Piece) -> bool:
        """Whether the piece is kept and can be read."""
        return self._load(piece.key) is not None

    def keep(self, key: str, arrays: Arrays) -> None:
        """Keep the arrays of the piece of that key, whole or not at all."""

        def write(path: Path) -> None:
            with path.open("wb") as file:
                np.savez_compressed(file, allow_pickle=False, **arrays)

        write_durably(self._pieces / f"{key}.npz", write)
        self._read[key] = arrays

    @property
    def _pieces(self) -> Path:
        return self.root / "pieces"

    def _load(self, key: str) -> Arrays | None:
        if key not in self._read:
            try:
                path = self._pieces / f"{key}.npz"
                with path.open("rb") as stream, np.load(stream, allow_pickle=False) as file:
                    self._read[key] = {name: file[name] for name in file.files}
            except (OSError, ValueError, KeyError, EOFError, BadZipFile):
                return None
        return self._read[key]


def _check(root: Path) -> None:
    if root.exists() and not root.is_dir():
        raise UserError(f"--out {root}: is a file; give a new or empty directory")
    if root.is_dir() and any(root.iterdir()) and not (root / MARK).exists():
        raise UserError(f"--out {root}: not empty and not made by this command; give a new or empty directory")
