import itertools
import math
import os
import signal
import subprocess
import sys
from concurrent.futures import Future
from contextlib import ExitStack
from types import SimpleNamespace

import pytest

from rubgen.dataset.making import workers
from rubgen.dataset.making.workers import ONE_THREAD, unordered, usable_cores, worker_pool
from rubgen.errors import RubgenError, RubgenWarning


def test_every_job_is_done_once():
    with worker_pool(2) as pool:
        done = list(unordered(pool, math.factorial, ((n,) for n in range(12))))
    assert sorted(done) == sorted(math.factorial(n) for n in range(12))


def test_workers_use_one_thread_and_the_environment_is_put_back(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    with worker_pool(2) as pool:
        assert list(unordered(pool, os.getenv, [(name,) for name in ONE_THREAD])) == ["1"] * len(ONE_THREAD)
    assert os.environ["OPENBLAS_NUM_THREADS"] == "7"


@pytest.mark.parametrize("code", [9, 0])
def test_a_worker_that_dies_is_reported_in_one_line(code):
    said = f"a worker process ended with exit code {code}; what is finished is kept: .+ --workers 1 it starts no worker"
    with pytest.raises(RubgenError, match=said), worker_pool(2) as pool:
        list(unordered(pool, os._exit, [(code,)]))


def _kill_this_process():
    os.kill(os.getpid(), signal.SIGKILL)


def test_a_worker_that_is_killed_is_told_by_its_signal():
    said = "a worker process was ended by SIGKILL; what is finished is kept"
    with pytest.raises(RubgenError, match=said), worker_pool(2) as pool:
        list(unordered(pool, _kill_this_process, [()]))


class _LateProcess:
    """A process whose exit code another thread notes after some questions."""

    def __init__(self, code, late):
        self.codes = iter([None] * late + [code] * 9)

    @property
    def exitcode(self):
        return next(self.codes)


def test_the_pool_s_own_signal_is_not_named_while_the_first_code_is_being_noted():
    processes = [_LateProcess(-signal.SIGKILL, late=3), _LateProcess(-signal.SIGTERM, late=0)]
    assert workers._how_it_ended(SimpleNamespace(workers=processes)) == "was ended by SIGKILL"


def test_workers_start_where_signals_cannot_be_masked(monkeypatch):
    there = {name: value for name, value in vars(signal).items() if name != "pthread_sigmask"}
    monkeypatch.setattr(workers, "signal", SimpleNamespace(**there))
    with worker_pool(2) as pool:
        assert sorted(unordered(pool, abs, [(-1,), (-2,)])) == [1, 2]


@pytest.mark.parametrize(
    "problem",
    [
        OSError(38, "Function not implemented"),
        BlockingIOError(11, "Resource temporarily unavailable"),
        ImportError("This platform lacks a functioning sem_open implementation"),
        RuntimeError("can't start new thread"),
    ],
)
def test_where_no_process_can_be_started_one_goes_on(monkeypatch, problem):
    def refuse(*_, **__):
        raise problem

    monkeypatch.setattr(workers, "ProcessPoolExecutor", refuse)
    reason = problem.strerror if isinstance(problem, OSError) else str(problem)
    with ExitStack() as stack:
        with pytest.warns(RubgenWarning, match=rf"cannot be started \({reason}\)"):
            pool = stack.enter_context(worker_pool(2))
        assert pool is None
        assert list(unordered(pool, os.getpid, [()])) == [os.getpid()]


def test_a_daemon_works_alone():
    made = "with worker_pool(2) as pool: print(pool, list(unordered(pool, abs, [(-1,)])), flush=True)"
    code = (
        "import multiprocessing\nfrom rubgen.dataset.making.workers import unordered, worker_pool\n"
        f"def work():\n    {made}\n"
        "process = multiprocessing.get_context('fork').Process(target=work, daemon=True)\n"
        "process.start()\nprocess.join()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "None [1]\n"
    assert "which may have no children); the work goes on in one process" in done.stderr


@pytest.mark.parametrize("how", ["script", "pipe", "text"])
def test_workers_leave_the_users_main_module_alone(tmp_path, how):
    code = (
        "import os\nfrom rubgen.dataset.making.workers import unordered, worker_pool\nprint('main', flush=True)\n"
        "with worker_pool(2) as pool:\n    print(sum(unordered(pool, abs, [(-1,), (-2,), (-3,)])))\n"
    )
    (tmp_path / "main.py").write_text(code)
    arguments = {"script": ["main.py"], "pipe": ["-"], "text": ["-c", code]}[how]
    given = code if how == "pipe" else None
    done = subprocess.run([sys.executable, *arguments], input=given, capture_output=True, text=True, cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "main\n6\n", "")


def test_what_a_worker_raises_reaches_the_caller():
    with pytest.raises(ValueError, match="negative"), worker_pool(2) as pool:
        list(unordered(pool, math.factorial, [(-1,)]))


def _system(root, groups, files):
    """The system's own files of a container, below `root`."""
    for name, text in {"proc/self/cgroup": groups, **files}.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return root


@pytest.mark.parametrize(
    ("groups", "files", "cores"),
    [
        ("0::/\n", {"sys/fs/cgroup/cpu.max": "200000 100000\n"}, 2),
        ("0::/\n", {"sys/fs/cgroup/cpu.max": "250000 100000\n"}, 3),
        ("0::/\n", {"sys/fs/cgroup/cpu.max": "10000 100000\n"}, 1),
        ("0::/\n", {"sys/fs/cgroup/cpu.max": "max 100000\n"}, 8),
        ("0::/\n", {"sys/fs/cgroup/cpu.max": "900000 100000\n"}, 8),
        ("0::/a/b\n", {"sys/fs/cgroup/a/cpu.max": "300000 100000\n", "sys/fs/cgroup/a/b/cpu.max": "max 100000\n"}, 3),
        (
            "4:memory:/m\n3:cpu,cpuacct:/docker/x\n",
            {
                "sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us": "150000\n",
                "sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us": "50000\n",
            },
            3,
        ),
        (
            "1:cpu:/\n0::/\n",
            {"sys/fs/cgroup/cpu/cpu.cfs_quota_us": "-1\n", "sys/fs/cgroup/cpu/cpu.cfs_period_us": "100000\n"},
            8,
        ),
        ("no table\n", {"sys/fs/cgroup/cpu.max": ""}, 8),
    ],
)
def test_the_cores_are_those_of_the_containers_quota(tmp_path, monkeypatch, groups, files, cores):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _pid: set(range(8)), raising=False)
    assert usable_cores(_system(tmp_path, groups, files)) == cores


def test_the_affinity_limits_the_cores_where_the_system_has_one(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "sched_getaffinity", lambda _pid: {5}, raising=False)
    assert usable_cores(tmp_path) == 1
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: 6)
    assert usable_cores(tmp_path) == 6
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert usable_cores(tmp_path) == 1


class _DyingPool:
    """A pool of one worker that dies so often before it does a job."""

    died = (InterruptedError,)
    number = 1

    def __init__(self, deaths):
        self.deaths = deaths

    def submit(self, work, job):
        future = Future()
        if self.deaths:
            self.deaths -= 1
            future.set_exception(InterruptedError())
        else:
            future.set_result(work(*job))
        return future

    def replaced(self, running):
        return "died", list(running)


def test_deaths_count_only_where_nothing_goes_on_between_them():
    runs = itertools.count()
    with pytest.warns(RubgenWarning):
        assert list(unordered(_DyingPool(9), abs, [(-1,)], tries=3, progress=lambda: next(runs))) == [1]
    with pytest.warns(RubgenWarning), pytest.raises(RubgenError, match="a worker process died"):
        list(unordered(_DyingPool(3), abs, [(-1,)], tries=3))
