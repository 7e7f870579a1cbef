"""Send the labels of a run to Rerun, as entities and properties."""

import json
from typing import Any

import numpy as np
import rerun as rr

from rubgen.labels.labels import Motion
from rubgen.scenario.scenario import scenario_dict
from rubgen.viz.colors import MOTION_COLORS, rgba
from rubgen.viz.entities.signals import time_column
from rubgen.viz.replay import Replay

MOST_SHOWN = 12
"""The text shows only the length of longer lists; the properties have all values."""
PARTS = {"system": "motion", "blisk": "motion_blisk", "casing": "motion_casing"}


def send_labels(stream: rr.RecordingStream, replay: Replay) -> None:
    """Send labels and scenario, as properties and as text, and the classes of motion over time.

    Only labels with one value for the whole run, and of no single true signal, are properties. All labels are in the
    property `json`: each property takes up to a kilobyte of the file, half of it in the index at its end.
    """
    plain, scenario = replay.labels, scenario_dict(replay.scenario)
    stream.send_property("labels", rr.AnyValues(**_single(plain), json=json.dumps(plain)))
    stream.send_property("scenario", rr.AnyValues(json=json.dumps(scenario)))
    shown = {key: value for key, value in plain.items() if not key.endswith("_orders")}
    _send_table(stream, "/labels/text", "label", replay, shown)
    _send_table(stream, "/labels/scenario", "parameter", replay, _flat(scenario))
    for part, label in PARTS.items():
        _send_motion(stream, part, replay.motion_classes.get(label) or [(0.0, str(plain[label]))])


def _single(labels: dict[str, object]) -> dict[str, Any]:
    """Return the labels with one value that belong to no single tap."""
    taps = tuple(key.removesuffix("orders") for key in labels if key.endswith("_orders"))
    return {
        key: value
        for key, value in labels.items()
        if isinstance(value, str | bool | int | float) and not key.startswith(taps)
    }


def _send_motion(stream: rr.RecordingStream, part: str, classes: list[tuple[float, str]]) -> None:
    """Send a lane of the classes from their times (s) on, each class in its colour."""
    named = rr.StateConfiguration(
        values=[each.value for each in Motion],
        labels=[f"{part}: {each.value}" for each in Motion],
        colors=[rgba(MOTION_COLORS[each]) for each in Motion],
    )
    stream.log(f"/labels/motion/{part}", named, static=True)
    times, motions = zip(*classes, strict=True)
    index = time_column(np.array(times))
    stream.send_columns(f"/labels/motion/{part}", index, rr.StateChange.columns(state=list(motions)))


def _send_table(
    stream: rr.RecordingStream, entity: str, heading: str, replay: Replay, values: dict[str, object]
) -> None:
    """Send names and values as Markdown."""
    title = f"# {replay.title}"
    rows = [f"| {key} | {_shown(value)} |" for key, value in values.items()]
    text = "\n".join([title, "", f"| {heading} | value |", "|---|---|", *rows])
    stream.log(entity, rr.TextDocument(text, media_type="text/markdown"), static=True)


def _flat(values: dict[str, Any], prefix: str = "") -> dict[str, object]:
    """Return nested tables as one, keys joined by dots."""
    flat: dict[str, object] = {}
    for key, value in values.items():
        flat |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat


def _shown(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list) and len(value) > MOST_SHOWN:
        return f"{len(value)} values"
    if isinstance(value, list):
        return ", ".join(_shown(item) for item in value) or "none"
    return "none" if value is None else str(value)
