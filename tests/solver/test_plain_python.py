"""The compiled kernels and the same functions as plain Python give the same run."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rubgen.scenario import ContactLaw, Liner
from rubgen.solver.scheme.energy_kernels import WORKS
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.taps import DEFAULT_TAPS, ContactTorque, TipTiming

SCRIPT = """
import numpy as np
from conftest import build_small_system
from test_plain_python import short_run
np.save({out!r}, short_run(build_small_system, {options}))
"""
LINER = Liner(thickness_m=1e-4, wear_m2_per_n=1e-10, width_m=0.02)
OPTIONS = {"half_thickness": True, "surface": "chords", "liner": LINER}


def short_run(build, options):
    """State, works and impulse after a turn in contact, from a start with the casing close."""
    law = ContactLaw(friction=0.2, **(OPTIONS if options else {}))
    system = build(speed=500.0, clearance=-2e-4)
    taps = (*DEFAULT_TAPS, ContactTorque(name="torque"), TipTiming(name="probe", angle_deg=40, axial_m=1e-3))
    stepper = rub_free_stepper(system, law, 128, taps=taps)
    stepper.run_turn(np.linspace(4e-4, 0, 130))
    arrivals = stepper.taps.timing.arrivals
    parts = stepper.coordinates.now, stepper.state.works, stepper.result.summary, stepper.result.taps.ravel()
    return np.concatenate([*parts, arrivals[:, :3].ravel(), 1e6 * arrivals[:, 3]])


@pytest.mark.parametrize("options", [False, True])
def test_compiled_and_plain_runs_agree(small_system, tmp_path, options):
    out = tmp_path / "plain.npy"
    subprocess.run(
        [sys.executable, "-c", SCRIPT.format(out=str(out), options=options)],
        cwd=Path(__file__).parent,
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        check=True,
    )
    compiled, plain = short_run(small_system, options), np.load(out)
    n = small_system().M.shape[0]
    end = n + WORKS
    assert plain[end] > 0.01  # N s: it touched
    np.testing.assert_allclose(compiled[:n], plain[:n], rtol=0, atol=1e-11 * np.abs(plain[:n]).max())
    np.testing.assert_allclose(compiled[n:end], plain[n:end], rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(compiled[end:], plain[end:], rtol=1e-6, atol=1e-6)
