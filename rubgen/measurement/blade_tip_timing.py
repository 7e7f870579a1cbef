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
    """The passages that one probe recorded, in order of time; all arrays (n_arrivals,)."""

    time: FloatArray
    """Times as recorded by the probe, s from the first sample."""
    blade: IntArray
    """Number of the blade, known because this is a simulation."""
    true_displacement: FloatArray
    """True displacement of the tip's chord along the rotation, m."""


def tick(time: FloatArray, clock_hz: float) -> FloatArray:
    """Round times (s) down to the resolution of a counter of `clock_hz`. For 0 they are returned unchanged."""
    return np.asarray(np.floor(time * clock_hz) / clock_hz) if clock_hz else time


def blurred(sensor: TimingProbe | OncePerRev, time: FloatArray, noise: float, rng: np.random.Generator) -> FloatArray:
    """Return times (any,) in s with the jitter and the counter of a sensor.

    Jitter is Gaussian, with the rms `noise` times `sensor.jitter_s`. The counter rounds down after it (`tick`).

    - time (any,): exact times, s.
    - noise: factor of the sensor's jitter.
    - rng: random numbers. Without jitter no number is drawn.
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
    """Record the passages of blades at a probe within a recording.

    Passages are recorded whose true time from the first sample is in [0, `seconds`). Those of lost blades are left out.
    Each other passage is missed with the probability `probe.missed`. The clock offset of the probe is added to the true
    time, then jitter, and the counter rounds the result down (`blurred`). Passages are in order of the recorded time.

    - probe: the sensor.
    - arrivals: the true passages in steps from the start of the record.
    - dt: time step, s.
    - start: time of the first sample from the start of the record, s.
    - seconds: length of the recording, s.
    - noise: factor of the probe's jitter.
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

    The mean deflection of each blade cannot be known and is 0. The angle of arrival is AoA = Omega (t - t_0) from the
    last pulse t_0, with Omega = 2 pi over the turn's time. The deflection is x = R (mean AoA of the blade - AoA): early
    is positive (S. Heath, M. Imregun, Int. J. Mech. Sci. 38, 1996). It is NaN for arrivals before the first pulse or
    after the last, so for all arrivals with fewer than two pulses.

    - times: the passages that the probe recorded.
    - once_per_rev (pulses,): times of the pulses, s.
    - tip_radius: R, m.
    """
    if once_per_rev.size < 2:
        return np.full(times.time.size, np.nan)
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
