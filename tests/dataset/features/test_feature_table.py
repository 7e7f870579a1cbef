"""The table of features of a set: columns, windows, bytes, and mistakes."""

import sys
from pathlib import Path

import numpy as np
import polars as pl
import pyarrow.parquet as pq
import pytest
from threadpoolctl import threadpool_limits

import rubgen
from rubgen.cli import main
from rubgen.errors import UserError
from rubgen.features.write import write_features
from schemas.features_page import with_features

PAGE = Path(__file__).parents[3] / "docs/features.md"


@pytest.fixture(scope="module")
def table(small_set, tmp_path_factory):
    out = tmp_path_factory.mktemp("features") / "features.parquet"
    write_features(str(small_set.directory), str(out))
    return out


def test_rows_are_the_good_runs_and_values_are_those_of_the_signals(small_set, table):
    data, read = rubgen.open(small_set.directory), pl.read_parquet(table)
    assert read["run_id"].to_list() == list(data.ok.index)
    for run_id in data.ok.index:
        row = read.row(by_predicate=pl.col("run_id") == run_id, named=True)
        signals = data.signals(run_id, ["casing_acc_90", "proximity_x"])
        assert row["casing_acc_90__rms"] == pytest.approx(signals["casing_acc_90"].std(), rel=1e-4)
        assert row["proximity_x_proximity_y__orbit_major"] >= row["proximity_x__order_1"] * 0.999
        assert row["proximity_x__turns"] == pytest.approx(0.62 * data.runs.speed_rpm[run_id] / 60, abs=2)


def test_a_column_names_its_unit_and_its_definition(table):
    schema = pq.read_schema(table)
    field = schema.field("casing_acc_0__envelope_2000_5000_hz_mean")
    assert field.metadata[b"unit"] == b"m/s2"
    assert b"2,000 to 5,000 Hz" in field.metadata[b"meaning"]
    assert not [name for name in schema.names if name.startswith("contact_force")]


def test_bytes_do_not_depend_on_workers_and_threads(small_set, table, tmp_path, monkeypatch):
    monkeypatch.setattr("rubgen.features.write.RUNS_PER_JOB", 1)
    with threadpool_limits(2):
        write_features(small_set.directory, tmp_path / "one.parquet")
    write_features(small_set.directory, tmp_path / "two.parquet", workers=2)
    assert (tmp_path / "one.parquet").read_bytes() == (tmp_path / "two.parquet").read_bytes()
    assert pl.read_parquet(tmp_path / "one.parquet").equals(pl.read_parquet(table))


def test_windows_of_a_time_and_of_turns(small_set, tmp_path):
    data, out = rubgen.open(small_set.directory), tmp_path / "windows.parquet"
    write_features(small_set.directory, out, window="0.2s", channels=["proximity_x"], sets=["time"])
    read = pl.read_parquet(out)
    assert read.filter(run_id="run-000000")["start_s"].to_list() == pytest.approx([0, 0.2, 0.4])
    second = data.signals("run-000000")["proximity_x"][5120:10240]
    assert read.filter(run_id="run-000000")["proximity_x__mean"][1] == pytest.approx(second.mean(), rel=1e-5)
    write_features(small_set.directory, out, window="16turns", channels=["proximity_x"], sets=["order"])
    read = pl.read_parquet(out)
    assert set(read["proximity_x__turns"]) == {16.0}
    seconds = read.group_by("run_id", maintain_order=True).agg(pl.col("seconds").mean())["seconds"].to_numpy()
    assert seconds == pytest.approx(16 * 60 / data.ok.speed_rpm.to_numpy(), rel=0.01)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--window", "2s"], "--window 2s: is longer than the signals of run-000000; give at most 0.62s"),
        (["--window", "500turns"], "is longer than the signals of run-000000; give at most"),
        (["--window", "7 minutes"], "--window 7 minutes: unknown length; give seconds such as 0.25s"),
        (["--window", "1.5turns"], "must be whole turns"),
        (["--window", "1e-3s"], "unknown length"),
        (["--window", "0.001s"], "has fewer than 64 samples at 25600 Hz"),
        (["--channels", "casing_ac_0"], "did you mean casing_acc_0?"),
        (["--channels", "casing_acc_0,"], "has an empty name"),
        (["--channels", "casing_acc_0", "--set", "orbit"], "orbit needs two proximity probes"),
        (["--set", "ordr"], "did you mean order?"),
        (["--workers", "0"], "must be at least 1"),
    ],
)
def test_a_mistake_is_one_line_and_nothing_is_written(small_set, tmp_path, capsys, options, message):
    with pytest.raises(SystemExit) as ended:
        main(["features", str(small_set.directory), "--out", str(tmp_path / "f.parquet"), *options])
    said = capsys.readouterr().err
    assert (ended.value.code, said.count("\n")) == (2, 1)
    assert message in said
    assert not list(tmp_path.iterdir())


def test_without_a_pulse_only_time_features_are_possible(small_set, tmp_path, monkeypatch):
    def without(data):
        sensors = type(data)._sensing.fget(data).set
        return type(sensors)(name="x", sensors=tuple(each for each in sensors.sensors if each.kind != "once_per_rev"))

    monkeypatch.setattr("rubgen.dataset.reading.open.DataSet.sensors", property(without))
    write_features(small_set.directory, tmp_path / "f.parquet")
    assert {name.split("__")[1] for name in pq.read_schema(tmp_path / "f.parquet").names[6:]} >= {"rms"}
    assert not [name for name in pq.read_schema(tmp_path / "f.parquet").names if "order" in name]
    with pytest.raises(UserError, match="order needs pulses, and the set has no sensor once_per_rev"):
        write_features(small_set.directory, tmp_path / "g.parquet", sets=["order"])
    with pytest.raises(UserError, match="16turns needs pulses"):
        write_features(small_set.directory, tmp_path / "g.parquet", window="16turns", sets=["time"])


def test_tsfel_that_is_not_installed_is_named(small_set, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "tsfel", None)
    with pytest.raises(UserError, match=r"tsfel is not installed; pip install 'rubgen\[tsfel\]'"):
        write_features(small_set.directory, tmp_path / "f.parquet", sets=["tsfel"])


def test_features_of_another_package_become_columns(small_set, tmp_path, monkeypatch):
    found = lambda signal, _rate: {"tsfel_absolute_energy": float(np.sum(signal**2))}  # noqa: E731
    for place in ("write", "of_run"):
        monkeypatch.setattr(f"rubgen.features.{place}.generic_features", found)
    write_features(small_set.directory, tmp_path / "f.parquet", sets=["tsfel"], channels=["proximity_x"])
    read, data = pl.read_parquet(tmp_path / "f.parquet"), rubgen.open(small_set.directory)
    x = data.signals("run-000000")["proximity_x"].astype(float)
    assert read["proximity_x__tsfel_absolute_energy"][0] == pytest.approx(np.sum(x**2))


def test_the_page_has_the_vocabulary():
    page = PAGE.read_text(encoding="utf-8")
    assert page == with_features(page), "run `make schemas`"
