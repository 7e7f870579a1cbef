"""Pieces made in parallel, each kept as soon as it is there."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from threadpoolctl import threadpool_limits

from rubgen.dataset.making.workers import unordered, worker_pool
from rubgen.scenario import Scenario
from validation.piece import Arrays, Piece
from validation.store import Store

Progress = Callable[[int, int], None]
"""Called with the number of finished pieces and of all pieces."""


def compute(pieces: Iterable[Piece], store: Store, workers: int, progress: Progress) -> int:
    """Make what the store does not hold; gives how many pieces were made.

    A run is made first, alone, so that kernels are compiled and the model is reduced once. Raises RubgenError where
    a worker process dies.
    """
    asked = {piece.key: piece for piece in pieces}
    missing = {key: piece for key, piece in asked.items() if not store.holds(piece)}
    done = len(asked) - len(missing)
    progress(done, len(asked))
    for key, arrays in _made(missing, workers):
        store.keep(key, arrays)
        progress(done := done + 1, len(asked))
    return len(missing)


def _made(missing: dict[str, Piece], workers: int) -> Iterable[tuple[str, Arrays]]:
    jobs = sorted(missing.items(), key=lambda job: not _is_run(job[1]))  # sorting is stable: runs come first
    if workers == 1 or len(jobs) < 2:
        yield from (_make(*job) for job in jobs)
        return
    with worker_pool(min(workers, len(jobs))) as pool:
        yield from unordered(pool, 1, _make, jobs[:1])
        yield from unordered(pool, workers, _make, jobs[1:])


def _is_run(piece: Piece) -> bool:
    return any(isinstance(argument, Scenario) for argument in piece.arguments)


def _make(key: str, piece: Piece) -> tuple[str, Arrays]:
    with threadpool_limits(1, user_api="blas"):
        return key, piece.make(*piece.arguments)
