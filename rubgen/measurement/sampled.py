"""Turn the tap (true signal) of a sampled sensor into its recorded channel."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.measurement.chain import adc_step, band_limit, digitise
from rubgen.measurement.channel import Channel
from rubgen.measurement.frame import FrameMotion
from rubgen.measurement.front_end import drop_out, front_end, miscalibrate, noise, noise_level
from rubgen.measurement.surroundings import Disturbances
from rubgen.measurement.tail import Tail
from rubgen.scenario import Sensing
from rubgen.sensors.sensor import SampledSensor
from rubgen.sensors.sensor_set import SensorSet
from rubgen.solver.response import Response
from rubgen.taps import HousingAcceleration, Tap


@dataclass(frozen=True)
class Source:
    """Everything that the sensors of a run may feel: the response, the frame and the surroundings."""

    response: Response
    tail: Callable[[], Tail]
    """Returns the steps that are measured, with the shaft's angle."""
    frame: FrameMotion | None
    """Motion of the machine's frame; None without one."""
    disturbances: Disturbances | None
    """The surroundings at the sensors; None without any."""

    def truth(self, tap: Tap) -> FloatArray:
        """Return the true signal (steps,) of a tap. Raises UserError where it needs a frame and there is none."""
        if not isinstance(tap, HousingAcceleration):
            return self.response.taps[tap.name]
        if self.frame is None:
            raise UserError(f"{tap.name}: feels only the machine's [frame], which is missing")
        return self.frame.of_housing(tap.angle_deg)


@dataclass(frozen=True)
class Feed:
    """The input of the anti-alias filter from one sensor."""

    sensor: SampledSensor
    """The sensor."""
    ideal: FloatArray
    """Signal of an ideal sensor, in the sensor's unit at every step (steps,)."""
    real: FloatArray
    """Signal of the sensor with its dynamics (steps,)."""

    @property
    def clock(self) -> tuple[float, float]:
        """Offset in s and slowness in ppm of the sensor's clock."""
        return self.sensor.clock_offset_s, self.sensor.clock_ppm


@dataclass(frozen=True)
class Samples:
    """Band-limited samples (n,): `real` of the sensor, and `ideal` of an ideal sensor or None."""

    ideal: FloatArray | None
    real: FloatArray


def feed_of(sensor: SampledSensor, source: Source, sensors: SensorSet) -> Feed:
    """Make the input of the anti-alias filter from one sensor: the ideal and the real signal, at every step.

    Only the real signal includes the surroundings, the shaft's profile and the sensor's dynamics.

    - sensor: the sensor.
    - source: the response with the sensor's tap, the frame and the surroundings.
    - sensors: the sensor set, with the profile of the shaft.

    Raises UserError where the sensor needs a frame and there is none.
    """
    true = source.truth(sensor.tap)
    added = source.disturbances.by(sensor.tap) if source.disturbances else None
    factor, zero = sensor.scale

    def in_unit(signal: FloatArray) -> FloatArray:
        return signal if (factor, zero) == (1.0, 0.0) else zero + factor * signal

    felt = true if added is None else true + added
    shaft = sensors.shaft_runout
    ideal, seen = in_unit(true), sensor.disturbed(felt, source.tail().angle, shaft) if shaft else felt
    return Feed(sensor, ideal, front_end(sensor, ideal if seen is true else in_unit(seen), source.response.dt))


def filtered(feeds: Sequence[Feed], positions: FloatArray, *, dt: float, sensing: Sensing) -> dict[str, Samples]:
    """Filter and resample every feed. Returns the samples by the sensor's name.

    Sample i of a sensor whose clock is late by o and slow by p ppm is taken o + (1 + 1e-6 p) i / rate after the first
    of `positions`. Sensors with the same clock are filtered together. Ideal samples have no clock errors. They are None
    without `sensing.keep_clean`.

    - feeds: inputs at every step.
    - positions (samples,): times of the samples without clock errors, in steps.
    - dt: time step, s.
    - sensing: sample rate, and whether clean channels are recorded too.
    """
    rate = sensing.sample_rate_hz
    time = np.arange(positions.size) / rate
    wanted = [((0.0, 0.0), feed.ideal) for feed in feeds if sensing.keep_clean]
    wanted += [(feed.clock, feed.real) for feed in feeds]
    done: dict[tuple[tuple[float, float], int], FloatArray] = {}
    for clock in dict.fromkeys(clock for clock, _ in wanted):
        signals = {id(signal): signal for own, signal in wanted if own == clock}
        at = positions if clock == (0.0, 0.0) else positions + (clock[0] + 1e-6 * clock[1] * time) / dt
        out = band_limit([*signals.values()], at, dt=dt, sample_rate_hz=rate)
        done |= {(clock, name): out[:, i] for i, name in enumerate(signals)}
    return {
        feed.sensor.name: Samples(
            done[(0.0, 0.0), id(feed.ideal)] if sensing.keep_clean else None, done[feed.clock, id(feed.real)]
        )
        for feed in feeds
    }


def recorded(sensor: SampledSensor, samples: Samples, sensing: Sensing, rng: np.random.Generator) -> Channel:
    """Make the channel of a sensor: its samples with calibration errors, noise, range, ADC and dropouts, in this order.

    - sensor: the sensor.
    - samples: its band-limited samples. The ideal ones become the clean copy as they are.
    - sensing: sample rate, noise and ADC.
    - rng: random numbers of the sensor.
    """
    about, rate = sensor.description, sensing.sample_rate_hz
    low, high = sensor.full_range
    bits = sensor.adc_bits or sensing.adc_bits
    seen = miscalibrate(sensor, samples.real, zero=sensor.scale[1], sample_rate_hz=rate)
    noisy = seen + noise(sensor, seen.size, rate, sensing.noise, rng)
    values = digitise(noisy, range_min=low, range_max=high, bits=bits)
    return Channel(
        name=sensor.name,
        unit=sensor.unit,
        quantity=about.quantity,
        axis=about.axis,
        location=about.location,
        range_min=low,
        range_max=high,
        resolution=adc_step(low, high, bits),
        noise_rms=sensing.noise * noise_level(sensor, seen.size, rate),
        values=drop_out(sensor, values, rate, rng).astype(np.float32),
        clean=None if samples.ideal is None else samples.ideal.astype(np.float32),
    )
