"""What reads a set works for a user who has no home and may write nowhere."""

import os
import shutil
import subprocess
import sys

import pytest

AS_NOBODY = [
    "setpriv", "--reuid=65534", "--regid=65534", "--clear-groups",
    "--inh-caps=+dac_read_search", "--ambient-caps=+dac_read_search",  # to read this environment, wherever it lies
]  # fmt: skip
LOOK = """
import sys, rubgen
data = rubgen.open(sys.argv[1])
assert data.signals(data.runs.index[0])
assert "numba" not in sys.modules
"""


def as_nobody(*command: str) -> subprocess.CompletedProcess[str]:
    if getattr(os, "geteuid", lambda: 1)() != 0 or shutil.which("setpriv") is None:
        pytest.skip("needs root and setpriv to become another user")
    environment = {name: value for name, value in os.environ.items() if name not in ("RUBGEN_CACHE_DIR", "HOME")}
    environment |= {"HOME": "/nonexistent", "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        [*AS_NOBODY, sys.executable, *command], env=environment, cwd="/", capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize("command", ["info", "verify", "label"])
def test_commands_that_read_work(copied_set, command):
    run = "import sys; from rubgen.cli import main; main(sys.argv[1:])"
    done = as_nobody("-c", run, command, str(copied_set))
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stderr == ""


def test_open_and_signals_work(copied_set):
    done = as_nobody("-c", LOOK, str(copied_set))
    assert done.returncode == 0, done.stderr
