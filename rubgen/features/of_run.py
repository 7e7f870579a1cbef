"""The rows of one run in the table of features."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyarrow as pa

from rubgen.arrays import FloatArray
from rubgen.errors import UserError
from rubgen.features.envelope import envelope_features
from rubgen.features.generic import generic_features
from rubgen.features.orders import orbit_features, order_features
from rubgen.features.plan import Plan
from rubgen.features.time_domain import time_features
from rubgen.features.turns import by_turn
from rubgen.features.vocabulary import GENERIC
from rubgen.measurement.channel import Float32Array


def run_features(
    plan: Plan, ids: tuple[str, str, str], signals: Mapping[str, Float32Array], pulses: FloatArray
) -> pa.Table:
    """Compute the rows of a run, one for each window, with the columns of `plan.schema()`. NaN becomes null.

    - ids: names of run, machine and split.
    - signals: at least the channels of the plan, each (samples,) in its unit.
    - pulses: times of the recorded pulses (any,) in s from the first sample.

    Raises UserError where the window is longer than the signals, and where tsfel gives other features than the plan
    has.
    """
    stacked = np.array([signals[name] for name in plan.channels], dtype=np.float64)
    samples, rate = stacked.shape[1], plan.rate_hz
    cuts = plan.window.cuts(samples, rate, pulses) if plan.window else [(0, samples)]
    if plan.window and not cuts:
        longest = plan.window.longest(samples, rate, pulses)
        raise UserError(f"--window {plan.window}: is longer than the signals of {ids[0]}; give at most {longest}")
    rows = []
    for first, size in cuts:
        window, start = stacked[:, first : first + size], first / rate
        rows.append(np.concatenate([[start, size / rate], window_features(plan, window, pulses - start)]))
    types, values = plan.schema(), np.array(rows)
    columns: list[Any] = [pa.array([each] * len(rows), pa.string()) for each in ids]
    columns.append(pa.array(range(len(rows)), pa.int64()))
    columns += [pa.array(column, pa.float64(), from_pandas=True) for column in values.T]
    if len(columns) != len(types):
        raise UserError(f"{ids[0]}: tsfel gives other features here than in the first window; use windows in s")
    return pa.table(columns, schema=types)


def window_features(plan: Plan, signals: FloatArray, pulses: FloatArray) -> FloatArray:
    """Compute the features (any,) of one window in the order of `plan.schema()`, without the columns IDS.

    - signals (channels, samples): the plan's channels.
    - pulses: times of the pulses in s from the first sample of the window.
    """
    rate, parts = plan.rate_hz, []
    turned = by_turn(signals, rate, pulses) if {"order", "orbit"} & set(plan.sets) else None
    if "time" in plan.sets:
        parts.append(time_features(signals))
    if "order" in plan.sets and turned is not None:
        parts.append(order_features(turned))
    if "envelope" in plan.sets:
        parts.append(envelope_features(signals, rate, pulses))
    if GENERIC in plan.sets:
        parts.append(np.array([[*generic_features(signal, rate).values()] for signal in signals]))
    found = [np.concatenate(parts, axis=1).ravel()] if parts else []
    for first, second, *angles in plan.pairs:
        if turned is not None:
            both = turned[[plan.channels.index(first), plan.channels.index(second)]]
            found.append(orbit_features(both, (angles[0], angles[1])))
    return np.concatenate(found)
