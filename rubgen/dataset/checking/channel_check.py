"""Checks of labels against labels of windows, and against the recorded channels as far as their errors allow.

A row has the parameters and labels of one run with status ok, by the column names of `runs.parquet`, and the labels of
its windows. Classes are words.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.labels.harmonics import SPECTRUM_TURNS
from rubgen.measurement.chain import PASS_BAND_SHARE
from rubgen.measurement.channel import Float32Array
from rubgen.solver.response import WINDOW_TURNS

Row = dict[str, Any]
LEAST_TURNS = 2
"""Least number of whole turns: fewer allow no weights without orders, and nothing is checked."""
SIGMAS = 6.5
"""A Gaussian number lies beyond it once in 1e10 times."""
STOP_BAND = 10 ** (-85 / 20)
"""Gain of the anti-alias filter beyond half the sample rate (`measurement/chain.py`)."""
ROUNDING = 1e-9
"""Tolerance as a share of the label: the sums have another order."""
COMPARED_ORDERS = 10
"""Largest number of compared orders; they are within the anti-alias filter's pass band."""
NOISE_PEAK = 6.5
"""Gaussian noise of 1e6 samples stays below 6.5 times its rms."""
ORDER_TOLERANCE = 0.01
"""Tolerance as a share of the largest amplitude."""


def windows_fit(row: Row) -> bool:
    """Return whether the run's impulse per turn is the mean over the windows of its record, weighted by their turns.

    `row` has the values of the run by column name. The result is False for a wrong number of windows.
    """
    turns, values = _window_turns(row), row["window_impulse_per_turn_n_s"]
    if len(values) != turns.size:
        return False
    mean = float(turns @ np.asarray(values)) / row["record_turns"]
    return math.isclose(mean, row["contact_impulse_per_turn_n_s"], rel_tol=ROUNDING, abs_tol=ROUNDING)


def duty_fits(row: Row) -> bool:
    """Return whether the run's contact duty is the mean over the windows of its record, weighted by their turns.

    `row` has the values of the run by column name. The result is always True for a run with a changing speed: its turns
    have unequal length, and nothing is compared. Else it is False for a wrong number of windows.
    """
    turns, values = _window_turns(row), row["window_contact_duty"]
    if row["change_times_s"] or len(values) != turns.size:
        return bool(row["change_times_s"])
    mean = float(turns @ np.asarray(values)) / row["record_turns"]
    return math.isclose(mean, row["contact_duty"], rel_tol=ROUNDING, abs_tol=ROUNDING)


def window_times_fit(row: Row) -> bool:
    """Return whether the windows begin after whole turns, WINDOW_TURNS apart, and have the run's speed.

    `row` has the values of the run by column name. The result is always True for a changing speed. Else it is False for
    a wrong number of windows.
    """
    if row["change_times_s"]:
        return True
    starts = np.arange(0, row["record_turns"], WINDOW_TURNS) * 60 / row["speed_rpm"]
    if not len(row["window_starts_s"]) == len(row["window_speeds_rpm"]) == starts.size:
        return False
    speeds = np.full(starts.size, row["speed_rpm"])
    pairs = (row["window_starts_s"], starts), (row["window_speeds_rpm"], speeds)
    return all(np.allclose(values, exact, rtol=ROUNDING, atol=ROUNDING) for values, exact in pairs)


def exponents_fit(row: Row) -> bool:
    """Return whether the Lyapunov exponents in 1/s and in 1/turn agree.

    `row` has the values of the run by column name. The result is True for a changing speed, or without exponents. It is
    False where only one of the two exponents is known.
    """
    by_turn, by_second = row["lyapunov_per_turn"], row["lyapunov_per_second"]
    if row["change_times_s"] or (by_turn is None and by_second is None):
        return True
    known = by_turn is not None and by_second is not None
    return known and math.isclose(by_turn * row["speed_rpm"] / 60, by_second, rel_tol=ROUNDING, abs_tol=ROUNDING)


def impulse_problems(row: Row, force: Float32Array, noise_rms: float, step: float) -> Iterator[str]:
    """Compare the impulse label of a period-1 run in contact with its force channel. Yields a sentence if they differ.

    The channel's impulse per turn is its mean over whole turns times the time of a turn. The label is the mean over the
    whole record. It is first scaled to the windows that the channel covers, and the two may then differ by
    `resolved_impulse`. Nothing is compared where fewer than LEAST_TURNS turns are recorded, or where the label
    contradicts the run's windows.

    - row: of a period-1 run in contact at a steady speed; this is not checked.
    - force (samples,): the channel in N, of a sensor without errors besides noise, range and ADC (`is_faultless`).
    - noise_rms, step: noise and ADC step in N.
    """
    weights = whole_turn_weights(force.size, samples_per_turn(row))
    if weights is None or not windows_fit(row):
        return
    impulse = float(weights @ force.astype(np.float64)) * 60 / row["speed_rpm"]
    label = row["contact_impulse_per_turn_n_s"] * _share_of_covered_windows(row, weights)
    if abs(impulse - label) > resolved_impulse(row, weights, noise_rms, step):
        yield f"contact_impulse_per_turn_n_s is {label:.4g}, the channel gives {impulse:.4g}"


def samples_per_turn(row: Row) -> float:
    """Return the number of samples in one turn, which is rarely whole. `row` has sample rate and speed of the run."""
    return float(row["sample_rate_hz"] * 60 / row["speed_rpm"])


def whole_turn_weights(samples: int, turn: float) -> FloatArray | None:
    """Return weights (samples,) for a mean over whole turns that contains no part of any order k >= 1.

    `turn` is the number of samples in one turn. The weights add up to 1 and cover all m whole turns. They are a boxcar
    of one turn convolved with a boxcar of m - 1 turns, which removes every order wherever the samples lie in the turn.
    A plain mean would include up to half a sample at its edge, where a blade may touch. Returns None below LEAST_TURNS
    turns.
    """
    turns = math.floor(samples / turn)
    if turns < LEAST_TURNS:
        return None
    middle = (samples - 1) / 2
    from_edge = turns * turn / 2 - np.abs(np.arange(samples) - middle)
    weights = np.clip(from_edge / turn, 0.0, 1.0)
    return np.asarray(weights / weights.sum(), dtype=np.float64)


def resolved_impulse(row: Row, weights: FloatArray, noise_rms: float, step: float) -> float:
    """Return the smallest difference of impulse per turn, in N s, that the channel can show.

    Four errors are known, for m recorded turns. The result is SIGMAS times the root of the sum of squares of noise and
    unequal turns, plus the ADC's bias, plus the error of sampling. `weights` are from `whole_turn_weights`; `noise_rms`
    and `step` are noise and ADC step in N.

    - Noise of rms s and ADC steps d: the weighted mean has the standard error sqrt((s^2 + d^2 / 12) sum w^2).
    - The ADC's bias where noise does not dither it. The mean error of a rounded Gaussian is the series (d / pi) sum_k
      (+-1 / k) q^(k^2) sin(2 pi k x / d), q = exp(-2 (pi s / d)^2) (Widrow, Kollar: Quantization Noise): at most -(d /
      pi) ln(1 - q), and never more than d / 2.
    - Sampling: a force that only pushes has orders of at most twice its mean F. With N samples a turn, orders below
      half the rate alias into the mean by 4 F / (pi^2 N (m - 1)), because the weights' spectrum falls as 1 / (pi^2 f^2
      (m - 1)) with f in orders. Higher orders come back through the filter's stop band, by one image for each sample
      period that the steps resolve: 2 F STOP_BAND a step in a sample.
    - Unequal turns: the scatter of the windows of the record's second half, which decide period-1. A window is a mean
      over WINDOW_TURNS turns. The result is the standard error of a mean over the recorded turns.
    """
    turn_seconds, turn = 60 / row["speed_rpm"], samples_per_turn(row)
    turns = math.floor(weights.size / turn)
    error = math.sqrt((noise_rms**2 + step**2 / 12) * float(weights @ weights)) * turn_seconds
    aliases = 4 / (math.pi**2 * turn * (turns - 1)) + 2 * STOP_BAND * row["steps_per_turn"] / turn
    known = _adc_bias(noise_rms, step) * turn_seconds + aliases * row["contact_impulse_per_turn_n_s"]
    return float(SIGMAS * math.hypot(error, _scatter_of_turns(row, turns)) + known)


def _adc_bias(noise_rms: float, step: float) -> float:
    """Return the largest mean error of an ADC, in its unit."""
    q = math.exp(-2 * (math.pi * noise_rms / step) ** 2)
    return float(min(step / 2, -step / math.pi * math.log1p(-q))) if q < 1 else step / 2


def _scatter_of_turns(row: Row, turns: int) -> float:
    """Return the standard error of the mean impulse over `turns` turns, from the scatter of the record's windows."""
    whole = np.asarray(row["window_impulse_per_turn_n_s"])[: row["record_turns"] // WINDOW_TURNS]
    late = whole[whole.size // 2 :]
    return float(np.std(late, ddof=1) * math.sqrt(WINDOW_TURNS / turns)) if late.size > 1 else 0.0


def _share_of_covered_windows(row: Row, weights: FloatArray) -> float:
    """Return the mean impulse of the windows that the channel covers over that of all windows.

    They differ where the record begins with a transient.
    """
    times = row["signal_start_s"] + np.arange(weights.size) / row["sample_rate_hz"]
    number = np.searchsorted(np.asarray(row["window_starts_s"]), times, side="right") - 1
    values = np.asarray(row["window_impulse_per_turn_n_s"])
    everything = float(_window_turns(row) @ values / row["record_turns"])
    return float(weights @ values[np.maximum(number, 0)]) / everything


def _window_turns(row: Row) -> FloatArray:
    """Return the number of turns of each window: WINDOW_TURNS, and the rest for the last."""
    starts = np.arange(0, row["record_turns"], WINDOW_TURNS)
    return np.asarray(np.minimum(WINDOW_TURNS, row["record_turns"] - starts), dtype=np.float64)


def order_problems(row: Row, tap: str, values: Float32Array, noise_rms: float, step: float) -> Iterator[str]:
    """Compare the labels of a true signal, its amplitudes at orders 1 to 10, with the amplitudes of its channel.

    The label covers the last SPECTRUM_TURNS turns of the record, or all turns if there are fewer. Nothing is compared
    where the channel has fewer turns than the label. Orders above the pass band of the anti-alias filter are not
    compared.

    Amplitudes may differ by the sum of three bounds: the effect of noise and ADC, ORDER_TOLERANCE of the largest
    amplitude of the label, and the effect of the end of the record. The channel ends half an anti-alias filter before
    the record. Yields one sentence, about the order with the largest excess, if an amplitude differs by more.

    - row: of a run at a steady speed; this is not checked.
    - tap: name of the true signal, such as casing_acc_0.
    - values (samples,): the channel in SI units, of a sensor without errors besides noise, range and ADC
      (`is_faultless`).
    - noise_rms, step: noise and ADC step, in the channel's unit.
    """
    turns = min(SPECTRUM_TURNS, row["record_turns"])
    turns_per_sample = row["speed_rpm"] / 60 / row["sample_rate_hz"]
    samples = round(turns / turns_per_sample)
    if values.size < samples:
        return
    amplitudes = order_amplitudes(values[-samples:], turns_per_sample)
    labels = np.asarray(row[f"{tap}_orders"][:COMPARED_ORDERS])
    passed = np.arange(1, COMPARED_ORDERS + 1) * turns_per_sample <= PASS_BAND_SHARE / 2
    error = np.abs(amplitudes - labels) - ORDER_TOLERANCE * labels.max() - _spectral_floor(noise_rms, step, samples)
    error[~passed] = 0
    if error.max() > 0:  # rare
        error -= _of_unseen_end(row, values, samples, turns_per_sample)
    if error.max() > 0:
        k = int(error.argmax())
        yield f"{tap}_orders: order {k + 1} is {labels[k]:.4g}, the channel gives {amplitudes[k]:.4g}"


def order_amplitudes(values: Float32Array, turns_per_sample: float) -> FloatArray:
    """Return peak amplitudes (10,) at k = 1..10 times the rotation frequency: 2/n |sum x exp(-2 pi i k turns)|.

    The mean of `values` is removed before. `turns_per_sample` is the rotation frequency over the sample rate.
    """
    return np.asarray(2 / values.size * np.abs(_turned(values, turns_per_sample).sum(axis=1)))


def _turned(values: Float32Array, turns_per_sample: float) -> ComplexArray:
    """Return the samples times exp(-2 pi i k turns) for k = 1..10 (orders, samples), mean removed."""
    turns = np.arange(values.size) * turns_per_sample
    centred = values.astype(np.float64) - values.mean(dtype=np.float64)
    return np.asarray([np.exp(-2j * np.pi * k * turns) * centred for k in range(1, COMPARED_ORDERS + 1)])


def _of_unseen_end(row: Row, values: Float32Array, samples: int, turns_per_sample: float) -> FloatArray:
    """Bound the difference of each amplitude because the channel ends half a filter before the label's window.

    The label has d samples at its end that the channel has not, and lacks d samples of the channel's beginning. Both
    pieces together change an amplitude by at most twice the amplitude of the largest piece of the recording, for any
    motion. One more sample stands for the fraction of a turn.
    """
    end = row["record_turns"] / turns_per_sample
    last = row["signal_start_s"] * row["sample_rate_hz"] + values.size - 1
    piece = min(math.ceil(max(end - last, 0.0)) + 1, values.size)
    sums = np.cumsum(np.pad(_turned(values, turns_per_sample), ((0, 0), (1, 0))), axis=1)
    return np.asarray(2 * 2 / samples * np.abs(sums[:, piece:] - sums[:, :-piece]).max(axis=1))


def _spectral_floor(noise_rms: float, step: float, samples: int) -> float:
    """Return the largest amplitude of a line from noise and ADC steps. The steps are white where noise dithers them."""
    if noise_rms < step / 2:
        return step
    return NOISE_PEAK * math.sqrt((noise_rms**2 + step**2 / 12) * 2 / samples)
