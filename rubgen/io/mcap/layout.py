"""A layout for Foxglove that opens an MCAP file of rubgen with a name at each line.

Keys and panels follow LayoutData of Foxglove Studio, of which Lichtblick is the open-source successor.
"""

from collections.abc import Sequence
from typing import Any

from rubgen.io.mcap.foxglove import BLISK, GROUND
from rubgen.measurement.channel import Recording


def foxglove_layout(recording: Recording) -> dict[str, Any]:
    """Return the layout of a recording, for JSON: a plot for each preview, touches, classes of motion, the frames.

    In the preview of a quantity every channel has two lines, its minimum and its maximum. The layout fits all files of
    the same sensor set.
    """
    panels: dict[str, dict[str, Any]] = {}
    for quantity, group in recording.by_quantity().items():
        ends = [f"{channel.name} {end}, {channel.unit}" for channel in group for end in ("min", "max")]
        lines = [(f"/preview/{quantity}.data[{place}]", name) for place, name in enumerate(ends)]
        panels[f"Plot!{quantity}"] = _plot(quantity.replace("_", " "), lines)
    touches = [
        ("/contact.impulse_n_s", "impulse, N s"),
        ("/contact.angle_rad", "angle, rad"),
        ("/contact.blade", "blade"),
    ]
    panels["Plot!contact"] = _plot("touches", touches, joined=False)
    motion = [("/labels/motion.motion", "motion"), ("/labels/motion.motion_blisk", "blisk"),
              ("/labels/motion.motion_casing", "casing")]  # fmt: skip
    panels["StateTransitions!motion"] = {"paths": _paths(motion), "isSynced": True, **_titled("motion")}
    panels["3D!frames"] = {"followTf": GROUND, "transforms": {f"frame:{BLISK}": {"visible": True}}, "topics": {}}
    return {
        "configById": panels,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 0.02},
        "layout": _split(list(panels), "column"),
    }


def _plot(title: str, lines: Sequence[tuple[str, str]], *, joined: bool = True) -> dict[str, Any]:
    paths = [{**path, "showLine": joined} for path in _paths(lines)]
    return {"paths": paths, **_titled(title), "xAxisVal": "timestamp", "showLegend": True, "isSynced": True}


def _titled(title: str) -> dict[str, str]:
    """Return the title of a panel under the keys of Foxglove and of Lichtblick, which reads the same layouts."""
    return {"foxglovePanelTitle": title, "lichtblickPanelTitle": title}


def _paths(lines: Sequence[tuple[str, str]]) -> list[dict[str, Any]]:
    return [
        {"value": value, "label": label, "enabled": True, "timestampMethod": "receiveTime"} for value, label in lines
    ]


def _split(panels: Sequence[str], direction: str) -> str | dict[str, Any]:
    """Return panels as Foxglove's tree: two halves of equal size, cut in turn side by side and one above the other."""
    if len(panels) == 1:
        return panels[0]
    half = (len(panels) + 1) // 2
    other = "row" if direction == "column" else "column"
    return {"first": _split(panels[:half], other), "second": _split(panels[half:], other), "direction": direction}
