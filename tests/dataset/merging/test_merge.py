"""Several sets become one: bytes of a set made at once, names of source and run, and what cannot be one."""

import json
import shutil
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.cli import main
from rubgen.dataset import shards as sharding
from rubgen.dataset.checking.repair import repair
from rubgen.dataset.making import generate as generating
from rubgen.dataset.remaking.regenerate import regenerate
from rubgen.errors import UserError
from rubgen.labels import Motion
from rubgen.scenario import Recipe
from rubgen.scenario.run_id import index_of, run_id_of

VALUES = {
    "name": "fake",
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [9000, 10000]}, "friction": {"uniform": [0.0, 0.02]}},
    "twins": {"friction": 0.1},
    "output": {"signal_seconds": 0.21, "formats": ["parquet", "mcap"]},
}
RUNS = {"a": (1, 6), "b": (2, 4), "c": (3, 2)}
TOTAL = 12
FAILED = 3


@pytest.fixture(autouse=True, scope="module")
def small_shards(module_with_short_records, make_synthetic_run):
    """Shards of three runs of two splits: every third pair is of the second one. Runs are made up, one fails."""
    template = with_windows(make_synthetic_run(seconds=0.21))

    def simulate(scenario):
        if scenario.index == FAILED:
            raise UserError("no such run")
        return replace(template, scenario=scenario)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rubgen.pipeline.simulate", simulate)
        patch.setattr(generating, "warm_up", lambda *_: [])
        patch.setattr("rubgen.dataset.remaking.remake.usable_cores", lambda: 1)
        patch.setattr(sharding, "RUNS_PER_SHARD", 3)
        patch.setattr(Recipe, "machine_number", lambda _recipe, index: index // 2)
        patch.setattr(Recipe, "parts", property(lambda recipe: {"train": recipe, "test": recipe}))
        patch.setattr(Recipe, "split_of", lambda _recipe, index: "test" if index // 2 % 3 == 2 else "train")
        patch.setattr(
            "rubgen.scenario.recipe.replace",
            lambda each, **changes: replace(each, **with_machine(each, changes)),
        )
        yield


def with_windows(run):
    """The run with labels of the eight windows of its record."""
    speed = run.response.speed
    starts = np.arange(0, run.response.record_turns, 16) * 2 * np.pi / speed
    same = {name: np.full(starts.size, value) for name, value in (("speed", speed), ("impulse", 1.5), ("duty", 0.125))}
    motion = tuple((Motion.PERIOD_K, None) for _ in starts)
    windows = replace(run.labels.windows, start=starts, motion=motion, **same)
    quick = replace(run.response, track=None)
    return replace(run, response=quick, labels=replace(run.labels, windows=windows, response=quick))


def with_machine(scenario, changes):
    """A machine of its own for each pair of runs of each seed."""
    if "index" not in changes or not hasattr(scenario, "seed"):
        return changes
    return changes | {"machine_id": f"{scenario.seed:04x}{changes['index'] // 2:08x}"}


@pytest.fixture(scope="module")
def sets(tmp_path_factory, small_shards):
    root = tmp_path_factory.mktemp("sources")
    for name, (seed, runs) in RUNS.items():
        rubgen.generate({**VALUES, "seed": seed, "runs": runs}, root / name, workers=1)
    return root


@pytest.fixture(scope="module")
def merged(sets, tmp_path_factory):
    out = tmp_path_factory.mktemp("merged") / "abc"
    rubgen.merge([sets / name for name in RUNS], out)
    return out


def tree(directory):
    files = [path for path in sorted(directory.rglob("*")) if path.is_file()]
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files}


def rows(directory, table="runs"):
    paths = [directory / "runs.parquet"] if table == "runs" else sorted((directory / table).glob("*.parquet"))
    return [row for path in paths for row in pq.read_table(path).to_pylist()]


@pytest.mark.parametrize("table", ["runs", "signals", "truth", "windows", "sections"])
def test_each_table_has_the_rows_of_all_sources_with_new_names(table, sets, merged):
    first, expected = 0, []
    for name, (_, runs) in RUNS.items():
        digits = rubgen.open(merged).manifest.identity.sources[list(RUNS).index(name)].digits
        for row in rows(sets / name, table):
            before = row["run_id"]
            row["run_id"] = run_id_of(index_of(before) + first)
            if row.get("twin_of"):
                row["twin_of"] = run_id_of(index_of(row["twin_of"]) + first)
            expected.append(row | ({"merged_from": f"{digits}/{before}"} if table == "runs" else {}))
        first += runs
    found = rows(merged, table)
    assert table == "sections" or {row["split"] for row in found} == {"train", "test"}
    assert sorted(map(repr, found)) == sorted(map(repr, expected))
    if table == "runs":
        assert [row["run_id"] for row in found] == [run_id_of(index) for index in range(TOTAL)]
        assert [row["reason"] for row in found if row["status"] != "ok"] == ["no such run"] * 2


def test_shards_are_those_of_the_sources_and_files_of_the_first_keep_their_bytes(sets, merged):
    own, whole = tree(sets / "a"), tree(merged)
    kept = [name for name in own if "/" in name]
    assert {name: whole[name] for name in kept} == {name: own[name] for name in kept}
    names = [path.name for path in sorted((merged / "signals").iterdir())]
    assert names == [f"{name}.parquet" for name in ("test-00000", *(f"train-{n:05d}" for n in range(5)))]
    for path in (merged / "signals").iterdir():
        assert set(pq.read_table(path, columns=["split"])["split"].to_pylist()) <= {path.name.split("-")[0]}


def test_merging_in_steps_makes_the_same_bytes(sets, merged, tmp_path):
    rubgen.merge([sets / "b", sets / "c"], tmp_path / "bc")
    rubgen.merge([sets / "a", tmp_path / "bc"], tmp_path / "abc")
    assert tree(tmp_path / "abc") == tree(merged)


def test_runs_of_every_source_are_made_again_and_so_are_damaged_shards(merged, tmp_path):
    for run_id in ("run-000001", "run-000007", "run-000009"):
        assert regenerate(merged, run_id).different == {}
    copy = shutil.copytree(merged, tmp_path / "copy")
    for name in ("signals/train-00002.parquet", "sections/train-00004.parquet", "mcap/0000/run-000007.mcap"):
        (copy / name).write_bytes(b"damaged")
    (copy / "README.md").unlink()
    assert repair(copy).made
    assert tree(copy) == tree(merged)


@pytest.mark.parametrize("stop", ["finish_set", "write_closed"])
def test_a_stop_at_any_moment_is_completed_to_the_same_bytes(stop, sets, merged, tmp_path, monkeypatch):
    out = tmp_path / "out"
    home = "rubgen.dataset.merging." + ("copying" if stop == "write_closed" else "merge")
    calls = []

    def stopped(*values):
        calls.append(values)
        if len(calls) == (1 if stop == "finish_set" else 2):
            raise KeyboardInterrupt
        return true(*values)

    with monkeypatch.context() as patch:
        module = __import__(home, fromlist=[stop])
        true = getattr(module, stop)
        patch.setattr(module, stop, stopped)
        with pytest.raises(KeyboardInterrupt):
            rubgen.merge([sets / name for name in RUNS], out)
    assert not (out / "manifest.json").exists()
    with pytest.raises(UserError, match="holds the output of another recipe"):
        rubgen.merge([sets / "a", sets / "b"], out)
    made = rubgen.merge([sets / name for name in RUNS], out)
    assert made.made < TOTAL
    assert tree(out) == tree(merged)
    assert rubgen.merge([sets / name for name in RUNS], out).verified


def test_a_merged_set_neither_grows_nor_gets_other_sensors(merged, sets, tmp_path):
    with pytest.raises(UserError, match="is a merged set; give the command for each of its sources"):
        rubgen.resense(merged, "rig", tmp_path / "out")
    with pytest.raises(UserError, match="is the recipe of a merged set; generate its sources"):
        rubgen.generate(rubgen.open(merged).recipe, tmp_path / "out")
    with pytest.raises(UserError, match="holds the output of another recipe"):
        rubgen.generate({**VALUES, "seed": 1, "runs": 20}, merged)
    with pytest.raises(UserError, match="which is to be merged; give another"):
        rubgen.merge([sets / "a", sets / "b"], sets / "a/more")
    assert not (tmp_path / "out").exists()


def change_manifest(directory, change):
    """Change the values of a manifest and its digest."""
    import hashlib

    path = directory / "manifest.json"
    values = json.loads(path.read_text())
    change(values["identity"])
    path.write_text(json.dumps(values, indent=2, ensure_ascii=False) + "\n")
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    (directory / "manifest.json.sha256").write_text(f"{digest}  manifest.json\n")


OTHER = {
    "version": lambda identity: identity["packages"].update(numpy="9.9"),
    "rate": lambda identity: identity["recipe"]["sensors"].update(sample_rate_hz=12800.0),
    "sensors": lambda identity: identity["sensors"]["sensors"].pop(),
    "range": lambda identity: identity["sensors"].update(name="other"),
}


@pytest.mark.parametrize(
    ("names", "why"),
    [
        (["a"], "give two or more data sets"),
        (["a", "a"], "every run must have random numbers of its own; leave one of them out"),
        (["abc", "c"], "every run must have random numbers of its own; leave one of them out"),
        (["a", "nothing"], "no such directory"),
        (["a", "seed"], "has the seed 1 of .*; make one of them with another seed"),
        (["a", "formats"], r"output.formats: \['parquet'\] in .*formats, \['mcap', 'parquet'\] in .*a;"),
        (["a", "rate"], r"sensors.sample_rate_hz: 12800.0 in .*rate, 25600.0 in"),
        (["a", "sensors"], r"channels: \['"),
        (["a", "range"], "sensors: other values in .*range than in .*a; make one .* rubgen resense"),
        (["a", "plain"], r"has the column twin_of in runs, .*plain has no such column"),
        (["a", "version"], "the version of numpy: '9.9' in .*version, '"),
        (["a", "lost"], r"train-00000.parquet: listed in the manifest, but not there \(1 problems\); rubgen repair"),
        (["a", "edited"], r"edited/runs.parquet: damaged, its sha256 is not the one in the manifest; rubgen repair"),
        (["a", "damaged"], r"train-00000.parquet: damaged, its sha256 is not the one in the manifest; rubgen repair"),
    ],
)
def test_what_cannot_be_one_is_one_line_and_nothing_is_written(names, why, sets, merged, tmp_path, capsys):
    import re

    b = {**VALUES, "seed": 2, "runs": 2}
    output = b["output"]
    others = {
        "seed": {**b, "seed": 1, "vary": {"speed_rpm": 9000}},
        "formats": {**b, "output": {**output, "formats": ["parquet"]}},
        "plain": {key: value for key, value in b.items() if key != "twins"},
    }
    paths = {name: sets / name for name in RUNS} | {"abc": merged, "nothing": tmp_path / "nothing"}
    for name in names[1:]:
        paths.setdefault(name, tmp_path / name)
        if name in others:
            rubgen.generate(others[name], tmp_path / name, workers=1)
        elif name in ("lost", "damaged", "edited", *OTHER):
            shutil.copytree(sets / "b", tmp_path / name)
    for name in OTHER.keys() & set(names):
        change_manifest(tmp_path / name, OTHER[name])
    shard = paths[names[-1]] / "signals/train-00000.parquet"
    if "lost" in names:
        shard.unlink()
    if "damaged" in names:
        shard.write_bytes(shard.read_bytes()[:-1] + b"?")
    if "edited" in names:
        content = (tmp_path / "edited/runs.parquet").read_bytes()
        (tmp_path / "edited/runs.parquet").write_bytes(content[:100] + b"?" + content[101:])
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        main(["merge", *(str(paths[name]) for name in names), "--out", str(tmp_path / "out")])
    told = capsys.readouterr().err
    assert (ended.value.code, told.count("\n")) == (2, 1)
    assert re.search(why, told), told
    assert names[-1] == "damaged" or not (tmp_path / "out").exists()
