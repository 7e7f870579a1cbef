"""Label short windows of a record, for users who cut its signals."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray, IntArray
from rubgen.labels.harmonics import with_casing_fields
from rubgen.labels.labels import Motion
from rubgen.solver.response import WINDOW_TURNS, ChangingSpeed, Response


@dataclass(frozen=True, kw_only=True)
class Windows:
    """Labels of the windows of a record. A window has WINDOW_TURNS turns; the last window may be shorter."""

    start: FloatArray
    """Start of each window (windows,), s."""
    speed: FloatArray
    """Mean speed (windows,), rad/s."""
    impulse: FloatArray
    """Impulse a turn (windows,), N s."""
    duty: FloatArray
    """Share of steps with contact (windows,)."""
    motion: tuple[tuple[Motion, float | None], ...] = ()
    """Class of motion of each window, with its confidence: `rubgen.labels.stretches`."""
    orders: dict[str, FloatArray]
    """By tap (windows, 20): |mean over turns of the complex amplitude at k f_r|, k = 1 .. 20. At a steady speed only
    the last windows, which the taps cover."""
    scatter: dict[str, FloatArray]
    """At a changing speed, the standard error of that mean by tap (windows, 20)."""


def window_edges(response: Response) -> IntArray:
    """Return the first turn of each window, and the number of turns at the end (windows + 1,)."""
    return np.append(np.arange(0, response.record_turns, WINDOW_TURNS), response.record_turns)


def windows(response: Response) -> Windows:
    """Label each window of WINDOW_TURNS turns: impulse a turn, share of steps with contact, amplitudes at orders.

    Windows do not overlap, and the last may be shorter. Taps are the true signals of the response, which at a steady
    speed cover only the end of the record. The amplitudes then have rows only for the windows that the taps cover: the
    last ones. The class of motion is left out; `rubgen.labels.stretches` finds it.
    """
    edges, changing = window_edges(response), response.changing_speed
    times = turn_times(response, changing)[edges]
    if changing is None:
        steps = response.steps_per_turn * np.diff(edges)
        orders = dict(zip(response.taps, response.window_orders.transpose(1, 0, 2), strict=False))
        means, scatter = {tap: np.abs(each) for tap, each in with_casing_fields(orders).items()}, {}
    else:
        steps = np.diff(changing.turn_steps[edges])
        parts = [slice(first, last) for first, last in pairwise(edges.tolist())]
        turns = with_casing_fields({tap: changing.orders[:, i] for i, tap in enumerate(response.taps)})
        means = {tap: np.abs([x[part].mean(axis=0) for part in parts]) for tap, x in turns.items()}
        scatter = {tap: np.array([_standard_error(x[part]) for part in parts]) for tap, x in turns.items()}
    return Windows(
        start=times[:-1],
        speed=2 * np.pi * np.diff(edges) / np.diff(times),
        impulse=np.add.reduceat(response.impulse_per_turn, edges[:-1]) / np.diff(edges),
        duty=np.add.reduceat(response.contact_steps_per_turn, edges[:-1]) / steps,
        orders=means,
        scatter=scatter,
    )


def turn_times(response: Response, changing: ChangingSpeed | None) -> FloatArray:
    """Return the start of each turn of the record, and last the end of the record (record_turns + 1,), in s.

    Times count from the start of the record. `changing` is the course of a changing speed; None is a steady speed.
    """
    turns = range(response.record_turns + 1)
    if changing is None:
        return np.asarray(response.turn_seconds * np.array(turns))
    return np.array([changing.rotation.time_of(2 * np.pi * turn) for turn in turns])


def _standard_error(amplitudes: ComplexArray) -> FloatArray:
    """Return the standard error of the mean over turns (turns, ...), from differences of successive turns.

    A slow drift is small in them.
    """
    if len(amplitudes) < 2:
        return np.asarray(np.abs(amplitudes[0]), dtype=np.float64)
    return np.asarray(np.sqrt(np.mean(np.abs(np.diff(amplitudes, axis=0)) ** 2, axis=0) / 2 / len(amplitudes)))
