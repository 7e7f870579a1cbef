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
    return {name: tap_orders(tap, response) for name, tap in with_casing_fields(response.taps).items()}


def with_casing_fields(taps: dict[str, Array]) -> dict[str, Array]:
    """Return `taps` with the even and the odd part of the casing's acceleration, (a(0) +- a(pi)) / 2.

    Without an acceleration at 180 degrees `taps` is returned unchanged.
    """
    if OPPOSITE_TAP not in taps:
        return taps
    first, second = taps[MARKED_TAP], taps[OPPOSITE_TAP]
    return taps | {"casing_even": (first + second) / 2, "casing_odd": (first - second) / 2}


def tap_orders(tap: FloatArray, response: Response) -> TapOrders:
    """Compute the orders of one tap. Raises ValueError as `order_lines` does.

    `tap` (steps,) has a value at every time step of the record or of its end.
    """
    turns = spectrum_turns(response)
    looked_at = turns * (max(HIGHEST_ORDER, response.n_blades + SIDEBANDS) + 1)
    lines = order_lines(tap, response)[:looked_at]
    whole = _at_orders(lines, turns * np.arange(1, HIGHEST_ORDER + 1))
    blades = np.arange(response.n_blades - SIDEBANDS, response.n_blades + SIDEBANDS + 1)
    return TapOrders(
        amplitudes=np.abs(whole),
        phases=np.where(whole == 0, 0.0, np.angle(whole)),
        floors=order_floors(np.abs(lines), turns),
        fractional=fractional_amplitudes(tap, response),
        blade_passing=np.abs(_at_orders(lines, turns * blades)),
    )


def _at_orders(lines: ComplexArray, places: IntArray) -> ComplexArray:
    """Return the lines at these places; NaN where there is none."""
    found = np.full(places.size, np.nan, dtype=np.complex128)
    inside = (places >= 0) & (places < lines.size)
    found[inside] = lines[places[inside]]
    return found


def spectrum_turns(response: Response) -> int:
    """Return the number of turns that a spectrum covers: 100, or all turns of a shorter record."""
    return min(SPECTRUM_TURNS, response.record_turns)


def order_lines(tap: FloatArray, response: Response) -> ComplexArray:
    """Compute peak amplitudes and phases of a tap (steps,): complex A e^(i phase) of A cos(k theta + phase).

    Line j (n // 2 + 1,) is at order j / turns: 2 X_j / n, with X the DFT of the last n = turns * steps_per_turn values,
    and `turns` from `spectrum_turns`. The unit is the tap's. Line 0 is twice the mean. The record ends with a complete
    turn, so at a constant speed the first of the n values is at theta = 0. Raises ValueError where the tap has fewer
    than n values.
    """
    count = spectrum_turns(response) * response.steps_per_turn
    if tap.size < count:
        raise ValueError(f"a tap of {tap.size} steps is shorter than the {count} steps that the orders need")
    return np.asarray(2 / count * rfft(tap[-count:]))


def order_spectrum(tap: FloatArray, response: Response) -> FloatArray:
    """Return the peak amplitudes (n // 2 + 1,) of the lines of `order_lines`, in the tap's unit.

    Raises ValueError as `order_lines` does.
    """
    return np.asarray(np.abs(order_lines(tap, response)), dtype=np.float64)


def order_floors(spectrum: FloatArray, turns: int) -> FloatArray:
    """Return the median amplitude (20,) of the lines around each order k = 1 .. 20; 0 where there are no lines.

    The lines around k are within half an order of k, without the lines within 0.05 of k. `spectrum` has `turns` lines
    per order.
    """
    near, half = turns // 20, turns // 2
    beside = np.concatenate([np.arange(-half, -near), np.arange(near + 1, half + 1)])
    if beside.size == 0:
        return np.zeros(HIGHEST_ORDER)
    lines = turns * np.arange(1, HIGHEST_ORDER + 1)[:, None] + beside
    if lines.max() < spectrum.size:
        return np.asarray(np.median(spectrum[lines], axis=1), dtype=np.float64)
    around = (spectrum[row[row < spectrum.size]] for row in lines)  # few steps a turn: some lie beyond the spectrum
    return np.array([float(np.median(row)) if row.size else 0.0 for row in around])


def fractional_amplitudes(tap: FloatArray, response: Response) -> FloatArray:
    """Compute peak amplitudes (9,) at FRACTIONS of f_r over the last 96 turns (or the largest multiple of 12 below).

    Twelve turns are a whole number of periods of each fraction. The tap is therefore averaged over its sections of
    twelve turns, which removes other orders and noise. All values are NaN for a record of fewer than 12 turns.
    """
    folds = spectrum_turns(response) // FOLDED_TURNS
    length = FOLDED_TURNS * response.steps_per_turn
    if folds == 0:
        return np.full(len(FRACTIONS), np.nan)
    folded = tap[-folds * length :].reshape(folds, length).mean(axis=0)
    size = 2 / length * np.abs(rfft(folded))
    places = [int(FOLDED_TURNS * fraction) for fraction in FRACTIONS]
    return np.asarray(size[places], dtype=np.float64)


def _share(amplitudes: FloatArray, part: FloatArray) -> float:
    total = float(np.sum(amplitudes**2))
    return float(np.sum(part**2)) / total if total > 0 else float("nan")
