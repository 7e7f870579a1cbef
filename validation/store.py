"""Results kept on disk, so that a study that was stopped goes on where it stood."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from threadpoolctl import threadpool_limits

from rubgen.dataset.files import is_system_file, remove_parts
from rubgen.dataset.making.claim import acquired
from rubgen.dataset.making.workers import unordered, worker_pool
from rubgen.errors import UserError, write_problems
from rubgen.io.files import write_durably
from rubgen.progress import step
from rubgen.scenario import Scenario
from validation.piece import Arrays, Piece

MARK = ".results"
"""File by which a directory is known as one of a study."""
Progress = Callable[[int, int], None]
"""Called with the number of finished pieces and of all pieces."""


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
        root, named = self.root, f"--out {self.root}"
        with write_problems(root, named=named, advice="give a directory you may write to", kept="pieces are kept"):
            _check(root)
            self._pieces.mkdir(parents=True, exist_ok=True)
            (root / MARK).touch()
            lock = acquired(root / f"{MARK}.lock")
            if lock is None:
                raise UserError(f"{named}: another rubgen works there; wait for it or choose another")
            try:
                remove_parts(self._pieces)
                yield
            finally:
                lock.release()

    def compute(self, pieces: Iterable[Piece], workers: int, progress: Progress = lambda _done, _all: None) -> int:
        """Make the pieces that are not kept yet, keep each as soon as it is there; return how many were made.

        A run is made first, alone, so that kernels are compiled and the model is reduced once. Raises RubgenError where
        a worker process dies.
        """
        asked = {piece.key: piece for piece in pieces}
        missing = {key: piece for key, piece in asked.items() if not self.holds(piece)}
        done = len(asked) - len(missing)
        progress(done, len(asked))
        for key, arrays in _made(missing, workers):
            self._keep(key, arrays)
            progress(done := done + 1, len(asked))
        return len(missing)

    def __call__(self, piece: Piece) -> Arrays:
        """The arrays of a piece that is kept; KeyError where it has not been made."""
        arrays = self._load(piece.key)
        if arrays is None:
            raise KeyError(f"{piece} has not been made")
        return arrays

    def holds(self, piece: Piece) -> bool:
        """Whether the piece is kept and can be read."""
        return self._load(piece.key) is not None

    def _keep(self, key: str, arrays: Arrays) -> None:
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


def _made(missing: dict[str, Piece], workers: int) -> Iterator[tuple[str, Arrays]]:
    jobs = sorted(missing.items(), key=lambda job: not _is_run(job[1]))  # sorting is stable: runs come first
    with worker_pool(min(workers, len(jobs))) as pool:
        yield from unordered(pool, _make, jobs[:1])
        yield from unordered(pool, _make, jobs[1:])


def _is_run(piece: Piece) -> bool:
    return any(isinstance(argument, Scenario) for argument in piece.arguments)


def _make(key: str, piece: Piece) -> tuple[str, Arrays]:
    with threadpool_limits(1, user_api="blas"), step("make a piece"):  # what it counts are no pieces
        return key, piece.make(*piece.arguments)


def _check(root: Path) -> None:
    if root.exists() and not root.is_dir():
        raise UserError(f"--out {root}: is a file; give a new or empty directory")
    if root.is_dir() and not (root / MARK).exists() and not all(is_system_file(path.name) for path in root.iterdir()):
        raise UserError(f"--out {root}: not empty and not made by this command; give a new or empty directory")
