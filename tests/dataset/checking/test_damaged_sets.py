"""Tables of a set that are well-formed and wrong: one line that names file and run, from every way of looking."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.dataset.checking.relabel import relabel
from rubgen.dataset.reading.replaying import find_replay, find_runs
from rubgen.errors import UserError
from rubgen.io.parquet.write import write_table
from rubgen.report.figures import Choice, make_figure
from rubgen.report.page import render_report

SECTIONS = "sections/train-00000.parquet"


def rewritten(path, column, value, row=1):
    table = pq.read_table(path)
    rows = table.to_pylist()
    rows[row][column] = value(rows[row][column]) if callable(value) else value
    write_table([pa.Table.from_pylist(rows, table.schema)], table.schema, path)


def looks(directory):
    """Every way of looking at a set."""
    yield lambda: rubgen.open(directory).runs
    yield lambda: find_replay(directory)
    yield lambda: find_replay(directory, "run-000001")
    yield lambda: render_report(directory)
    yield lambda: make_figure("overview", directory, Choice())


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        ("motion", 17, r"runs\.parquet: run-000001: motion = 'class 17'"),
        ("motion", None, r"runs\.parquet: run-000001: motion = None"),
        ("rub", None, r"runs\.parquet: run-000001: rub = None"),
        ("blades_touched", None, r"runs\.parquet: run-000001: blades_touched = None"),
        ("contact_impulse_per_turn_n_s", float("nan"), r"run-000001: contact_impulse_per_turn_n_s = nan"),
        ("run_id", "../../x", r"runs\.parquet: its runs are not the 4 of the manifest"),
        ("run_id", None, r"runs\.parquet: its runs are not the 4"),
        ("status", "fine", r"runs\.parquet: its status counts"),
    ],
)
def test_wrong_rows_are_named(column, value, message, copied_set):
    rewritten(copied_set / "runs.parquet", column, value)
    for look in looks(copied_set):
        with pytest.raises(UserError, match=message) as caught:
            look()
        assert "\n" not in str(caught.value)


def test_a_damaged_table_is_named_whatever_is_asked(copied_set):
    path = copied_set / "runs.parquet"
    group = pq.read_metadata(path).row_group(0)
    (rub,) = (each for each in map(group.column, range(group.num_columns)) if each.path_in_schema == "rub")
    content = bytearray(path.read_bytes())
    content[rub.data_page_offset + rub.total_compressed_size - 1] ^= 1  # within the page's values
    path.write_bytes(content)
    for look in looks(copied_set):
        with pytest.raises(UserError, match=r"runs\.parquet: damaged"):
            look()
    with pytest.raises(UserError, match=r"runs\.parquet: damaged"):
        find_replay(copied_set, where="rub")


def test_a_condition_sees_the_runs_and_no_file(small_set, tmp_path):
    secret = tmp_path / "secret.csv"
    secret.write_text("a\n1\n")
    data = rubgen.open(small_set.directory)
    for where in (
        f"EXISTS (SELECT 1 FROM read_csv('{secret}'))",  # noqa: S608
        f"TRUE); COPY (SELECT 1) TO '{tmp_path / 'written'}'; SELECT (TRUE",
        "TRUE); SET enable_external_access = true; SELECT (TRUE",
    ):
        with pytest.raises(UserError, match="--where"):
            find_runs(data, where)
    assert [path.name for path in tmp_path.iterdir()] == ["secret.csv"]
    assert len(find_runs(data, "rub OR NOT rub")) == 4


@pytest.mark.parametrize(
    ("column", "value", "message"),
    [
        ("scalars", [1.0], "run-000001: scalars has 1 of 9 numbers"),
        ("scalars", lambda old: [*old[:5], 1e300, *old[6:]], "run-000001: n_blades is 1e\\+300, no count"),
        ("scalars", lambda old: [*old[:4], 109.5, *old[5:]], "run-000001: record_turns is 109.5, no count"),
        ("scalars", lambda old: [old[0], float("nan"), *old[2:]], "run-000001: dt is nan"),
        ("section", lambda old: old[:-1], "run-000001: section has [0-9]+ numbers, in rows of [0-9]+"),
        ("section", lambda old: [float("inf"), *old[1:]], "run-000001: section is not finite"),
        ("turn_impulse", lambda old: old[1:], "run-000001: turn_impulse has 109 of 110 turns"),
        ("turn_impulse", lambda old: [float("nan"), *old[1:]], "run-000001: turn_impulse is not finite"),
        ("blade", lambda old: [*old, 1], "run-000001: lists of touches differ"),
        ("rotation", [1.0], "run-000001: rotation and turn_steps do not fit"),
    ],
)
def test_sections_that_do_not_fit_are_named(column, value, message, copied_set):
    rewritten(copied_set / SECTIONS, column, value)
    with pytest.raises(UserError, match=rf"{SECTIONS}: .*({message})") as caught:
        relabel(copied_set)
    assert "\n" not in str(caught.value)


def test_a_whole_set_passes(small_set):
    assert relabel(small_set.directory).differences == ()
    assert np.isfinite(rubgen.open(small_set.directory).ok["contact_duty"]).all()
