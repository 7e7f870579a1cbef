"""What pictures show of a recording: order spectra along a run, the orbit of the disk centre, sectors of the casing."""

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
"""Two directions are a pair where they stand at 30 degrees or more: noise grows by two at most."""


@dataclass(frozen=True, kw_only=True)
class OrderMap:
    """Peak amplitudes (blocks, orders) in the channel's unit at `order` (orders,); block i begins at `time[i]` in s."""

    time: FloatArray
    order: FloatArray
    amplitude: FloatArray


def order_map(
    values: Float32Array, sample_rate_hz: float, pulses: FloatArray, *, turns: int = BLOCK_TURNS, most_blocks: int = 60
) -> OrderMap:
    """Spectra of a channel over blocks of `turns` turns (fewer in a shorter recording), at most `most_blocks`.

    `pulses` (any,) are the times in s at which turns begin. The samples are read by linear interpolation at 256 equal
    angles of each turn, so that orders stay sharp while the speed changes; |2 X / n| under no window, for each block
    holds whole turns. Blocks with lost samples are left out, and without two pulses there is none. Valid up to order
    12 while the sample rate is some 50 times the rotation frequency.
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
    """X and Y of the disk centre (2, samples) in um as the first pair of probes saw it; None without a pair.

    A probe at angle phi reads u = x cos(phi) + y sin(phi); two readings are solved for x and y. Readings in V lose
    their bias and are divided by the sensitivity.
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


def section(replay: Replay) -> FloatArray | None:
    """X and Y (2, pulses) of the recorded orbit at the once-per-turn pulses, um; None without a pair of probes."""
    orbit = shaft_orbit(replay)
    if orbit is None:
        return None
    time = np.arange(orbit.shape[1]) / replay.recording.sample_rate_hz
    return np.array([np.interp(replay.pulse_times, time, values) for values in orbit])


def _micrometres(probe: Proximity, values: Float32Array) -> FloatArray:
    factor, zero = probe.scale
    return np.asarray(1e6 * (np.asarray(values, dtype=np.float64) - zero) / factor)


def sector_of(angle: FloatArray, sectors: int) -> IntArray:
    """Number of the sector, of so many equal ones, in which each polar angle (rad) lies; sector 0 lies about 0."""
    width = 2 * np.pi / sectors
    return np.floor(np.mod(angle + width / 2, 2 * np.pi) / width).astype(np.int64) % sectors
