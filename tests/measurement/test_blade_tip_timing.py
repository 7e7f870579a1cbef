"""Deflections from arrival times agree with the true ones."""

import numpy as np
import pytest

from rubgen.measurement.blade_tip_timing import TipTimes, blurred, tip_deflections, tip_times
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.solver.response import TipArrivals

SPEED, RADIUS, BLADES, TURNS = 2 * np.pi * 150.0, 0.4, 36, 40


def vibration(blade, time):
    """A tip's displacement along the rotation, m: engine order 2 with the blade's phase, and a free decay."""
    return 3e-4 * np.cos(2 * SPEED * time + blade) + 1e-4 * np.exp(-20 * time) * np.sin(
        2 * np.pi * 433 * time + 2 * blade
    )


def arrivals(angle):
    """Every blade at every turn, by bisection of theta + angle_k + u / R = phi; blade k stands at 2 pi k / BLADES."""
    times, blades = [], []
    for blade in range(BLADES):
        for turn in range(TURNS):
            target = angle - 2 * np.pi * blade / BLADES + 2 * np.pi * (turn + 1)
            time = target / SPEED
            for _ in range(30):  # contracts: the blade moves at 1 m/s, the rim at 377
                time = (target - vibration(blade, time) / RADIUS) / SPEED
            times.append(time)
            blades.append(blade)
    order = np.argsort(times)
    return np.array(times)[order], np.array(blades)[order]


@pytest.mark.parametrize("angle", [0.0, 0.001, 1.9, 6.28])
def test_deflections_are_recovered_whatever_the_place_of_the_probe(angle):
    time, blade = arrivals(angle)
    true = vibration(blade, time)
    seen = TipTimes(time=time, blade=blade, true_displacement=true)
    deflection = tip_deflections(seen, 2 * np.pi * np.arange(TURNS + 3) / SPEED, RADIUS)
    assert np.isfinite(deflection).all()
    for k in range(BLADES):
        own = true[blade == k]
        assert deflection[blade == k] == pytest.approx(own - own.mean(), abs=1e-12)


def test_arrivals_outside_the_pulses_are_unknown():
    time = np.array([-1e-3, 1e-3, 8e-3, 30e-3])
    seen = TipTimes(time=time, blade=np.zeros(4, np.int64), true_displacement=np.zeros(4))
    known = np.isfinite(tip_deflections(seen, np.array([0.0, 6.6e-3, 13.2e-3]), RADIUS))
    assert known.tolist() == [False, True, True, False]


@pytest.mark.parametrize("pulses", [[], [2e-3]])
def test_without_a_whole_turn_every_arrival_is_unknown(pulses):
    seen = TipTimes(time=np.array([1e-3, 8e-3]), blade=np.array([0, 1]), true_displacement=np.zeros(2))
    assert np.isnan(tip_deflections(seen, np.array(pulses), RADIUS)).tolist() == [True, True]


def test_a_probe_blurs_shifts_and_misses_as_it_says():
    rng, dt, count = np.random.default_rng(2), 1e-5, 20_000
    step = np.sort(rng.uniform(0, 5e5, count))
    made = TipArrivals(blade=np.arange(count) % BLADES, step=step, displacement=np.arange(float(count)))
    probe = TimingProbe(name="p", angle_deg=0, jitter_s=3e-6, clock_hz=1e6, clock_offset_s=2e-4, missed=0.1)
    seen = tip_times(probe, made, dt=dt, start=1.0, seconds=2.0, noise=1.0, rng=rng)
    true = step[seen.true_displacement.astype(int)] * dt - 1.0
    assert np.all((true >= 0) & (true < 2))
    assert seen.time.size / (count * 2 / 5) == pytest.approx(0.9, abs=0.02)
    error = seen.time - true
    assert error.mean() == pytest.approx(2e-4 - 0.5e-6, abs=2e-7)  # a counter shows the tick before
    assert error.std() == pytest.approx(np.hypot(3e-6, 1e-6 / np.sqrt(12)), rel=0.03)
    assert seen.time * 1e6 == pytest.approx(np.round(seen.time * 1e6), abs=1e-4)
    assert np.all(np.diff(seen.time) >= 0)
    assert np.array_equal(seen.blade, seen.true_displacement.astype(int) % BLADES)


def test_an_ideal_probe_is_exact_and_noise_scales_jitter():
    time = np.linspace(0, 1, 50)
    assert blurred(OncePerRev(name="k"), time, 1.0, np.random.default_rng(0)) is time
    shaken = blurred(OncePerRev(name="k", jitter_s=1e-6), time, 0.0, np.random.default_rng(0))
    assert shaken is time


def test_a_recording_with_a_rig_s_probes(rig_run):
    """Made deflections of 0.1 mm, jitter of 20 ns at 419 m/s, a pulse with 50 ns: what is left is 10 to 30 um."""
    recording = rig_run.recording
    assert set(recording.tip_timing) == {"timing_10", "timing_29", "timing_61", "timing_138"}
    for seen in recording.tip_timing.values():
        assert 0.3 * 166.7 * BLADES * 0.99 < seen.time.size < 0.3 * 166.7 * BLADES * 1.01
        deflection = tip_deflections(seen, recording.once_per_rev, RADIUS)
        known = np.isfinite(deflection)
        error = deflection[known] - seen.true_displacement[known]
        for k in range(BLADES):
            own = error[seen.blade[known] == k]
            assert (own - own.mean()).std() < 40e-6
