import os
from dataclasses import replace

import duckdb
import numpy as np
import polars as pl
import pyarrow.parquet as pq
import pytest

from rubgen.errors import UserError
from rubgen.io.parquet.read import read_table, row_groups
from rubgen.io.parquet.write import run_table, schema, write_parquet, write_table
from rubgen.labels import MOTION_CLASSES
from rubgen.solver.response import Status
from tests.default_columns import CHANNELS, CLEAN_SIGNALS, SCALARS, SIGNALS

PROMISED = {
    "run_id",
    "machine_id",
    "split",
    "seed",
    "status",
    "rub",
    "contact_duty",
    "contact_zones",
    "motion_blisk",
    "motion_casing",
    "motion",
    "period",
    "has_2fr",
    "contact_force_orders",
    "blisk_x_orders",
    "speed_rpm",
    "clearance_m",
    "ovality_m",
    "disk_support_stiffness_n_per_m",
    "casing_support_stiffness_n_per_m",
    "friction",
    "lobes",
    "unbalance_kg_m",
    "casing_thickness_m",
    "lateral_damping",
    "steps_per_turn",
}


@pytest.fixture(scope="module")
def file(rub_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("parquet") / "run.parquet"
    write_parquet(rub_run, path)
    return path


def test_promised_columns_are_there():
    assert {column.name for column in SCALARS} >= PROMISED


def test_columns_have_units_and_meanings_and_one_name_each():
    columns = SCALARS + CLEAN_SIGNALS
    assert len({column.name for column in columns}) == len(columns)
    assert all(column.meaning for column in columns)
    field = schema(signals=True).field("casing_acc_90")
    assert field.metadata[b"unit"] == b"m/s2"


def test_channels_come_back_to_the_bit(rub_run, file):
    table = pq.read_table(file)
    for name, channel in rub_run.recording.channels.items():
        np.testing.assert_array_equal(table[name][0].values.to_numpy(), channel.values)
        assert channel.values.size > 1000
    assert table["once_per_rev_s"][0].as_py() == rub_run.recording.once_per_rev.tolist()
    assert set(CHANNELS) == set(rub_run.recording.channels)


def test_polars_and_duckdb_read_the_same_floats(rub_run, file):
    expected = rub_run.recording.channels["contact_force"].values
    assert expected.max() > 1000
    frame = pl.read_parquet(file)
    np.testing.assert_array_equal(frame["contact_force"][0].to_numpy(), expected)
    ((value,),) = duckdb.read_parquet(str(file)).select("contact_force").fetchall()
    np.testing.assert_array_equal(np.array(value, dtype=np.float32), expected)


def test_labels_and_parameters_stand_in_the_row(rub_run, file):
    row = pq.read_table(file, columns=[column.name for column in SCALARS]).to_pylist()[0]
    assert row["motion_casing"] == MOTION_CLASSES["period-k"] == 1
    assert row["period"] == 3
    assert row["contact_impulse_per_turn_n_s"] == 1.5
    assert row["contact_zone_centres_rad"] == [0.0, np.pi]
    assert row["blisk_x_orders"] == rub_run.labels.orders["blisk_x"].amplitudes.tolist()
    assert (row["speed_rpm"], row["lobes"], row["status"], row["seed"]) == (10000.0, 2, "ok", 1)
    assert row["energy_residual"] == rub_run.response.energy.residual


def test_undefined_labels_are_null(free_run):
    row = run_table(free_run).select([column.name for column in SCALARS]).to_pylist()[0]
    assert row["rub"] is False
    assert row["contact_zones_symmetric"] is None
    assert row["contact_force_even_share"] is None
    assert row["contact_zone_centres_rad"] == []


def test_failed_run_has_its_reason_and_nothing_else(rub_run):
    response = replace(rub_run.response, status=Status.DIVERGED, reason="turn 12")
    failed = replace(rub_run, response=response, recording=None, labels=None)
    row = run_table(failed).to_pylist()[0]
    assert (row["status"], row["reason"]) == ("diverged", "turn 12")
    assert {row[column.name] for column in SCALARS if column.nullable} == {None}
    assert {row[column.name] for column in SIGNALS} == {None}
    assert row["speed_rpm"] == 10000.0


def test_a_label_without_a_column_is_refused(rub_run):
    orders = rub_run.labels.orders
    labels = replace(rub_run.labels, orders=orders | {"new_tap": orders["blisk_x"]})
    with pytest.raises(ValueError, match="no column for new_tap"):
        run_table(replace(rub_run, labels=labels))


def test_clean_channels_are_columns_of_their_own(make_synthetic_run):
    run = make_synthetic_run(keep_clean=True)
    table = run_table(run)
    assert table.column_names == [column.name for column in SCALARS + CLEAN_SIGNALS]
    clean = table["proximity_x_clean"][0].values.to_numpy()
    np.testing.assert_array_equal(clean, run.recording.channels["proximity_x"].clean)
    assert np.any(clean != table["proximity_x"][0].values.to_numpy())


def test_same_run_same_bytes(rub_run, file, tmp_path):
    write_parquet(rub_run, tmp_path / "again.parquet")
    assert (tmp_path / "again.parquet").read_bytes() == file.read_bytes()


def test_encodings_are_those_that_were_measured(file):
    group = pq.ParquetFile(file).metadata.row_group(0)
    columns = {group.column(i).path_in_schema: group.column(i) for i in range(group.num_columns)}
    assert {column.compression for column in columns.values()} == {"ZSTD"}
    assert "RLE_DICTIONARY" in columns["proximity_x.list.element"].encodings
    assert not any("BYTE_STREAM_SPLIT" in column.encodings for column in columns.values())
    assert "RLE_DICTIONARY" in columns["machine_id"].encodings
    assert not any("DICTIONARY" in e for name in columns if "orders" in name for e in columns[name].encodings)


def test_other_readers_need_no_new_encoding_for_runs_and_find_pages_by_an_index(rub_run, tmp_path):
    table = run_table(rub_run, signals=False)
    write_table([table], table.schema, tmp_path / "runs.parquet")
    group = pq.ParquetFile(tmp_path / "runs.parquet").metadata.row_group(0)
    columns = [group.column(place) for place in range(group.num_columns)]
    assert not any("BYTE_STREAM_SPLIT" in column.encodings for column in columns)
    assert all(column.has_offset_index for column in columns)


def test_a_flipped_bit_is_found(file, tmp_path):
    start = pq.ParquetFile(file).metadata.row_group(0).column(len(SCALARS) + 3).data_page_offset
    content = bytearray(file.read_bytes())
    content[start + 2000] ^= 1
    path = tmp_path / "bad.parquet"
    path.write_bytes(content)
    with pytest.raises(UserError, match=r"bad\.parquet: damaged or no Parquet file"):
        read_table(path)
    with pytest.raises(UserError, match=r"bad\.parquet: damaged or no Parquet file"):
        list(row_groups(path))


@pytest.mark.parametrize("content", [b"", b"PAR1", b"no parquet at all, but long enough to look"])
def test_no_parquet_is_refused_in_one_line(content, tmp_path):
    path = tmp_path / "x.parquet"
    path.write_bytes(content)
    with pytest.raises(UserError) as caught:
        read_table(path)
    assert "\n" not in str(caught.value)


def test_nothing_is_left_where_writing_fails(rub_run, tmp_path):
    def tables():
        yield run_table(rub_run)
        raise OSError(28, "No space left on device")

    path = tmp_path / "x.parquet"
    with pytest.raises(OSError, match="No space left"):
        write_table(tables(), schema(signals=True), path)
    assert list(tmp_path.iterdir()) == []


def test_a_name_that_is_no_utf8_is_written_and_read(rub_run, tmp_path):
    path = tmp_path / os.fsdecode(b"\xff run.parquet")
    write_parquet(rub_run, path)
    assert read_table(path, ["status"])["status"].to_pylist() == ["ok"]
