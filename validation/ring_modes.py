"""How the number of casing modes moves what an accelerometer on the casing feels: `python -m validation.ring_modes`.

Three comparisons at 8,600 rev/min and a clearance of 0.72 mm, in third octaves of the second half of the signals:

1. a run with 41 casing modes, and the sum of its modes driven by its own contact forces outside of the integration
2. the run with 11 modes, against the run with 41
3. the run with 11 modes and modes 12 to 41 driven one way by its contact forces, against the run with 41
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
from scipy.signal import lfilter

import rubgen
from rubgen.arrays import FloatArray, IntArray
from rubgen.measurement.shaft import shaft_angle
from rubgen.pipeline import Run
from rubgen.reduction import reduce
from rubgen.reduction.casing import ReducedCasing
from rubgen.scenario import Reduction
from rubgen.solver.response import Response

SPEED_RPM, CLEARANCE_M, SECONDS = 8600.0, 7.2e-4, 0.5
FEW, MANY = 11, 41
ANGLES = (0, 90)
CENTRES = 1000 * 2.0 ** (np.arange(-6, 11) / 3)
"""Middle frequencies of third octaves, 250 Hz to 10 kHz."""


def contacts(response: Response) -> tuple[IntArray, FloatArray, FloatArray]:
    """Return step of the tail, polar angle (rad) and normal force (N) of every contact (contacts,).

    The contact force of a step is shared among the blades that touch, by the mean forces of their touches. A touch runs
    with the blade, and its mean angle by impulse is that of the touch.
    """
    events, steps = response.events, response.tail_steps
    begins = events.start_step - (response.record_steps - steps)
    inside = (begins >= 0) & (begins + events.steps <= steps)
    begins, lasts = begins[inside], events.steps[inside]
    touch = np.repeat(np.arange(begins.size), lasts)
    step = np.repeat(begins - np.cumsum(lasts) + lasts, lasts) + np.arange(touch.size)
    mean_force = (events.impulse[inside] / lasts)[touch]
    force = response.taps["contact_force"][step] * mean_force / np.bincount(step, mean_force, steps)[step]
    turned = np.unwrap(shaft_angle(response, np.arange(steps)))[step]
    weight = np.bincount(touch, force, begins.size)
    centre = np.bincount(touch, force * turned, begins.size) / weight
    return step, np.asarray(events.angle[inside][touch] + turned - centre[touch]), np.asarray(force)


def displacement(casing: ReducedCasing, angle: FloatArray, mode: int) -> tuple[FloatArray, FloatArray]:
    """Return radial and tangential displacement (any,) at polar angles per unit of a mode, by its Fourier series."""
    nodes = len(casing.modes_xy)
    n = np.fft.rfftfreq(nodes, 1 / nodes)
    share = np.where((n == 0) | (2 * n == nodes), 1, 2) / nodes
    waves = share * np.exp(1j * np.multiply.outer(angle, n))
    x, y = ((waves @ np.fft.rfft(casing.modes_xy[:, axis, mode])).real for axis in (0, 1))
    return x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)


def driven(casing: ReducedCasing, modes: range, run: Run) -> dict[int, FloatArray]:
    """Return the radial acceleration (steps,) at ANGLES of these modes under the contact forces of a run, in m/s2.

    Each mode is the filter of Smallwood (1981) for a force that is linear between the steps, as in the frame.
    """
    response, machine = run.response, run.scenario.machine
    step, angle, force = contacts(response)
    felt = {each: np.zeros(response.tail_steps) for each in ANGLES}
    for mode in modes:
        w, d = 2 * np.pi * casing.frequencies_hz[mode], machine.damping.casing
        decay, turned = np.exp(-d * w * response.dt), w * response.dt * np.sqrt(1 - d**2)
        radial, along = displacement(casing, angle, mode)
        pushed = np.bincount(step, force * (radial + run.scenario.contact.friction * along), response.tail_steps)
        b = decay * np.sin(turned) / turned
        motion = lfilter([b, -2 * b, b], [1, -2 * decay * np.cos(turned), decay**2], pushed)
        for each in ANGLES:
            felt[each] += displacement(casing, np.deg2rad([float(each)]), mode)[0] * motion
    return felt


def levels(signal: FloatArray, dt: float) -> FloatArray:
    """Return levels in dB of the second half of a signal in third octaves; a factor of no signal is left out."""
    half = signal[signal.size // 2 :]
    power = np.abs(np.fft.rfft(half * np.hanning(half.size))) ** 2 / half.size**2
    hertz = np.fft.rfftfreq(half.size, dt)
    sides = 2 ** (1 / 6)
    sums = [power[(hertz >= centre / sides) & (hertz < centre * sides)].sum() for centre in CENTRES]
    return np.asarray(10 * np.log10(sums))


def simulated(modes: int) -> tuple[Run, ReducedCasing]:
    """Return the run with that number of casing modes, and its casing."""
    scenario = rubgen.make_scenario(
        speed_rpm=SPEED_RPM, clearance_m=CLEARANCE_M, signal_seconds=SECONDS, lyapunov=False
    )
    scenario = replace(scenario, reduction=Reduction(casing_modes=modes))
    return rubgen.simulate(scenario), reduce(scenario.machine, scenario.reduction).casing


def main() -> None:
    """Simulate both runs and print the table."""
    (few, _), (many, casing) = simulated(FEW), simulated(MANY)
    for run, modes in ((few, FEW), (many, MANY)):
        if run.labels is None:
            sys.exit(f"the run with {modes} casing modes failed: {run.response.reason}")
        impulse = run.labels.impulse_per_turn
        sys.stdout.write(f"{modes} modes: {run.labels.motion.value}, {impulse:.3f} N s a turn\n")
    own, added = driven(casing, range(MANY), many), driven(casing, range(FEW, MANY), few)
    sys.stdout.write("\n| angle | comparison | " + " | ".join(f"{centre:.0f}" for centre in CENTRES) + " |\n")
    sys.stdout.write("|" + "---|" * (CENTRES.size + 2) + "\n")
    for angle in ANGLES:
        name = f"casing_acc_{angle}"
        kept, alone = many.response.taps[name], few.response.taps[name]
        truth = levels(kept, many.response.dt)
        for words, signal, run in (
            ("own forces, outside", own[angle], many),
            (f"{FEW} modes", alone, few),
            (f"{FEW}, and {FEW + 1} to {MANY} one way", alone + added[angle], few),
        ):
            off = levels(signal, run.response.dt) - truth
            sys.stdout.write(f"| {angle} deg | {words} | " + " | ".join(f"{each:+.1f}" for each in off) + " |\n")


if __name__ == "__main__":
    main()
