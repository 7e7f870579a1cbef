"""`rubgen repair`: what is derived comes back, what is data stays, and what cannot be made again is said."""

import json
import os
import shutil

import pytest

import rubgen
from rubgen.cli import main
from rubgen.dataset.checking.repair import repair

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
    assert done.made == ("rrd/0000/run-000001.rrd", "derived.json")
    left = [finding.text for finding in done.left]
    assert left == ([] if with_mcap else ["mcap/0000/run-000001.mcap: listed in the manifest, but not there"])
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


def test_data_and_strays_are_left_as_they_are(copied_shown_set, capsys):
    (copied_shown_set / DATA).write_bytes(b"damaged")
    (copied_shown_set / "mine.txt").write_text("mine")
    (copied_shown_set / "README.md").unlink()
    assert run_command("repair", str(copied_shown_set), "--json") == 1
    printed = json.loads(capsys.readouterr().out)
    assert printed["made"] == ["README.md"]
    assert "make this set again in a new directory" in printed["advice"]
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
