"""Labels of a run as Rerun entities and properties."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import rerun as rr

from rubgen.labels.harmonics import HIGHEST_ORDER
from rubgen.labels.labels import Labels, Motion
from rubgen.labels.plain import labels_dict
from rubgen.scenario import Scenario
from rubgen.scenario.plain import scenario_dict
from rubgen.viz.colors import MOTION_COLORS, rgba
from rubgen.viz.signal_entities import TIMELINE, times_ns

BAR_WIDTH = 0.8


def send_labels(stream: rr.RecordingStream, scenario: Scenario, labels: Labels) -> None:
    """Properties `labels` and `scenario`, labels as text, lanes of motion, amplitudes of orders as bars."""
    plain = labels_dict(labels)
    known: dict[str, Any] = {key: value for key, value in plain.items() if value not in (None, [])}
    stream.send_property("labels", rr.AnyValues(**known))
    stream.send_property("scenario", rr.AnyValues(json=json.dumps(scenario_dict(scenario))))
    stream.log("/labels/text", rr.TextDocument(_table(scenario, plain), media_type="text/markdown"), static=True)
    _send_motions(stream, labels)
    for tap, amplitudes in labels.orders.items():
        left = np.arange(1, HIGHEST_ORDER + 1) - BAR_WIDTH / 2
        bars = rr.BarChart(amplitudes, abscissa=left, widths=np.full(HIGHEST_ORDER, BAR_WIDTH))
        stream.log(f"/orders/{tap}", bars, static=True)


def _send_motions(stream: rr.RecordingStream, labels: Labels) -> None:
    """One lane each for system, blisk and casing, every class in its colour."""
    index = [rr.TimeColumn(TIMELINE, duration=times_ns(np.zeros(1)))]
    colors = [rgba(MOTION_COLORS[motion]) for motion in Motion]
    motions = {"system": labels.motion, "blisk": labels.motion_blisk, "casing": labels.motion_casing}
    for part, motion in motions.items():
        named = rr.StateConfiguration(
            values=[motion.value for motion in Motion],
            labels=[f"{part}: {motion.value}" for motion in Motion],
            colors=colors,
        )
        stream.log(f"/labels/motion/{part}", named, static=True)
        stream.send_columns(f"/labels/motion/{part}", index, rr.StateChange.columns(state=[motion.value]))


def _table(scenario: Scenario, plain: dict[str, object]) -> str:
    """Labels but for the order amplitudes, which have their own view, as Markdown."""
    rows = [f"| {key} | {_shown(value)} |" for key, value in plain.items() if not key.endswith("_orders")]
    title = f"# {scenario.run_id}: {scenario.machine.name} at {scenario.operation.speed_rpm:g} rev/min"
    return "\n".join([title, "", "| label | value |", "|---|---|", *rows])


def _shown(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list):
        return ", ".join(_shown(item) for item in value) or "none"
    return "none" if value is None else str(value)
