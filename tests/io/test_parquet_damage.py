"""Damaged, foreign and hostile Parquet files: a correct table, or one line that names the file."""

import errno
import os

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from mutations import mutated

from rubgen.errors import UserError
from rubgen.io.parquet.read import ParquetSource, damage_named, read_table, row_groups
from rubgen.io.parquet.write import run_table, write_table

WORD, MANY = "x" * 1_000_000, 40_000_000


@pytest.fixture(scope="module")
def file(rub_run, tmp_path_factory):
    table = run_table(rub_run)
    path = tmp_path_factory.mktemp("parquet") / "run.parquet"
    write_table([table, table], table.schema, path)
    return path


def refusal(path, columns=None):
    """The one line with which the file is refused."""
    with pytest.raises(UserError) as caught:
        read_table(path, columns)
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    assert len(text) < 500
    return text


@pytest.mark.parametrize("seed", range(150))
def test_a_mutated_file_is_read_or_named(seed, file, tmp_path):
    """What the footer says about text statistics or encodings may change unseen; the values may not."""
    path = tmp_path / "mutated.parquet"
    path.write_bytes(mutated(file.read_bytes(), np.random.default_rng(seed)))
    try:
        table = read_table(path)
    except UserError:
        refusal(path)
        return
    table.to_pylist()
    table.to_pandas()
    whole = read_table(file)
    same = [name for name in table.schema.names if name in whole.schema.names]
    assert all(table[name].equals(whole[name]) for name in same if table.num_rows == whole.num_rows)


def test_every_way_of_reading_names_the_file(file, tmp_path):
    content = bytearray(file.read_bytes())
    group = pq.ParquetFile(file).metadata.row_group(1)
    column = next(group.column(i) for i in range(group.num_columns) if "proximity_x" in group.column(i).path_in_schema)
    content[column.data_page_offset + column.total_compressed_size // 2] ^= 1
    path = tmp_path / "bad.parquet"
    path.write_bytes(content)
    refusal(path)
    with pytest.raises(UserError, match=r"bad\.parquet: damaged"):
        list(row_groups(path))
    with ParquetSource(path) as source:
        name = "".join(column.path_in_schema.split(".")[:1])
        source.read_row_group(0)
        assert source.read_row_group(1, ["run_id"]).num_rows == 1
        with pytest.raises(UserError, match=r"bad\.parquet: damaged"):
            source.read_row_group(1, [name])
        with pytest.raises(IndexError):  # a mistake of ours is not called damage
            source.read_row_group(2)


def test_a_column_that_is_missing_is_named(file):
    assert "has no column 'speed'" in refusal(file, ["run_id", "speed"])


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (pa.table({"a": [{"b": 1}]}), "column 'a' is struct"),
        (pa.table({"a": [[["x"]]]}), "column 'a' is list<.*list<.*string"),
        (pa.table({"a": [b"x"]}), "column 'a' is binary"),
        (pa.Table.from_arrays([pa.array([1]), pa.array([2])], ["a", "a"]), "two columns share a name"),
    ],
)
def test_a_table_of_somebody_else_is_named(table, message, tmp_path):
    pq.write_table(table, tmp_path / "other.parquet")
    with pytest.raises(UserError, match=message):
        read_table(tmp_path / "other.parquet")


def test_what_pandas_notes_in_a_file_is_not_followed(tmp_path):
    path = tmp_path / "pandas.parquet"
    pq.write_table(pa.table({"run_id": ["a"]}).replace_schema_metadata({"pandas": "no JSON"}), path)
    assert read_table(path).to_pandas()["run_id"].tolist() == ["a"]


def test_text_that_is_no_utf_8_is_named(tmp_path):
    path = tmp_path / "text.parquet"
    text = pa.array([b"run-\xff\xfe", b"b"]).view(pa.string())
    pq.write_table(pa.table({"run_id": text}), path)
    assert "UTF8" in refusal(path).upper()


def words_of(numbers):
    return pa.DictionaryArray.from_arrays(numbers, [WORD])


@pytest.mark.parametrize(
    ("column", "use_dictionary"),
    [
        (lambda: pa.array(np.zeros(MANY)), False),
        (lambda: pa.array(np.zeros(MANY)), True),
        (lambda: pa.nulls(MANY, pa.int64()), False),
        (lambda: words_of(np.zeros(100_000, np.int32)), True),
        (lambda: pa.ListArray.from_arrays(np.arange(100_001), words_of(np.zeros(100_000, np.int32))), True),
        (lambda: pa.ListArray.from_arrays([0, 2 * MANY], pa.array(np.zeros(2 * MANY, np.float32))), False),
    ],
    ids=["zstd", "runs of an index", "nulls", "a long word", "lists of a long word", "a long list"],
)
def test_a_small_file_that_unpacks_to_gigabytes_is_refused(column, use_dictionary, tmp_path):
    path = tmp_path / "bomb.parquet"
    pq.write_table(
        pa.table({"a": column()}), path, compression="zstd", use_dictionary=use_dictionary, row_group_size=10**9,
        store_schema=False,
    )  # fmt: skip
    assert path.stat().st_size < 300_000
    before = pa.default_memory_pool().max_memory() or 0
    assert "would unpack to" in refusal(path)
    assert (pa.default_memory_pool().max_memory() or 0) - before < 100_000_000


def test_pipes_folders_and_devices_are_not_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    assert "is a pipe" in refusal(tmp_path / "pipe")
    assert "is a folder" in refusal(tmp_path)
    with pytest.raises(UserError, match="/dev/zero: is a pipe, a socket or a device"):
        read_table(type(tmp_path)("/dev/zero"))
    with pytest.raises(UserError, match="cannot be read"):
        read_table(tmp_path / "a\0b")
    assert "No such file" in refusal(tmp_path / "none.parquet")


@pytest.mark.parametrize("wrong", [TypeError, ValueError, LookupError, OverflowError, AttributeError])
def test_a_bug_is_not_called_damage(wrong):
    with pytest.raises(wrong), damage_named("run.parquet"):
        raise wrong


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (OSError(errno.EMFILE, "of pyarrow"), "run.parquet: cannot be read (Too many open files)"),
        (pa.ArrowMemoryError("malloc of size 8 failed"), "run.parquet: cannot be read (malloc of size 8 failed)"),
        (OSError("Couldn't deserialize"), "run.parquet: damaged or no Parquet file of rubgen (Couldn't deserialize)"),
    ],
)
def test_what_the_system_refuses_is_not_called_damage(error, message):
    with pytest.raises(UserError) as caught, damage_named("run.parquet"):
        raise error
    assert str(caught.value).startswith(message)


def test_a_name_of_a_column_that_is_no_utf_8_is_damage(tmp_path):
    path = tmp_path / "names.parquet"
    pq.write_table(pa.table({"run_id": ["a"]}), path, store_schema=False)
    path.write_bytes(path.read_bytes().replace(b"run_id", b"run\xff\xfed"))
    assert "damaged or no Parquet file" in refusal(path)
