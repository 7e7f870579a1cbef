"""Labels made again from what is kept of each run: equal, and found where they are not."""

import json

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from test_verify import reseal

import rubgen
from rubgen.cli import main
from rubgen.dataset.checking.relabel import equal, relabel
from rubgen.errors import UserError
from rubgen.io.columns import scalar_columns
from rubgen.io.parquet.compact_records import SCHEMA
from rubgen.io.parquet.write import write_table
from rubgen.labels.to_json import FROM_TAPS
from rubgen.sensors.load import default_sensor_set

SECTIONS = "sections/train-00000.parquet"


def run_command(*arguments):
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    return ended.value.code


def change(directory, name, change_row):
    """Change the rows of a Parquet file in place."""
    table = pq.read_table(directory / name)
    rows = [change_row(row) for row in table.to_pylist()]
    write_table([pa.Table.from_pylist(rows, table.schema)], table.schema, directory / name)


def test_all_labels_but_orders_come_back(small_set):
    done = relabel(small_set.directory)
    assert done.differences == ()
    assert done.runs == 4
    names = [column.name for column in scalar_columns(default_sensor_set())]
    first, last = names.index("rub"), names.index("window_motion_confidence")
    assert done.labels == 4 * len([name for name in names[first : last + 1] if name not in FROM_TAPS])


def test_a_changed_label_is_found(copied_set, capsys):
    change(copied_set, "runs.parquet", lambda row: row | {"blades_touched": row["blades_touched"] + 1})
    assert run_command("label", str(copied_set), "--json") == 1
    printed = json.loads(capsys.readouterr().out)
    assert [each["label"] for each in printed["differences"]] == ["blades_touched"] * 4
    assert printed["differences"][0]["stands"] == printed["differences"][0]["again"] + 1


def test_a_changed_section_changes_labels(copied_set):
    change(copied_set, SECTIONS, lambda row: row | {"impulse": [2 * value for value in row["impulse"]]})
    changed = {each.label for each in relabel(copied_set).differences}
    assert changed == {"blade_impulses_per_turn_n_s"}


def test_the_command_says_what_it_did_and_changes_nothing(small_set, capsys):
    before = {path: path.stat().st_mtime_ns for path in small_set.directory.rglob("*")}
    assert run_command("label", str(small_set.directory)) == 0
    assert "labels of 4 runs made again, all as in runs.parquet; labels of orders left out" in capsys.readouterr().out
    assert before == {path: path.stat().st_mtime_ns for path in small_set.directory.rglob("*")}


@pytest.mark.parametrize("name", ["blade", "scalars", "contact_steps"])
def test_a_null_list_is_named(copied_set, name):
    change(copied_set, SECTIONS, lambda row: row | {name: None})
    with pytest.raises(UserError, match=rf"{SECTIONS}: run-00000\d: {name} is null"):
        relabel(copied_set)


def test_lost_sections_are_named(copied_set):
    (copied_set / SECTIONS).unlink()
    with pytest.raises(UserError, match=rf"{SECTIONS}: cannot be read \(No such file"):
        relabel(copied_set)


def test_sections_are_those_of_the_manifest(copied_set):
    (copied_set / "sections/._train-00000.parquet").write_bytes(b"of a file server")
    (copied_set / "sections/old.parquet").write_bytes(b"stray")
    assert relabel(copied_set).differences == ()


def test_a_set_without_sections_is_said_so(copied_set):
    path = copied_set / "manifest.json"
    manifest = json.loads(path.read_text())
    manifest["files"] = [entry for entry in manifest["files"] if entry["path"] != SECTIONS]
    path.write_text(json.dumps(manifest))
    reseal(copied_set)
    with pytest.raises(UserError, match="no sections/ to make labels from; generate the set again"):
        relabel(copied_set)


def test_verify_holds_sections_to_the_runs(copied_set):
    table = pq.read_table(copied_set / SECTIONS)
    assert table.schema.equals(SCHEMA)
    write_table([table.slice(1)], SCHEMA, copied_set / SECTIONS)
    assert any(problem.startswith(f"{SECTIONS}: has ") for problem in rubgen.verify(copied_set))
    reseal(copied_set)
    assert rubgen.verify(copied_set) == ["run-000000: is ok, but has no row in sections"]
    with pytest.raises(UserError, match=r"sections/ and runs\.parquet differ at run-000000; check it: rubgen verify"):
        relabel(copied_set)


def test_rounding_is_no_difference():
    assert equal([1.0, None, "a"], [1.0 + 1e-12, None, "a"])
    assert not equal([1.0], [1.0 + 1e-6])
    assert not equal([1.0], [1.0, 2.0])
    assert not equal(None, 0.0)
