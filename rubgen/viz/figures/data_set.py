"""Draw a data set at a glance: which parameters were drawn, and what came of them."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rubgen.scenario.vary import PARAMETERS
from rubgen.viz.colors import MOTION_COLORS
from rubgen.viz.figures.style import MOTION_MARKERS, label_axes, motion_legend, new_figure

if TYPE_CHECKING:
    import pandas as pd

FIRST = ("speed_rpm", "clearance_m", "casing_support_stiffness_n_per_m")
"""The parameters that are shown first, where they vary."""
FOLLOWING = ("end_speed_rpm", "duration_s")
LOGARITHMIC_SPAN = 5.0
LABEL_LETTERS = 40
"""A longer label of an upright axis is broken into lines."""


def dataset_overview(runs: pd.DataFrame) -> Figure:
    """Draw the runs in up to two planes of parameters that vary, and their contact impulse, marked by class of motion.

    `runs` is the table `runs.parquet`; failed runs are left out. Runs without contact are hollow.
    """
    shown = runs[runs["status"] == "ok"]
    varied = varied_keys(shown) or ["speed_rpm"]
    x, others = varied[0], varied[1:3]
    figure = new_figure(5.0 * (1 + len(others)), 4.4)
    axes = figure.subplots(1, 1 + len(others), squeeze=False)[0]
    for panel, y in zip(axes, others, strict=False):
        parameter_plane(panel, shown, x, y)
    parameter_plane(axes[-1], shown, x, "contact_impulse_per_turn_n_s")
    marks = motion_legend(shown["motion"], hollow=not shown["rub"].all())
    figure.legend(handles=marks, loc="outside lower center", ncols=6 if others else 3, frameon=False, fontsize=9)
    return figure


def varied_keys(runs: pd.DataFrame) -> list[str]:
    """Return the keys of `[vary]` with more than one value among the runs, the keys of `FIRST` first.

    At steady speed the duration and the end speed are determined by the speed and are left out.
    """
    follow = FOLLOWING if _is_steady(runs) else ()
    known = [entry.key for entry in PARAMETERS if entry.key in runs and entry.key not in follow]
    keys = [key for key in known if runs[key].nunique() > 1]
    return sorted(keys, key=lambda key: FIRST.index(key) if key in FIRST else len(FIRST))


def _is_steady(runs: pd.DataFrame) -> bool:
    if "end_speed_rpm" not in runs:
        return True
    return bool((runs["end_speed_rpm"] == runs["speed_rpm"]).all() and (runs["fluctuation_rpm"] == 0).all())


def parameter_plane(axes: Axes, runs: pd.DataFrame, x: str, y: str) -> None:
    """Draw runs over two columns `x` and `y`, coloured and shaped by class of motion, hollow without contact.

    An axis is logarithmic where its values are positive and span more than a factor of LOGARITHMIC_SPAN.
    """
    for motion, color in MOTION_COLORS.items():
        for rub, inside in ((True, color), (False, "none")):
            chosen = runs[(runs["motion"] == motion.value) & (runs["rub"] == rub)]
            axes.plot(
                chosen[x] * scale_of(x),
                chosen[y] * scale_of(y),
                MOTION_MARKERS[motion],
                markersize=6.5 if len(runs) < 300 else 3.5,
                color=color,
                markerfacecolor=inside,
            )
    label_axes(axes, axis_text(x), fill(axis_text(y), LABEL_LETTERS))
    for key, scale in ((x, axes.set_xscale), (y, axes.set_yscale)):
        values = runs[key].to_numpy(dtype=float)
        if values.size and values.min() > 0 and values.max() > LOGARITHMIC_SPAN * values.min():
            scale("log")


def scale_of(key: str) -> float:
    """Return the factor from a column's unit to the displayed unit: lengths in m are shown in mm."""
    return 1e3 if key.endswith("_m") and not key.endswith(("per_m", "kg_m")) else 1.0


def axis_text(key: str) -> str:
    """Return the label of an axis for the column `key`: the beginning of its meaning, with the displayed unit.

    `key` is a key of `[vary]` or `contact_impulse_per_turn_n_s`.
    """
    if key == "contact_impulse_per_turn_n_s":
        return "Contact impulse a turn, N s"
    entry = next(entry for entry in PARAMETERS if entry.key == key)
    unit = "mm" if scale_of(key) != 1 else entry.unit
    meaning = entry.meaning.split(";")[0].split(",")[0]
    meaning = meaning[0].upper() + meaning[1:]
    return meaning if unit in ("", "1") else f"{meaning}, {unit}"
