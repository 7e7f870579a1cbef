"""The pictures of docs/faults-laws.md and docs/surroundings.md: each fault beside a healthy machine and a rub."""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

import rubgen
from rubgen.arrays import FloatArray
from rubgen.measurement import Recording
from rubgen.scenario.surroundings import Surroundings, Tone
from rubgen.viz.colors import BLUE, GREEN, VERMILION

FOLDER = Path(__file__).parent / "pictures"
AIR_M = 2e-3
"""A clearance at which nothing rubs."""
FAULTS: dict[str, dict[str, Any]] = {
    "misalignment": {"parallel_m": 2e-4, "direction_deg": 30},
    "bow": {"bow_m": 3e-5, "angle_deg": 90},
    "casing-off-centre": {"offset_m": 1e-4, "clearance_m": 7.2e-4, "speed_rpm": 8600},
    "growing-unbalance": {"kg_m": 5e-3, "start_s": 2.0, "growth_s": 1.0},
    "closing-clearance": {"closing_m": 1.75e-3, "start_s": 2.0, "growth_s": 1.0},
    "bearing-defect": {"width_m": 3e-3},
    "loose-support": {"lost_stiffness": 0.9, "speed_rpm": 7500},
    "oil-whirl": {"speed_rpm": 8000},
    "crack": {"crack_loss": 0.3, "speed_rpm": 4300, "gravity_m_per_s2": 9.81},
    "cracked-blade": {"stiffness_loss": 0.2},
    "lost-tip": {"lost_kg": 0.005},
    "lost-blade": {"clearance_m": 4e-3},
}
"""Keys of each kind of fault, beside keys of the machine where it needs others."""
SHARED = ("speed_rpm", "gravity_m_per_s2")
"""Keys of the healthy machine too."""
SURROUNDINGS: dict[str, Surroundings] = {
    "background": Surroundings(background_m_per_s2=30),
    "blade-passing": Surroundings(blade_passing_m_per_s2=30),
    "tones": Surroundings(tones=(Tone(order=3.2, level_m_per_s2=10), Tone(frequency_hz=100, level_m_per_s2=10))),
    "path": Surroundings(path_gain=1),
    "runout-and-drift": Surroundings(runout_m=6e-6, shaft_drift_m=2e-5),
}
"""Each part of the surroundings, alone."""
DEFAULT_RPM = 9600.0
SHOWN_TURNS = 4
HIGHEST_ORDER = 40
COLORS = (GREEN, BLUE, VERMILION)


def main(names: Sequence[str]) -> None:
    """Draw the named faults and parts of the surroundings, or all."""
    FOLDER.mkdir(exist_ok=True)
    for name in names or (*FAULTS, *SURROUNDINGS):
        drawn = io.BytesIO()
        picture(name).savefig(drawn, format="png", dpi=80)
        with Image.open(drawn) as image:  # a palette, for a file of some 60 kB
            image.convert("RGB").quantize(64).save(FOLDER / f"{name}.png", optimize=True)


def picture(name: str) -> Figure:
    """Waveform, spectrum and orbit of a healthy machine, of the one with that fault or surroundings, and of a rub."""
    values = FAULTS.get(name, {})
    machine: dict[str, Any] = {"sensors": "field", "lyapunov": False, "path_gain": 1.0, "speed_rpm": DEFAULT_RPM}
    machine |= {key: values[key] for key in SHARED if key in values}
    keys = {"clearance_m": AIR_M} | {key: value for key, value in values.items() if key not in machine}
    air = rubgen.make_scenario("zeng2019", clearance_m=AIR_M, **machine)
    other = rubgen.make_scenario("zeng2019", fault=name, **machine, **keys) if values else air
    rub = rubgen.make_scenario("zeng2019", **machine | {"speed_rpm": DEFAULT_RPM})  # not every speed has one
    if not values:
        air, rub = (replace(each, surroundings=None) for each in (air, rub))
        other = replace(air, surroundings=SURROUNDINGS[name])
    figure = Figure(figsize=(11, 8), layout="constrained", facecolor="white")
    axes = figure.subplots(3, 3, sharey="row")
    titles = ("healthy", name.replace("-", " "), "rub")
    for column, (scenario, title, color) in enumerate(zip((air, other, rub), titles, COLORS, strict=True)):
        recording = rubgen.simulate(scenario).recording
        if recording is None:
            raise ValueError(f"{name}: the run of {title} did not end well")
        _draw(axes[:, column], recording, color)
        axes[0, column].set_title(f"{title}, {scenario.operation.speed_rpm:,.0f} rev/min")
    for row, label in enumerate(("housing, casing, m/s2", "casing, m/s2, amplitude", "shaft, um")):
        axes[row, 0].set_ylabel(label)
    return figure


def _draw(axes: Sequence[Axes], recording: Recording, color: str) -> None:
    """Waveform of casing and housing, spectrum of the casing by orders, orbit."""
    pulses, rate = recording.once_per_rev, recording.sample_rate_hz
    turn = float(np.mean(np.diff(pulses)))
    time = np.arange(recording.samples) / rate
    last = time >= time[-1] - SHOWN_TURNS * turn
    casing, housing = (_values(recording, name) for name in ("casing_acc_45", "housing_acc_x"))
    axes[0].plot((time[last] - time[last][0]) / turn, casing[last], color=color, linewidth=0.7, label="casing")
    axes[0].plot((time[last] - time[last][0]) / turn, housing[last], color="black", linewidth=0.7, label="housing")
    axes[0].set_yscale("symlog", linthresh=10)
    axes[0].set(xlabel="turns", ylim=(-1e5, 1e5))
    axes[0].legend(frameon=False, loc="upper right", ncols=2)
    window = np.hanning(casing.size)
    amplitude = 2 * np.abs(np.fft.rfft(casing * window)) / window.sum()
    order = np.fft.rfftfreq(casing.size, 1 / rate) * turn
    axes[1].semilogy(order, amplitude, color=color, linewidth=0.7)
    axes[1].set(xlabel="order of the speed", xlim=(0, HIGHEST_ORDER), ylim=(1e-3, 1e4))
    x, y = _orbit(recording)
    axes[2].plot(x[last], y[last], color=color, linewidth=0.8)
    axes[2].set(xlabel="shaft, um", aspect="equal", adjustable="datalim")
    for each in axes:
        each.spines[["top", "right"]].set_visible(False)


def _values(recording: Recording, name: str) -> FloatArray:
    values = recording.channels[name].values.astype(np.float64)
    return np.asarray(values - values.mean())


def _orbit(recording: Recording) -> tuple[FloatArray, FloatArray]:
    """X and Y in um from the probes at 45 and 135 degrees, which record V at 7.874 V/mm."""
    a, b = (1e3 * _values(recording, name) / 7.874 for name in ("proximity_45", "proximity_135"))
    return (a - b) / np.sqrt(2), (a + b) / np.sqrt(2)


if __name__ == "__main__":
    main(sys.argv[1:])
