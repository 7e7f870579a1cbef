"""Label a run whose speed changes: the whole record, and how rub and motion change over time."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from rubgen.arrays import BoolArray, FloatArray, IntArray
from rubgen.labels.harmonics import FRACTIONS, HIGHEST_ORDER, SIDEBANDS, TapOrders
from rubgen.labels.labels import Motion
from rubgen.labels.motion.classify import Motions
from rubgen.labels.motion.decision import AT_REST, FORCED
from rubgen.labels.motion.drifting import UNDECIDED, drifting_motion
from rubgen.labels.windows import Windows, turn_times, window_edges
from rubgen.solver.response import WINDOW_TURNS, ChangingSpeed, ContactEvents, Response


@dataclass(frozen=True, kw_only=True)
class Change:
    """A change of rub or motion during a record, and the state after it.

    A rub begins with its first touch. It ends with the end of its last touch; touches fewer than WINDOW_TURNS turns
    apart are one rub. All other changes are at the start of a window.
    """

    time: float
    """Time from the start of the record, s."""
    speed: float
    """Spin speed at that time, rad/s."""
    rub: bool
    """Whether there is rub from then on."""
    impulse: float
    """Mean impulse a turn until the next change, N s."""
    blisk: Motion
    """Motion of the blisk from then on."""
    casing: Motion
    """Motion of the casing from then on."""
    motion: Motion
    """The less regular of the two."""


@dataclass(frozen=True, kw_only=True)
class SpeedHistory:
    """The changes of rub and motion in a record whose speed changes."""

    changes: tuple[Change, ...]
    """Changes in order of time; the first is at the start of the record."""
    onset_speed: float | None
    """Speed at the first touch, rad/s; None without touch."""
    end_of_rub_speed: float | None
    """Speed at the end of the last touch, rad/s; None without touch."""


def speed_history(response: Response) -> SpeedHistory:
    """Find every change of rub or motion of a run whose speed changes, and the speeds at which rub begins and ends.

    All speeds are in rad/s, all times in s from the start of the record. The speeds of begin and end are taken at the
    start of the first touch and at the end of the last touch; None without touch. The motion is classified for each
    window by `drifting_motion`; a window where rub begins or ends is divided there. The first entry of `changes` is the
    state at the start of the record.

    Raises ValueError for a response at a steady speed.
    """
    changing = response.changing_speed
    if changing is None:
        raise ValueError("a steady speed has no history")
    touched = response.events.start_step.size > 0
    ends = response.events.start_step + response.events.steps
    return SpeedHistory(
        changes=_changes(response, changing, window_edges(response)),
        onset_speed=_speed_at(changing, response.events.start_step.min() * response.dt) if touched else None,
        end_of_rub_speed=_speed_at(changing, ends.max() * response.dt) if touched else None,
    )


def changing_motion(response: Response, rub: bool) -> Motions:
    """Return the motion of a whole record in which the speed or the machine changes: the forced whirl, or undecided.

    It is undecided with rub, and where the motion without rub is not known because a support is not linear. The casing
    is at rest without rub, undecided with rub. `rub` is whether any blade touched.
    """
    blisk = UNDECIDED if rub or not response.knows_free_motion else FORCED
    return Motions(blisk=blisk, casing=UNDECIDED if rub else AT_REST, system=blisk)


def changing_orders(windows: Windows) -> dict[str, TapOrders]:
    """Average the orders of a record at a changing speed over its windows. Returns the orders by tap.

    - windows: the windows of the record, at least one, from `rubgen.labels.windows`.

    Amplitudes (20,) at the orders 1 to 20 are root mean squares over the windows. Floors (20,) are root mean squares of
    the windows' standard errors. A window with NaN makes the order NaN. Phases, fractional orders and blade passing are
    unknown: NaN.
    """
    unknown = {
        "phases": np.full(HIGHEST_ORDER, np.nan),
        "fractional": np.full(len(FRACTIONS), np.nan),
        "blade_passing": np.full(2 * SIDEBANDS + 1, np.nan),
    }
    return {
        tap: TapOrders(amplitudes=_rms(windows.orders[tap]), floors=_rms(windows.scatter[tap]), **unknown)
        for tap in windows.orders
    }


def _rms(values: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt(np.mean(values**2, axis=0)))


def by_angle(response: Response) -> ContactEvents:
    """Return the touches in steps of equal angle, `steps_per_turn` a turn, instead of steps of equal time.

    Starts and ends are rounded to whole steps. A touch has at least one step. At a steady speed the touches are
    returned unchanged.
    """
    changing, events = response.changing_speed, response.events
    if changing is None:
        return events
    scale = response.steps_per_turn / (2 * np.pi)
    start = scale * changing.rotation.angle(events.start_step * response.dt)
    end = scale * changing.rotation.angle((events.start_step + events.steps) * response.dt)
    first = np.rint(start).astype(np.int64)
    return replace(events, start_step=first, steps=np.maximum(1, np.rint(end).astype(np.int64) - first))


def _speed_at(changing: ChangingSpeed, time: float) -> float:
    return float(changing.rotation.speed(time))


def _changes(response: Response, changing: ChangingSpeed, edges: IntArray) -> tuple[Change, ...]:
    """Return the first turn, and every turn where rub or motion differs from before."""
    times, rubs = turn_times(response, changing), rubbing(response)
    edges = np.union1d(edges, np.flatnonzero(np.diff(rubs)) + 1)
    states = [_state(response, a, b, rub=bool(rubs[a])) for a, b in pairwise(edges.tolist())]
    begins = [0, *(i for i in range(1, len(states)) if states[i] != states[i - 1])]
    changes = []
    for first, last in pairwise([*begins, len(states)]):
        turns = slice(edges[first], edges[last])
        time = _start_of(response, times, int(edges[first]), states[first][0], states[first - 1][0] if first else None)
        rub, blisk, casing, system = states[first]
        changes.append(
            Change(
                time=time,
                speed=_speed_at(changing, time),
                rub=rub,
                impulse=float(response.impulse_per_turn[turns].mean()),
                blisk=blisk,
                casing=casing,
                motion=system,
            )
        )
    return tuple(changes)


def _start_of(response: Response, times: FloatArray, turn: int, rub: bool, rubbed: bool | None) -> float:
    """Return when a stretch begins: with the first touch, after the last touch, or with its first turn."""
    start, dt = float(times[turn]), response.dt
    begun = response.events.start_step * dt
    if rub and rubbed is False:
        return float(begun[begun >= start - dt].min(initial=np.inf)) if (begun >= start - dt).any() else start
    if rubbed and not rub:
        ends = (response.events.start_step + response.events.steps) * dt
        return min(float(ends[begun < start].max(initial=0.0)), start)
    return start


def rubbing(response: Response) -> BoolArray:
    """Return whether there is rub in each turn (turns,). Touches fewer than WINDOW_TURNS turns apart are one rub."""
    touched = np.flatnonzero(response.contact_steps_per_turn)
    rubs = np.zeros(response.record_turns, dtype=bool)
    rubs[touched] = True
    for before, after in pairwise(touched.tolist()):
        if after - before < WINDOW_TURNS:
            rubs[before:after] = True
    return rubs


def _state(response: Response, first: int, last: int, *, rub: bool) -> tuple[bool, Motion, Motion, Motion]:
    """Return rub, and motion of blisk, casing and both, of the turns first .. last - 1."""
    found = drifting_motion(response, first, last, rub=rub)
    return rub, found.blisk.motion, found.casing.motion, found.system.motion
