"""Workers that are killed, here and on a Dask cluster: nothing is lost, and only a run that kills counts as failed."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

RECIPE = """
name = "small"
runs = 24
machine = "zeng2019"
[output]
formats = ["parquet"]
signal_seconds = 0.1
"""
PATCH = """
import importlib.abc, importlib.util, os, signal, sys, time

def simulate(scenario):
    if scenario.index == int(os.environ.get("DEADLY", "-1")) and scenario.operation.settle_turns == "auto":
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.2)
    raise sys.modules["rubgen.errors"].UserError(f"run {scenario.index} is made up")

class Finder(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name != "rubgen.pipeline":
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        true = spec.loader.exec_module
        def execute(module):
            true(module)
            module.simulate = simulate
        spec.loader.exec_module = execute
        return spec

sys.meta_path.insert(0, Finder())
"""
"""Every process of Python reads it: runs are refused after a while, and one run kills its process."""
CLUSTER = """
import json, os, signal, sys, threading, time
from distributed import Client, LocalCluster

if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            print(cluster.scheduler_address, flush=True)
            while sys.stdin.readline():
                pids = sorted(client.run(os.getpid).values())
                os.kill(pids[0], signal.SIGKILL)
                print(len(pids), flush=True)
"""
PATIENCE_S = 400


def starting(folder):
    """Return a function that starts a process of Python with made-up runs, in a folder with a recipe."""
    (folder / "recipe.toml").write_text(RECIPE)
    (folder / "sitecustomize.py").write_text(PATCH)

    def start(*arguments, **environment):
        paths = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
        return subprocess.Popen(
            [sys.executable, *arguments],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": paths, **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    return start


@pytest.fixture
def here(tmp_path):
    return starting(tmp_path)


@pytest.fixture(scope="module")
def quiet(tmp_path_factory):
    """The files of the set that one process makes, of which nothing is killed."""
    folder = tmp_path_factory.mktemp("quiet")
    output, errors = generate(starting(folder), "set", "--workers", "1").communicate(timeout=PATIENCE_S)
    assert json.loads(output)["status"] == {"refused": 24}, errors
    return tree(folder / "set")


def generate(here, out, *options, **environment):
    code = "from rubgen.cli import main; main()"
    return here("-c", code, "generate", "recipe.toml", "--out", out, "--json", *options, **environment)


def tree(directory):
    files = [path for path in sorted(directory.rglob("*")) if path.is_file()]
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files}


def children(pid):
    try:
        return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except FileNotFoundError:
        return []


def test_a_run_that_kills_its_worker_twice_is_recorded_and_all_others_are_made(here, tmp_path):
    output, errors = generate(here, "set", "--workers", "2", DEADLY="3").communicate(timeout=PATIENCE_S)
    made = json.loads(output)
    assert made["status"] == {"died": 1, "refused": 23}, errors
    (died,) = [each for each in made["outcome"]["failures"] if each["status"] == "died"]
    assert died["run_id"] == "run-000003"
    assert died["reason"].endswith("and so did a process for it alone, which was ended by SIGKILL")
    assert "a worker process was ended by SIGKILL; it is replaced, and what it was doing is done again" in errors


def test_workers_killed_from_outside_cost_nothing(here, tmp_path, quiet):
    killed = generate(here, "set", "--workers", "2")
    kills = 0
    while killed.poll() is None:
        time.sleep(0.3)
        begun = list((tmp_path / "set/.staging/kept").glob("*/*.kept"))
        workers = [pid for pid in children(killed.pid) if begun and kills < 2 and b"spawn_main" in command_of(pid)]
        if workers:
            os.kill(workers[0], signal.SIGKILL)
            kills += 1
            time.sleep(1.0)
    output, errors = killed.communicate(timeout=PATIENCE_S)
    assert json.loads(output)["status"] == {"refused": 24}, errors
    assert kills == errors.count("it is replaced") > 0
    assert tree(tmp_path / "set") == quiet


def command_of(pid):
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except FileNotFoundError:
        return b""


def test_a_cluster_of_which_two_workers_are_killed(here, tmp_path, quiet):
    pytest.importorskip("distributed")
    (tmp_path / "cluster.py").write_text(CLUSTER)
    cluster = here("cluster.py")
    address = cluster.stdout.readline().strip()
    kills = []
    done = threading.Event()

    def kill():
        while len(kills) < 2 and not done.wait(1.5):
            if not list((tmp_path / "set/.staging/kept").glob("*/*.kept")):
                continue  # nothing is made yet
            cluster.stdin.write("kill\n")
            cluster.stdin.flush()
            kills.append(cluster.stdout.readline())

    try:
        made = generate(here, "set", "--scheduler", address)
        killer = threading.Thread(target=kill)
        killer.start()
        output, errors = made.communicate(timeout=PATIENCE_S)
        done.set()
        killer.join()
    finally:
        cluster.communicate(timeout=PATIENCE_S)
    assert output, errors
    assert json.loads(output)["status"] == {"refused": 24}, errors
    assert kills
    assert tree(tmp_path / "set") == quiet


def test_a_scheduler_that_does_not_answer_is_one_line(here, tmp_path):
    pytest.importorskip("distributed")
    made = generate(here, "set", "--scheduler", "tcp://127.0.0.1:9")
    _, errors = made.communicate(timeout=PATIENCE_S)
    assert made.returncode == 2
    assert "--scheduler tcp://127.0.0.1:9: does not answer" in errors
    assert "Traceback" not in errors
    assert not (tmp_path / "set").exists()


def test_slurm_is_asked_for_only_where_it_is(here, tmp_path):
    pytest.importorskip("dask_jobqueue")
    code = (
        "from rubgen.dataset.making.cluster import job_script, slurm\nprint(job_script())\nwith slurm(2, None): pass\n"
    )
    output, errors = here("-c", code, PATH="/nowhere").communicate(timeout=PATIENCE_S)
    assert "#SBATCH --cpus-per-task=1" in output
    assert "distributed.cli.dask_worker" in output
    assert errors.splitlines()[-1].endswith(
        "UserError: --scheduler slurm: there is no sbatch here; give the command where SLURM takes jobs"
    )
