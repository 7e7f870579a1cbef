"""The recorded orbit of the disk centre, from whatever pair of proximity probes there is."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.measurement.channel import Float32Array
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.viz.replay import Replay

LEAST_SINE = 0.5
"""Two directions are a pair where they stand at 30 degrees or more: noise grows by two at most."""


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
