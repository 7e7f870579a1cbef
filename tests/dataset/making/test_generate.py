import errno
import hashlib
import json
import shutil
from dataclasses import replace

import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.dataset.files import sha256_of
from rubgen.dataset.making import generate as generating
from rubgen.dataset.making.keep import Keeper
from rubgen.dataset.making.outcome import finished_runs
from rubgen.errors import RubgenWarning, UserError
from rubgen.solver.response import Status


@pytest.fixture
def fake_simulate(short_records, make_synthetic_run, monkeypatch):
    """Runs with made-up signals instead of simulated ones, for tests of what happens around them; keeps a list."""
    made = []
    template = make_synthetic_run(seconds=0.1)

    def simulate(scenario):
        made.append(scenario.index)
        return replace(template, scenario=scenario)

    monkeypatch.setattr("rubgen.pipeline.simulate", simulate)
    monkeypatch.setattr(generating, "warm_up", lambda *_: [])
    return made


def before_run(patch, stopped, error):
    """Raise `error` in the worker before it makes run number `stopped`."""
    true = Keeper.begin

    def begin(keeper, index):
        if index == stopped:
            raise error
        true(keeper, index)

    patch.setattr(Keeper, "begin", begin)


def tree(directory):
    """Path and content of every file but the derived ones and their digests."""
    files = [path for path in sorted(directory.rglob("*")) if path.is_file() and path.suffix != ".rrd"]
    files = [path for path in files if path.name != "derived.json"]
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files}


def recipe(**changes):
    return {"name": "fake", "runs": 3, "machine": "zeng2019", "output": {"signal_seconds": 0.1}, **changes}


def test_the_set_has_every_file_and_nothing_else(small_set):
    names = {path.relative_to(small_set.directory).as_posix() for path in small_set.directory.rglob("*.*")}
    exports = {f"mcap/0000/run-{i:06d}.mcap" for i in range(4)}
    assert names == exports | {
        "README.md",
        "croissant.json",
        "signals/train-00000.parquet",
        "manifest.json",
        "manifest.json.sha256",
        "runs.parquet",
        "sections/train-00000.parquet",
        "sensors.parquet",
        "truth/train-00000.parquet",
        "windows/train-00000.parquet",
    }
    assert small_set.made.made == small_set.made.runs == 4
    assert small_set.made.status == {"ok": 4}
    assert not small_set.made.verified


def test_simulated_runs_hold_both_classes_of_rub(small_set):
    runs = rubgen.open(small_set.directory).runs
    assert set(runs["rub"]) == {True, False}
    assert (runs["rub"] == (runs["speed_rpm"] == 10000.0)).all()


def test_manifest_proves_every_file(small_set):
    directory = small_set.directory
    manifest = json.loads((directory / "manifest.json").read_text())
    assert {entry["path"] for entry in manifest["files"]} | {"manifest.json", "manifest.json.sha256"} == set(
        tree(directory)
    )
    for entry in manifest["files"]:
        content = (directory / entry["path"]).read_bytes()
        assert entry["sha256"] == hashlib.sha256(content).hexdigest()
        assert entry["bytes"] == len(content)
    digest = hashlib.sha256((directory / "manifest.json").read_bytes()).hexdigest()
    assert (directory / "manifest.json.sha256").read_text().split() == [digest, "manifest.json"]
    assert {"rubgen", "numpy", "numba", "pyarrow"} <= set(manifest["identity"]["packages"])


def test_a_finished_set_is_left_alone(small_set, fake_simulate):
    before = {path: path.stat().st_mtime_ns for path in small_set.directory.rglob("*")}
    again = rubgen.generate(small_set.recipe, small_set.directory)
    assert (again.made, again.runs, again.status) == (0, 4, {"ok": 4})
    assert again.verified
    assert again.outcome == small_set.made.outcome
    assert sum(again.outcome.motion.values()) == again.outcome.rub + again.outcome.no_rub == 4
    assert fake_simulate == []
    assert {path: path.stat().st_mtime_ns for path in small_set.directory.rglob("*")} == before


def test_an_interrupted_set_is_completed_to_the_same_bytes(fake_simulate, tmp_path, monkeypatch):
    rubgen.generate(recipe(), tmp_path / "whole", workers=1)

    with monkeypatch.context() as patch:
        before_run(patch, 2, KeyboardInterrupt())
        with pytest.raises(KeyboardInterrupt):
            rubgen.generate(recipe(), tmp_path / "parts", workers=1)
    assert finished_runs(tmp_path / "parts") == 2
    assert not (tmp_path / "parts/manifest.json").exists()
    (tmp_path / "parts/mcap/0000/run-000002.part.mcap").write_bytes(b"half-written")
    fake_simulate.clear()
    made = rubgen.generate(recipe(), tmp_path / "parts", workers=1)
    assert (made.made, made.runs, fake_simulate) == (1, 3, [2])
    assert tree(tmp_path / "parts") == tree(tmp_path / "whole")


@pytest.mark.parametrize(
    "names",
    [[".staging/runs/", ".staging.lock"], [".staging.lock"], [".staging.part/runs/"], [".staging.lock.soft"]],
)
def test_what_a_stop_after_the_manifest_leaves_is_no_fault_and_removed(small_set, copied_set, short_records, names):
    for name in names:
        (copied_set / name).parent.mkdir(exist_ok=True)
        (copied_set / name).mkdir() if name.endswith("/") else (copied_set / name).touch()
    assert rubgen.verify(copied_set) == []
    assert rubgen.generate(small_set.recipe, copied_set).made == 0
    assert not list(copied_set.glob(".staging*"))


def test_failed_runs_are_listed_and_have_no_files(fake_simulate, tmp_path, make_synthetic_run, monkeypatch):
    good = make_synthetic_run(seconds=0.1)

    def simulate(scenario):
        if scenario.index != 1:
            return replace(good, scenario=scenario)
        response = replace(good.response, status=Status.DIVERGED, reason="in turn 7")
        return replace(good, scenario=scenario, response=response, recording=None, labels=None)

    monkeypatch.setattr("rubgen.pipeline.simulate", simulate)
    made = rubgen.generate(recipe(), tmp_path / "set", workers=1)
    assert made.status == {"diverged": 1, "ok": 2}
    runs = rubgen.open(tmp_path / "set").runs
    assert runs.loc["run-000001", ["status", "reason"]].tolist() == ["diverged", "in turn 7"]
    data = pq.read_table(tmp_path / "set/signals/train-00000.parquet", columns=["run_id"])
    assert data["run_id"].to_pylist() == ["run-000000", "run-000002"]
    assert sorted(path.name for path in (tmp_path / "set/mcap/0000").iterdir()) == [
        "run-000000.mcap",
        "run-000002.mcap",
    ]


def test_a_set_without_one_valid_run_is_still_whole(fake_simulate, tmp_path, make_synthetic_run, monkeypatch):
    run = make_synthetic_run(seconds=0.1)
    response = replace(run.response, status=Status.DIVERGED, reason="at once")
    monkeypatch.setattr(
        "rubgen.pipeline.simulate",
        lambda scenario: replace(run, scenario=scenario, response=response, recording=None, labels=None),
    )
    assert rubgen.generate(recipe(), tmp_path / "set", workers=1).status == {"diverged": 3}
    assert rubgen.verify(tmp_path / "set") == []


def test_many_runs_go_into_several_files_and_groups(fake_simulate, tmp_path, monkeypatch):
    monkeypatch.setattr("rubgen.dataset.shards.RUNS_PER_SHARD", 5)
    monkeypatch.setattr("rubgen.dataset.making.close.RUNS_PER_ROW_GROUP", 2)
    monkeypatch.setattr("rubgen.dataset.making.finish.ROWS_PER_GROUP", 3)
    rubgen.generate(recipe(runs=7, output={"signal_seconds": 0.1, "formats": ["parquet"]}), tmp_path / "set", workers=1)
    shards = sorted((tmp_path / "set" / "signals").glob("*.parquet"))
    assert [path.name for path in shards] == ["train-00000.parquet", "train-00001.parquet"]
    groups = [pq.ParquetFile(path).metadata for path in shards]
    assert [[g.row_group(i).num_rows for i in range(g.num_row_groups)] for g in groups] == [[2, 2, 1], [2]]
    signals = rubgen.open(tmp_path / "set").signals("run-000006")
    assert signals["proximity_x"].size == 2560
    assert not (tmp_path / "set/mcap").exists()


def test_another_recipe_or_number_of_runs_is_refused(small_set, short_records):
    with pytest.raises(
        UserError, match="holds 4 runs of this recipe, asked for 3; it can only grow: ask for --runs 4 or more"
    ):
        rubgen.generate(small_set.recipe, small_set.directory, runs=3)
    with pytest.raises(UserError, match=r"another recipe \(seed = 3, asked for 4\)"):
        rubgen.generate({**small_set.recipe, "seed": 4}, small_set.directory)


def test_an_unfinished_set_of_another_recipe_or_version_is_refused(fake_simulate, tmp_path, monkeypatch):
    before_run(monkeypatch, 0, KeyboardInterrupt())
    with pytest.raises(KeyboardInterrupt):
        rubgen.generate(recipe(), tmp_path / "set", workers=1)
    with pytest.raises(UserError, match=r"another recipe \(name = 'fake', asked for 'other'\)"):
        rubgen.generate(recipe(name="other"), tmp_path / "set", workers=1)
    identity = tmp_path / "set/.staging/identity.json"
    values = json.loads(identity.read_text())
    values["packages"]["numpy"] = "1.0"
    identity.write_text(json.dumps(values))
    with pytest.raises(UserError, match=r"begun with numpy 1\.0, now it is"):
        rubgen.generate(recipe(), tmp_path / "set", workers=1)


def test_a_directory_that_is_not_ours_is_refused_and_left_alone(fake_simulate, tmp_path):
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(UserError, match="not empty and no data set of rubgen; give a new or empty directory"):
        rubgen.generate(recipe(), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]
    with pytest.raises(UserError, match=r"letter.txt: is a file; give a new or empty directory"):
        rubgen.generate(recipe(), tmp_path / "letter.txt")


@pytest.mark.parametrize("inner", ["new", "signals", "signals/far/new"])
def test_no_set_is_made_within_another(copied_set, fake_simulate, inner):
    before = sorted(copied_set.rglob("*"))
    with pytest.raises(UserError, match=rf"{inner}: lies in the data set .+copy; choose a directory outside of it$"):
        rubgen.generate(recipe(), copied_set / inner, workers=1)
    assert sorted(copied_set.rglob("*")) == before


def test_a_link_to_itself_on_the_way_is_one_line(fake_simulate, tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(UserError, match=r"cannot be written \(Too many levels of symbolic links\)"):
        rubgen.generate(recipe(), tmp_path / "loop" / "set", workers=1)


def test_a_directory_that_cannot_be_written_is_refused(fake_simulate):
    with pytest.raises(UserError, match=r"/proc/rubgen: cannot be written \(.+\); give a directory that you may"):
        rubgen.generate(recipe(), "/proc/rubgen", workers=1)


def test_two_at_once_are_refused(fake_simulate, tmp_path, monkeypatch):
    true = Keeper.begin

    def second(keeper, index):
        with pytest.raises(UserError, match="another rubgen is writing there"):
            rubgen.generate(recipe(), tmp_path / "set", workers=1)
        true(keeper, index)

    monkeypatch.setattr(Keeper, "begin", second)
    assert rubgen.generate(recipe(), tmp_path / "set", workers=1).made == 3


def test_a_full_disk_is_one_line_and_loses_nothing(fake_simulate, tmp_path, monkeypatch):
    rubgen.generate(recipe(), tmp_path / "whole", workers=1)

    with monkeypatch.context() as patch:
        before_run(patch, 1, OSError(errno.ENOSPC, "No space left on device"))
        with pytest.raises(UserError, match=r"set: the disk is full; make room and give the same command again"):
            rubgen.generate(recipe(), tmp_path / "set", workers=1)
    assert not list((tmp_path / "set").rglob("*.part*"))
    rubgen.generate(recipe(), tmp_path / "set", workers=1)
    assert tree(tmp_path / "set") == tree(tmp_path / "whole")


def test_a_damaged_finished_set_is_not_called_finished(small_set, copied_set, short_records):
    (copied_set / "mcap/0000/run-000001.mcap").unlink()
    with pytest.raises(UserError, match=r"mcap/0000/run-000001.mcap: listed in the manifest, but not there"):
        rubgen.generate(small_set.recipe, copied_set)


def test_workers_below_one_are_refused(tmp_path):
    with pytest.raises(UserError, match="--workers 0: must be at least 1; give a number of processes"):
        rubgen.generate(None, tmp_path / "x", workers=0)
    assert not (tmp_path / "x").exists()


def test_what_physics_refuses_fails_before_any_run(tmp_path, short_records):
    machine = tmp_path / "few.toml"
    shutil.copy("rubgen/machine/presets/zeng2019.toml", machine)
    machine.write_text(machine.read_text().replace("circumferential_elements = 72", "circumferential_elements = 70"))
    with pytest.raises(UserError, match=r"circumferential_elements = 70: must be a multiple"):
        rubgen.generate(recipe(machine=str(machine)), tmp_path / "set", workers=1)
    assert finished_runs(tmp_path / "set") == 0


def test_progress_counts_every_run(fake_simulate, tmp_path):
    seen = []
    generating.generate(recipe(), tmp_path / "set", workers=1, progress=lambda *counts: seen.append(counts))
    assert seen == [(0, 3), (1, 3), (2, 3), (3, 3)]


def test_hash_of_a_file(tmp_path):
    (tmp_path / "a").write_bytes(b"abc")
    assert sha256_of(tmp_path / "a") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"


def test_a_run_that_its_own_values_forbid_is_recorded_with_its_reason(tmp_path, short_records):
    """Run 1 draws a speed at which blades grow beyond a round casing; the others are made, the first warms up."""
    asked = {
        "name": "refusals",
        "seed": 3,
        "runs": 4,
        "machine": "zeng2019",
        "vary": {"speed_rpm": {"choice": [5000.0, 16000.0]}, "ovality_m": 0.0, "clearance_m": 3e-4},
        "simulation": {"settle_turns": 20, "record_turns": 100, "closing_turns": 20},
        "output": {"formats": ["parquet"], "signal_seconds": 0.3},
    }
    with pytest.warns(RubgenWarning, match="no blade can reach the casing in any of the 2 runs looked at"):
        made = rubgen.generate(asked, tmp_path / "set", workers=1)
    runs = rubgen.open(tmp_path / "set").runs
    fast = runs["speed_rpm"] == 16000.0
    assert set(runs["status"][fast]) == {"refused"}
    assert set(runs["status"][~fast]) == {"ok"}
    assert made.status == {"ok": int((~fast).sum()), "refused": int(fast.sum())}
    assert runs["reason"][fast].str.contains("pass the casing everywhere, its widest gap at rest is 0.0003 m").all()
    assert runs["motion"][fast].isna().all()
    assert rubgen.verify(tmp_path / "set") == []


@pytest.mark.parametrize("name", ["rub", "run_id"])
def test_a_sensor_with_the_name_of_a_column_is_refused_before_anything_is_written(name, tmp_path):
    sensors = f'name = "s"\n[[sensors]]\nkind = "proximity"\nname = "{name}"\nangle_deg = 0\n'
    (tmp_path / "s.toml").write_text(sensors)
    recipe = {"name": "a", "runs": 1, "machine": "zeng2019", "sensors": {"set": str(tmp_path / "s.toml")}}
    with pytest.raises(UserError, match=f"two columns would be called {name}; rename that sensor"):
        rubgen.generate(recipe, tmp_path / "out", workers=1)
    assert not (tmp_path / "out").exists()
