"""Croissant's own library finds croissant.json valid and loads through it."""

import json
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.labels import MOTION_CLASSES
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
        loaded = np.array(row["signals/proximity_y"], dtype=np.float32)
        np.testing.assert_array_equal(loaded, signals["proximity_y"])
    speeds = [row["runs/speed_rpm"] for row in described.records("runs")]
    assert speeds == data.runs["speed_rpm"].tolist()


def test_columns_that_are_lists_have_their_shape(small_set):
    described = json.loads((small_set.directory / "croissant.json").read_text())
    files = {name: f"{name}/*.parquet" for name in ("signals", "truth", "windows")}
    files |= {name: f"{name}.parquet" for name in ("runs", "sensors")}
    found = {records["name"]: records["field"] for records in described["recordSet"]}
    assert set(found) == {*files, "splits", "motion_classes"}
    for name, pattern in files.items():
        types = pq.read_schema(next(small_set.directory.glob(pattern)))
        shapes = {each.name: -1 for each in types if pa.types.is_list(each.type)}
        shapes |= {each.name: each.type.list_size for each in types if pa.types.is_fixed_size_list(each.type)}
        assert {each["name"]: int(each["arrayShape"]) for each in found[name] if each.get("isArray")} == shapes
    assert next(each for each in found["signals"] if each["name"] == "proximity_x")["arrayShape"] == "15872"


def test_labels_splits_and_classes_are_named(mlcroissant, small_set):
    described = mlcroissant.Dataset(jsonld=str(small_set.directory / "croissant.json"))
    classes = {row["motion_classes/name"]: row["motion_classes/number"] for row in described.records("motion_classes")}
    assert {word.decode() if isinstance(word, bytes) else word: n for word, n in classes.items()} == MOTION_CLASSES
    assert [str(row["splits/name"]).strip("b'") for row in described.records("splits")] == ["train"]
    assert described.metadata.data_biases
    assert not described.metadata.issues.warnings


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
    assert "signals" not in [record_set["name"] for record_set in names]
