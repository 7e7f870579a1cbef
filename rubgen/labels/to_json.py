"""Turn labels into a dictionary for JSON, by their names in every file and command."""

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from rubgen.labels.compact_record import CompactRecord, response_of
from rubgen.labels.label import label
from rubgen.labels.labels import Labels
from rubgen.labels.registry import LABELS, TAP_LABELS, WINDOW_LABELS

MOTION_LABELS = ("motion", "motion_blisk", "motion_casing")


def labels_to_json(labels: Labels) -> dict[str, object]:
    """Return the labels of one run by their public names, as plain Python values for JSON.

    The keys are in the order of `rubgen.labels.registry`, which lists names, units and meanings. Then follow the labels
    of each true signal, such as `<tap>_orders`. Labels of windows of the signals are not included (`window_labels`).
    Undefined values, NaN and infinite values are None, in lists too.
    """
    values = {each.name: _plain(each.kind, each.value(labels)) for each in LABELS}
    for tap, orders in labels.orders.items():
        values |= {f"{tap}_{each.ending}": _plain(each.kind, each.value(orders)) for each in TAP_LABELS}
    return values


def remade_labels(record: CompactRecord) -> dict[str, object]:
    """Compute labels from the compact record of a run, by their public names: all except labels of orders."""
    values = labels_to_json(label(response_of(record)))
    return {name: value for name, value in values.items() if name not in FROM_TAPS}


def window_labels(labels: Labels) -> dict[str, object]:
    """Return the labels of windows of each true signal (tap), by their public names, `<tap>_window_amplitudes`."""
    orders = labels.windows.orders
    return {f"{tap}_{each.ending}": each.value(values) for tap, values in orders.items() for each in WINDOW_LABELS}


def _number(value: float) -> float | None:
    """Return a number for JSON, which has no NaN: NaN becomes None."""
    return float(value) if math.isfinite(value) else None


FROM_TAPS = tuple(each.name for each in LABELS if each.from_taps)
"""Labels that need the taps although their names contain no tap."""
_SINGLE: dict[str, Callable[[Any], object]] = {"text": str, "flag": bool, "integer": int, "number": _number}


def _plain(kind: str, value: Any) -> object:
    if value is None:
        return None
    if kind in _SINGLE:
        return _SINGLE[kind](value)
    each: Iterable[Any] = value.tolist() if isinstance(value, np.ndarray) else value
    return [_SINGLE[kind.removesuffix("s")](one) for one in each]


def motion_classes(labels: Labels, start: float, seconds: float) -> list[tuple[float, dict[str, str]]]:
    """Return the classes of motion in a part of the record, each with the time in s from which it is valid.

    - labels: the labels of the run.
    - start: start of the part in s from the start of the record. The returned times count from it.
    - seconds: length of the part.

    A class is a dict of the labels in MOTION_LABELS. A class that began before the part has the time 0. A steady run
    has one entry, at time 0.
    """
    if labels.history is None:
        stretches = [(0.0, labels.motion, labels.motion_blisk, labels.motion_casing)]
    else:
        changes = labels.history.changes
        times = [change.time - start for change in changes]
        stretches = [
            (max(time, 0.0), change.motion, change.blisk, change.casing)
            for time, after, change in zip(times, [*times[1:], math.inf], changes, strict=True)
            if after > 0 and time < seconds
        ]
    return [(time, dict(zip(MOTION_LABELS, map(str, found), strict=True))) for time, *found in stretches]
