"""Compute what pictures of a recording show: order spectra, the orbit of the disk centre, sectors of the casing."""

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.measurement.channel import Float32Array
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.viz.replay import Replay

BLOCK_TURNS = 16
SAMPLES_PER_TURN = 256
HIGHEST_ORDER = 12
LEAST_SINE = 0.5
"""Two directions are a pair where the angle between them is at least 30 degrees: noise at most doubles."""


@dataclass(frozen=True, kw_only=True)
class OrderMap:
    """Peak amplitudes (blocks, orders) in the channel's unit at `order` (orders,); block i begins at `time[i]` in s."""

    time: FloatArray
    order: FloatArray
    amplitude: FloatArray


def order_map(
    values: Float32Array, sample_rate_hz: float, pulses: FloatArray, *, turns: int = BLOCK_TURNS, most_blocks: int = 60
) -> OrderMap:
    """Compute spectra of a channel over successive blocks of `turns` turns, at the orders 1/turns, 2/turns, ..., 12.

    The samples are interpolated linearly at 256 equal angles of each turn, so that orders stay sharp while the speed
    changes. Amplitudes are |2 X / n|, without a window, because each block is a whole number of turns. Valid up to
    order 12 where the sample rate is at least some 50 times the rotation frequency.

    - values (samples,): the channel; blocks with NaN are left out.
    - sample_rate_hz: samples per second.
    - pulses (any,): times in s at which turns begin; the last pulse ends the last turn. The map is empty below two
      pulses.
    - turns: turns of a block; fewer in a shorter recording.
    - most_blocks: largest number of blocks. If there are more, only every second, third, ... is taken.
    """
    length = min(turns, pulses.size - 1)
    if length < 1:
        return OrderMap(time=np.zeros(0), order=np.zeros(0), amplitude=np.zeros((0, 0)))
    share = np.arange(SAMPLES_PER_TURN) / SAMPLES_PER_TURN
    at = (pulses[:-1, None] + share * np.diff(pulses)[:, None]).ravel()
    angular = np.interp(at, np.arange(values.size) / sample_rate_hz, values)
    count = (pulses.size - 1) // length
    blocks = angular[: count * length * SAMPLES_PER_TURN].reshape(count, -1)
    chosen = np.flatnonzero(np.isfinite(blocks).all(axis=1))
    chosen = chosen[:: max(1, -(-chosen.size // most_blocks))]
    blocks = blocks[chosen]
    stop = HIGHEST_ORDER * length + 1
    return OrderMap(
        time=pulses[chosen * length],
        order=np.arange(1, stop) / length,
        amplitude=np.asarray(2 / blocks.shape[1] * np.abs(np.fft.rfft(blocks, axis=1)[:, 1:stop])),
    )


def shaft_orbit(replay: Replay) -> FloatArray | None:
    """Compute X and Y of the disk centre (2, samples) in um from the first pair of recorded proximity probes.

    Returns None without two probes whose directions differ by 30 to 150 degrees. A probe at angle phi reads u = x
    cos(phi) + y sin(phi), so the two readings determine x and y. From readings in V the bias is subtracted, and the
    rest is divided by the sensitivity.
    """
    channels = replay.recording.channels
    sensors = replay.scenario.sensing.set.sensors
    probes = [sensor for sensor in sensors if isinstance(sensor, Proximity) and sensor.name in channels]
    for place, first in enumerate(probes):
        for second in probes[place + 1 :]:
            angles = np.radians([first.angle_deg, second.angle_deg])
            if abs(np.sin(angles[1] - angles[0])) >= LEAST_SINE:
                directions = np.column_stack([np.cos(angles), np.sin(angles)])
                readings = [_micrometres(each, channels[each.name].values) for each in (first, second)]
                return np.asarray(np.linalg.solve(directions, np.array(readings)))
    return None


def poincare_section(replay: Replay) -> FloatArray | None:
    """Compute the Poincare section of the recorded orbit: its points at the once-per-turn pulses.

    The orbit of `shaft_orbit` is interpolated linearly at each pulse. Returns X and Y (2, pulses) in um, or None
    without a pair of probes. In period-1 motion all points coincide, apart from noise; in period-k motion there are k
    groups.
    """
    orbit = shaft_orbit(replay)
    if orbit is None:
        return None
    time = np.arange(orbit.shape[1]) / replay.recording.sample_rate_hz
    return np.array([np.interp(replay.pulse_times, time, values) for values in orbit])


def _micrometres(probe: Proximity, values: Float32Array) -> FloatArray:
    factor, zero = probe.scale
    return np.asarray(1e6 * (np.asarray(values, dtype=np.float64) - zero) / factor)


def sector_of(angle: FloatArray, sectors: int) -> IntArray:
    """Return the number of the sector of each polar angle (rad), of `sectors` equal sectors around the casing.

    Sector 0 is centred at angle 0.
    """
    width = 2 * np.pi / sectors
    return np.floor(np.mod(angle + width / 2, 2 * np.pi) / width).astype(np.int64) % sectors
