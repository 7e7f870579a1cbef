"""Blows of a defective bearing, and the frame through which sensors feel them.

The table of the SKF 6205 rounds the diameters, so its orders agree to 4e-4. The envelope is that of a recorded channel
between 3 and 5 kHz, of a run of the preset without a rub: 1 s at 10,000 rev/min resolves an order to 0.006, and the
slip of 1.5 % widens a line. A sine is a chord between steps, which costs (w dt)^2 / 12 of its amplitude, at most 3e-4.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
from scipy.signal import butter, hilbert, lsim, sosfiltfilt

import rubgen
from rubgen.arrays import FloatArray
from rubgen.machine.faults.bearing_defect import BearingDefect
from rubgen.machine.frame import FrameMode
from rubgen.measurement import measure
from rubgen.measurement.frame import accelerations
from rubgen.pipeline import Run
from validation.verification.row import Row, relative, within

TITLE = "Bearing defects and the frame"
Place = Literal["outer", "inner", "ball", "cage"]
TABLE: dict[Place, float] = {"outer": 3.5848, "inner": 5.4152, "ball": 4.7135, "cage": 0.39828}
"""Defect frequencies of the SKF 6205-2RS JEM over the speed, Case Western Reserve University's bearing data centre."""
MODE = FrameMode(frequency_hz=1200, damping=0.02, modal_mass_kg=40, direction_deg=0)
DT = 6e-6


def defect_at(place: Place) -> BearingDefect:
    """Return a spall of 0.5 mm of an SKF 6205."""
    return BearingDefect(place=place, width_m=5e-4, balls=9, ball_diameter_m=7.94e-3, pitch_diameter_m=39.04e-3)


def envelope(signal: FloatArray, rate: float, turn_hz: float) -> tuple[FloatArray, FloatArray]:
    """Return orders, and the spectrum of the envelope of a signal between 3 and 5 kHz."""
    band = sosfiltfilt(butter(4, (3000, 5000), btype="band", fs=rate, output="sos"), signal)
    height = np.abs(hilbert(band))
    spectrum = np.abs(np.fft.rfft((height - height.mean()) * np.hanning(height.size), 8 * height.size))
    return np.asarray(np.fft.rfftfreq(8 * height.size, turn_hz / rate)), np.asarray(spectrum, dtype=np.float64)


def line_near(orders: FloatArray, spectrum: FloatArray, order: float) -> float:
    """Return the order of the highest line within 0.1 of `order`."""
    near = np.flatnonzero(np.abs(orders - order) < 0.1)
    return float(orders[near[spectrum[near].argmax()]])


def recorded(run: Run, defect: BearingDefect) -> FloatArray:
    """Return the channel of the housing in a run as it is with a defect, which changes no motion."""
    scenario = run.scenario
    recording = measure(
        run.response, scenario.sensing, seconds=scenario.signal_seconds, rng=np.random.default_rng(1),
        frame=scenario.frame, faults=(defect,),
    )  # fmt: skip
    return recording.channels["housing_acc_y"].values.astype(np.float64)


def envelope_rows() -> Iterator[Row]:
    """The line of each place in the envelope of a recorded channel, and that it stands out of what is beside it."""
    run = rubgen.simulate(rubgen.make_scenario(clearance_m=2e-3, sensors="field", lyapunov=False))
    sensing = run.scenario.sensing
    for place, order in TABLE.items():
        channel = recorded(run, defect_at(place))
        orders, spectrum = envelope(channel, sensing.sample_rate_hz, run.scenario.operation.rotation_frequency_hz)
        found = line_near(orders, spectrum, order)
        yield relative(f"{place}: line in the envelope, order", "table of the SKF 6205", order, found, 0.01)
        away = np.abs(orders - order)
        beside = np.median(spectrum[(away > 0.1) & (away < 0.35)])
        share = float(beside / spectrum[np.abs(orders - found).argmin()])
        yield within(f"{place}: what is beside the line, over its height", "0", 0.0, share, 0.3)


def frame_rows() -> Iterator[Row]:
    """The accelerance of a mode below, at and above its resonance, and an integration of another kind."""
    w = 2 * np.pi * MODE.frequency_hz
    steps = np.arange(100_000)
    for hertz in (200.0, 1200.0, 3000.0):
        driven = 2 * np.pi * hertz
        exact = driven**2 / (MODE.modal_mass_kg * abs(w**2 - driven**2 + 2j * MODE.damping * w * driven))
        wave = np.exp(-1j * driven * DT * steps[50_000:])
        found = 2 * abs(np.mean(accelerations(MODE, np.sin(driven * DT * steps), DT)[50_000:] * wave))
        yield relative(f"mode of the frame at {hertz:g} Hz: accelerance, 1/kg", "closed form", exact, found, 2e-3)
    force = np.random.default_rng(0).standard_normal(4000).cumsum()
    force -= force[0]
    back = [-(w**2), -2 * MODE.damping * w]
    system: Any = ([[0, 1], back], [[0], [1 / 40]], [back], [[1 / 40]])
    _, expected, _ = lsim(system, force, DT * np.arange(force.size))
    error = np.abs(accelerations(MODE, force, DT) - expected).max() / np.abs(expected).max()
    yield within("mode of the frame: error against scipy's lsim over the peak", "0", 0.0, float(error), 1e-9)


def rows() -> Iterator[Row]:
    """The orders of the 6205, their lines, and the frame."""
    for place, order in TABLE.items():
        yield relative(f"SKF 6205: blows a turn, {place}", "its table", order, defect_at(place).order, 4e-4)
    yield from envelope_rows()
    yield from frame_rows()
