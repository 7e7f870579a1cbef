"""`rubgen repair` makes each file that a manifest lists again to the same bytes, lost or damaged."""

import shutil
from dataclasses import replace

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.cli import main
from rubgen.dataset import shards as sharding
from rubgen.dataset.checking.repair import repair
from rubgen.dataset.making import generate as generating
from rubgen.dataset.remaking.remake import shards_with
from rubgen.errors import UserError
from rubgen.io.parquet.write import write_table

VALUES = {
    "name": "fake",
    "runs": 3,
    "machine": "zeng2019",
    "vary": {"friction": {"uniform": [0.0, 0.02]}},
    "output": {"signal_seconds": 0.1, "formats": ["parquet", "mcap"]},
}
FILES = (
    "README.md", "croissant.json", "sensors.parquet", "runs.parquet", "signals/train-00001.parquet",
    "truth/train-00000.parquet", "windows/train-00000.parquet", "sections/train-00000.parquet",
    "mcap/0000/run-000000.mcap",
)  # fmt: skip
"""One of each kind."""


@pytest.fixture(autouse=True, scope="module")
def simulated(module_with_short_records, make_synthetic_run):
    """Shards of two runs; runs are made up, run 1 fails. Yields the numbers of the runs that were simulated."""
    template, numbers = make_synthetic_run(seconds=0.1), []
    template = replace(template, response=replace(template.response, track=None))

    def simulate(scenario):
        numbers.append(scenario.index)
        if scenario.index == 1:
            raise UserError("no such run")
        return replace(template, scenario=scenario)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rubgen.pipeline.simulate", simulate)
        patch.setattr(generating, "warm_up", lambda *_: [])
        patch.setattr("rubgen.dataset.remaking.remake.usable_cores", lambda: 1)
        patch.setattr("rubgen.dataset.making.finish.ROWS_PER_GROUP", 2)
        patch.setattr(sharding, "RUNS_PER_SHARD", 2)
        yield numbers


@pytest.fixture(scope="module")
def whole(simulated, tmp_path_factory):
    directory = tmp_path_factory.mktemp("whole") / "set"
    rubgen.generate(VALUES, directory, workers=1)
    return directory


def tree(directory):
    files = [path for path in sorted(directory.rglob("*")) if path.is_file()]
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files}


def test_each_kind_is_tried(whole):
    listed = [entry.path for entry in rubgen.open(whole).manifest.files]
    assert {path.partition("/")[0] for path in listed} == {path.partition("/")[0] for path in FILES}
    assert set(FILES) <= set(listed)


@pytest.mark.parametrize(
    ("name", "loss"),
    [*zip(FILES, ["lost", "flipped"] * 5, strict=False), ("runs.parquet", "lost"), ("README.md", "flipped")],
)
def test_it_comes_back(name, loss, whole, simulated, tmp_path):
    copy = shutil.copytree(whole, tmp_path / "copy")
    path = copy / name
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.unlink()
    if loss == "flipped":
        path.write_bytes(content)
    simulated.clear()
    assert repair(copy).made == (name,)
    assert tree(copy) == tree(whole)
    shards = shards_with(rubgen.open(whole).recipe, [name])
    needed = {"train-00000": [0, 1], "train-00001": [2]}
    if name != "runs.parquet":
        assert sorted(simulated) == [index for shard in sorted(shards) for index in needed[shard]]


def test_only_runs_without_readable_rows_are_made_again(whole, simulated, tmp_path):
    copy = shutil.copytree(whole, tmp_path / "copy")
    path = copy / "runs.parquet"
    place = pq.ParquetFile(path).metadata.row_group(1).column(0).data_page_offset
    content = bytearray(path.read_bytes())
    content[place + 30] ^= 1
    path.write_bytes(content)
    simulated.clear()
    assert repair(copy).made == ("runs.parquet",)
    assert (simulated, tree(copy) == tree(whole)) == ([2], True)


def test_a_table_of_runs_with_other_values_is_made_anew(whole, simulated, tmp_path, capsys):
    copy = shutil.copytree(whole, tmp_path / "copy")
    table = pq.read_table(copy / "runs.parquet")
    place = table.column_names.index("friction")
    other = table.set_column(place, table.schema.field(place), pa.array([0.5, 0.5, 0.5]))
    write_table([other], other.schema, copy / "runs.parquet")
    simulated.clear()
    with pytest.raises(SystemExit):
        main(["verify", str(copy), "--repair"])
    told = capsys.readouterr().out.splitlines()
    assert told[0].startswith("runs.parquet: ")
    assert "runs.parquet: made again" in told
    assert (simulated, tree(copy) == tree(whole)) == ([0, 1, 2], True)


def test_a_stop_in_between_is_completed(whole, simulated, tmp_path, monkeypatch):
    copy = shutil.copytree(whole, tmp_path / "copy")
    for name in ("runs.parquet", "signals/train-00000.parquet", "signals/train-00001.parquet"):
        (copy / name).unlink()
    with monkeypatch.context() as patch:
        patch.setattr("rubgen.dataset.remaking.remake.write_runs", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            repair(copy)
    simulated.clear()
    repair(copy)
    assert (simulated, tree(copy) == tree(whole)) == ([], True)


def test_sample_and_repair_do_not_go_together(whole, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["verify", str(whole), "--repair", "--sample", "1"])
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith("--sample 1: --repair reads all shards; leave out one of the two\n")
