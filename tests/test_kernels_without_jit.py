"""Tests of kernels hold for the plain Python of the kernels too, all the way down."""

import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
ROOMS = [HERE / "contact", HERE / "linalg", *sorted((HERE / "solver").rglob("test_*_kernels.py"))]


def test_every_test_of_kernels_holds_without_jit():
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:xdist", "-p", "no:cacheprovider", *map(str, ROOMS)],
        cwd=HERE.parent,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        check=False,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
