"""Compute amplitudes and phases of taps, the true signals, at multiples of the rotation frequency f_r."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeVar

import numpy as np
from scipy.fft import rfft

from rubgen.arrays import ComplexArray, FloatArray, IntArray
from rubgen.solver.response import Response

Array = TypeVar("Array", FloatArray, ComplexArray)
HIGHEST_ORDER = 20
SPECTRUM_TURNS = 100
FRACTIONS = tuple(Fraction(text) for text in ("1/4", "1/3", "1/2", "2/3", "3/4", "4/3", "3/2", "5/3", "5/2"))
"""Orders of motions that repeat after 2, 3 or 4 turns."""
FOLDED_TURNS = 12
"""A common multiple of their denominators."""
SIDEBANDS = 2
"""Whole orders on either side of the blade passing frequency."""
MARKED_TAP, OPPOSITE_TAP = "casing_acc_0", "casing_acc_180"
RATIO = 10.0
"""20 dB above the median of the neighbourhood."""
FLOOR = 0.1
"""Least amplitude, in m/s2: 20 dB above a line of a sensor's noise of 1 m/s2 over 1 s."""
TOGETHER = 4
"""Taps that are transformed together: twice as fast as one by one, and still in the nearest caches."""


@dataclass(frozen=True, kw_only=True)
class TapOrders:
    """Peak amplitudes of one true signal at its orders, in the signal's unit, and phases in rad.

    Orders above half the step rate are NaN: the steps cannot show them.
    """

    amplitudes: FloatArray
    """A (20,) at k f_r, k = 1 .. 20, in A cos(k theta + phase)."""
    phases: FloatArray
    """Phase (20,) at k f_r."""
    floors: FloatArray
    """Median of the lines around each order k (20,)."""
    fractional: FloatArray
    """Amplitudes (9,) at FRACTIONS of f_r."""
    blade_passing: FloatArray
    """Amplitudes (5,) at the orders n_blades - 2 .. n_blades + 2."""

    @property
    def even_share(self) -> float:
        """Share of the sum of squared amplitudes that is on even orders; NaN where the sum is zero or one is NaN."""
        return _share(self.amplitudes, self.amplitudes[1::2])

    @property
    def odd_share(self) -> float:
        """Share of the sum of squared amplitudes that is on odd orders; NaN where the sum is zero or one is NaN."""
        return _share(self.amplitudes, self.amplitudes[0::2])

    @property
    def dominant(self) -> int:
        """The order k of the largest amplitude; 0 where the sum of squared amplitudes is zero, as below 1e-162."""
        return int(np.nanargmax(self.amplitudes)) + 1 if np.nansum(self.amplitudes**2) > 0 else 0

    @property
    def present(self) -> tuple[int, ...]:
        """The orders k that stand out: above FLOOR, and at least 20 dB above the median of the lines around k."""
        stands = (self.amplitudes > FLOOR) & (self.amplitudes >= RATIO * self.floors)
        return tuple((np.flatnonzero(stands) + 1).tolist())


def harmonics(response: Response) -> dict[str, TapOrders]:
    """Compute the orders of every tap (true signal) over the last 100 turns, or over all turns of a shorter record.

    The keys of the result are the names of the taps, which have a value at every time step. If the casing's
    accelerations a at 0 and 180 degrees were both recorded, the result also has `casing_even` and `casing_odd`. They
    are the parts of a(0) with even and with odd circumferential order, (a(0) +- a(pi)) / 2.
    """
    taps = with_casing_fields(response.taps)
    names, found = list(taps), dict[str, TapOrders]()
    for some in (names[first : first + TOGETHER] for first in range(0, len(names), TOGETHER)):
        found |= zip(some, _orders(_spectrum_part([taps[name] for name in some], response), response), strict=True)
    return found


def with_casing_fields(taps: dict[str, Array]) -> dict[str, Array]:
    """Return `taps` with the even and the odd part of the casing's acceleration, (a(0) +- a(pi)) / 2.

    They are called `casing_even` and `casing_odd`. Without an acceleration at 180 degrees `taps` is returned unchanged.
    """
    if OPPOSITE_TAP not in taps:
        return taps
    first, second = taps[MARKED_TAP], taps[OPPOSITE_TAP]
    return taps | {"casing_even": (first + second) / 2, "casing_odd": (first - second) / 2}


def _spectrum_part(taps: list[FloatArray], response: Response) -> FloatArray:
    """Return the values (taps, steps) that a spectrum covers: the turns of `spectrum_turns` at the end of each tap.

    Raises ValueError for a tap that is shorter.
    """
    count = spectrum_turns(response) * response.steps_per_turn
    for tap in taps:
        if tap.size < count:
            raise ValueError(f"a tap of {tap.size} steps is shorter than the {count} steps that the orders need")
    return np.stack([tap[-count:] for tap in taps])


def _orders(taps: FloatArray, response: Response) -> list[TapOrders]:
    """Compute the orders of each of the taps (taps, steps), which are the turns of a spectrum."""
    turns, steps = spectrum_turns(response), response.steps_per_turn
    looked_at = turns * (max(HIGHEST_ORDER, response.n_blades + SIDEBANDS) + 1)
    lines = spectrum_lines(taps, turns)[:, :looked_at]
    whole = _at_orders(lines, turns * np.arange(1, HIGHEST_ORDER + 1))
    blades = np.arange(response.n_blades - SIDEBANDS, response.n_blades + SIDEBANDS + 1)
    columns = (
        np.abs(whole),
        np.where(whole == 0, 0.0, np.angle(whole)),
        order_floors(np.abs(lines), turns),
        fractional_amplitudes(taps, steps),
        np.abs(_at_orders(lines, turns * blades)),
    )
    names = ("amplitudes", "phases", "floors", "fractional", "blade_passing")
    return [TapOrders(**dict(zip(names, row, strict=True))) for row in zip(*columns, strict=True)]


def _at_orders(lines: ComplexArray, places: IntArray) -> ComplexArray:
    """Return the lines of each row at these places (rows, places); NaN where there is none."""
    found = np.full((len(lines), places.size), np.nan, dtype=np.complex128)
    inside = (places >= 0) & (places < lines.shape[1])
    found[:, inside] = lines[:, places[inside]]
    return found


def spectrum_turns(response: Response) -> int:
    """Return the number of turns that a spectrum covers: 100, or all turns of a shorter record."""
    return min(SPECTRUM_TURNS, response.record_turns)


def spectrum_lines(taps: FloatArray, turns: int) -> ComplexArray:
    """Compute peak amplitudes and phases of taps (taps, n): complex A e^(i phase) of A cos(k theta + phase).

    The n values are `turns` whole turns, the first at theta = 0. Line j (taps, n // 2 + 1) is at order j / turns: 2 X_j
    / n, with X the DFT. The unit is that of the taps. Line 0 is twice the mean. Taps that repeat exactly after one turn
    have lines at whole orders alone: those of the turn, and 0 between them.
    """
    count = taps.shape[1]
    steps = count // turns
    again = (taps[:, steps:] == taps[:, :-steps]).all(axis=1)
    if again.all():
        lines = np.zeros((len(taps), count // 2 + 1), dtype=np.complex128)
    else:
        lines = np.asarray(2 / count * rfft(taps, axis=1))
        lines[again] = 0.0
    lines[again, ::turns] = 2 / steps * rfft(taps[again, :steps], axis=1)
    return lines


def order_spectrum(tap: FloatArray, response: Response) -> FloatArray:
    """Return the peak amplitudes (n // 2 + 1,) of a tap (steps,) from `spectrum_lines`, in the tap's unit.

    The n values are the last ones, of `spectrum_turns` turns. Raises ValueError where the tap has fewer.
    """
    lines = spectrum_lines(_spectrum_part([tap], response), spectrum_turns(response))
    return np.asarray(np.abs(lines[0]), dtype=np.float64)


def order_floors(spectra: FloatArray, turns: int) -> FloatArray:
    """Return the median amplitude (taps, 20) of the lines around each order k = 1 .. 20; 0 where there are no lines.

    The lines around k are within half an order of k, without the lines within 0.05 of k. The rows of `spectra` have
    `turns` lines per order.
    """
    near, half = turns // 20, turns // 2
    beside = np.concatenate([np.arange(-half, -near), np.arange(near + 1, half + 1)])
    floors = np.zeros((len(spectra), HIGHEST_ORDER))
    if beside.size == 0:
        return floors
    lines = turns * np.arange(1, HIGHEST_ORDER + 1)[:, None] + beside
    if lines.max() < spectra.shape[1]:
        return np.asarray(np.median(spectra[:, lines], axis=2), dtype=np.float64)
    for order, row in enumerate(lines):  # few steps a turn: some lie beyond the spectrum
        there = row[row < spectra.shape[1]]
        if there.size:
            floors[:, order] = np.median(spectra[:, there], axis=1)
    return floors


def fractional_amplitudes(taps: FloatArray, steps: int) -> FloatArray:
    """Compute peak amplitudes (taps, 9) at FRACTIONS of f_r over the last 12, 24, ... turns, as many as there are.

    Twelve turns are a whole number of periods of each fraction. Each tap is therefore averaged over its sections of
    twelve turns, which reduces noise and all orders that are no multiple of 1/12. All values are NaN for taps of fewer
    than 12 turns.

    - taps (taps, any): the values of whole turns.
    - steps: number of steps of a turn.
    """
    length = FOLDED_TURNS * steps
    folds = taps.shape[1] // length
    if folds == 0:
        return np.full((len(taps), len(FRACTIONS)), np.nan)
    folded = taps[:, -folds * length :].reshape(len(taps), folds, length).mean(axis=1)
    size = 2 / length * np.abs(rfft(folded, axis=1))
    places = [int(FOLDED_TURNS * fraction) for fraction in FRACTIONS]
    return np.asarray(size[:, places], dtype=np.float64)


def _share(amplitudes: FloatArray, part: FloatArray) -> float:
    total = float(np.sum(amplitudes**2))
    return float(np.sum(part**2)) / total if total > 0 else float("nan")
