"""Make the figures of the page that a reader zooms and turns, as values for plotly.js, and the library that draws them.

The page holds the library, compressed, so it needs no network.
"""

from __future__ import annotations

import base64
import gzip
from functools import lru_cache
from html import escape
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine import Machine
from rubgen.reduction import reduce
from rubgen.reduction.modes import blisk_modes
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s
from rubgen.viz.colors import BLUE, GREY, ORANGE, VERMILION
from rubgen.viz.derived import order_map, poincare_section, shaft_orbit
from rubgen.viz.figures.campbell_diagram import ABOVE_CRITICAL, HIGHEST_RPM, SLOWEST_RPM, branches
from rubgen.viz.replay import Replay

SPEEDS, ORDERS = 21, 8
ORBIT_TURNS, ORBIT_SAMPLES = 20, 40
BLOCKS, DECIBELS = 30, 80.0
Values = dict[str, Any]


def interactive_figures(replays: list[Replay]) -> list[Values]:
    """Return the figures of the page: Campbell diagram of the first run's machine, orbits and waterfalls of all runs.

    Each figure has `name`, `text`, and the `data` and `layout` of plotly.js. A menu in a figure chooses the run. A run
    without a pair of proximity probes has no orbit, a run of fewer than two blocks of turns no waterfall. A figure
    without any run is left out. `replays` are the runs, at least one.
    """
    first = replays[0].scenario
    found = [_campbell(first.machine, first.reduction), _orbits(replays), _waterfalls(replays)]
    return [figure for figure in found if figure["data"]]


@lru_cache(maxsize=1)
def packed_library() -> str:
    """Return the text of plotly.js, compressed by gzip, in base64. It is always the same."""
    from plotly.offline import get_plotlyjs

    return base64.b64encode(gzip.compress(get_plotlyjs().encode(), mtime=0)).decode("ascii")


@lru_cache(maxsize=4)
def _campbell(machine: Machine, reduction: Reduction) -> Values:
    model = reduce(machine, reduction)
    top = max(HIGHEST_RPM, ABOVE_CRITICAL * model.critical_speed_rpm)
    speeds = np.linspace(0.0, top, SPEEDS)
    modes = [blisk_modes(model, rad_per_s(max(float(speed), SLOWEST_RPM))) for speed in speeds]
    data = [
        _line(np.array([0.0, top]), order * np.array([0.0, top]) / 60, GREY, f"{order}X", hover="skip", width=1)
        for order in range(1, ORDERS + 1)
    ]
    for waves in range(machine.blades.count // 2 + 1):
        for number, (_, seen, ratio) in enumerate(branches(modes, waves).transpose(1, 2, 0)):
            ways = ((seen > 0, BLUE, "forward"), (seen <= 0, ORANGE, "backward")) if waves else ((seen > 0, BLUE, ""),)
            for part, color, whirl in ways:
                if part.any():
                    line = _line(speeds, np.where(part, np.abs(seen), np.nan), color, f"ND {waves}")
                    line |= {
                        "legendgroup": f"ND {waves}", "showlegend": number == 0, "customdata": _short(100 * ratio),
                        "visible": True if waves <= 1 else "legendonly",
                        "hovertemplate": f"ND {waves} {whirl}<br>%{{x:,.0f}} rev/min, %{{y:.1f}} Hz"
                        "<br>damping %{customdata} %<extra></extra>",
                    }  # fmt: skip
                    data.append(line)
    frequency = {"title": {"text": "Frequency in the inertial frame, Hz"}, "range": [0, 2.2 * top / 120]}
    return {
        "name": f"Campbell diagram of {machine.name}",
        "text": "Modes of the blisk without contact, in the inertial frame: forward whirl blue, backward whirl orange. "
        "Grey lines are orders of rotation. A click in the legend shows or hides the modes of a number of nodal "
        "diameters (ND). Draw a rectangle to zoom.",
        "data": data,
        "layout": _layout(
            xaxis={"title": {"text": "Speed, rev/min"}, "range": [0, top], "tickformat": ",d"}, yaxis=frequency
        ),
    }


def _orbits(replays: list[Replay]) -> Values:
    """Draw the last turns of the recorded orbit in space: x, y and the turn, with the section."""
    data, shown = list[Values](), list[Replay]()
    for replay in replays:
        orbit, once = shaft_orbit(replay), poincare_section(replay)
        pulses = replay.pulse_times
        if orbit is None or once is None or pulses.size < 2:
            continue
        turns = min(ORBIT_TURNS, pulses.size - 1)
        at = np.interp(np.arange(turns * ORBIT_SAMPLES + 1) / ORBIT_SAMPLES, np.arange(turns + 1), pulses[-turns - 1 :])
        time = np.arange(orbit.shape[1]) / replay.recording.sample_rate_hz
        x, y = (np.interp(at, time, values) for values in orbit)
        path = {"x": _short(x), "y": _short(y), "z": _short(np.arange(at.size) / ORBIT_SAMPLES)}
        points = {"x": _short(once[0, -turns - 1 :]), "y": _short(once[1, -turns - 1 :]), "z": list(range(turns + 1))}
        hover = "x %{x} µm, y %{y} µm, turn %{z}<extra></extra>"
        shown.append(replay)
        data += [
            {"type": "scatter3d", "mode": "lines", "line": {"color": BLUE, "width": 2}, "hovertemplate": hover} | path,
            {"type": "scatter3d", "mode": "markers", "marker": {"color": VERMILION, "size": 3}, "hovertemplate": hover}
            | points,
        ]
    axes = {"x": "Disk centre x, µm", "y": "Disk centre y, µm", "z": "Turn"}
    return {
        "name": "Orbits of the examples",
        "text": f"The recorded orbit over the last {ORBIT_TURNS} turns, one above the other. Red points are once a "
        "turn. Turn it with the mouse.",
    } | _chooser(data, shown, 2, axes)


def _waterfalls(replays: list[Replay]) -> Values:
    """Draw order spectra of an accelerometer, else of the first channel, over the time as a surface, in dB."""
    data, shown, name = list[Values](), list[Replay](), ""
    for replay in replays:
        channels = list(replay.recording.channels.values())
        channel = next((each for each in channels if each.quantity == "acceleration"), channels[0])
        pulses = replay.pulse_times
        found = order_map(channel.values, replay.recording.sample_rate_hz, pulses, most_blocks=BLOCKS)
        if len(found.time) < 2 or not found.amplitude.any():
            continue
        level = 20 * np.log10(np.maximum(found.amplitude / found.amplitude.max(), 10 ** (-DECIBELS / 20)))
        shown.append(replay)
        name = channel.name
        data.append(
            {
                "type": "surface", "x": _short(found.order), "y": _short(found.time),
                "z": [_whole(row) for row in level], "colorscale": "Viridis", "showscale": False,
                "hovertemplate": "order %{x}, %{y} s, %{z} dB<extra></extra>",
            }
        )  # fmt: skip
    axes = {"x": "Order f / f_r", "y": "Time, s", "z": "dB of the largest"}
    return {
        "name": "Waterfalls of the examples",
        "text": f"Order spectra of {name} over the time, each of 16 turns.",
    } | _chooser(data, shown, 1, axes)


def _chooser(data: list[Values], shown: list[Replay], each: int, axes: dict[str, str]) -> Values:
    """Return data and layout of a scene with a menu of the runs, of `each` traces, the first one visible."""
    buttons: list[Values] = []
    for number, replay in enumerate(shown):
        seen = [trace // each == number for trace in range(len(data))]
        title = f"{escape(replay.title)}<br>{escape(replay.headline)}"
        change = [{"visible": seen}, {"title.text": title}]
        buttons.append({"label": escape(replay.scenario.run_id), "method": "update", "args": change})
    for trace, values in enumerate(data):
        values |= {"visible": trace < each, "showlegend": False}
    scene = {f"{name}axis": {"title": {"text": text}} for name, text in axes.items()}
    layout = _layout(
        margin={"l": 0, "r": 0, "t": 40, "b": 50},
        scene=scene | {"aspectmode": "cube", "camera": {"eye": {"x": 1.9, "y": 1.9, "z": 1.1}}},
    )
    if buttons:
        below = {"x": 0.5, "y": 0.07, "yanchor": "bottom", "yref": "container", "font": {"size": 13}}
        layout |= {"title": below | {"text": buttons[0]["args"][1]["title.text"]}}
        layout |= {"updatemenus": [{"buttons": buttons, "x": 0, "xanchor": "left", "y": 1, "yanchor": "top"}]}
    return {"data": data, "layout": layout}


def _line(x: FloatArray, y: FloatArray, color: str, name: str, *, hover: str = "all", width: float = 1.5) -> Values:
    return {
        "type": "scatter", "mode": "lines", "x": _short(x), "y": _short(y), "name": name, "hoverinfo": hover,
        "line": {"color": color, "width": width}, "showlegend": False,
    }  # fmt: skip


def _layout(**more: Any) -> Values:
    return {"margin": {"l": 60, "r": 10, "t": 40, "b": 50}, "font": {"size": 12}, "hovermode": "closest"} | more


def _short(values: FloatArray) -> list[float | None]:
    """Return values with five digits; None, a gap, for NaN."""
    return [float(f"{value:.5g}") if np.isfinite(value) else None for value in values.tolist()]


def _whole(values: FloatArray) -> list[int]:
    whole: list[int] = np.rint(values).astype(int).tolist()
    return whole
