"""Recordings of a merged set: made from its MCAP files, or simulated again where it has none, with the new names."""

from dataclasses import replace

import pytest

import rubgen
from rubgen.io.mcap import read_mcap
from rubgen.viz.rerun import id_in

SETS = {"first": 1, "second": 2}


@pytest.fixture
def made(short_records, make_synthetic_run, monkeypatch, tmp_path):
    """Makes two sets of one run with these formats; gives their directories, and counts runs simulated afterwards."""
    template, simulated = make_synthetic_run(seconds=0.1), []

    def simulate(scenario):
        simulated.append(scenario.run_id)
        return replace(template, scenario=scenario)

    monkeypatch.setattr("rubgen.pipeline.simulate", simulate)
    monkeypatch.setattr("rubgen.dataset.making.generate.warm_up", lambda *_: [])
    for problems in ("label_problems", "signal_problems"):
        monkeypatch.setattr(f"rubgen.dataset.checking.table_check.{problems}", lambda *_: [])

    def make(*formats):
        recipe = {"runs": 1, "machine": "zeng2019", "output": {"signal_seconds": 0.1, "formats": list(formats)}}
        for name, seed in SETS.items():
            rubgen.generate({**recipe, "name": name, "seed": seed}, tmp_path / name, workers=1)
        simulated.clear()
        return [tmp_path / name for name in SETS], simulated

    return make


def run_in(directory, number):
    """The run that the recording of this number says it holds: its id begins with the name."""
    return id_in(directory / f"rrd/0000/run-{number:06d}.rrd").rpartition("-")[0]


def test_recordings_follow_from_the_mcap_files_of_the_merged_set(made, tmp_path):
    sources, simulated = made("mcap", "rrd")
    merged = rubgen.merge(sources, tmp_path / "set").directory
    assert simulated == []
    assert rubgen.verify(merged) == []
    assert [run_in(merged, number) for number in (0, 1)] == ["run-000000", "run-000001"]
    first, second = (merged / f"mcap/0000/run-00000{number}.mcap" for number in (0, 1))
    assert first.read_bytes() == (sources[0] / "mcap/0000/run-000000.mcap").read_bytes()
    theirs = read_mcap(sources[1] / "mcap/0000/run-000000.mcap")
    assert read_mcap(second).scenario["merged"]["first"] == 1
    assert "merged" not in theirs.scenario
    assert all((read_mcap(second).signals[name] == values).all() for name, values in theirs.signals.items())


def test_recordings_of_a_set_without_mcap_are_simulated_again(made, tmp_path):
    sources, simulated = made("parquet", "rrd")
    merged = rubgen.merge(sources, tmp_path / "set").directory
    assert simulated == ["run-000001"]  # the first set keeps its files
    assert rubgen.verify(merged) == []
    assert run_in(merged, 1) == "run-000001"


def test_a_damaged_recording_is_not_copied(made, tmp_path):
    sources, _ = made("parquet", "rrd")
    path = sources[0] / "rrd/0000/run-000000.rrd"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    with pytest.raises(rubgen.UserError, match=r"first/rrd/0000/run-000000\.rrd: damaged, .+; rubgen repair"):
        rubgen.merge(sources, tmp_path / "set")
    assert not (tmp_path / "set/manifest.json").exists()
