"""A job of runs that is given again, because its worker died, makes only what is missing."""

import subprocess
import sys
from types import SimpleNamespace

import pytest

from rubgen.dataset.layout import Layout
from rubgen.dataset.making import make_runs
from rubgen.dataset.making.keep import Keeper
from rubgen.pipeline import refused
from rubgen.scenario import parse_recipe

ENDS = """
import threading, time
from rubgen.dataset.making.make_runs import _end_with_input
threading.Thread(target=_end_with_input, daemon=True).start()
print("ready", flush=True)
time.sleep(60)
"""


@pytest.fixture
def made(tmp_path, monkeypatch):
    """Numbers of runs that are made here, as refused ones, and of those that get a process of their own."""
    recipe = parse_recipe({"name": "job", "runs": 4, "machine": "zeng2019", "output": {"formats": ["parquet"]}})
    numbers = SimpleNamespace(here=[], alone=[])

    def simulated(_recipe, index):
        numbers.here.append(index)
        return refused(recipe.scenario(index), "made up")

    monkeypatch.setattr(make_runs, "recipe_at", lambda _root: recipe)
    monkeypatch.setattr(make_runs, "simulated", simulated)
    monkeypatch.setattr(make_runs, "_make_alone", lambda *given: numbers.alone.append(given[-1]))
    return numbers


def test_runs_that_the_session_kept_are_left_alone(tmp_path, made):
    make_runs.make_runs(tmp_path, "train-00000", "one", (0, 1))
    assert make_runs.make_runs(tmp_path, "train-00000", "one", (0, 1, 2)) == 3
    assert made.here == [0, 1, 2]
    make_runs.make_runs(tmp_path, "train-00000", "two", (0,))  # its files may be missing: the plan asked for it
    assert made.here == [0, 1, 2, 0]


def test_a_run_whose_worker_died_is_made_alone(tmp_path, made):
    Keeper(Layout(tmp_path), "train-00000", "one").begin(1)
    make_runs.make_runs(tmp_path, "train-00000", "one", (0, 1))
    assert (made.here, made.alone) == ([0], [1])


def test_the_process_of_a_run_alone_ends_with_its_worker():
    with subprocess.Popen([sys.executable, "-c", ENDS], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as alone:
        assert alone.stdout.readline() == b"ready\n"
        assert alone.poll() is None
        alone.stdin.close()
        assert alone.wait(30) == 1
