"""`verify --sample`: content of the drawn shards, presence and size of all. Manifests that list too much or little."""

import json
import random
import shutil
from dataclasses import replace

import pytest
from test_set_damage import seal_manifest

import rubgen
from rubgen.cli import main
from rubgen.dataset.checking.verify import findings
from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError

SHARDS = ["train-00000", "train-00001", "train-00002"]


@pytest.fixture(scope="module")
def whole(tmp_path_factory, module_with_short_records, make_synthetic_run):
    """A set of five runs in three shards with MCAP files. Labels of made-up runs are not compared."""
    template, directory = make_synthetic_run(seconds=0.1), tmp_path_factory.mktemp("sets") / "set"
    output = {"signal_seconds": 0.1, "formats": ["parquet", "mcap"]}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("rubgen.pipeline.simulate", lambda scenario: replace(template, scenario=scenario))
        patch.setattr("rubgen.dataset.making.generate.warm_up", lambda *_: [])
        patch.setattr("rubgen.dataset.shards.RUNS_PER_SHARD", 2)
        for problems in ("label_problems", "signal_problems"):
            patch.setattr(f"rubgen.dataset.checking.table_check.{problems}", lambda *_: [])
        rubgen.generate({"name": "a", "runs": 5, "machine": "zeng2019", "output": output}, directory, workers=1)
        yield directory


@pytest.fixture
def sharded(whole, tmp_path):
    """A copy that a test may damage."""
    return shutil.copytree(whole, tmp_path / "set")


def drawn(monkeypatch, *names):
    """Let the sample be of these shards; gives what was asked for."""
    asked = []

    def sample(known, count):
        asked.append((list(known), count))
        return list(names)

    monkeypatch.setattr(random, "sample", sample)
    return asked


def flip(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


@pytest.mark.parametrize(
    ("name", "shard"),
    [
        ("signals/train-00001.parquet", SHARDS[1]),
        ("sections/train-00002.parquet", SHARDS[2]),
        ("mcap/0000/run-000003.mcap", SHARDS[1]),
        ("mcap/0000/run-000004.mcap", SHARDS[2]),
    ],
)
def test_damage_within_a_file_is_found_where_its_shard_is_drawn(sharded, monkeypatch, name, shard):
    flip(sharded / name)
    drawn(monkeypatch, *(each for each in SHARDS if each != shard))
    assert findings(sharded, sample=2) == []
    drawn(monkeypatch, shard)
    assert {finding.text.partition(": ")[0] for finding in findings(sharded, sample=1)} >= {name}


def test_presence_size_and_the_files_of_the_whole_set_are_checked_whatever_is_drawn(sharded, monkeypatch):
    (sharded / "mcap/0000/run-000004.mcap").unlink()
    with (sharded / "truth/train-00001.parquet").open("ab") as stream:
        stream.write(b"X")
    flip(sharded / "README.md")
    drawn(monkeypatch, SHARDS[0])
    assert sorted(finding.path for finding in findings(sharded, sample=1)) == [
        "README.md", "mcap/0000/run-000004.mcap", "truth/train-00001.parquet",
    ]  # fmt: skip


def test_a_sample_is_drawn_of_all_shards_and_of_no_more_than_there_are(sharded, monkeypatch):
    asked = drawn(monkeypatch, *SHARDS)
    assert findings(sharded, sample=2) == findings(sharded, sample=99) == []
    assert [(sorted(known), count) for known, count in asked] == [(SHARDS, 2), (SHARDS, 3)]


@pytest.mark.parametrize("sample", [0, -1, True, 1.5, "2"])
def test_a_sample_is_a_number_of_shards(sharded, sample):
    with pytest.raises(UserError, match=f"^--sample {sample}: must be at least 1; give a number of shards$"):
        findings(sharded, sample=sample)


def test_the_command_ends_with_1_where_a_drawn_shard_is_damaged(sharded, monkeypatch, capsys):
    flip(sharded / "windows/train-00000.parquet")
    for shard, code in ((SHARDS[1], 0), (SHARDS[0], 1)):
        drawn(monkeypatch, shard)
        with pytest.raises(SystemExit) as ended:
            main(["verify", str(sharded), "--sample", "1", "--json"])
        assert ended.value.code == code
        assert bool(json.loads(capsys.readouterr().out)["problems"]) == bool(code)


def test_a_listed_file_of_no_shard_is_found(sharded):
    shutil.copy(sharded / "signals/train-00002.parquet", sharded / "signals/train-00003.parquet")

    def list_it(manifest):
        (entry,) = [each for each in manifest["files"] if each["path"] == "signals/train-00002.parquet"]
        manifest["files"].append(entry | {"path": "signals/train-00003.parquet"})

    seal_manifest(sharded, list_it)
    found = [finding.text for finding in findings(sharded)]
    assert found == ["signals/train-00003.parquet: is no file of this recipe's set"]


@pytest.mark.parametrize("name", ["sections/train-00001.parquet", "mcap/0000/run-000002.mcap"])
def test_a_file_that_the_manifest_forgot_is_found_as_missing_there(sharded, name):
    def forget(manifest):
        manifest["files"] = [each for each in manifest["files"] if each["path"] != name]

    seal_manifest(sharded, forget)
    found = [finding.text for finding in findings(sharded)]
    assert f"{name}: missing in the manifest" in found
    assert f"{name}: not listed in the manifest" in found


def test_a_run_whose_rows_a_shard_lacks_is_named_by_each_reader(sharded):
    def forget(manifest):
        manifest["files"] = [each for each in manifest["files"] if "train-00001" not in each["path"]]

    seal_manifest(sharded, forget)
    data = DataSet(sharded)
    assert data.signals("run-000004", ["proximity_x"])
    for read in (data.signals, data.touches):
        with pytest.raises(UserError, match=r"^run-000002: has no row in .+; generate the set again$"):
            read("run-000002")
