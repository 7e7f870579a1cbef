"""`rubgen repair`: what is derived comes back, what is data stays, and what cannot be made again is said."""

import json
import os
import shutil

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.cli import main
from rubgen.dataset.checking.repair import repair
from rubgen.io.parquet.write import write_table

DATA = "signals/train-00000.parquet"


def run_command(*arguments):
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    return ended.value.code


def contents(directory):
    return {
        path.relative_to(directory).as_posix(): path.read_bytes() for path in directory.rglob("*") if path.is_file()
    }


@pytest.mark.parametrize("name", ["README.md", "croissant.json", "derived.json"])
@pytest.mark.parametrize("loss", ["edited", "lost", "flipped", "pipe"])
def test_texts_come_back_to_the_same_bytes(name, loss, shown_set, copied_shown_set):
    path = copied_shown_set / name
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    if loss in ("lost", "pipe"):
        path.unlink()
    if loss == "pipe":
        os.mkfifo(path)
    if loss in ("edited", "flipped"):
        path.write_bytes(b"edited" if loss == "edited" else content)
    assert rubgen.verify(copied_shown_set) != []
    done = repair(copied_shown_set)
    assert done.left == ()
    assert name in done.made
    assert rubgen.verify(copied_shown_set) == []
    if name != "derived.json":  # then nothing proves the recordings, and they are made again too
        assert contents(copied_shown_set) == contents(shown_set)


@pytest.mark.parametrize("with_mcap", [True, False])
def test_a_recording_comes_back(with_mcap, shown_set, copied_shown_set, short_records):
    path = copied_shown_set / "rrd/0000/run-000001.rrd"
    path.write_bytes(path.read_bytes()[:-100])
    if not with_mcap:
        (copied_shown_set / "mcap/0000/run-000001.mcap").unlink()
    done = repair(copied_shown_set)
    own = () if with_mcap else ("mcap/0000/run-000001.mcap",)
    assert done.made == (*own, "rrd/0000/run-000001.rrd", "derived.json")
    assert done.left == ()
    before, after = contents(shown_set), contents(copied_shown_set)
    assert {name for name in after if after[name] != before[name]} <= set(done.made)


def test_a_whole_folder_of_recordings_comes_back(copied_shown_set):
    shutil.rmtree(copied_shown_set / "rrd")
    assert repair(copied_shown_set).left == ()


def test_a_damaged_recording_of_other_versions_gets_no_new_digest(copied_shown_set, monkeypatch):
    path = copied_shown_set / "rrd/0000/run-000001.rrd"
    path.write_bytes(b"damaged")
    (copied_shown_set / "mcap/0000/run-000001.mcap").unlink()
    monkeypatch.setattr("rubgen.dataset.manifest.version", lambda _name: "9.9")
    done = repair(copied_shown_set)
    assert done.made == ()
    assert any(finding.text.startswith("rrd/0000/run-000001.rrd: has 7 bytes") for finding in done.left)


@pytest.mark.parametrize("lost", [(DATA, "mcap/0000/run-000000.mcap"), ("sections/train-00000.parquet",)])
def test_a_damaged_shard_comes_back_to_the_bit(lost, small_set, copied_set, short_records, capsys):
    for name in lost:
        (copied_set / name).write_bytes((copied_set / name).read_bytes()[:-9])
    assert run_command("repair", str(copied_set)) == 0
    assert {f"{name}: made again" for name in lost} <= set(capsys.readouterr().out.splitlines())
    assert contents(copied_set) == contents(small_set.directory)


def test_a_run_is_made_again_and_compared(small_set, copied_set, short_records, monkeypatch, tmp_path, capsys):
    out = tmp_path / "run.mcap"
    assert run_command("regenerate", str(copied_set), "run-000001", "--out", str(out)) == 0
    assert capsys.readouterr().out == "run-000001: equal to the bit\n"
    assert out.read_bytes() == (small_set.directory / "mcap/0000/run-000001.mcap").read_bytes()
    table = pq.read_table(copied_set / "runs.parquet")
    duty = table["contact_duty"].to_pylist()
    duty[1] += 1e-9
    place = table.column_names.index("contact_duty")
    changed = table.set_column(place, table.schema.field(place), pa.array(duty))
    write_table([changed], changed.schema, copied_set / "runs.parquet")
    assert run_command("regenerate", str(copied_set), "run-000001") == 1
    assert capsys.readouterr().out.startswith("run-000001: runs: other bits in contact_duty\n")
    monkeypatch.setattr("rubgen.dataset.manifest.version", lambda _name: "9.9")
    assert run_command("regenerate", str(copied_set), "run-000001", "--json") == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["same"], told["moved"], told["versions"]["numpy"][1]) == (False, [], "9.9")


@pytest.mark.parametrize("run_id", ["run-000004", "run-4", "4", "", "run-a1000000"])
def test_a_run_that_is_not_there_is_one_line(run_id, small_set, capsys):
    assert run_command("regenerate", str(small_set.directory), run_id) == 2
    assert f"no run '{run_id}'; give run-000000 to run-000003" in capsys.readouterr().err


def test_data_of_other_versions_and_strays_are_left_as_they_are(copied_shown_set, capsys, monkeypatch):
    monkeypatch.setattr("rubgen.dataset.manifest.version", lambda _name: "9.9")
    (copied_shown_set / DATA).write_bytes(b"damaged")
    (copied_shown_set / "mine.txt").write_text("mine")
    (copied_shown_set / "README.md").unlink()
    assert run_command("repair", str(copied_shown_set), "--json") == 1
    printed = json.loads(capsys.readouterr().out)
    assert printed["made"] == ["README.md"]
    assert "make the set again in a new directory" in printed["advice"]
    assert "delete" not in printed["advice"]
    assert (copied_shown_set / DATA).read_bytes() == b"damaged"
    assert (copied_shown_set / "mine.txt").read_text() == "mine"


def test_a_whole_set_is_not_touched(shown_set, capsys):
    before = {path: path.stat().st_mtime_ns for path in shown_set.rglob("*")}
    assert run_command("repair", str(shown_set)) == 0
    assert capsys.readouterr().out == f"{shown_set}: nothing wrong\n"
    assert before == {path: path.stat().st_mtime_ns for path in shown_set.rglob("*")}


def test_the_command_line_says_what_it_made(copied_shown_set, capsys):
    (copied_shown_set / "croissant.json").unlink()
    assert run_command("verify", str(copied_shown_set)) == 1
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "croissant.json: listed in the manifest, but not there"
    assert told[-1].startswith("the data files are whole; ")
    assert told[-1].endswith(f"rubgen repair {copied_shown_set}")
    assert run_command("repair", str(copied_shown_set)) == 0
    assert capsys.readouterr().out == f"croissant.json: made again\n{copied_shown_set}: nothing wrong\n"
