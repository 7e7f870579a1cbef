"""A data set in a notebook: what pandas does with its runs, what is read of it, how it shows itself."""

import json
from hashlib import sha256
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.dataset.reading.stored_run import StoredRun
from rubgen.dataset.reading.tables import runs_frame, touches_frame
from rubgen.errors import UserError
from rubgen.io.mcap import read_mcap
from rubgen.io.parquet.compact_records import TOUCH_COLUMNS, read_touches
from rubgen.io.parquet.read import read_table
from rubgen.io.parquet.words import with_words
from rubgen.io.parquet.write import schema
from rubgen.scenario import Sensing
from rubgen.sensors.load import default_sensor_set
from tests.default_columns import CHANNELS, SCALARS
from tests.whole_table import whole_table

DATA = "signals/train-00000.parquet"


@pytest.fixture(scope="module")
def data(small_set):
    return rubgen.open(small_set.directory)


@pytest.fixture(scope="module")
def with_a_failed_run(small_set):
    """The table of runs in which run 2 failed: nothing that may be null is left of it."""
    table = read_table(small_set.directory / "runs.parquet")
    nullable = [column.name for column in SCALARS if column.nullable]
    rows = table.to_pylist()
    rows[2] |= dict.fromkeys(nullable) | {"status": "diverged", "reason": "in turn 3"}
    return runs_frame(with_words(pa.Table.from_pylist(rows, schema=schema(signals=False))), default_sensor_set())


def test_run_id_has_one_home(data):
    runs = data.runs
    assert runs.index.name == "run_id"
    assert "run_id" not in runs
    assert runs.reset_index()["run_id"].tolist() == list(data) == [f"run-{index:06d}" for index in range(4)]
    assert runs.groupby("run_id")["speed_rpm"].mean().shape == (4,)
    mine = pd.DataFrame({"run_id": list(data), "score": [3, 1, 2, 0]})
    assert runs.merge(mine, on="run_id")["score"].tolist() == [3, 1, 2, 0]
    assert runs.join(mine.set_index("run_id"))["score"].tolist() == [3, 1, 2, 0]
    assert runs.sort_values("run_id", ascending=False).index[0] == "run-000003"
    assert runs.query("run_id == 'run-000001'").index.tolist() == ["run-000001"]
    assert runs.loc["run-000001", "status"] == "ok"


def test_a_flag_selects_runs_though_some_failed(with_a_failed_run):
    runs = with_a_failed_run
    assert set(runs[runs.rub].index) | set(runs[~runs.rub].index) == {"run-000000", "run-000001", "run-000003"}
    assert runs.query("rub").index.tolist() == runs[runs.rub].index.tolist()
    assert runs.loc["run-000002", "rub"] is pd.NA


def test_what_is_missing_leaves_the_type_of_a_column_alone(with_a_failed_run, data):
    kinds = {"flag": "boolean", "integer": "Int64", "text": "string", "class": "string", "number": "float64"}
    for runs in (with_a_failed_run, data.runs):
        for column in SCALARS[1:]:
            assert runs[column.name].dtype == kinds.get(column.kind, "object"), column.name
    assert with_a_failed_run["period"].dropna().map(type).eq(int).all()
    assert np.isnan(with_a_failed_run.loc["run-000002", "contact_duty"])
    assert isinstance(data.runs.loc["run-000000", "casing_acc_0_orders"], np.ndarray)


def test_units_and_meanings_go_with_the_frame(data, tmp_path):
    runs = data.runs
    for attrs in (runs.attrs, runs[runs["rub"]].attrs, pd.concat([runs, runs]).attrs):
        assert attrs["units"] == {column.name: column.unit for column in SCALARS[1:]}
        assert attrs["meanings"]["clearance_m"] == "smallest gap between blade tips and casing at rest"
    runs.to_parquet(tmp_path / "runs.parquet")
    assert pd.read_parquet(tmp_path / "runs.parquet").index.tolist() == list(data)


def test_ok_are_the_good_runs(small_set, with_a_failed_run, monkeypatch):
    data = rubgen.open(small_set.directory)
    monkeypatch.setattr("rubgen.dataset.reading.open.DataSet.runs", with_a_failed_run)
    assert data.ok.index.tolist() == ["run-000000", "run-000001", "run-000003"]


def test_a_set_is_counted_walked_and_asked(data):
    assert len(data) == 4
    assert [data[run_id].run_id for run_id in data] == data.runs.index.tolist()
    assert "run-000003" in data
    assert "run-000004" not in data
    assert (data.channels, data.sample_rate_hz) == (CHANNELS, 25600.0)


def test_a_run_of_a_set_holds_plain_values(data, small_set):
    run = data["run-000001"]
    labels = read_mcap(small_set.directory / "mcap/0000/run-000001.mcap").labels
    assert {name: run.labels[name] for name in labels} == labels
    assert run.parameters["disk_support_stiffness_n_per_m"] == 2e8
    assert set(run.parameters) & set(run.labels) == set()
    np.testing.assert_array_equal(
        run.signals(["contact_force"])["contact_force"], data.signals(run.run_id)["contact_force"]
    )
    assert run.touches().equals(data.touches(run.run_id))


def test_only_what_is_asked_is_decoded(data, monkeypatch):
    asked = []
    monkeypatch.setattr("rubgen.io.parquet.read.ParquetSource.read_row_group", spy(asked))
    signals = data.signals("run-000002", ["casing_acc_90", "proximity_x"])
    assert list(signals) == ["casing_acc_90", "proximity_x"]
    assert [set(columns) for columns in asked if columns != ["run_id"]] == [
        {"casing_acc_90", "proximity_x", "once_per_rev_s"}
    ]


def spy(asked):
    from rubgen.io.parquet.read import ParquetSource

    read = ParquetSource.read_row_group

    def reading(self, group, columns=None):
        asked.append(columns)
        return read(self, group, columns)

    return reading


def test_only_what_is_asked_is_decoded_from_mcap(without_parquet, data, monkeypatch):
    seen = []
    from rubgen.io.mcap import read as mcap_read

    decode = mcap_read.read_sample_block
    monkeypatch.setattr(mcap_read, "read_sample_block", lambda block: seen.append(decode(block)) or seen[-1])
    signals = rubgen.open(without_parquet).signals("run-000001", ["contact_force"])
    assert list(signals) == ["contact_force"]
    np.testing.assert_array_equal(signals["contact_force"], data.signals("run-000001")["contact_force"])
    blocks = -(-signals["contact_force"].size // 1024)
    assert blocks <= len(seen) <= 2 * blocks


@pytest.fixture
def without_parquet(copied_set):
    """The same set as one of MCAP files alone: its manifest lists no data."""
    path = copied_set / "manifest.json"
    manifest = json.loads(path.read_text())
    manifest["files"] = [entry for entry in manifest["files"] if not entry["path"].startswith(("signals/", "truth/"))]
    path.write_text(json.dumps(manifest))
    (copied_set / "manifest.json.sha256").write_text(f"{sha256(path.read_bytes()).hexdigest()}  manifest.json\n")
    return copied_set


def test_a_set_is_what_its_manifest_lists(without_parquet, copied_set):
    """Files that nobody listed lie in both folders: neither is read."""
    (copied_set / "signals/train-00001.parquet").write_bytes(b"foreign")
    (copied_set / "sections/._x.parquet").write_bytes(b"foreign")
    opened = rubgen.open(without_parquet)
    assert opened.signals("run-000001")["contact_force"].size == 15872
    assert len(opened.touches("run-000001").columns) == 7


def test_touches_are_those_beside_the_signals(data, small_set):
    """The data file holds the touches that overlap the signals, in the same time."""
    rubbing = data.ok[data.ok["rub"]].index[0]
    touches = data.touches(rubbing)
    assert touches["start_s"].is_monotonic_increasing
    assert touches.attrs["units"]["impulse_n_s"] == "N s"
    rows = whole_table(small_set.directory).to_pylist()
    (row,) = [row for row in rows if row["run_id"] == rubbing]
    within = touches[(touches["end_s"] > 0) & (touches["start_s"] < 0.62)]
    assert len(within) > 10
    for name, kept in {"start_s": "touch_start_s", "end_s": "touch_end_s", "blade": "touch_blade"}.items():
        np.testing.assert_allclose(within[name], row[kept], rtol=0, atol=1e-12)
    for name, kept in {"impulse_n_s": "touch_impulse_n_s", "friction_work_j": "touch_friction_work_j"}.items():
        np.testing.assert_allclose(within[name], row[kept], rtol=1e-6)
    touched = data.row(rubbing)["blades_touched"]
    assert touches["blade"].nunique() == touched


def test_touches_are_read_where_a_fault_grows(small_set):
    """The record of such a run has one number more."""
    (path,) = sorted((small_set.directory / "sections").glob("*.parquet"))
    row = pq.read_table(path, columns=["run_id", *TOUCH_COLUMNS]).slice(0, 1)
    at = row.schema.get_field_index("scalars")
    grows = row.set_column(
        at, row.schema.field(at), pa.array([[*row["scalars"][0].as_py(), 1.0]], row.schema.types[at])
    )
    frames = [touches_frame(read_touches(each, 0, path), Sensing(), 0.62) for each in (row, grows)]
    assert frames[1].equals(frames[0])


def test_a_damaged_page_is_one_line_that_names_file_and_run(copied_set):
    path = copied_set / DATA
    content = bytearray(path.read_bytes())
    middle = len(content) // 2
    content[middle - 2000 : middle + 2000] = bytes(4000)
    path.write_bytes(content)
    opened = rubgen.open(copied_set)
    messages = []
    for run_id in opened:
        with pytest.raises(UserError) as caught:
            opened.signals(run_id)
        messages.append(str(caught.value))
    for run_id, message in zip(opened, messages, strict=True):
        assert message.startswith(f"{run_id}: {path}: ")
        assert "\n" not in message
    messages = []
    for name in opened.channels:
        try:
            list(opened.each_channel(name))
        except UserError as error:
            messages.append(str(error))
    assert messages
    assert all(message.startswith(f"run-000000, run-000001, run-000002, run-000003: {path}: ") for message in messages)


def test_a_missing_or_cut_file_is_one_line(copied_set):
    (copied_set / DATA).unlink()
    with pytest.raises(UserError, match="train-00000"):
        rubgen.open(copied_set).signals("run-000000")
    for name in ("sections/train-00000.parquet", "runs.parquet"):
        path = copied_set / name
        path.write_bytes(path.read_bytes()[:-50])
        with pytest.raises(UserError, match=f"{path.name}: damaged"):
            rubgen.open(copied_set).touches("run-000000")


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda data: data["run-3"], "no run 'run-3'; did you mean run-000003? give one of run-000000, run-000001, "),
        (lambda data: data[2], "no run 2; did you mean run-000002? "),
        (lambda data: data.signals("first"), "no run 'first'; give one of run-000000, run-000001, run-000002, ..."),
        (lambda data: data.touches(""), "no run ''; give one of"),
        (lambda data: data.signals("run-000000", ["casing_ac_0"]), "'casing_ac_0'; did you mean casing_acc_0? allowed"),
        (lambda data: data.signals("run-000000", "contact_force"), "channels = 'contact_force': give a list of names"),
        (lambda data: list(data.each_channel("force")), "no channel 'force'; did you mean support_force_x? allowed"),
    ],
)
def test_a_mistake_is_one_line_that_says_what_was_meant(data, ask, message):
    with pytest.raises(UserError) as caught:
        ask(data)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_set_and_its_runs_are_shown_short(data):
    assert repr(data) == (f"Data set 'small' in {data.layout.root}: 4 runs (4 ok), 12 channels at 25600 Hz")
    table = data._repr_html_()
    assert "<th>run-000000</th>" in table
    assert "<th>friction</th>" in table
    run = data["run-000000"]
    assert len(repr(run).splitlines()) <= 10
    assert len(repr(run)) < 800
    assert "contact_zones" in repr(run)
    assert "<th>motion</th>" in run._repr_html_()


def test_a_failed_run_is_shown_with_its_reason():
    run = StoredRun(
        run_id="run-000009",
        status="diverged",
        reason="blade <3> in turn 7",
        parameters={},
        labels={},
        data=SimpleNamespace(layout=SimpleNamespace(root="set")),
    )
    assert "diverged: blade <3> in turn 7" in repr(run)
    assert "blade &lt;3&gt; in turn 7" in run._repr_html_()
