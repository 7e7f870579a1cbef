"""Universal file format: data sets 151, 164, 15, 82, one 58 a channel and one 55 a mode, for modal analysis (pyuff)."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from math import cos, radians, sin
from pathlib import Path
from typing import Any

import numpy as np

from rubgen.export.machine_modes import CENTRE, FIRST_OF_CASING, FIRST_OF_TIPS, ShownMode, modes_of, nodes_of
from rubgen.export.run import ExportedChannel, ExportedRun
from rubgen.reduction import ReducedModel

QUANTITIES = {"displacement": 8, "gap": 8, "acceleration": 12, "force": 13, "contact force": 13, "strain": 3}
"""Specific data types of the format, for quantities in SI units; 0 is any other."""
SI = ("m", "m/s2", "N", "1")
FLAT = 2.56
"""Sample rate over the highest frequency that the channels hold, and so of a mode in the file."""
DIRECTIONS = {0.0: 1, 90.0: 2, 180.0: -1, 270.0: -2}
"""Directions +X, +Y, -X, -Y of the format by angle; 0 is any other, which ID line 4 names."""
NEVER = "01-Jan-70"
"""The date in the file: the bytes must not depend on the day."""


def write_uff(runs: Iterator[ExportedRun], path: Path) -> None:
    """Write one run as a universal file. Channels are sets of type 58, binary in double precision: no value changes.

    `runs` must yield exactly one run, else ValueError is raised. Set 164 declares SI units. A channel in another unit
    has the data type "unknown" and its unit as the axis label. The geometry (sets 15, 82) has nodes for each sensor,
    the casing, the tips and the disk centre. Sets 55 are the modes of the run's machine up to the sample rate / 2.56:
    `machine_modes.modes_of`. The format cannot contain arrival times of pulses; the channel of the pulse is written.
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
    model = run.model()
    sets = [header, units, *_geometry(run, model)]
    sets += [_channel(run, channel, node) for node, channel in enumerate(run.channels, start=1)]
    modes = modes_of(model, run.sample_rate_hz / FLAT)
    sets += [_mode(run, mode, number) for number, mode in enumerate(modes, start=1)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)  # pyuff closes a binary file twice, and one of them late
        file.write_sets(sets, "overwrite")


_DATES = ("db_created", "db_saved", "file_written")


def _geometry(run: ExportedRun, model: ReducedModel) -> list[dict[str, Any]]:
    radius, angle = model.machine.tip_radius_m, [channel.facts.get("angle_deg") for channel in run.channels]
    inner = [channel.facts["location"] in ("disk centre", "shaft") for channel in run.channels]
    sensors = [
        (0.0, 0.0, 0.0)
        if at is None or shaft
        else (radius * cos(radians(float(at))), radius * sin(radians(float(at))), 0.0)
        for at, shaft in zip(angle, inner, strict=True)
    ]
    numbers, places = nodes_of(model)
    every = np.vstack([np.array(sensors).reshape(-1, 3), places])
    nodes = {"type": 15, "node_nums": np.append(np.arange(1, len(sensors) + 1), numbers)}
    nodes |= dict(zip("xyz", every.T, strict=True))
    casing = numbers[(numbers >= FIRST_OF_CASING) & (numbers < FIRST_OF_TIPS)]
    tips = numbers[(numbers >= FIRST_OF_TIPS) & (numbers < CENTRE)]
    spokes = np.column_stack([np.full(tips.size, CENTRE), tips]).ravel()  # from the centre to each tip and back
    lines = {"casing": np.append(casing, casing[0]), "blisk": np.append(spokes, CENTRE)}
    return [nodes] + [
        {"type": 82, "trace_num": number, "n_nodes": line.size, "id": name, "nodes": line}
        for number, (name, line) in enumerate(lines.items(), start=1)
    ]


def _mode(run: ExportedRun, mode: ShownMode, number: int) -> dict[str, Any]:
    return {
        "type": 55,
        "id1": f"{mode.name}: {mode.hertz:.6g} Hz",
        "id2": run.run_id,
        "id3": "at rest, undamped, without contact",
        "model_type": 1,
        "analysis_type": 2,
        "data_ch": 2,
        "spec_data_type": 8,
        "load_case": 0,
        "mode_n": number,
        "freq": mode.hertz,
        "modal_m": 1.0,
        "node_nums": mode.nodes,
        **dict(zip(("r1", "r2", "r3"), mode.shape.T, strict=True)),
    }


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
