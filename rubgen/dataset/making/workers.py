"""Run work in worker processes, which end on request and when the process that started them has ended."""

import math
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from itertools import islice
from multiprocessing import connection
from multiprocessing.context import SpawnContext, SpawnProcess
from pathlib import Path
from types import ModuleType
from typing import Any, Protocol, TypeVar

from rubgen.cache_root import cache_folder
from rubgen.errors import RubgenError, warn

R = TypeVar("R")
ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS", "RAYON_NUM_THREADS"), "1"
)
WAITING_PER_WORKER = 2
EXIT_CODE_TRIES = 100
_ONE_START = threading.Lock()


def usable_cores(root: Path = Path("/")) -> int:
    """Return the number of cores that this process may use: its affinity and its container's CPU quota, rounded up.

    `root` is the folder that stands for "/": its proc/self/cgroup and sys/fs/cgroup are read.
    """
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(1, min([cores, *(math.ceil(quota) for quota in _cpu_quotas(root))]))


def _cpu_quotas(root: Path) -> Iterator[float]:
    """Yield the quota in cores of every control group of this process, inner and outer."""
    base = root / "sys/fs/cgroup"
    for line in _text(root / "proc/self/cgroup").splitlines():
        _number, controllers, inner = [*line.split(":", 2), "", ""][:3]
        if controllers and "cpu" not in controllers.split(","):
            continue
        for mount in {controllers, "cpu" if controllers else ""}:
            group = base / mount / inner.lstrip("/")
            yield from (quota for folder in (group, *group.parents) if (quota := _quota(folder)))


def _quota(folder: Path) -> float | None:
    """Return the cores of one control group: `cpu.max` of version 2, `cpu.cfs_*` of version 1; None without a limit."""
    limit = _text(folder / "cpu.max") or f"{_text(folder / 'cpu.cfs_quota_us')} {_text(folder / 'cpu.cfs_period_us')}"
    match limit.split():
        case [quota, period] if quota.isdecimal() and period.isdecimal() and int(period) > 0:
            return int(quota) / int(period)
    return None


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="ascii")
    except (OSError, ValueError):
        return ""


class Workers:
    """New worker processes, each with one BLAS thread. If one process dies, all are replaced."""

    died: tuple[type[BaseException], ...] = (BrokenProcessPool,)
    """Errors that say that a process died."""

    def __init__(self, number: int) -> None:
        """Start them. Raises OSError, ImportError or RuntimeError where the system cannot."""
        self._number = number
        self.start()

    @property
    def number(self) -> int:
        """Number of processes."""
        return self._number

    def start(self) -> None:
        """Start the processes, which have ended or were never there."""
        self._context = _OwnMain()
        with _interrupts_delayed():
            self._pool = ProcessPoolExecutor(self._number, self._context, initializer=_start_worker)
        with _interrupts_delayed():  # anew: Python's tracker of semaphores, just started, lets Ctrl-C through again
            self._pool.submit(os.getpid)  # the first job starts every process

    def submit(self, work: Callable[..., R], job: tuple[object, ...]) -> Future[R]:
        """Ask one process to call `work(*job)`."""
        return self._pool.submit(work, *job)

    def end(self) -> None:
        """End all processes at once."""
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in self._context.workers:
            if process.pid is not None:
                process.terminate()
                process.join()

    def replaced(self, running: dict[Future[R], tuple[object, ...]]) -> tuple[str, list[Future[R]]]:
        """End and start all processes.

        Return how the dead process ended, and all `running` jobs, to be submitted again.
        """
        self.end()
        how = _how_it_ended(self._context)
        self.start()
        return how, list(running)


class Pool(Protocol):
    """Worker processes, here or on a cluster."""

    died: tuple[type[BaseException], ...]

    @property
    def number(self) -> int:
        """Current number of workers."""
        ...

    def submit(self, work: Callable[..., R], job: tuple[object, ...]) -> Future[R]:
        """Ask one worker to call `work(*job)`."""
        ...

    def replaced(self, running: dict[Future[R], tuple[object, ...]]) -> tuple[str, list[Future[R]]]:
        """Replace a worker that died. Return how it died and the running jobs that must be done again."""
        ...


@contextmanager
def worker_pool(workers: int) -> Iterator[Workers | None]:
    """Yield `workers` new processes, each with one BLAS thread. They are ended at once when the block ends.

    Yields None for one worker and, with a warning, where no process can be started: `unordered` then works in this
    process. Raises RubgenError where memory runs out.
    """
    cache_folder("kernels")  # found, and where it is a temporary one handed on, before there are workers
    with _environment(ONE_THREAD if workers > 1 else {}):
        pool = _started(workers) if workers > 1 else None
        try:
            yield pool
        except MemoryError as error:
            raise RubgenError(
                f"memory ran out ({error or 'no more is known'}); what is finished is kept: "
                "give the same command again, with fewer --workers"
            ) from None
        finally:
            if pool is not None:
                pool.end()


def unordered(
    pool: Pool | None,
    work: Callable[..., R],
    jobs: Iterable[tuple[object, ...]],
    *,
    tries: int = 1,
    progress: Callable[[], int] = lambda: 0,
) -> Iterator[R]:
    """Call `work(*job)` for every job and yield the results as they finish, in any order.

    Only a few jobs are submitted at a time. If a process dies, the lost jobs are submitted again. Raises RubgenError
    where processes die `tries` times without a result and without progress in between. An exception of `work` is raised
    here.

    - pool: from `worker_pool` or a cluster; None works in this process.
    - work: a function that can be pickled.
    - jobs: the tuples of its arguments. The iterator may yield further jobs after its end, when results have come.
    - progress: called after a death. If its number differs from the number at the death before, there was progress.
    """
    if pool is None:
        yield from (work(*job) for job in jobs)
        return
    remaining = iter(jobs)
    running: dict[Future[R], tuple[object, ...]] = {}
    deaths = so_far = 0
    while True:
        try:
            with _interrupts_delayed():
                for job in islice(remaining, max(0, pool.number * WAITING_PER_WORKER - len(running))):
                    running[_submitted(pool, work, job, running)] = job
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                result = future.result()
                del running[future]
                deaths = 0
                yield result
        except pool.died:
            before, so_far = so_far, progress()
            deaths = deaths + 1 if so_far == before else 1
            how, lost = pool.replaced(running)
            if deaths >= tries:
                raise RubgenError(
                    f"a worker process {how}; what is finished is kept: the same command makes the "
                    "rest, and with --workers 1 it starts no worker process"
                ) from None
            warn(f"a worker process {how}; it is replaced, and what it was doing is done again")
            again = [running.pop(future) for future in lost]
            running |= {pool.submit(work, job): job for job in again}


def _submitted(
    pool: Pool, work: Callable[..., R], job: tuple[object, ...], running: dict[Future[R], tuple[object, ...]]
) -> Future[R]:
    """Submit a job. Where the pool is broken, note the job before the error passes on."""
    try:
        return pool.submit(work, job)
    except pool.died:
        running[Future()] = job
        raise


class _Worker(SpawnProcess):
    """A process that does not import the user's main module, which would run a script a second time."""

    def start(self) -> None:
        """Start it while the main module has no file: workers need nothing of it."""
        with _ONE_START:
            main = sys.modules["__main__"]
            sys.modules["__main__"] = ModuleType("__main__")
            try:
                super().start()
            finally:
                sys.modules["__main__"] = main


class _OwnMain(SpawnContext):
    """A context of multiprocessing that makes `_Worker` processes and remembers them."""

    def __init__(self) -> None:
        self.workers: list[_Worker] = []

    def Process(self, *args: Any, **kwargs: Any) -> _Worker:  # type: ignore[override]
        """Make a process of this context. The pool calls it."""
        self.workers.append(_Worker(*args, **kwargs))
        return self.workers[-1]


def _started(workers: int) -> Workers | None:
    reason = "this process is a daemon, which may have no children"
    if not multiprocessing.current_process().daemon:
        try:
            return Workers(workers)
        except (OSError, ImportError, RuntimeError) as error:  # no semaphores, too many processes, threads or files
            reason = error.strerror or str(error) if isinstance(error, OSError) else str(error)
    warn(f"worker processes cannot be started ({reason}); the work goes on in one process")
    return None


def _how_it_ended(context: _OwnMain) -> str:
    """Say how the process ended that broke the pool, from the system. The pool ends the others by SIGTERM."""
    return how_ended([code for process in context.workers if (code := _exit_code(process)) is not None])


def how_ended(codes: Sequence[int]) -> str:
    """Return how a process ended, such as "was ended by SIGKILL", from the exit codes of several processes.

    SIGTERM is chosen only if all codes are SIGTERM.
    """
    if not codes:
        return "ended, and the system does not say how"
    first = next((code for code in codes if code != -signal.SIGTERM), -signal.SIGTERM)
    if first >= 0:
        return f"ended with exit code {first}"
    names = {number.value: number.name for number in signal.Signals}
    return f"was ended by {names.get(-first, f'signal {-first}')}"


def _exit_code(process: _Worker) -> int | None:
    """Return the exit code of an ended process. The system gives it to one thread only; wait until it is noted."""
    for _ in range(EXIT_CODE_TRIES):
        if process.exitcode is not None:
            break
        time.sleep(0.01)
    return process.exitcode


def _start_worker() -> None:
    # Ctrl-C reaches the whole process group; the parent alone decides what it means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _set_mask("SIG_UNBLOCK", {signal.SIGINT})
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """End this process with its parent: a worker whose parent was killed would wait for jobs for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


@contextmanager
def _interrupts_delayed() -> Iterator[None]:
    """Delay Ctrl-C and SIGTERM to the end of the block.

    A process that is being started needs its parent until it has started. The mask is for the new processes, which
    inherit it until they ignore Ctrl-C. The handlers are for this process, where a signal may reach another thread.
    """
    delayed: list[int] = []
    mask = _set_mask("SIG_BLOCK", {signal.SIGINT})
    main = threading.current_thread() is threading.main_thread()
    handlers = {
        name: signal.signal(name, lambda number, _frame: delayed.append(number))
        for name in (signal.SIGINT, signal.SIGTERM)
        if main and signal.getsignal(name) is not None  # None: not set from Python, so it could not be put back
    }
    try:
        yield
    finally:
        _set_mask("SIG_SETMASK", mask)
        for name, handler in handlers.items():
            signal.signal(name, handler)
    if delayed:
        signal.raise_signal(delayed[0])


def _set_mask(how: str, signals: Iterable[int]) -> set[signal.Signals | int]:
    """Set the mask of signals; return the mask before. Windows has none."""
    set_mask = getattr(signal, "pthread_sigmask", None)
    return set(set_mask(getattr(signal, how), signals)) if set_mask else set()


@contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    saved = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in saved.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
