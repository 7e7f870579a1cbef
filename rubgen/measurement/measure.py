"""Record all channels and events of one run.

The tail is the end of a run: the steps at which the response has taps (true signals).
"""

import zlib
from collections.abc import Sequence
from functools import cache, partial

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.machine.faults.fault import Fault
from rubgen.machine.frame import Frame
from rubgen.measurement.blade_tip_timing import TipTimes, blurred, tip_times
from rubgen.measurement.chain import half_width_seconds, late_seconds, start_seconds
from rubgen.measurement.channel import Channel, Recording
from rubgen.measurement.frame import FrameMotion, spread
from rubgen.measurement.sampled import Source, feed_of, filtered, recorded
from rubgen.measurement.shaft import pulse_channel, pulse_times, shaft_angle, shaft_speed
from rubgen.measurement.strikes import force_of
from rubgen.measurement.surroundings import Disturbances
from rubgen.measurement.tail import Tail
from rubgen.scenario import Sensing
from rubgen.scenario.costs import STEPS_PER_SAMPLE
from rubgen.scenario.surroundings import Surroundings
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.sensor import SampledSensor
from rubgen.solver.response import Response

SURROUNDINGS_STREAM = 2**32 - 1
"""The child of a run's random numbers that its surroundings have: far beyond those of sensors."""
FRAME_STREAM = SURROUNDINGS_STREAM - 1
"""The child that draws the frame."""
STRIKES_STREAM = FRAME_STREAM - 1
"""The child that draws the blows of faults."""


def measure(
    response: Response,
    sensing: Sensing,
    *,
    seconds: float,
    rng: np.random.Generator,
    surroundings: Surroundings | None = None,
    frame: Frame | None = None,
    faults: Sequence[Fault] = (),
    lost: Sequence[int] = (),
) -> Recording:
    """Record the channels and events of a run with the sensors of `sensing.set`.

    - response: true response with the taps of all sensors.
    - sensing: sensors, sample rate, noise and ADC.
    - seconds: length of the recording, > 0, at the end of the record.
    - rng: random numbers. A second call with the same generator draws other noise.
    - surroundings: what sensors feel in addition to the motion, or None.
    - frame: frame of the machine, which carries the force of the disk's support to sensors, or None.
    - faults: faults of the machine; only their blows on the frame are used here.
    - lost: numbers of lost blades, which pass no probe.

    The last sample of the latest clock is half a filter length before the end of the tail, so that no sample is
    affected by its edge. The step after the tail has theta = 0 mod 2 pi. Each sensor has its own child of `rng`, by its
    place in the set: its noise depends only on the seed of `rng`, how many children it had before, and the number of
    samples. Surroundings, frame and blows have further children, which are the same in every call with this `rng`.
    Raises UserError where the tail is too short for `seconds` and the filter, where the step rate is below 2.56 sample
    rates, and where a sensor or the surroundings need a frame and there is none.
    """
    rate, sensors = sensing.sample_rate_hz, sensing.set.sensors
    positions = sample_positions(response, sensing, seconds)
    angle = shaft_angle(response, positions)
    covered = positions.size / rate
    start = start_seconds(sensing, seconds, steps=response.record_steps, dt=response.dt)
    pulses = pulse_times(response, float(angle[0]), start, covered)
    streams = dict(zip((sensor.name for sensor in sensors), rng.spawn(len(sensors)), strict=True))
    tail = cache(partial(_tail, response, seconds))  # few runs need it
    motion = _frame_motion(frame, response, tail(), surroundings, faults, rng) if frame else None
    stream = _stream(rng, SURROUNDINGS_STREAM)
    disturbances = Disturbances(surroundings, tail(), stream, motion) if surroundings else None
    source = Source(response, tail, motion, disturbances)
    channels = _channels(source, sensing, positions, angle, streams)
    timing: dict[str, TipTimes] = {}
    for sensor in sensors:
        if isinstance(sensor, OncePerRev):
            pulses = blurred(sensor, pulses, sensing.noise, streams[sensor.name])
        if isinstance(sensor, TimingProbe):
            timing[sensor.name] = tip_times(
                sensor, response.arrivals[sensor.name], dt=response.dt, start=start, seconds=covered,
                noise=sensing.noise, rng=streams[sensor.name], lost=lost,
            )  # fmt: skip
    return Recording(
        sample_rate_hz=rate,
        start_seconds=start,
        rotation_angle=float(angle[0]),
        channels=channels,
        once_per_rev=pulses,
        tip_timing=timing,
    )


def sample_positions(response: Response, sensing: Sensing, seconds: float) -> FloatArray:
    """Return the times of the samples (samples,) in steps from the start of the tail, fractional and ascending.

    There are round(seconds * rate). They are the times for a sensor without clock errors.

    - response: the response with its tail.
    - sensing: sample rate and clocks of the sensors.
    - seconds: length of the recording, s.

    Raises UserError where the tail is too short for `seconds`, the filter and the clocks, for less than one sample, and
    where the step rate is below 2.56 sample rates.
    """
    dt, rate = response.dt, sensing.sample_rate_hz
    if dt * rate * STEPS_PER_SAMPLE > 1 + 1e-9:
        highest = 1 / dt / STEPS_PER_SAMPLE
        raise UserError(
            f"sample_rate_hz = {rate:g}: at most {highest:.6g} Hz with {1 / dt:.6g} steps a second; "
            "lower sample_rate_hz or raise steps_per_turn"
        )
    tail = response.tail_steps
    half_width, late = half_width_seconds(rate) / dt, late_seconds(sensing, seconds) / dt
    count = round(seconds * rate)
    positions = (tail - 1 - half_width - late) - np.arange(count - 1, -1, -1) / (rate * dt)
    early = late_seconds(sensing, seconds, sign=-1) / dt
    if count < 1 or np.floor(positions[0] - early) - np.ceil(half_width) + 1 < 0:
        longest = max((tail - 1 - 2 * half_width - late - early) * dt, 0.0)
        raise UserError(
            f"signal_seconds = {seconds:g}: must be at least one sample and at most {longest:.6g} s for this record; "
            "shorten signal_seconds or raise record_turns"
        )
    return np.asarray(positions, dtype=np.float64)


def _channels(
    source: Source,
    sensing: Sensing,
    positions: FloatArray,
    angle: FloatArray,
    streams: dict[str, np.random.Generator],
) -> dict[str, Channel]:
    """Return the sampled channels and the pulse, in the order of the set."""
    feeds = [feed_of(sensor, source, sensing.set) for sensor in sensing.set.sampled]
    samples = filtered(feeds, positions, dt=source.response.dt, sensing=sensing)
    channels: dict[str, Channel] = {}
    for sensor in sensing.set.sensors:
        if isinstance(sensor, SampledSensor):
            channels[sensor.name] = recorded(sensor, samples[sensor.name], sensing, streams[sensor.name])
        if isinstance(sensor, OncePerRev):
            channels[sensor.name] = pulse_channel(angle, sensor.name, keep_clean=sensing.keep_clean)
    return channels


def _frame_motion(
    frame: Frame,
    response: Response,
    tail: Tail,
    surroundings: Surroundings | None,
    faults: Sequence[Fault],
    rng: np.random.Generator,
) -> FrameMotion:
    """Move the run's own frame by the force on the disk's support and by the blows of faults."""
    own = spread(frame, surroundings.frame_spread, _stream(rng, FRAME_STREAM)) if surroundings else frame
    x, y = response.taps["support_force_x"], response.taps["support_force_y"]
    for fault in (each for each in faults if each.STRIKES):
        stream = _stream(rng, STRIKES_STREAM, zlib.crc32(type(fault).__name__.encode()))
        strikes = fault.strikes(tail.turned, tail.speed, stream)
        if strikes:
            more = force_of(strikes, tail.turned, response.dt)
            x, y = x + more[0], y + more[1]
    return FrameMotion(frame=own, force=(x, y), dt=response.dt)


def _tail(response: Response, seconds: float) -> Tail:
    """Make the steps that are measured."""
    steps = np.arange(response.tail_steps)
    return Tail(
        dt=response.dt,
        angle=shaft_angle(response, steps),
        speed=shaft_speed(response, steps),
        seconds=seconds,
        blades=response.n_blades,
        turn=response.steps_per_turn if response.changing_speed is None else None,
    )


def _stream(rng: np.random.Generator, *child: int) -> np.random.Generator:
    """Make a child of the run's random numbers, whatever other children there are."""
    own = rng.bit_generator.seed_seq
    sequence = np.random.SeedSequence(own.entropy, spawn_key=(*own.spawn_key, *child))  # type: ignore[attr-defined]
    return np.random.default_rng(sequence)
