"""A set whose rub-free runs repeat after two turns or not at all goes through the whole line."""

import warnings

import rubgen
from rubgen.dataset.checking.relabel import relabel
from rubgen.dataset.checking.verify import verify
from rubgen.scenario import parse_recipe

RECIPE = {
    "name": "settling",
    "runs": 2,
    "machine": "zeng2019",
    "vary": {"clearance_m": 4e-3, "speed_rpm": 7500, "unbalance_kg_m": 1e-2},
    "labels": {"lyapunov": False},
    "output": {"signal_seconds": 0.2, "formats": ["parquet", "mcap"]},
}
LOOSE = {"kind": "loose-support", "lost_stiffness": 0.9}


def test_a_loose_support_without_rub_is_a_run_as_any(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # that no blade can reach the casing is not known before the runs
        rubgen.generate(parse_recipe({**RECIPE, "faults": [LOOSE]}), tmp_path / "set", workers=1)
    data = rubgen.open(tmp_path / "set")
    row = data.row("run-000000")
    assert (row["status"], row["rub"], row["motion"], row["period"]) == ("ok", False, "period-k", 2)
    assert (row["faults"], row["healthy"], row["lost_stiffness"]) == (["loose-support"], False, 0.9)
    assert row["free_penetration_m"] is None
    assert verify(data.layout.root) == []
    again = relabel(data.layout.root)
    assert (again.runs, again.differences) == (2, ())
