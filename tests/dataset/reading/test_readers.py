"""Others read what rubgen writes, to the bit: memory, Parquet and MCAP carry the same floats."""

import errno
import re
from pathlib import Path

import duckdb
import numpy as np
import pandas as pd
import polars as pl
import pytest
import yaml

import datasets
import rubgen
from rubgen.dataset.card import card
from rubgen.dataset.manifest import identity_of, read_manifest
from rubgen.dataset.tally import Tally
from rubgen.errors import UserError
from rubgen.io.mcap import read_mcap
from rubgen.io.parquet.compact_records import RECORD_COLUMNS
from rubgen.io.parquet.set_tables import SEEN
from rubgen.scenario import load_recipe, parse_recipe
from rubgen.scenario.load import RECIPES
from tests.default_columns import CHANNELS, SCALARS, SIGNALS

DATA = "signals/train-00000.parquet"


@pytest.fixture(scope="module")
def data(small_set):
    return rubgen.open(small_set.directory)


@pytest.fixture(scope="module")
def memory(small_set, module_with_short_records):
    """Run 1 again, alone and in memory."""
    run = rubgen.simulate(parse_recipe(small_set.recipe).scenario(1))
    return {name: channel.values for name, channel in run.recording.channels.items()}


def assert_same(signals, memory):
    assert set(signals) == set(memory) == set(CHANNELS)
    for name, values in memory.items():
        assert signals[name].dtype == values.dtype == np.float32
        np.testing.assert_array_equal(signals[name], values)


def test_memory_parquet_and_mcap_agree_to_the_bit(small_set, data, memory):
    assert_same(data.signals("run-000001"), memory)
    assert_same(read_mcap(small_set.directory / "mcap/0000/run-000001.mcap").signals, memory)


def test_datasets_loads_the_directory(small_set, memory, tmp_path, monkeypatch):
    monkeypatch.setattr(datasets.config, "HF_HUB_OFFLINE", True)
    loaded = datasets.load_dataset(str(small_set.directory), split="train", cache_dir=str(tmp_path))
    seen = {column.name for column in SCALARS + SIGNALS if column.role in SEEN}
    assert set(loaded.column_names) == seen
    assert loaded.features["proximity_x"].length == memory["proximity_x"].size
    assert loaded.features["motion"].names[:2] == ["period-1", "period-k"]
    row = loaded.with_format("numpy")[1]
    np.testing.assert_array_equal(row["proximity_x"], memory["proximity_x"])
    runs = datasets.load_dataset(str(small_set.directory), "runs", split="train", cache_dir=str(tmp_path))
    assert runs.column_names == [column.name for column in SCALARS]
    assert runs["motion"][:] == loaded["motion"][:]


def test_polars_duckdb_and_pandas_read_the_data(small_set, memory):
    path = small_set.directory / DATA
    polars = pl.scan_parquet(path).filter(pl.col("run_id") == "run-000001").select("proximity_x").collect()
    np.testing.assert_array_equal(polars["proximity_x"][0].to_numpy(), memory["proximity_x"])
    ((values,),) = duckdb.read_parquet(str(path)).filter("run_id = 'run-000001'").select("proximity_x").fetchall()
    np.testing.assert_array_equal(np.array(values, np.float32), memory["proximity_x"])
    frame = pd.read_parquet(path).set_index("run_id")
    np.testing.assert_array_equal(frame.loc["run-000001", "proximity_x"], memory["proximity_x"])


def test_the_card_describes_every_column_and_its_head_is_yaml(small_set):
    text = (small_set.directory / "README.md").read_text()
    _, head, body = text.split("---\n", 2)
    values = yaml.safe_load(head)
    assert values["license"] == "cc-by-4.0"
    assert [config["config_name"] for config in values["configs"]] == [
        "signals",
        "truth",
        "windows",
        "sections",
        "runs",
        "sensors",
    ]
    for column in SCALARS + SIGNALS:
        assert f"| `{column.name}` | {column.role.value} | {column.kind} | {column.unit} |" in body
    for name, (kind, meaning) in RECORD_COLUMNS.items():
        assert f"| `{name}` | {kind} | {meaning} |" in body
    assert "4 runs" in body


@pytest.mark.parametrize("name", ["rig", "run-up", "three-lobes"])
def test_the_card_fits_its_recipe(name):
    """It reads a channel that these sensors have, and tells of a constant speed only where it is."""
    recipe = load_recipe(RECIPES / f"{name}.toml")
    text = card(identity_of(recipe), {"ok": recipe.runs}, Tally(splits={}, shifts=()))
    (channel,) = re.findall(r'select\("run_id", "motion", "(\w+)"\)', text)
    assert channel in [sensor.name for sensor in recipe.sensing.set.sensors]
    assert ("constant speed" in text) is (name != "run-up")
    assert ("come from 500 turns" in text) is (name != "run-up")


def test_the_card_names_every_machine_of_the_recipe():
    recipe = load_recipe(RECIPES / "machines.toml")
    text = card(identity_of(recipe), {"ok": recipe.runs}, Tally(splits={}, shifts=()))
    assert "casing: machines `zeng2019`, `zeng2019-fitted`, seed\n5.\n" in text


def test_open_gives_runs_as_a_frame(data, small_set):
    runs = data.runs
    assert runs.index.tolist() == [f"run-{i:06d}" for i in range(4)]
    assert runs["speed_rpm"].isin([6000.0, 10000.0]).all()
    assert data.manifest == read_manifest(data.layout)


def test_units_are_those_of_the_channels(data):
    assert tuple(data.units) == CHANNELS
    units = {name: data.units[name] for name in ("proximity_x", "casing_acc_0", "contact_force")}
    assert units == {"proximity_x": "m", "casing_acc_0": "m/s2", "contact_force": "N"}


def test_open_says_what_is_missing(data, tmp_path):
    with pytest.raises(UserError, match=r"no run 'run-7'; give one of run-000000, run-000001, run-000002, \.\.\."):
        data.signals("run-7")
    with pytest.raises(UserError, match="no finished data set of rubgen"):
        rubgen.open(tmp_path)


def test_a_whole_row_has_labels_and_truth_and_no_channel(data, small_set):
    row = data.whole_row("run-000001")
    assert {name: row[name] for name in data.row("run-000001")} == data.row("run-000001")
    assert not set(row) & set(data.channels)
    for table in ("signals", "truth"):
        frame = pd.read_parquet(small_set.directory / table / "train-00000.parquet").set_index("run_id")
        for name in set(frame.columns) - set(data.channels) - set(data.row("run-000001")):
            np.testing.assert_array_equal(row[name], frame.loc["run-000001", name], err_msg=name)
    assert len(row["once_per_rev_s"]) > 50


def test_what_only_parquet_has_is_not_asked_of_a_set_without(data, monkeypatch):
    without = rubgen.open(data.layout.root)
    monkeypatch.setattr(type(data.manifest), "listed", lambda *_: [])
    with pytest.raises(
        UserError, match=r"^run-000001: the set has no such files; generate it with the format parquet$"
    ):
        without.whole_row("run-000001")
    with pytest.raises(UserError, match=r"has no files with signals; generate it with formats parquet or mcap$"):
        without.signals("run-000001")


def test_a_manifest_that_the_system_refuses_is_no_missing_set(data, monkeypatch):
    def refuse(path):
        raise PermissionError(errno.EACCES, "of the system", str(path))

    monkeypatch.setattr(Path, "read_bytes", refuse)
    with pytest.raises(UserError, match=r"its manifest cannot be read \(.*manifest\.json: Permission denied\)$"):
        rubgen.open(data.layout.root)
