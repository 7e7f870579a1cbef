"""All channels of one run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.scenario import Sensing
from rubgen.scenario.feasible import STEPS_PER_SAMPLE
from rubgen.sensors.chain import adc_step, band_limit, digitise, half_width_seconds
from rubgen.sensors.channel import Channel, Recording
from rubgen.sensors.once_per_rev import arrival_times, pulse_channel
from rubgen.sensors.probes import PROBES, Probe
from rubgen.solver.response import Response


def measure(response: Response, sensing: Sensing, *, seconds: float, rng: np.random.Generator) -> Recording:
    """The channels of a run over `seconds` (> 0) at the end of its record, at `sensing.sample_rate_hz`.

    The last sample stands half a filter length before the end of the tail, so that no sample sees an edge. The step
    after the tail's last one would have theta = 0 mod 2 pi. Each channel has its own child of `rng`, in the fixed order
    of PROBES: its noise depends on nothing but the state of `rng` and its own length.

    Raises UserError where the tail is too short for `seconds` and the filter, or the step rate is below 2.56 sample
    rates.
    """
    positions = sample_positions(response, sensing, seconds)
    signals = np.stack([response.taps[probe.tap] for probe in PROBES], axis=1)
    clean = band_limit(signals, positions, dt=response.dt, sample_rate_hz=sensing.sample_rate_hz)
    children = rng.spawn(len(PROBES))
    channels = {p.name: _channel(p, clean[:, i], sensing, children[i]) for i, p in enumerate(PROBES)}
    angle = _blisk_angle(response, positions)
    pulses = pulse_channel(angle)
    channels[pulses.name] = replace(pulses, clean=pulses.values) if sensing.keep_clean else pulses
    return Recording(
        sample_rate_hz=sensing.sample_rate_hz,
        rotation_angle=float(angle[0]),
        channels=channels,
        once_per_rev=arrival_times(
            float(angle[0]), 2 * np.pi / response.turn_seconds, positions.size / sensing.sample_rate_hz
        ),
    )


def sample_positions(response: Response, sensing: Sensing, seconds: float) -> FloatArray:
    """Times of the samples, counted in steps from the start of the tail; round(seconds * sample rate) of them."""
    dt, rate = response.dt, sensing.sample_rate_hz
    if dt * rate * STEPS_PER_SAMPLE > 1 + 1e-9:
        highest = 1 / dt / STEPS_PER_SAMPLE
        raise UserError(
            f"sample_rate_hz = {rate:g}: at most {highest:.6g} Hz with {1 / dt:.6g} steps a second; "
            "lower sample_rate_hz or raise steps_per_turn"
        )
    tail = _tail_steps(response)
    half_width = half_width_seconds(rate) / dt
    count = round(seconds * rate)
    positions = (tail - 1 - half_width) - np.arange(count - 1, -1, -1) / (rate * dt)
    if count < 1 or np.floor(positions[0]) - np.ceil(half_width) + 1 < 0:
        longest = max((tail - 1 - 2 * half_width) * dt, 0.0)
        raise UserError(
            f"signal_seconds = {seconds:g}: must be at least one sample and at most {longest:.6g} s for this record; "
            "shorten signal_seconds or raise record_turns"
        )
    return np.asarray(positions, dtype=np.float64)


def first_sample_seconds(response: Response, recording: Recording) -> float:
    """Time of the recording's first sample, in s; step s of the record stands at s dt, its first at theta = 0."""
    rate = recording.sample_rate_hz
    last_step = (response.record_turns * response.steps_per_turn - 1) * response.dt
    return last_step - half_width_seconds(rate) - (recording.samples - 1) / rate


def _tail_steps(response: Response) -> int:
    return next(iter(response.taps.values())).size


def _blisk_angle(response: Response, positions: FloatArray) -> FloatArray:
    angle = np.mod((positions - _tail_steps(response)) * (2 * np.pi / response.steps_per_turn), 2 * np.pi)
    return np.where(angle < 2 * np.pi, angle, 0.0)


def _channel(probe: Probe, clean: FloatArray, sensing: Sensing, rng: np.random.Generator) -> Channel:
    noise_rms = sensing.noise * probe.noise_rms
    noisy = clean + noise_rms * rng.standard_normal(clean.size)
    limits = {"range_min": probe.range_min, "range_max": probe.range_max}
    return Channel(
        name=probe.name,
        unit=probe.unit,
        quantity=probe.quantity,
        axis=probe.axis,
        location=probe.location,
        **limits,
        resolution=adc_step(**limits, bits=sensing.adc_bits),
        noise_rms=noise_rms,
        values=digitise(noisy, **limits, bits=sensing.adc_bits).astype(np.float32),
        clean=clean.astype(np.float32) if sensing.keep_clean else None,
    )
