"""Two workers, a kill -9 in the middle, a Ctrl-C, and the bytes of one quiet process."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from rubgen.dataset.making.outcome import finished_runs

COMMAND = """
import sys
import rubgen.scenario.checks.feasible
from rubgen.cli import main

if __name__ == "__main__":
    rubgen.scenario.checks.feasible.MIN_RECORD_TURNS = 100
    main(sys.argv[1:])
"""
PATIENCE_S = 120

pytestmark = pytest.mark.long


@pytest.fixture
def start(small_set, tmp_path):
    """Starts the generation of the small set in `tmp_path/set` with two workers, as a process of its own."""
    (tmp_path / "recipe.toml").write_text(_toml(small_set.recipe))
    (tmp_path / "command.py").write_text(COMMAND)
    processes = []

    def start():
        arguments = ["generate", str(tmp_path / "recipe.toml"), "--out", str(tmp_path / "set"), "--workers", "2"]
        command = [sys.executable, str(tmp_path / "command.py"), *arguments]
        processes.append(
            subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True, start_new_session=True)
        )
        return processes[-1]

    yield start
    for process in processes:
        process.kill()
        process.communicate()


def _toml(recipe):
    """JSON's values are TOML's, but for the tables."""
    inline = {key: value for key, value in recipe.items() if not isinstance(value, dict)}
    lines = [f"{key} = {json.dumps(value)}" for key, value in inline.items()]
    for table in recipe.keys() - inline.keys():
        lines.append(f"[{table}]")
        lines += [f"{key} = {json.dumps(value).replace(':', ' =')}" for key, value in recipe[table].items()]
    return "\n".join(lines).replace('{"', "{ ").replace('" =', " =")


def _wait_for(condition):
    deadline = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < deadline, "it did not happen"
        time.sleep(0.02)


def _children(pid):
    try:
        return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except FileNotFoundError:
        return []


def _alive(pid):
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


def test_killed_interrupted_and_completed_to_the_same_bytes(start, small_set, tmp_path):
    directory = tmp_path / "set"
    killed = start()
    _wait_for(lambda: finished_runs(directory) > 0)
    workers = _children(killed.pid)
    assert workers
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    _wait_for(lambda: not any(map(_alive, workers)))
    kept = finished_runs(directory)
    assert not (directory / "manifest.json").exists()

    stopped = start()
    _wait_for(lambda: _children(stopped.pid) or stopped.poll() is not None)
    os.killpg(stopped.pid, signal.SIGINT)  # as a terminal does
    _, errors = stopped.communicate(timeout=PATIENCE_S)
    if stopped.returncode:  # it may have been done already
        assert stopped.returncode == 130
        assert "rubgen: interrupted; " in errors.splitlines()[-1]
        assert "the same command makes the rest" in errors.splitlines()[-1]
        assert "Traceback" not in errors
        assert finished_runs(directory) >= kept > 0

    output, errors = start().communicate(timeout=PATIENCE_S)
    assert "4 runs, " in output, errors
    assert ": 4 ok; " in output
    for path in small_set.directory.rglob("*"):
        if path.is_file():
            assert (directory / path.relative_to(small_set.directory)).read_bytes() == path.read_bytes()
    assert not (directory / ".staging").exists()
