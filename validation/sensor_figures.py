"""What sensors do, measured: `python -m validation.sensor_figures [DIRECTORY]` prints it and draws two figures."""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from matplotlib.figure import Figure
from scipy.sparse.linalg import splu

from rubgen.arrays import FloatArray, IntArray
from rubgen.fem.beam import root_strain_row
from rubgen.fem.blisk import assemble_blisk
from rubgen.fem.constraints import on_springs, support_stiffness
from rubgen.machine import Machine, load_machine
from rubgen.measurement import Recording, margin_seconds, measure
from rubgen.measurement.blade_tip_timing import tip_deflections
from rubgen.measurement.chain import PASS_BAND_SHARE, band_limit, half_width_seconds
from rubgen.reduction import ReducedModel, reduce
from rubgen.scenario import ContactLaw, Operation, Reduction, Sensing
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.contact_force import ContactForceSensor
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.sensor_set import SensorSet
from rubgen.solver import Response
from rubgen.solver.integrate import integrate
from rubgen.solver.wants import Wants
from rubgen.units import rad_per_s
from rubgen.viz.colors import BLUE, VERMILION
from rubgen.viz.figures import save_png

RATE = 25600.0
STEP_RATE = 8500 / 60 * 1024
SPEED_RPM, SETTLE_TURNS, RECORD_TURNS, SECONDS = 8500.0, 150, 120, 0.5
FRICTION = 0.01
HELD_N = 10.0


@dataclass(frozen=True)
class Recovery:
    """Deflections (n,) of one probe in m, without each blade's mean: from arrival times, and true."""

    probe: str
    blade: IntArray
    time: FloatArray
    recovered: FloatArray
    true: FloatArray

    @property
    def error(self) -> FloatArray:
        """What timing gets wrong, m."""
        return np.asarray(self.recovered - self.true)


def filter_response(frequencies: FloatArray) -> FloatArray:
    """Gain of the anti-alias filter for tones at these frequencies in Hz, the largest over 400 samples of each."""
    margin = int(np.ceil(half_width_seconds(RATE) * STEP_RATE)) + 1
    positions: FloatArray = margin + 0.37 + np.arange(400, dtype=np.float64) * STEP_RATE / RATE
    phase = 2 * np.pi * frequencies / STEP_RATE * np.arange(int(positions[-1]) + margin + 2)[:, None]
    parts = np.concatenate([np.cos(phase), np.sin(phase)], axis=1)
    out = band_limit([*parts.T], positions, dt=1 / STEP_RATE, sample_rate_hz=RATE)
    half = len(frequencies)
    return np.asarray(np.hypot(out[:, :half], out[:, half:]).max(axis=0))


def response_of(machine: Machine, sensing: Sensing) -> Response:
    """A short chaotic rub of the preset with the taps of these sensors."""
    operation = Operation(speed_rpm=SPEED_RPM, settle_turns=SETTLE_TURNS, record_turns=RECORD_TURNS)
    return integrate(
        reduce(machine, Reduction()),
        operation,
        ContactLaw(friction=FRICTION),
        Wants(
            tail_seconds=SECONDS + margin_seconds(sensing, SECONDS),
            sample_rate_hz=sensing.fastest_hz,
            taps=sensing.set.taps,
        ),
    )


def recoveries(recording: Recording, tip_radius: float) -> list[Recovery]:
    """What each timing probe gives, beside the truth."""
    found = []
    for name, seen in recording.tip_timing.items():
        recovered = tip_deflections(seen, recording.once_per_rev, tip_radius)
        known = np.isfinite(recovered)
        true = seen.true_displacement[known]
        blade = seen.blade[known]
        mean = np.bincount(blade, weights=true) / np.bincount(blade)
        found.append(Recovery(name, blade, seen.time[known], recovered[known], true - mean[blade]))
    return found


def without_faults(sensors: SensorSet) -> SensorSet:
    """Ideal timing probes at the places of those of a set, and the one sampled sensor that every set needs."""
    probes = [each for each in sensors.sensors if isinstance(each, TimingProbe)]
    ideal = tuple(TimingProbe(name=p.name, angle_deg=p.angle_deg, axial_m=p.axial_m) for p in probes)
    return SensorSet(name="ideal", sensors=(*ideal, ContactForceSensor(name="contact_force")))


def held_load(model: ReducedModel, speed: float) -> dict[str, tuple[float, float]]:
    """Root strain and drive torque under a steady tangential force on one tip: reduced model, and full model.

    Of the drive the balance of torques gives -F R; the strain's comes from the full matrices at that speed.
    """
    machine, blade = model.machine, 0
    load = np.zeros(len(model.blisk.K))
    load[3 * blade + 1] = HELD_N
    q = np.linalg.solve(model.stiffness(speed), load)
    full = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
    K = on_springs(full.K, support_stiffness(machine.disk_support)) + speed**2 * (full.K_sigma - full.S)
    force = np.zeros(K.shape[0])
    force[full.tips[blade, 1]] = HELD_N
    displaced = splu(sp.csc_array(K)).solve(force)
    row = root_strain_row(machine.blades, machine.disk.rim_radius_m, full.beam)
    first = full.roots[blade, 0]
    return {
        "root strain, um/m": (
            1e6 * float(model.root_strain(blade, speed) @ q),
            1e6 * float(row @ displaced[first : first + 12]),
        ),
        "drive torque, N m": (-float(model.springs[5] * model.blisk.centre[5] @ q), -HELD_N * machine.tip_radius_m),
    }


def draw_filter(frequencies: FloatArray, gain: FloatArray) -> Figure:
    """The measured response, whole and in the pass band."""
    figure = Figure(figsize=(8, 4), layout="constrained")
    whole, near = figure.subplots(1, 2)
    decibel = 20 * np.log10(np.maximum(gain, 1e-9))
    whole.plot(frequencies / 1e3, decibel, color=BLUE, linewidth=1)
    whole.axvline(RATE / 2e3, color=VERMILION, linewidth=1, linestyle="--")
    whole.axhline(-85, color=VERMILION, linewidth=1, linestyle=":")
    whole.set(xlabel="frequency, kHz", ylabel="gain, dB", title="swept sine; dashed: Nyquist, dotted: -85 dB")
    inside = frequencies <= RATE / 2
    near.plot(frequencies[inside] / 1e3, gain[inside] - 1, color=BLUE, linewidth=1)
    near.axvline(PASS_BAND_SHARE * RATE / 2e3, color=VERMILION, linewidth=1, linestyle="--")
    near.set(ylim=(-2e-4, 2e-4), xlabel="frequency, kHz", ylabel="gain - 1", title="pass band; dashed: its end")
    return figure


def draw_timing(exact: Recovery, rig: Recovery) -> Figure:
    """Deflections of one blade from arrival times and true; recovered against true for all blades."""
    figure = Figure(figsize=(8, 4), layout="constrained")
    turns, against = figure.subplots(1, 2)
    own = rig.blade == 0
    turns.plot(1e3 * rig.time[own], 1e6 * rig.true[own], color=BLUE, linewidth=1, label="true")
    turns.plot(1e3 * rig.time[own], 1e6 * rig.recovered[own], ".", color=VERMILION, markersize=4, label="from timing")
    turns.set(xlabel="time, ms", ylabel="tip deflection, um", title=f"blade 0 at {rig.probe}, a rig's jitter")
    turns.legend(frameon=False)
    for each, color, label in ((rig, VERMILION, "rig"), (exact, BLUE, "ideal probe")):
        against.plot(1e6 * each.true, 1e6 * each.error, ".", color=color, markersize=2, label=label)
    against.set(xlabel="true deflection, um", ylabel="error, um", title="all blades")
    against.legend(frameon=False, markerscale=4)
    return figure


def main(directory: Path) -> None:
    """Measure, print and draw into `directory`."""
    frequencies = np.unique(np.concatenate([np.linspace(20, STEP_RATE / 2, 900), np.linspace(9.5e3, 13.5e3, 400)]))
    gain = filter_response(frequencies)
    passed, stopped = frequencies <= RATE / 2.56, frequencies >= RATE / 2
    _say(f"anti-alias filter at {RATE:g} Hz, {STEP_RATE:.0f} steps a second, {frequencies.size} tones")
    _say(f"  largest error up to {RATE / 2.56:g} Hz: {np.abs(gain[passed] - 1).max():.2g}")
    _say(f"  largest gain from {RATE / 2:g} Hz on: {20 * np.log10(gain[stopped].max()):.1f} dB")
    save_png(draw_filter(frequencies, gain), directory / "anti-alias-filter.png")

    machine = load_machine("zeng2019")
    for rpm in (60.0, SPEED_RPM):
        for name, (reduced, full) in held_load(reduce(machine, Reduction()), rad_per_s(rpm)).items():
            _say(f"{HELD_N:g} N held on a tip at {rpm:g} rev/min: {name} {reduced:.4g}, full {full:.4g}")

    sensing = Sensing(set=load_sensor_set("rig"))
    begun = time.process_time()
    response = response_of(machine, sensing)
    _say(f"{SPEED_RPM:g} rev/min, friction {FRICTION:g}: {response.status.code}, {time.process_time() - begun:.1f} s")
    found = {}
    for name, used in (("ideal", Sensing(set=without_faults(sensing.set))), ("rig", sensing)):
        begun = time.process_time()
        recording = measure(response, used, seconds=SECONDS, rng=np.random.default_rng(1))
        _say(f"{name} set: {time.process_time() - begun:.2f} s of CPU for {SECONDS:g} s")
        found[name] = recoveries(recording, machine.tip_radius_m)
        for each in found[name]:
            _say(
                f"  {each.probe}: {each.true.size} arrivals, deflections {1e6 * each.true.std():.1f} um rms, error "
                f"{1e6 * each.error.std():.3g} um rms, {1e6 * np.abs(each.error).max():.3g} um at most"
            )
        for channel in recording.channels.values():
            values = channel.values.astype(np.float64)
            _say(f"  {channel.name}: {values.min():.4g} to {values.max():.4g} {channel.unit}")
    save_png(draw_timing(found["ideal"][0], found["rig"][0]), directory / "tip-timing.png")


def _say(line: str) -> None:
    sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs"))
