import math
import os

import pytest

from rubgen.dataset.workers import ONE_THREAD, unordered, worker_pool
from rubgen.errors import RubgenError


def test_every_job_is_done_once():
    with worker_pool(2) as pool:
        done = list(unordered(pool, 2, math.factorial, ((n,) for n in range(12))))
    assert sorted(done) == sorted(math.factorial(n) for n in range(12))


def test_workers_use_one_thread_and_the_environment_is_put_back(monkeypatch):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "7")
    with worker_pool(1) as pool:
        assert list(unordered(pool, 1, os.getenv, [(name,) for name in ONE_THREAD])) == ["1"] * len(ONE_THREAD)
    assert os.environ["OPENBLAS_NUM_THREADS"] == "7"


def test_a_worker_that_dies_is_reported_in_one_line():
    with pytest.raises(RubgenError, match=r"a worker process died.+ with fewer --workers"), worker_pool(1) as pool:
        list(unordered(pool, 1, os._exit, [(9,)]))


def test_what_a_worker_raises_reaches_the_caller():
    with pytest.raises(ValueError, match="negative"), worker_pool(1) as pool:
        list(unordered(pool, 1, math.factorial, [(-1,)]))
