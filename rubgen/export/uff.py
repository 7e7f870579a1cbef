"""Universal file format: data sets 151, 164, 15, 82 and one 58 a channel, for programs of modal analysis (pyuff)."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import numpy as np

from rubgen.export.run import ExportedChannel, ExportedRun

QUANTITIES = {"displacement": 8, "gap": 8, "acceleration": 12, "force": 13, "contact force": 13, "strain": 3}
"""Specific data types of the format, for quantities in SI units; 0 is any other."""
SI = ("m", "m/s2", "N", "1")
RING = 36
FIRST_OF_RING = 1001
DIRECTIONS = {0.0: 1, 90.0: 2, 180.0: -1, 270.0: -2}
"""Directions +X, +Y, -X, -Y of the format by angle; 0 is any other, which ID line 4 names."""
NEVER = "01-Jan-70"
"""The date in the file: the bytes must not depend on the day."""


def write_uff(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write one run as a file of type 58, binary in double precision: no value changes.

    Set 164 says SI units. A channel in another unit has the data type "unknown" and its unit as the axis label. The
    geometry (sets 15, 82) has a node for each sensor and a ring of the casing at the radius of the tips. Arrival times
    of pulses have no place in the format; the channel of the pulse has one.
    """
    import pyuff

    (run,) = runs
    file = pyuff.UFF(str(path))
    header = {
        "type": 151,
        "model_name": "rubgen",
        "description": run.run_id,
        "db_app": "NONE",
        "program": "rubgen",
        **{f"{kind}_{what}": NEVER if kind == "date" else "00:00:00" for kind in ("date", "time") for what in _DATES},
    }
    units = {"type": 164, "units_code": 1, "units_description": "SI", "temp_mode": 1}
    units |= {"length": 1.0, "force": 1.0, "temp": 1.0, "temp_offset": 273.15}
    sets = [header, units, *_geometry(run)]
    sets += [_channel(run, channel, node) for node, channel in enumerate(run.channels, start=1)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)  # pyuff closes a binary file twice, and one of them late
        file.write_sets(sets, "overwrite")


_DATES = ("db_created", "db_saved", "file_written")


def _geometry(run: ExportedRun) -> list[dict[str, Any]]:
    angles = [channel.facts.get("angle_deg") for channel in run.channels]
    on_shaft = [channel.facts["location"] in ("disk centre", "shaft") for channel in run.channels]
    radius = [0.0 if angle is None or inner else run.tip_radius for angle, inner in zip(angles, on_shaft, strict=True)]
    ring = [360.0 * node / RING for node in range(RING)]
    every = [float(angle or 0.0) for angle in angles] + ring
    radius += [run.tip_radius] * RING
    numbers = np.array([*range(1, len(angles) + 1), *range(FIRST_OF_RING, FIRST_OF_RING + RING)])
    nodes = {
        "type": 15,
        "node_nums": numbers,
        "x": np.array([r * cos(radians(angle)) for r, angle in zip(radius, every, strict=True)]),
        "y": np.array([r * sin(radians(angle)) for r, angle in zip(radius, every, strict=True)]),
        "z": np.zeros(numbers.size),
    }
    closed = np.append(numbers[-RING:], FIRST_OF_RING)
    return [nodes, {"type": 82, "trace_num": 1, "n_nodes": closed.size, "id": "casing", "nodes": closed}]


def _channel(run: ExportedRun, channel: ExportedChannel, node: int) -> dict[str, Any]:
    facts = channel.facts
    quantity = str(facts["quantity"])
    angle = facts.get("angle_deg")
    return {
        "type": 58,
        "binary": 1,
        "func_type": 1,
        "rsp_node": node,
        "rsp_dir": DIRECTIONS.get(float(angle), 0) if angle is not None else 0,
        "ref_node": 0,
        "ref_dir": 0,
        "rsp_ent_name": channel.name[:10],
        "id1": channel.name,
        "id2": run.run_id,
        "id3": f"{run.sample_rate_hz!r} samples a second",
        "id4": ", ".join(filter(None, (str(facts["location"]), f"{angle:g} deg" if angle is not None else ""))),
        "id5": f"{facts['kind']}, {facts['axis']}".rstrip(", "),
        "ord_data_type": 4,
        "abscissa_spacing": 1,
        "x": np.arange(run.samples) / run.sample_rate_hz,
        "data": channel.values,
        "abscissa_spec_data_type": 17,
        "abscissa_axis_lab": "Time",
        "abscissa_axis_units_lab": "s",
        "ordinate_spec_data_type": QUANTITIES.get(quantity, 0) if channel.unit in SI else 0,
        "ordinate_axis_lab": quantity[:20],
        "ordinate_axis_units_lab": channel.unit,
        "orddenom_spec_data_type": 0,
    }
