"""Workers of a Dask cluster in the place of local processes: `rubgen generate --scheduler ADDRESS`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from rubgen.errors import RubgenError, UserError

R = TypeVar("R")
PATIENCE_S = 10
"""Time in which a scheduler must answer."""


class ClusterWorkers:
    """The workers of a Dask cluster. The scheduler replaces those that die, and gives their work to others."""

    def __init__(self, client: Any) -> None:
        """Take a client that is connected."""
        from distributed import KilledWorker

        self.died: tuple[type[BaseException], ...] = (KilledWorker,)
        self._client = client
        self._executor = client.get_executor(pure=False)

    @property
    def number(self) -> int:
        """Number of workers now."""
        return max(1, len(self._client.nthreads()))

    def submit(self, work: Callable[..., R], job: tuple[object, ...]) -> Future[R]:
        """Ask one worker to call `work(*job)`."""
        future: Future[R] = self._executor.submit(work, *job)
        return future

    def replaced(self, running: dict[Future[R], tuple[object, ...]]) -> tuple[str, list[Future[R]]]:
        """Say how a worker died, and return the jobs that must be done again: those of which the scheduler gave up."""
        lost = [future for future in running if future.done() and isinstance(future.exception(), self.died)]
        return "of the cluster died several times", lost


@contextmanager
def cluster(address: str, root: Path) -> Iterator[ClusterWorkers]:
    """Connect to the Dask scheduler at `address` for the block.

    Raises UserError where distributed is not installed, the scheduler does not answer, it has no worker, a worker has
    several threads or other versions, or does not see the directory `root`; RubgenError where the scheduler is lost.
    """
    try:
        from distributed import Client
    except ImportError:
        raise UserError("--scheduler: needs Dask; install it: pip install 'rubgen[dask]'") from None
    try:
        client: Any = Client(address, timeout=PATIENCE_S)  # type: ignore[no-untyped-call, unused-ignore]
    except (OSError, ValueError) as error:
        raise UserError(
            f"--scheduler {address}: does not answer ({' '.join(str(error).split())[:100]}); start one: dask scheduler"
        ) from None
    with client:
        _check(client, address, root.resolve())
        try:
            yield ClusterWorkers(client)
        except CancelledError:
            raise RubgenError(
                f"--scheduler {address}: is lost; what is finished is kept: the same command makes the rest"
            ) from None


def _check(client: Any, address: str, root: Path) -> None:
    threads = client.nthreads()
    if not threads:
        raise UserError(f"--scheduler {address}: has no worker; start some: dask worker {address} --nthreads 1")
    for worker, number in threads.items():
        if number > 1:
            raise UserError(f"--scheduler {address}: {worker} has {number} threads; start workers with --nthreads 1")
    here = _seen(str(root))
    for worker, there in client.run(_seen, str(root)).items():
        if there != here:
            name = next(key for key in here if there.get(key) != here[key])
            raise UserError(
                f"--scheduler {address}: {worker} has {name} {there.get(name)}, here it is {here[name]}; "
                "give its workers the same packages and the same file system"
            )


def _seen(root: str) -> dict[str, Any]:
    """Return what must be the same on every worker: versions of packages, and the directory of the set."""
    import platform
    from importlib.metadata import version

    from rubgen.dataset.manifest import PACKAGES

    versions = {name: version(name) for name in PACKAGES}
    return versions | {"python": platform.python_version(), root: "there" if Path(root).exists() else "missing"}
