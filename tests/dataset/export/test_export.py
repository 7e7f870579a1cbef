"""Each format through a reader of its own: signals bit for bit, units, sensors, labels; and mistakes."""

import json
import shutil

import h5py
import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest
import pyuff
from scipy.io import loadmat, wavfile
from scipy.linalg import eigh

import datasets
import rubgen
from rubgen.cli import main
from rubgen.dataset.reading.replaying import scenario_of
from rubgen.export.formats import FORMATS
from rubgen.export.run import without_nulls
from rubgen.export.write import _json, export
from rubgen.linalg.threads import one_blas_thread
from rubgen.reduction import reduce

CHANNELS = ["proximity_x", "casing_acc_90", "once_per_rev"]
RUN = "run-000001"


@pytest.fixture(scope="module")
def data(small_set):
    return rubgen.open(small_set.directory)


@pytest.fixture
def exported(small_set, tmp_path):
    def make(name, channels=CHANNELS):
        export(small_set.directory, tmp_path / name, name, channels=channels)
        return tmp_path / name

    return make


def test_uff_has_signals_units_and_geometry(data, exported):
    file = pyuff.UFF(str(exported("uff58") / "train" / f"{RUN}.uff"))
    types = list(file.get_set_types())
    assert types[:8] == [151, 164, 15, 82, 82, 58, 58, 58]
    assert set(types[8:]) == {55}
    assert file.read_sets(1)["units_code"] == 1
    nodes, signals = file.read_sets(2), data.signals(RUN)
    for number, name in enumerate(CHANNELS):
        found = file.read_sets(5 + number)
        assert np.array_equal(found["data"].astype(np.float32), signals[name])
        assert (found["id1"].strip(), found["id2"].strip()) == (name, RUN)
        assert found["ordinate_axis_units_lab"].strip() == data.units[name]
        assert found["abscissa_inc"] == 1 / 25600
    acceleration = file.read_sets(6)
    assert (acceleration["ordinate_spec_data_type"], acceleration["rsp_dir"]) == (12, 2)
    place = nodes["x"][acceleration["rsp_node"] - 1], nodes["y"][acceleration["rsp_node"] - 1]
    assert place == pytest.approx((0, data.recipe.base.machine.tip_radius_m), abs=1e-6)


def test_uff_has_the_modes_of_the_machine_of_the_run(data, exported):
    file = pyuff.UFF(str(exported("uff58", ["proximity_x"]) / "train" / f"{RUN}.uff"))
    scenario = scenario_of(data, RUN)
    model = reduce(scenario.machine, scenario.reduction)
    with one_blas_thread():  # modes of nearly equal frequencies mix in another way with other sums
        squares, vectors = eigh(model.stiffness(0.0), model.blisk.M)
    geometry = file.read_sets(2)
    places = dict(zip(geometry["node_nums"], zip(geometry["x"], geometry["y"], strict=True), strict=True))
    modes = [file.read_sets(number) for number, kind in enumerate(file.get_set_types()) if kind == 55]
    casing, blisk = ([each for each in modes if each["id1"].startswith(what)] for what in ("casing", "blisk"))
    assert [each["freq"] for each in casing] == pytest.approx(model.casing_frequencies_hz[: len(casing)], rel=1e-5)
    assert [each["freq"] for each in blisk] == pytest.approx(np.sqrt(squares[: len(blisk)]) / 2 / np.pi, rel=1e-5)
    assert max(each["freq"] for each in modes) <= 25600 / 2.56
    assert all(set(each["node_nums"]) <= set(places) for each in modes)
    tip = 9  # of 36 blades, at 90 degrees: outward is +y
    node = list(blisk[4]["node_nums"]).index(2001 + tip)
    assert places[2001 + tip] == pytest.approx((0, model.machine.tip_radius_m), abs=1e-6)
    for number in (2, 4, 40):
        radial, tangential, axial = vectors[3 * tip : 3 * tip + 3, number]
        found = [blisk[number][name][node] for name in ("r1", "r2", "r3")]
        assert found == pytest.approx((-tangential, radial, axial), rel=1e-4, abs=1e-5)


def test_mat_has_signals_units_and_labels(data, exported):
    found = loadmat(exported("mat") / "train" / f"{RUN}.mat", simplify_cells=True)
    assert np.array_equal(found["casing_acc_90"]["values"], data.signals(RUN)["casing_acc_90"])
    assert found["casing_acc_90"]["values"].dtype == np.float32
    assert (found["casing_acc_90"]["unit"], found["casing_acc_90"]["angle_deg"]) == ("m/s2", 90)
    assert found["run"]["speed_rpm"] == data.row(RUN)["speed_rpm"]
    assert bool(found["run"]["rub"]) is data.row(RUN)["rub"]
    assert found["once_per_rev_s"].size > 50


def test_hdf5_has_signals_units_and_labels(data, exported):
    with h5py.File(exported("hdf5") / "train" / f"{RUN}.h5") as file:
        channel = file["channels/casing_acc_90"]
        assert np.array_equal(channel[:], data.signals(RUN)["casing_acc_90"])
        assert (channel.attrs["units"], channel.attrs["location"]) == ("m/s2", "casing at 90 deg")
        assert channel.attrs["sample_rate_hz"] == 25600
        assert (file.attrs["motion"], file.attrs["speed_rpm"]) == (data.row(RUN)["motion"], data.row(RUN)["speed_rpm"])


def test_csv_keeps_every_digit(data, exported):
    found = pd.read_csv(exported("csv") / "train" / f"{RUN}.csv")
    assert list(found) == ["time_s", "proximity_x [m]", "casing_acc_90 [m/s2]", "once_per_rev [1]"]
    assert np.array_equal(found["proximity_x [m]"].astype(np.float32), data.signals(RUN)["proximity_x"])
    assert found["time_s"][1000] == 1000 / 25600


def test_wav_has_a_track_a_channel(data, exported):
    rate, found = wavfile.read(exported("wav") / "train" / f"{RUN}.wav")
    assert rate == 25600
    assert np.array_equal(found[:, 1], data.signals(RUN)["casing_acc_90"])


def test_ts_has_a_case_a_run(data, exported):
    lines = (exported("ts") / "train.ts").read_text().splitlines()
    head, cases = lines[: lines.index("@data")], lines[lines.index("@data") + 1 :]
    assert "@dimensions 3" in head
    assert f"@seriesLength {len(data.signals(RUN)['proximity_x'])}" in head
    *dimensions, rub = cases[1].split(":")
    assert np.array_equal(np.array(dimensions[1].split(","), dtype=np.float32), data.signals(RUN)["casing_acc_90"])
    assert [case.rsplit(":", 1)[1] for case in cases] == [str(rub).lower() for rub in data.ok.rub]
    assert rub == str(data.row(RUN)["rub"]).lower()


def test_webdataset_is_read_by_datasets(data, exported, tmp_path):
    files = str(exported("webdataset") / "*.tar")
    found = datasets.load_dataset("webdataset", data_files=files, split="train", cache_dir=str(tmp_path / "hub"))
    row = found[1]
    assert row["__key__"] == RUN
    assert np.array_equal(np.array(row["npy"], dtype=np.float32)[1], data.signals(RUN)["casing_acc_90"])
    assert row["json"]["rub"] is data.row(RUN)["rub"]
    assert row["json"]["channels"][1]["unit"] == "m/s2"


def test_tables_beside_the_files(data, exported):
    folder = exported("csv")
    channels, runs = pd.read_csv(folder / "channels.csv"), pd.read_csv(folder / "runs.csv", index_col="run_id")
    assert channels.set_index("name").unit["casing_acc_90"] == "m/s2"
    assert channels.set_index("name").angle_deg["casing_acc_90"] == 90
    assert list(runs.rub) == list(data.ok.rub)
    assert json.loads((folder / "export.json").read_text())["format"] == "csv"


def test_lists_in_the_table_of_runs_are_json_with_every_digit(data, exported):
    runs = pd.read_csv(exported("ts") / "runs.csv", index_col="run_id")
    assert _json(np.array([1 / 3, np.nan])) == "[0.3333333333333333, null]"
    assert _json(np.array(["a, b", None], dtype=object)) == '["a, b", null]'
    lists = [name for name in runs if data.runs[name].dtype == object]
    assert {"blade_touches", "contact_force_orders", "window_rub"} <= set(lists)
    for name in lists:
        for text, truth in zip(runs[name], data.runs[name], strict=True):
            found = None if pd.isna(text) else np.array(json.loads(text), truth.dtype)
            assert (found is truth is None) or np.array_equal(found, truth, equal_nan=True), name


@pytest.mark.parametrize("name", ["uff58", "mat", "hdf5", "webdataset"])
def test_a_stopped_export_is_completed_to_the_same_bytes(small_set, tmp_path, name):
    export(small_set.directory, tmp_path / "whole", name, channels=CHANNELS)
    shutil.copytree(tmp_path / "whole", tmp_path / "part")
    (tmp_path / "part/export.json").rename(tmp_path / "part/.export.json")
    sorted((tmp_path / "part").rglob(f"*{FORMATS[name].ending}"))[0].unlink()
    (tmp_path / "part/runs.csv").unlink()
    export(small_set.directory, tmp_path / "part", name, channels=CHANNELS)
    files = [each.relative_to(tmp_path / "whole") for each in (tmp_path / "whole").rglob("*") if each.is_file()]
    assert len(files) >= 4
    assert all((tmp_path / "whole" / each).read_bytes() == (tmp_path / "part" / each).read_bytes() for each in files)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--format", "matt"], "did you mean mat?"),
        (["--format", "csv", "--split", "tests"], "no good run has this split"),
        (["--format", "csv", "--channels", "proximity"], "no recorded channel 'proximity'"),
    ],
)
def test_a_mistake_is_one_line_and_nothing_is_written(small_set, tmp_path, capsys, options, message):
    said = _refused(capsys, small_set.directory, tmp_path / "out", *options)
    assert message in said
    assert not list(tmp_path.iterdir())


def test_what_a_format_cannot_hold_is_refused(small_set, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("rubgen.dataset.reading.open.DataSet.sample_rate_hz", 25600.5)
    assert "holds whole sample rates, not 25600.5 Hz" in _refused(
        capsys, small_set.directory, tmp_path / "out", "--format", "wav"
    )
    monkeypatch.setattr("rubgen.export.write.BYTES", 10**6)
    assert "choose fewer --channels, or hdf5" in _refused(
        capsys, small_set.directory, tmp_path / "out", "--format", "mat"
    )
    monkeypatch.setattr("rubgen.export.write.find_spec", lambda _name: None)
    assert "the package h5py is not installed; pip install 'rubgen[export]'" in _refused(
        capsys, small_set.directory, tmp_path / "out", "--format", "hdf5"
    )


def test_an_export_that_cannot_begin_leaves_no_folder(copied_set, tmp_path, capsys):
    (copied_set / "signals/train-00000.parquet").write_bytes(b"x")
    for name in ("csv", "ts", "parquet"):
        assert "train-00000.parquet" in _refused(capsys, copied_set, tmp_path / "out", "--format", name)
        assert not (tmp_path / "out").exists()


def test_another_folder_is_never_overwritten(small_set, tmp_path, capsys):
    (tmp_path / "mine.txt").write_text("mine")
    assert "is not empty (mine.txt)" in _refused(capsys, small_set.directory, tmp_path, "--format", "csv")
    export(small_set.directory, tmp_path / "out", "csv", channels=CHANNELS)
    assert "has another export" in _refused(capsys, small_set.directory, tmp_path / "out", "--format", "wav")


@pytest.mark.parametrize("inner", ["csv", "signals/csv", "."])
def test_no_export_goes_into_the_set_itself(copied_set, capsys, inner):
    before = sorted(copied_set.rglob("*"))
    assert "lies in the data set" in _refused(capsys, copied_set, copied_set / inner, "--format", "csv")
    assert sorted(copied_set.rglob("*")) == before


def _refused(capsys, directory, out, *options):
    with pytest.raises(SystemExit) as ended:
        main(["export", str(directory), "--out", str(out), *options])
    said = capsys.readouterr().err
    assert (ended.value.code, said.count("\n")) == (2, 1)
    return said


def test_a_list_with_undefined_values_has_nan_or_an_empty_text():
    assert np.array_equal(without_nulls([1.0, None, 3]), [1, np.nan, 3], equal_nan=True)
    assert without_nulls(["a", None]) == ["a", ""]
    assert without_nulls([None])[0] != without_nulls([None])[0]


def test_parquet_has_no_answer(data, exported):
    folder = exported("parquet", channels=None)
    table = pq.read_table(folder / "train-00000.parquet")
    assert set(table.column_names) == {"run_id", "machine_id", "split", "once_per_rev_s", *data.inputs}
    assert "contact_force" not in table.column_names
    assert np.array_equal(table["casing_acc_90"][1].as_py(), data.signals(RUN)["casing_acc_90"])
    assert table.schema.field("casing_acc_90").metadata[b"unit"] == b"m/s2"
    assert not (folder / "runs.csv").exists()
