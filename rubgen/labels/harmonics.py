"""Amplitudes of the taps at multiples of the rotation frequency."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.fft import rfft

from rubgen.arrays import FloatArray
from rubgen.solver.response import Response

HIGHEST_ORDER = 10
SPECTRUM_TURNS = 100
SECOND_ORDER_TAP = "casing_acc_0"
SECOND_ORDER_RATIO = 10.0
"""20 dB above the median of the neighbourhood."""
SECOND_ORDER_FLOOR = 0.1
"""Least amplitude of order 2, in m/s2: 20 dB above what the sensor's noise of 1 m/s2 puts into a line over 1 s."""


@dataclass(frozen=True, kw_only=True)
class Harmonics:
    """Peak amplitudes at k f_r, k = 1 .. 10, of each tap, what follows from them, and whether order 2 stands out."""

    amplitudes: dict[str, FloatArray]
    even_share: dict[str, float]
    odd_share: dict[str, float]
    dominant_order: dict[str, int]
    has_2fr: bool


def harmonics(response: Response) -> Harmonics:
    """Orders of every tap over exactly the last 100 turns (all turns of a shorter record), at the step rate."""
    spectra = {name: order_spectrum(tap, response) for name, tap in response.taps.items()}
    turns = spectrum_turns(response)
    amplitudes = {name: s[turns : HIGHEST_ORDER * turns + 1 : turns].copy() for name, s in spectra.items()}
    return Harmonics(
        amplitudes=amplitudes,
        even_share={name: _share(a, a[1::2]) for name, a in amplitudes.items()},
        odd_share={name: _share(a, a[0::2]) for name, a in amplitudes.items()},
        dominant_order={name: int(np.argmax(a)) + 1 if a.any() else 0 for name, a in amplitudes.items()},
        has_2fr=has_second_order(spectra[SECOND_ORDER_TAP], turns),
    )


def spectrum_turns(response: Response) -> int:
    """Number of turns that the spectrum covers: 100, or all of a shorter record."""
    return min(SPECTRUM_TURNS, response.record_turns)


def order_spectrum(tap: FloatArray, response: Response) -> FloatArray:
    """Peak amplitudes of a tap over orders 0, 1/turns, 2/turns, ...: 2 |X| / n of the last n = turns * steps values."""
    count = spectrum_turns(response) * response.steps_per_turn
    if tap.size < count:
        raise ValueError(f"a tap of {tap.size} steps is shorter than the {count} steps that the orders need")
    return np.asarray(2 / count * np.abs(rfft(tap[-count:])), dtype=np.float64)


def has_second_order(spectrum: FloatArray, turns: int) -> bool:
    """Whether order 2 exceeds the floor and, by 20 dB, the median between orders 1.5 and 2.5 without 2 +- 0.05."""
    order = np.arange(spectrum.size) / turns
    distance = np.abs(order - 2)
    around = spectrum[(distance <= 0.5) & (distance > 0.05 + 1e-9)]
    amplitude = spectrum[2 * turns]
    return bool(amplitude > SECOND_ORDER_FLOOR and amplitude >= SECOND_ORDER_RATIO * np.median(around))


def _share(amplitudes: FloatArray, part: FloatArray) -> float:
    """Share of the sum of squares; NaN, undefined, where there is no amplitude at all."""
    total = float(np.sum(amplitudes**2))
    return float(np.sum(part**2)) / total if total > 0 else float("nan")
