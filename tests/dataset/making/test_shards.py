"""Shards of several splits: a set in parts, a set that grows, workers that die: the bytes of one quiet process."""

from dataclasses import replace

import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.dataset import shards as sharding
from rubgen.dataset.layout import Layout
from rubgen.dataset.making import generate as generating
from rubgen.dataset.making.keep import Keeper, kept_runs
from rubgen.dataset.making.plan import Part, PartOfSet, Plan, part_of
from rubgen.dataset.shards import shards_of
from rubgen.errors import UserError
from rubgen.scenario import Recipe, parse_recipe
from rubgen.scenario.run_id import index_of, run_id_of

VALUES = {
    "name": "fake",
    "runs": 23,
    "machine": "zeng2019",
    "output": {"signal_seconds": 0.1, "formats": ["parquet", "mcap"]},
}


@pytest.fixture(autouse=True)
def small_shards(short_records, make_synthetic_run, monkeypatch):
    """Shards of five runs of two splits: every third run is of the second one. Runs are made up, one of them fails."""
    template = make_synthetic_run(seconds=0.1)

    def simulate(scenario):
        if scenario.index == 7:
            raise UserError("no such run")
        return replace(template, scenario=scenario)

    monkeypatch.setattr("rubgen.pipeline.simulate", simulate)
    monkeypatch.setattr(generating, "warm_up", lambda *_: [])
    monkeypatch.setattr(sharding, "RUNS_PER_SHARD", 5)
    monkeypatch.setattr("rubgen.dataset.making.finish.ROWS_PER_GROUP", 4)
    monkeypatch.setattr(Recipe, "machine_number", lambda _recipe, index: index)
    monkeypatch.setattr(Recipe, "parts", property(lambda recipe: {"train": recipe, "test": recipe}))
    monkeypatch.setattr(Recipe, "split_of", lambda _recipe, index: "test" if index % 3 == 2 else "train")


def make(out, **options):
    return rubgen.generate(VALUES, out, workers=1, **options)


def tree(directory):
    files = [path for path in sorted(directory.rglob("*")) if path.is_file()]
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files}


def test_every_run_is_in_one_shard_of_its_split_and_rows_are_in_order(tmp_path):
    make(tmp_path / "set")
    names = [f"{run}.parquet" for run in ("test-00000", "test-00001", "train-00000", "train-00001", "train-00002")]
    assert sorted(path.name for path in (tmp_path / "set/signals").iterdir()) == [*names, "train-00003.parquet"]
    runs = pq.read_table(tmp_path / "set/runs.parquet", columns=["run_id", "split", "status"]).to_pylist()
    assert [row["run_id"] for row in runs] == [run_id_of(index) for index in range(23)]
    assert [row["split"] for row in runs] == ["test" if index % 3 == 2 else "train" for index in range(23)]
    assert [row["run_id"] for row in runs if row["status"] != "ok"] == ["run-000007"]
    for path in (tmp_path / "set/signals").iterdir():
        rows = pq.read_table(path, columns=["run_id", "split"])
        assert set(rows["split"].to_pylist()) == {path.name.split("-")[0]}
        assert rows["run_id"].to_pylist() == sorted(rows["run_id"].to_pylist())


@pytest.mark.parametrize("count", [4, 11])
def test_parts_in_any_order_and_a_finish_make_the_same_bytes(tmp_path, count):
    make(tmp_path / "whole")
    for number in range(count, 0, -1):
        part = make(tmp_path / "parts", shard=f"{number}/{count}")
        assert (part.part, (tmp_path / "parts/manifest.json").exists()) == (f"{number}/{count}", False)
    assert make(tmp_path / "parts", finish=True).made == 0
    assert tree(tmp_path / "parts") == tree(tmp_path / "whole")


def test_parts_share_all_runs_and_have_none_twice(tmp_path):
    recipe = parse_recipe(VALUES)
    for count in (1, 3, 6, 7, 23, 40):
        mine = []
        for number in range(1, count + 1):
            plan = Plan(PartOfSet(recipe, Layout(tmp_path), Part(number, count)), "session")
            for _, _, shard, indexes in plan.jobs(2):
                mine += indexes
                if indexes:
                    plan.ended(shard)
        assert sorted(mine) == list(range(23)), count


def test_finish_names_what_is_missing(tmp_path):
    make(tmp_path / "set", shard="1/2")
    with pytest.raises(UserError, match=r"--finish: \d+ runs of 23 are not made, the first is run-0000"):
        make(tmp_path / "set", finish=True)
    with pytest.raises(UserError, match="--finish: stands beside --shard 1/2"):
        make(tmp_path / "set", finish=True, shard="1/2")


@pytest.mark.parametrize("text", ["0/10", "11/10", "1", "a/b", "-1/3", "1/0", "1.5/2", "", "1/2/3", "/"])
def test_a_part_that_is_none_is_refused(text, tmp_path):
    with pytest.raises(UserError, match=r"--shard .*: give number/count"):
        make(tmp_path / "set", shard=text)
    assert not (tmp_path / "set").exists()
    assert part_of("17/200") == Part(17, 200)


@pytest.mark.parametrize("before", [1, 16])
def test_a_set_that_grows_has_the_bytes_of_one_made_at_once(tmp_path, before):
    make(tmp_path / "whole")
    make(tmp_path / "set", runs=before)
    assert make(tmp_path / "set").made < 23
    assert tree(tmp_path / "set") == tree(tmp_path / "whole")
    with pytest.raises(UserError, match="holds 23 runs of this recipe, asked for 22; it can only grow"):
        make(tmp_path / "set", runs=22)


def test_a_set_is_as_it_was_until_it_has_grown(tmp_path, monkeypatch):
    make(tmp_path / "whole")
    make(tmp_path / "set", runs=13)
    before = tree(tmp_path / "set")
    true = Keeper.begin

    def stopped(keeper, index):
        if index == 20:
            raise KeyboardInterrupt
        true(keeper, index)

    with monkeypatch.context() as patch:
        patch.setattr(Keeper, "begin", stopped)
        with pytest.raises(KeyboardInterrupt):
            make(tmp_path / "set")
    now = tree(tmp_path / "set")
    assert {name: now[name] for name in before} == before
    assert make(tmp_path / "set", runs=13).verified
    made = make(tmp_path / "set")
    assert 0 < made.made < 10
    assert tree(tmp_path / "set") == tree(tmp_path / "whole")


def test_jobs_are_for_all_workers_and_full_shards_come_first(tmp_path):
    recipe = parse_recipe({**VALUES, "runs": 20})
    jobs = list(Plan(PartOfSet(recipe, Layout(tmp_path)), "session").jobs(2))
    assert len(jobs) >= 8
    whole = [shard.full for shard in shards_of(recipe)]
    assert whole == sorted(whole, reverse=True)


def test_a_half_written_record_and_what_follows_is_left_out(tmp_path, monkeypatch):
    monkeypatch.setattr("rubgen.dataset.making.plan.close_shard", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        make(tmp_path / "set")
    layout = Layout(tmp_path / "set")
    file = next(layout.kept("train-00000").iterdir())
    whole = file.read_bytes()
    there = kept_runs(layout, "train-00000")
    for cut in range(0, len(whole), 997):
        file.write_bytes(whole[:cut])
        assert kept_runs(layout, "train-00000").items() <= there.items()
    content = bytearray(whole)
    content[len(content) // 2] ^= 4
    file.write_bytes(content)
    assert len(kept_runs(layout, "train-00000")) < len(there)


def test_names_of_runs_sort_as_numbers_do():
    numbers = [0, 7, 999_999, 1_000_000, 1_000_001, 9_999_999, 10_000_000, 123_456_789]
    names = [run_id_of(number) for number in numbers]
    assert names == sorted(names)
    assert (names[1], names[3], names[6]) == ("run-000007", "run-a1000000", "run-b10000000")
    assert [index_of(name) for name in names] == numbers
    for wrong in ("run-7", "run-1000000", "run-b1000000", "run-a0000001", "7", "run-00000a"):
        with pytest.raises(ValueError, match="names no run"):
            index_of(wrong)
