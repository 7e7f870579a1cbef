"""Runs of a data set to look at: by name, by condition, from MCAP or simulated again."""

import dataclasses
import hashlib
import json
import shutil

import numpy as np
import pytest

import rubgen
from rubgen.dataset.reading.replaying import find_replay, find_runs, scenario_of
from rubgen.errors import UserError


def test_the_named_run_is_the_recorded_one(small_set):
    found = find_replay(small_set.directory, "run-000001")
    assert found.remarks == ()
    signals = rubgen.open(small_set.directory).signals("run-000001")
    for name, channel in found.replay.recording.channels.items():
        assert channel.values.tobytes() == signals[name].tobytes()
    assert found.replay.frames.dense.sum() > 200


def test_conditions_are_duckdbs(small_set):
    data = rubgen.open(small_set.directory)
    fast = find_runs(data, "speed_rpm > 9000 AND friction < 0.2")
    assert fast == [name for name in data.runs.index if data.runs.loc[name, "speed_rpm"] == 10000.0]
    found = find_replay(small_set.directory, where="speed_rpm > 9000")
    assert found.replay.scenario.run_id == fast[0]
    assert found.remarks == (f"{len(fast)} runs meet the condition, {fast[0]} is shown",)


def test_the_first_good_run_without_any_wish(small_set):
    assert find_replay(small_set.directory).replay.scenario.run_id == "run-000000"


def test_the_scenario_follows_from_the_manifest(small_set):
    data = rubgen.open(small_set.directory)
    recorded = find_replay(small_set.directory, "run-000002").replay.scenario
    assert scenario_of(data, "run-000002") == recorded
    assert recorded.index == 2


def test_without_mcap_the_run_is_simulated_again(copied_set, short_records):
    before = find_replay(copied_set, "run-000001").replay
    shutil.rmtree(copied_set / "mcap")
    found = find_replay(copied_set, "run-000001")
    assert found.remarks == ("run-000001 has no MCAP file and was simulated again",)
    again = found.replay
    assert again.labels == before.labels
    for name, channel in before.recording.channels.items():
        assert again.recording.channels[name].values.tobytes() == channel.values.tobytes()
    for field in dataclasses.fields(before.touches):
        np.testing.assert_array_equal(getattr(again.touches, field.name), getattr(before.touches, field.name))
    np.testing.assert_allclose(again.frames.tips, before.frames.tips, rtol=1e-6)


def test_a_recording_under_the_name_of_another_run_is_refused(copied_set):
    shutil.copy(copied_set / "mcap/0000/run-000000.mcap", copied_set / "mcap/0000/run-000001.mcap")
    with pytest.raises(UserError, match=r"run-000001\.mcap: holds run-000000"):
        find_replay(copied_set, "run-000001")
    path = copied_set / "manifest.json"
    manifest = json.loads(path.read_text())  # of a set that has no data files
    manifest["files"] = [entry for entry in manifest["files"] if not entry["path"].startswith(("signals/", "truth/"))]
    path.write_text(json.dumps(manifest))
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    (copied_set / "manifest.json.sha256").write_text(f"{digest}  manifest.json\n")
    data = rubgen.open(copied_set)
    assert data.signals("run-000000")["proximity_x"].size
    with pytest.raises(UserError, match=r"run-000001\.mcap: holds run-000000"):
        data.signals("run-000001")


@pytest.mark.parametrize(
    ("run_id", "where", "message"),
    [
        ("run-000099", None, "no run 'run-000099'; give one of run-000000, "),
        (None, "speed_rpm > 1e6", "no run meets 'speed_rpm > 1e6'; see `rubgen info"),
        (None, "speed > 9000", r"columns are those of .*README\.md, such as .*speed_rpm"),
        (None, "speed_rpm >", r"--where 'speed_rpm >': Parser Error.*columns are those of .*README\.md$"),
        (None, "motions = 'chaotic' and qqq > 1", r"such as motion[^ ]*(, motion[^ ]*)*$"),
        ("run-000000", "TRUE", "give a run or a condition, not both"),
    ],
)
def test_mistakes_are_named(small_set, run_id, where, message):
    with pytest.raises(UserError, match=message) as raised:
        find_replay(small_set.directory, run_id, where)
    assert "\n" not in str(raised.value)
    assert len(str(raised.value)) < 500  # a set has hundreds of columns
