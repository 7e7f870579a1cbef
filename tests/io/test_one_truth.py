"""One run, four readers: memory, MCAP, Parquet and Rerun agree to the bit after float32."""

import dataclasses

import numpy as np
import pytest
from rerun.chunk import RrdReader

from rubgen.io.mcap import check_mcap, read_mcap, write_mcap
from rubgen.io.parquet.read import read_table
from rubgen.io.parquet.words import with_words
from rubgen.io.parquet.write import write_parquet
from rubgen.labels.labels import Motion
from rubgen.labels.speed_history import Change, SpeedHistory
from rubgen.labels.to_json import labels_to_json
from rubgen.viz.entities.signals import detail_window
from rubgen.viz.replay import replay_of
from rubgen.viz.rerun import write_rrd
from tests.default_columns import SCALARS


@pytest.fixture(scope="module", params=["rub_run", "rig_run"])
def run(request):
    """With the sensors that every recipe has, and with those of a rig."""
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="module")
def folder(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("truth")
    write_mcap(run, folder / "run.mcap")
    write_parquet(run, folder / "run.parquet")
    write_rrd(run, folder / "run.rrd")
    return folder


def test_signals_agree_to_the_bit(run, folder):
    mcap, row = read_mcap(folder / "run.mcap").signals, read_table(folder / "run.parquet").to_pylist()[0]
    for name, channel in run.recording.channels.items():
        memory = channel.values
        assert memory.dtype == np.float32
        assert mcap[name].tobytes() == memory.tobytes()
        assert np.array(row[name], dtype=np.float32).tobytes() == memory.tobytes()


def test_rerun_shows_the_same_samples(run, folder):
    window = detail_window(replay_of(run))
    mcap = read_mcap(folder / "run.mcap").signals
    groups = {quantity: group for quantity, group in run.recording.by_quantity().items() if quantity != "pulse"}
    for quantity, group in groups.items():
        (chunk,) = [
            chunk
            for chunk in RrdReader(folder / "run.rrd").stream().filter(content=f"/detail/{quantity}").to_chunks()
            if not chunk.is_static
        ]
        shown = np.array(chunk.to_record_batch().column("Scalars:scalars").to_pylist(), dtype=np.float32)
        for column, channel in enumerate(group):
            assert shown[:, column].tobytes() == mcap[channel.name][window].tobytes()


def test_labels_agree(run, folder):
    memory = labels_to_json(run.labels)
    row = with_words(read_table(folder / "run.parquet")).to_pylist()[0]
    assert read_mcap(folder / "run.mcap").labels == memory
    columns = [column.name for column in SCALARS if column.name in memory]
    assert len(columns) > 20
    assert {name: row[name] for name in columns} == {name: memory[name] for name in columns}


def test_pulses_agree(run, folder):
    pulses = run.recording.once_per_rev
    row = with_words(read_table(folder / "run.parquet")).to_pylist()[0]
    assert read_mcap(folder / "run.mcap").once_per_rev.tobytes() == pulses.tobytes()
    assert np.array(row["once_per_rev_s"]).tobytes() == pulses.tobytes()


def test_touches_agree_and_fit_in_the_recording(run, folder):
    mcap, row = read_mcap(folder / "run.mcap").contacts, read_table(folder / "run.parquet").to_pylist()[0]
    assert len(row["touch_blade"]) > 100
    order = np.argsort(mcap["start_s"], kind="stable")
    assert row["touch_start_s"] == mcap["start_s"][order].tolist()
    assert row["touch_blade"] == mcap["blade"][order].astype(int).tolist()
    assert row["touch_end_s"] == (mcap["start_s"] + mcap["duration_s"])[order].tolist()
    for name, column in (("touch_angle_rad", "angle_rad"), ("touch_impulse_n_s", "impulse_n_s")):
        np.testing.assert_allclose(row[name], mcap[column][order], rtol=1e-6)
    np.testing.assert_allclose(row["touch_friction_work_j"], mcap["friction_loss_j"][order], rtol=1e-6)
    assert max(row["touch_start_s"]) < 0.3
    assert row["signal_start_s"] == run.recording.start_seconds


def test_arrivals_of_blades_agree(run, folder):
    mcap, row = read_mcap(folder / "run.mcap"), read_table(folder / "run.parquet").to_pylist()[0]
    assert set(mcap.tip_timing) == set(run.recording.tip_timing)
    for name, seen in run.recording.tip_timing.items():
        assert seen.time.size > 1000
        read = mcap.tip_timing[name]
        assert read["time_s"].tobytes() == np.array(row[f"{name}_s"]).tobytes() == seen.time.tobytes()
        assert read["blade"].tolist() == row[f"{name}_blade"] == seen.blade.tolist()
        known = seen.true_displacement.tobytes()
        assert read["true_displacement_m"].tobytes() == np.array(row[f"{name}_true_m"]).tobytes() == known


def test_no_problem_is_found_in_the_file(folder):
    assert check_mcap(folder / "run.mcap") == []


def test_motion_changes_with_the_recording_in_memory_and_in_mcap(rub_run, tmp_path):
    """A recording that begins 0.5 s into the record holds the class it begins with, and what changes within it."""
    seconds = rub_run.recording.samples / rub_run.recording.sample_rate_hz
    times = (0.0, 0.3, 0.5 + seconds / 4, 0.5 + 2 * seconds)
    motions = (Motion.PERIOD_1, Motion.UNDECIDED, Motion.CHAOTIC, Motion.PERIOD_K)
    changes = tuple(
        Change(time=time, speed=1e3, rub=True, impulse=0.1, blisk=motion, casing=Motion.STATIC, motion=motion)
        for time, motion in zip(times, motions, strict=True)
    )
    run = dataclasses.replace(
        rub_run,
        recording=dataclasses.replace(rub_run.recording, start_seconds=0.5),
        labels=dataclasses.replace(
            rub_run.labels, history=SpeedHistory(changes=changes, onset_speed=1e3, end_of_rub_speed=None)
        ),
    )
    write_mcap(run, tmp_path / "run.mcap")
    for found in (replay_of(run).motion_classes, read_mcap(tmp_path / "run.mcap").motion_classes):
        assert [motion for _, motion in found["motion"]] == ["undecided", "chaotic"]
        assert [time for time, _ in found["motion_blisk"]] == pytest.approx([0.0, seconds / 4], abs=1e-9)
        assert {motion for _, motion in found["motion_casing"]} == {"static"}
