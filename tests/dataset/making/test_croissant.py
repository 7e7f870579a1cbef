"""Croissant's own library finds croissant.json valid and loads through it."""

import json
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.solver.response import Status

pytestmark = [  # of mlcroissant's own calls, not of ours
    pytest.mark.filterwarnings("ignore:ConjunctiveGraph is deprecated:DeprecationWarning"),
    pytest.mark.filterwarnings("ignore:The inplace keyword in DataFrame.reset_index:DeprecationWarning"),
]


@pytest.fixture(scope="module")
def mlcroissant():
    return pytest.importorskip("mlcroissant")


def test_valid_and_loaded_to_the_bit(mlcroissant, small_set):
    described = mlcroissant.Dataset(jsonld=str(small_set.directory / "croissant.json"))
    assert not described.metadata.issues.errors
    rows = list(described.records("signals"))
    data = rubgen.open(small_set.directory)
    assert [row["signals/run_id"].decode() for row in rows] == list(data)
    for row in rows:
        signals = data.signals(row["signals/run_id"].decode())
        loaded = np.array(row["signals/contact_force"], dtype=np.float32)
        np.testing.assert_array_equal(loaded, signals["contact_force"])
    speeds = [row["runs/speed_rpm"] for row in described.records("runs")]
    assert speeds == data.runs["speed_rpm"].tolist()


def test_columns_that_are_lists_are_repeated(small_set):
    described = json.loads((small_set.directory / "croissant.json").read_text())
    files = {"runs": "runs.parquet", "signals": "signals/*.parquet"}
    for records in described["recordSet"]:
        types = pq.read_schema(next(small_set.directory.glob(files[records["name"]])))
        lists = {each.name for each in types if pa.types.is_list(each.type)}
        assert {field["name"] for field in records["field"] if field.get("repeated")} == lists != set()


def test_failed_runs_have_empty_labels(mlcroissant, make_synthetic_run, short_records, tmp_path, monkeypatch):
    run = make_synthetic_run(seconds=0.1)
    response = replace(run.response, status=Status.DIVERGED, reason="at once")
    monkeypatch.setattr("rubgen.dataset.making.generate.warm_up", lambda *_: [])
    monkeypatch.setattr(
        "rubgen.pipeline.simulate",
        lambda scenario: replace(run, scenario=scenario, response=response, recording=None, labels=None),
    )
    output = {"formats": ["mcap"], "signal_seconds": 0.1}
    rubgen.generate({"name": "a", "runs": 2, "machine": "zeng2019", "output": output}, tmp_path / "set", workers=1)
    described = mlcroissant.Dataset(jsonld=str(tmp_path / "set/croissant.json"))
    rows = list(described.records("runs"))
    assert [row["runs/status"] for row in rows] == [b"diverged", b"diverged"]
    assert rows[0]["runs/contact_force_orders"] is None
    names = json.loads((tmp_path / "set/croissant.json").read_text())["recordSet"]
    assert [record_set["name"] for record_set in names] == ["runs"]
