"""Record passages of the blades at each timing probe, and compute the tip deflections from them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.solver.response import TipArrivals


@dataclass(frozen=True, kw_only=True)
class TipTimes:
    """The record of one probe in order of time; all arrays (n_arrivals,)."""

    time: FloatArray
    """Times as recorded by the probe, s from the first sample."""
    blade: IntArray
    """Number of the blade, known because this is a simulation."""
    true_displacement: FloatArray
    """True displacement of the tip's chord along the rotation, m."""


def tick(time: FloatArray, clock_hz: float) -> FloatArray:
    """Round times down to the resolution of a counter of `clock_hz`; with 0 they stay exact."""
    return np.asarray(np.floor(time * clock_hz) / clock_hz) if clock_hz else time


def blurred(sensor: TimingProbe | OncePerRev, time: FloatArray, noise: float, rng: np.random.Generator) -> FloatArray:
    """Return times with the jitter and the counter of a sensor.

    - time: exact times, s.
    - noise: factor of the jitter.
    - rng: random numbers.
    """
    jitter = noise * sensor.jitter_s
    shaken = time + jitter * rng.standard_normal(time.size) if jitter else time
    return tick(shaken, sensor.clock_hz)


def tip_times(
    probe: TimingProbe,
    arrivals: TipArrivals,
    *,
    dt: float,
    start: float,
    seconds: float,
    noise: float,
    rng: np.random.Generator,
    lost: Sequence[int] = (),
) -> TipTimes:
    """Record the passages of a probe within a recording, with jitter, counter and clock offset.

    Missed passages and lost blades are left out.

    - probe: the sensor.
    - arrivals: the true passages in steps.
    - dt: time step, s.
    - start: time of the first sample from the start of the record, s.
    - seconds: length of the recording.
    - noise: factor of the jitter.
    - rng: random numbers.
    - lost: numbers of the lost blades.
    """
    true = arrivals.step * dt - start
    seen = (true >= 0) & (true < seconds) & ~np.isin(arrivals.blade, lost)
    if probe.missed:
        seen &= rng.uniform(size=seen.size) >= probe.missed
    time = blurred(probe, true[seen] + probe.clock_offset_s, noise, rng)
    order = np.argsort(time, kind="stable")
    return TipTimes(
        time=time[order],
        blade=arrivals.blade[seen][order],
        true_displacement=arrivals.displacement[seen][order],
    )


def tip_deflections(times: TipTimes, once_per_rev: FloatArray, tip_radius: float) -> FloatArray:
    """Compute tip deflections (n_arrivals,) in m along the rotation from arrival times alone.

    Each blade's mean is lost. The angle of arrival is AoA = Omega (t - t_0) from the last pulse t_0, Omega = 2 pi over
    the turn's time. The deflection is x = R (mean AoA of that blade - AoA): early is positive (S. Heath, M. Imregun,
    Int. J. Mech. Sci. 38, 1996). Arrivals before the first pulse or after the last are NaN.

    - times: the probe's record.
    - once_per_rev (pulses,): times of the pulses, s.
    - tip_radius: R, m.
    """
    turn = np.searchsorted(once_per_rev, times.time, side="right") - 1
    inside = (turn >= 0) & (turn < once_per_rev.size - 1)
    first = once_per_rev[np.where(inside, turn, 0)]
    length = np.diff(once_per_rev)[np.where(inside, turn, 0)]
    angle = np.where(inside, 2 * np.pi * (times.time - first) / length, np.nan)
    deflection = np.full(angle.size, np.nan)
    for blade in np.unique(times.blade[inside]):
        own = inside & (times.blade == blade)
        # A blade that passes near angle 0 lies on both sides of it: its circle of angles is cut opposite to it.
        centre = np.angle(np.exp(1j * angle[own]).mean())
        about = np.angle(np.exp(1j * (angle[own] - centre)))
        deflection[own] = tip_radius * (about.mean() - about)
    return deflection
