"""Workers of a Dask cluster in the place of local processes: `rubgen generate --scheduler ADDRESS`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager
from pathlib import Path
from shutil import which
from typing import Any, TypeVar

from rubgen.errors import RubgenError, UserError
from rubgen.progress import step

R = TypeVar("R")
PATIENCE_S = 10
"""Time in which a scheduler must answer."""
SLURM = "slurm"
"""In the place of an address: each worker is a job of SLURM."""
MEMORY = "2GB"
"""Of a job of SLURM, where the settings of dask-jobqueue name none."""
WAIT_S = 0.2


class ClusterWorkers:
    """The workers of a Dask cluster. The scheduler replaces workers that die, and moves their work to other workers."""

    def __init__(self, client: Any) -> None:
        """Take a client that is connected."""
        from distributed import KilledWorker

        self.died: tuple[type[BaseException], ...] = (KilledWorker,)
        self._client = client
        self._executor = client.get_executor(pure=False)

    @property
    def number(self) -> int:
        """Current number of workers, at least 1."""
        return max(1, len(self._client.nthreads()))

    def submit(self, work: Callable[..., R], job: tuple[object, ...]) -> Future[R]:
        """Ask one worker to call `work(*job)`."""
        future: Future[R] = self._executor.submit(work, *job)
        return future

    def replaced(self, running: dict[Future[R], tuple[object, ...]]) -> tuple[str, list[Future[R]]]:
        """Return how a worker died, and the jobs to be submitted again: those that the scheduler has given up."""
        lost = [future for future in running if future.done() and isinstance(future.exception(), self.died)]
        return "of the cluster died several times", lost


def job_script() -> str:
    """Return the batch script with which `--scheduler slurm` starts one worker as a job of SLURM.

    Queue, memory, time and more come from the settings of dask-jobqueue (jobqueue.slurm in ~/.config/dask). Without
    settings a job has 2 GB and 30 minutes. Raises UserError where dask-jobqueue is not installed.
    """
    with _slurm() as jobs:
        return str(jobs.job_script())


def _slurm() -> Any:
    try:
        import dask
        from dask_jobqueue.slurm import SLURMCluster
    except ImportError:
        raise UserError(f"--scheduler {SLURM}: needs Dask; install it: pip install 'rubgen[dask]'") from None
    memory = dask.config.get("jobqueue.slurm.memory", None) or MEMORY
    return SLURMCluster(cores=1, processes=1, memory=memory, scheduler_options={"dashboard_address": None})


@contextmanager
def slurm(jobs: int, root: Path) -> Iterator[ClusterWorkers]:
    """Start `jobs` jobs of SLURM for the block, each one worker. The block begins when the first job runs.

    `root` is the directory of the set, which every worker must see. Raises UserError where dask-jobqueue is not
    installed, where this computer has no sbatch, and as `cluster` does.
    """
    if which("sbatch") is None:
        raise UserError(f"--scheduler {SLURM}: there is no sbatch here; give the command where SLURM takes jobs")
    with _slurm() as started:
        started.scale(jobs=jobs)
        with step("wait for the first job of SLURM", long=True):
            while not started.scheduler_info["workers"]:
                time.sleep(WAIT_S)
        with cluster(started.scheduler_address, root) as workers:
            yield workers


@contextmanager
def cluster(address: str, root: Path) -> Iterator[ClusterWorkers]:
    """Connect to the Dask scheduler at `address` for the block. `root` is the directory of the set.

    Raises UserError where distributed is not installed, the scheduler does not answer, it has no worker, a worker has
    several threads or other package versions, or a worker does not see `root`. Raises RubgenError where the connection
    to the scheduler is lost.
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
