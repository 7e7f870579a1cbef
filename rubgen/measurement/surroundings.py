"""Compute the signals that the surroundings add to taps (true signals). The motion and its labels do not change."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.errors import UserError
from rubgen.measurement.frame import FrameMotion
from rubgen.measurement.tail import Tail
from rubgen.scenario.surroundings import Surroundings, Tone
from rubgen.scenario.vary import DEFAULT_SPEED_RPM
from rubgen.taps import CasingAcceleration, CentreDisplacement, HousingAcceleration, Tap
from rubgen.units import rad_per_s

DISTURBED_TAPS = (CasingAcceleration, CentreDisplacement, HousingAcceleration)
"""The kinds of taps to which surroundings add."""
BAND_HZ = (10.0, 20_000.0)
"""Band of the background."""
HIGHEST_CIRCUMFERENTIAL = 6
"""Circumferential orders 0 to 6 of the casing share the power of background and tones: signals at places 15 degrees
apart have the correlation 0.61, at places 30 degrees apart none."""
PERIOD_MARGIN_S = 0.5
"""The background repeats after the recorded seconds and this margin, whatever tail the sensors need."""
BLADE_PASSING_HARMONICS = 3
RUNOUT_ORDERS = 3


class Disturbances:
    """The signals that one run's surroundings add to taps.

    Each kind of signal, and each tone, has its own random numbers. Acceleration at the polar angle phi of the casing,
    x_n and y_n independent with equal power:

    - background and tones: sum over n = 0..6 of x_n cos(n phi) + y_n sin(n phi), so that near sensors agree
    - blade passing: sum over k = 1..3 of cos(k N_b (theta - phi) + psi_k) / k, a pattern that turns with the blades
    - the motion of the machine's frame

    A bearing housing moves as one body: it feels the part n = 1 of background and tones, with their whole power.
    """

    def __init__(
        self, surroundings: Surroundings, tail: Tail, rng: np.random.Generator, frame: FrameMotion | None = None
    ):
        if surroundings.path_gain and frame is None:
            raise UserError("surroundings.path_gain: needs the machine's [frame], which is missing")
        self.frame = frame
        self.surroundings, self.tail = surroundings, tail
        level = (tail.once.speed / rad_per_s(DEFAULT_SPEED_RPM)) ** surroundings.speed_exponent
        self._level = np.asarray(level, dtype=np.float64)
        tones, runout, passing, drift, background = rng.spawn(5)
        self._tones = [_tone_field(each) for each in tones.spawn(len(surroundings.tones))]
        self._runout = runout.uniform(0, 2 * np.pi, RUNOUT_ORDERS)
        self._passing = passing.uniform(0, 2 * np.pi, BLADE_PASSING_HARMONICS)
        self._drift = float(drift.uniform(0, 2 * np.pi))
        self._background = background

    def by(self, tap: Tap) -> FloatArray | None:
        """Return the signal (steps,) that is added to a tap, in the tap's unit; None where nothing is added."""
        if isinstance(tap, CasingAcceleration):
            return self._on_the_casing(np.deg2rad(tap.angle_deg), tap.angle_deg)
        if isinstance(tap, HousingAcceleration):
            return self._shaking(_rigid(np.deg2rad(tap.angle_deg)))
        return self._under_a_probe(tap) if isinstance(tap, CentreDisplacement) else None

    def _on_the_casing(self, around: float, angle_deg: float) -> FloatArray:
        added = self._shaking(_elastic(around))
        if self.surroundings.blade_passing_m_per_s2:
            added += self.tail.everywhere(self._level * self._blade_passing(around))
        if self.surroundings.path_gain and self.frame is not None:
            added += self.surroundings.path_gain * self.frame.of_casing(angle_deg)
        return added

    def _shaking(self, weights: FloatArray) -> FloatArray:
        """Background and tones (steps,) where the parts of the fields have these weights (2 n + 1,)."""
        added = np.zeros(self.tail.angle.size)
        if self.surroundings.background_m_per_s2:
            added += self._broadband(weights)
        amplitudes = np.array([weights @ parts for parts in self._tones], dtype=np.complex128)
        turning, waves = self._waves
        if len(turning):
            a = amplitudes[turning]
            added += self.tail.everywhere(np.concatenate([a.real, -a.imag]) @ waves)
        steady, advances, levels = self._steady
        if len(steady):
            added += self.tail.sinusoids(levels * amplitudes[steady], advances)
        return added

    @cached_property
    def _steady(self) -> tuple[list[int], FloatArray, FloatArray]:
        """Numbers of the tones of one frequency that are no whole order, their rad a step and their amplitudes."""
        found = []
        for number, tone in enumerate(self.surroundings.tones):
            if tone.order is None:
                advance = 2 * np.pi * (tone.frequency_hz or 0.0) * self.tail.dt
            elif self.tail.turn is not None and not float(tone.order).is_integer():
                advance = 2 * np.pi * tone.order / self.tail.turn
            else:
                continue
            found.append((number, advance, np.sqrt(2) * tone.level_m_per_s2 * (advance < np.pi)))
        numbers, advances, levels = zip(*found, strict=True) if found else ((), (), ())
        return list(numbers), np.array(advances, dtype=np.float64), np.array(levels, dtype=np.float64)

    @cached_property
    def _waves(self) -> tuple[list[int], FloatArray]:
        """Numbers of the other tones, and their cosines and then their sines over a turn with their levels."""
        numbers = sorted(set(range(len(self._tones))) - set(self._steady[0]))
        waves = [self._wave(self.surroundings.tones[number]) for number in numbers]
        return numbers, np.array([wave.real for wave in waves] + [wave.imag for wave in waves])

    def _wave(self, tone: Tone) -> ComplexArray:
        order, once = tone.order or 0.0, self.tail.once
        return np.asarray(np.sqrt(2) * tone.level_m_per_s2 * once.resolved(order) * once.wave(order))

    @cached_property
    def _lines(self) -> tuple[int, slice, FloatArray, FloatArray]:
        """Length of the transform, its lines in the band, their rms, and one draw (2, 2 n + 1, lines) for all.

        The draw has real and imaginary parts with a mean square of 1.
        """
        from scipy.fft import next_fast_len  # slow to import

        length = next_fast_len(round((self.tail.seconds + PERIOD_MARGIN_S) / self.tail.dt), real=True)
        resolution = 1 / (length * self.tail.dt)
        first, end = int(np.ceil(BAND_HZ[0] / resolution)), int(BAND_HZ[1] / resolution) + 1
        power = np.arange(first, end, dtype=np.float64) ** -self.surroundings.background_slope
        rms = self.surroundings.background_m_per_s2 * np.sqrt(power / power.sum())
        drawn = self._background.standard_normal((2, 2 * HIGHEST_CIRCUMFERENTIAL + 1, power.size))
        lines = slice(first, min(end, (length + 1) // 2))  # the steps show no higher ones
        shown = lines.stop - lines.start
        return length, lines, rms[:shown], drawn[..., :shown]

    def _broadband(self, weights: FloatArray) -> FloatArray:
        """Return the background with its level (steps,) where its parts have these weights (2 n + 1,).

        A line of rms r is r sqrt(2) Re(z exp(i w t)), |z| = 1 in the mean.
        """
        from scipy.fft import irfft  # slow to import

        length, lines, rms, drawn = self._lines
        steady, steps = self.tail.turn is not None, self.tail.angle.size
        scale = length / 2 * (self._level[-1] if steady else 1.0)
        spectrum = np.zeros(length // 2 + 1, dtype=np.complex128)
        real, imaginary = weights @ drawn
        spectrum.real[lines], spectrum.imag[lines] = scale * rms * real, scale * rms * imaginary
        signal = irfft(spectrum, length)
        signal = signal[length - steps :] if steps <= length else signal[np.arange(-steps, 0) % length]
        return np.asarray(signal if steady else self._level * signal)

    def _blade_passing(self, around: float) -> FloatArray:
        """Return the blade passing (steps of a turn,) at the polar angle `around` in rad."""
        once = self.tail.once
        order = np.arange(1, BLADE_PASSING_HARMONICS + 1)
        shares = np.sqrt(2) / order / np.sqrt(np.sum(1 / order**2))
        waves = (
            share * (np.exp(1j * (psi - n * around)) * once.wave(n)).real * once.resolved(n)
            for n, share, psi in zip(map(float, order * self.tail.blades), shares, self._passing, strict=True)
        )
        return np.asarray(self.surroundings.blade_passing_m_per_s2 * sum(waves))

    def _under_a_probe(self, tap: CentreDisplacement) -> FloatArray:
        """Return runout at phi - theta, amplitudes falling as 1/order, and the slow drift along one direction."""
        around = np.deg2rad(tap.angle_deg)
        orders = np.arange(1, RUNOUT_ORDERS + 1)
        profile = sum(
            (np.exp(1j * (phase - m * around)) * self.tail.once.wave(m)).real / m
            for m, phase in zip(map(float, orders), self._runout, strict=True)
        )
        share = 1 + self.tail.time / self.tail.seconds
        drift = self.surroundings.shaft_drift_m * np.cos(around - self._drift) * share
        return np.asarray(self.tail.everywhere(self.surroundings.runout_m * np.asarray(profile)) + drift)


def _tone_field(rng: np.random.Generator) -> ComplexArray:
    """Draw the parts of a tone (2 n + 1,), scaled to a mean square of 1 over the circumference."""
    parts = _complex_normal(rng, (2 * HIGHEST_CIRCUMFERENTIAL + 1,))
    square = np.abs(parts) ** 2
    mean = (square[0] + square[1:].sum() / 2) / (HIGHEST_CIRCUMFERENTIAL + 1)
    return np.asarray(parts / np.sqrt(mean))


def _complex_normal(rng: np.random.Generator, shape: tuple[int, ...]) -> ComplexArray:
    """Draw complex normal numbers with a mean square of 1."""
    return np.asarray((rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2))


def _elastic(around: float) -> FloatArray:
    """Return the weights (2 n + 1,) of a field's parts at a polar angle of the casing, in rad; mean square 1."""
    n = np.arange(1, HIGHEST_CIRCUMFERENTIAL + 1)
    parts = [[1.0], np.cos(n * around), np.sin(n * around)]
    return np.asarray(np.concatenate(parts) / np.sqrt(HIGHEST_CIRCUMFERENTIAL + 1))


def _rigid(along: float) -> FloatArray:
    """Return the weights (2 n + 1,) of a field's parts in the motion of one body along a direction, in rad.

    Only order 1 counts.
    """
    weights = np.zeros(2 * HIGHEST_CIRCUMFERENTIAL + 1)
    weights[1], weights[1 + HIGHEST_CIRCUMFERENTIAL] = np.cos(along), np.sin(along)
    return weights
