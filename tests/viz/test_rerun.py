import dataclasses
import json
import resource
from pathlib import Path

import numpy as np
import pytest
from rerun.chunk import RrdReader

from rubgen.labels.to_json import labels_to_json
from rubgen.machine import Unbalance
from rubgen.measurement.motion import contact_intervals
from rubgen.viz.entities.machine_shape import blade_leanings, blade_placements, drawing_factor
from rubgen.viz.entities.signals import PREVIEW_VALUES, detail_window, preview_rate, shown_channels
from rubgen.viz.replay import replay_of
from rubgen.viz.rerun import check_rrd, id_in, recording_id, write_replay, write_rrd
from rubgen.viz.views import arrangement


@pytest.fixture(scope="module")
def rrd_file(rub_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("rrd") / "run-000000.rrd"
    write_rrd(rub_run, path)
    return path


def columns(path, entity):
    """Every column of one entity, static ones included."""
    found = {}
    for chunk in RrdReader(path).stream().filter(content=entity).to_chunks():
        batch = chunk.to_record_batch()
        found |= {name: batch.column(name).to_pylist() for name in batch.schema.names}
    return found


def test_full_rate_excerpt_reads_back_to_the_bit(rub_run, rrd_file):
    window = detail_window(replay_of(rub_run))
    read = columns(rrd_file, "/detail/acceleration")
    angles = (0, 90, 180, 270)
    sent = [rub_run.recording.channels[f"casing_acc_{angle}"].values[window] for angle in angles]
    assert window.stop - window.start == 28_000 // 11  # of 11 channels; 20 turns would be 3,072 samples
    assert np.array(read["Scalars:scalars"], dtype=np.float32).tobytes() == np.column_stack(sent).tobytes()
    assert read["SeriesLines:names"] == [[f"casing_acc_{angle} [m/s2]" for angle in angles]]


def test_preview_reads_back_as_minimum_and_maximum(rub_run, rrd_file):
    values = rub_run.recording.channels["contact_force"].values
    read = columns(rrd_file, "/preview/contact_force")
    names = read["SeriesLines:names"][0]
    preview = np.array(read["Scalars:scalars"], dtype=np.float32)
    bins = [values[first : first + 25] for first in range(0, values.size, 25)]
    assert preview[:, names.index("contact_force.min [N]")].tolist() == [part.min() for part in bins]
    assert preview[:, names.index("contact_force.max [N]")].tolist() == [part.max() for part in bins]


def test_times_are_whole_nanoseconds_from_the_first_sample(rrd_file):
    (chunk,) = [c for c in RrdReader(rrd_file).stream().filter(content="/preview/gap").to_chunks() if not c.is_static]
    times = chunk.to_record_batch().column("time").cast("int64").to_pylist()
    assert times[:3] == [0, round(25 / 25600 * 1e9), round(50 / 25600 * 1e9)]
    assert len(times) == 308


def test_contacts_read_back_in_order_of_time(rub_run, rrd_file):
    touches = contact_intervals(rub_run.response, rub_run.recording)
    order = np.argsort(touches.start, kind="stable")
    read = columns(rrd_file, "/contact/impulse")
    assert [value for (value,) in read["Scalars:scalars"]] == touches.impulse[order].tolist()


def test_the_detail_window_holds_the_hardest_touch(rub_run):
    window = detail_window(replay_of(rub_run))
    touches = contact_intervals(rub_run.response, rub_run.recording)
    hardest = touches.start[np.argmax(touches.impulse)] * rub_run.recording.sample_rate_hz
    assert window.start <= hardest <= window.stop


def test_labels_and_scenario_are_properties(rub_run, rrd_file):
    read = columns(rrd_file, "/__properties/labels")
    assert json.loads(read["json"][0][0]) == labels_to_json(rub_run.labels)
    assert read["motion"] == [["period-k"]]
    assert read["rub"] == [[True]]
    scenario = json.loads(columns(rrd_file, "/__properties/scenario")["json"][0][0])
    assert scenario["operation"]["speed_rpm"] == 10000.0


def test_the_text_counts_long_lists(rub_run, tmp_path):
    long = replay_of(rub_run).labels | {"window_starts_s": [0.1 * i for i in range(50)], "orders_present": [1, 3]}
    write_replay(dataclasses.replace(replay_of(rub_run), labels=long), tmp_path / "run.rrd")
    (text,) = columns(tmp_path / "run.rrd", "/labels/text")["TextDocument:text"][0]
    assert "| window_starts_s | 50 values |" in text
    assert "| orders_present | 1, 3 |" in text
    assert text.startswith("# run-000000: zeng2019 at 10,000 rev/min\n")


def test_motion_lanes_show_each_part(rrd_file):
    lanes = {part: columns(rrd_file, f"/labels/motion/{part}")["StateChange:state"] for part in ("system", "blisk")}
    assert lanes == {"system": [["period-k"]], "blisk": [["period-1"]]}


def test_section_points_are_the_recorded_orbit_at_the_pulses(rub_run, rrd_file):
    points = columns(rrd_file, "/orbit/plane/section")["Points2D:positions"][0]
    recording = rub_run.recording
    time = np.arange(recording.samples) / recording.sample_rate_hz
    at = [np.interp(recording.once_per_rev, time, recording.channels[f"proximity_{axis}"].values) for axis in "xy"]
    np.testing.assert_allclose(points, 1e6 * np.column_stack(at), rtol=1e-6)


def test_verify_passes_with_a_default_arrangement(rrd_file):
    assert check_rrd(rrd_file) == []
    assert len(RrdReader(rrd_file).blueprints()) == 1


def names_in(part):
    """Names of a part of an arrangement and of all within it; the contents of a view are texts."""
    inner = [each for each in part.contents if not isinstance(each, str)]
    return [*([part.name] if part.name else []), *(name for each in inner for name in names_in(each))]


def test_a_near_view_says_where_every_sample_is(rub_run):
    replay = replay_of(rub_run)
    window, rate = detail_window(replay), replay.recording.sample_rate_hz
    assert 0 < window.start < window.stop <= replay.recording.samples
    said = f"samples {window.start / rate:.3f} to {window.stop / rate:.3f} s, else preview"
    near = [name for name in names_in(arrangement(replay).root_container) if name.startswith("near: ")]
    assert len(near) >= 3
    assert all(name.endswith(said) for name in near)
    full = [name for name in names_in(arrangement(replay, full=True).root_container) if name.startswith("near: ")]
    assert len(full) == len(near)
    assert not any("preview" in name for name in full)


def test_recording_id_follows_from_the_scenario(rub_run, rrd_file):
    (entry,) = RrdReader(rrd_file).recordings()
    assert entry.recording_id == recording_id(rub_run.scenario)
    assert id_in(rrd_file) == recording_id(rub_run.scenario)
    assert id_in(rrd_file.parent / "none.rrd") is None
    other = dataclasses.replace(rub_run.scenario, seed=99)
    assert recording_id(other) != recording_id(rub_run.scenario)
    assert recording_id(other).startswith("run-000000-")


def test_a_run_without_contact(free_run, tmp_path):
    write_rrd(free_run, tmp_path / "free.rrd")
    assert check_rrd(tmp_path / "free.rrd") == []
    assert columns(tmp_path / "free.rrd", "/contact/angle") == {}


def test_the_machine_moves_frame_by_frame(rub_run, rrd_file):
    frames = replay_of(rub_run).frames
    assert 256 < frames.time.size <= 256 + 48
    places = columns(rrd_file, "/machine/casing/ring")["InstancePoses3D:translations"]
    assert (len(places), len(places[0])) == (frames.time.size, 72)
    leanings = columns(rrd_file, "/machine/rotor/blades")["InstancePoses3D:mat3x3"]
    assert (len(leanings), len(leanings[0])) == (frames.time.size, 36)
    turned = columns(rrd_file, "/machine/rotor")["Transform3D:quaternion"]
    assert np.array(turned)[:, 0, 2] == pytest.approx(np.sin(frames.angle / 2), abs=1e-6)


def test_every_unbalance_has_its_mark(rub_run, tmp_path):
    """On the disk at its angle, at rest; on a blade where the drawn tip is."""
    machine = dataclasses.replace(
        rub_run.scenario.machine,
        unbalance_angle_deg=30.0,
        unbalances=(Unbalance(kg_m=2e-3, angle_deg=200.0), Unbalance(kg_m=1e-4, blade=7)),
    )
    run = dataclasses.replace(rub_run, scenario=dataclasses.replace(rub_run.scenario, machine=machine))
    write_rrd(run, tmp_path / "run.rrd")
    disk = columns(tmp_path / "run.rrd", "/machine/rotor/unbalance/disk")
    x, y, z = np.array(disk["Points3D:positions"][0]).T
    np.testing.assert_allclose(np.degrees(np.arctan2(y, x)) % 360, [30.0, 200.0], atol=1e-3)
    assert z.min() > machine.disk.rim_thickness_m / 2
    assert disk["Points3D:labels"] == [[f"unbalance {1e3 * machine.unbalance_kg_m:.3g} g m", "unbalance 2 g m"]]
    blade = columns(tmp_path / "run.rrd", "/machine/rotor/unbalance/blades")
    frames = replay_of(run).frames
    leanings = blade_leanings(machine, frames, drawing_factor(machine, frames))
    expected = blade_placements(machine)[7] + leanings[:, 7, :, 0] * machine.blades.length_m
    np.testing.assert_allclose(np.array(blade["Points3D:positions"])[:, 0], expected, atol=1e-6)
    assert blade["Points3D:labels"] == [["unbalance 0.1 g m, blade 7"]]


def test_motion_lanes_change_with_the_run(rub_run, tmp_path):
    classes = {
        "motion": [(0.0, "period-1"), (0.1, "chaotic")],
        "motion_blisk": [(0.0, "period-1")],
        "motion_casing": [(0.0, "static"), (0.1, "chaotic")],
    }
    write_replay(dataclasses.replace(replay_of(rub_run), motion_classes=classes), tmp_path / "run.rrd")
    for part, label in (("system", "motion"), ("blisk", "motion_blisk"), ("casing", "motion_casing")):
        (chunk,) = [
            each
            for each in RrdReader(tmp_path / "run.rrd").stream().filter(content=f"/labels/motion/{part}").to_chunks()
            if not each.is_static
        ]
        batch = chunk.to_record_batch()
        states = [state for (state,) in batch.column("StateChange:state").to_pylist()]
        times = [1e-9 * time for time in batch.column("time").cast("int64").to_pylist()]
        assert list(zip(np.round(times, 9).tolist(), states, strict=True)) == classes[label]


def test_contact_points_flash_while_they_touch(rub_run, rrd_file):
    replay = replay_of(rub_run)
    touches, frames = replay.touches, replay.frames
    shown = columns(rrd_file, "/machine/contact/flash")["Points3D:positions"]
    end = np.append(frames.time[1:], replay.seconds)
    for row in np.flatnonzero(frames.dense)[:-1]:
        touching = (touches.start < end[row]) & (touches.start + touches.duration > frames.time[row])
        assert len(shown[row]) == min(np.count_nonzero(touching), 24)
    assert max(map(len, shown)) > 1


def test_a_run_without_frames_has_signals_alone(rub_run, tmp_path):
    bare = dataclasses.replace(rub_run, response=dataclasses.replace(rub_run.response, track=None))
    write_rrd(bare, tmp_path / "bare.rrd")
    assert check_rrd(tmp_path / "bare.rrd") == []
    assert columns(tmp_path / "bare.rrd", "/machine/casing/ring") == {}


def test_full_holds_every_sample_and_touch(rub_run, tmp_path):
    write_replay(replay_of(rub_run), tmp_path / "full.rrd", full=True)
    read = columns(tmp_path / "full.rrd", "/detail/contact_force")["Scalars:scalars"]
    values = rub_run.recording.channels["contact_force"].values
    assert np.array(read, dtype=np.float32)[:, 0].tobytes() == values.tobytes()


@pytest.mark.parametrize("sensors", ["default", "rig"])
def test_a_file_stays_below_two_megabytes(make_synthetic_run, sensors, tmp_path):
    write_rrd(make_synthetic_run(seconds=0.65, sensors=sensors), tmp_path / "long.rrd")
    assert (tmp_path / "long.rrd").stat().st_size < 2e6


def test_of_many_passages_those_about_the_hardest_touch_stay_and_full_keeps_all(rig_run, monkeypatch, tmp_path):
    monkeypatch.setattr("rubgen.viz.entities.events.MOST_PASSAGES", 400)  # of four probes
    replay = replay_of(rig_run)
    for full in (False, True):
        write_replay(replay, tmp_path / "run.rrd", full=full)
        (chunk,) = [
            each
            for each in RrdReader(tmp_path / "run.rrd")
            .stream()
            .filter(content="/blade_tip_timing/timing_10")
            .to_chunks()
            if not each.is_static
        ]
        times = 1e-9 * np.array(chunk.to_record_batch().column("time").cast("int64").to_pylist())
        seen = replay.recording.tip_timing["timing_10"].time
        if full:
            assert times.size > 0.95 * seen.size > 400
        else:
            assert 75 <= times.size <= 101
            near = np.abs(times - replay.hardest_touch) < 20 / 36 * replay.turn_seconds
            assert near.sum() >= 19


def test_previews_do_not_grow_with_the_recording(rub_run):
    replay = replay_of(rub_run)
    bins = preview_rate(replay) * replay.seconds * 2 * shown_channels(replay)
    assert bins <= PREVIEW_VALUES
    long = dataclasses.replace(replay.recording, sample_rate_hz=replay.recording.sample_rate_hz / 40)
    longer = dataclasses.replace(replay, recording=long)
    assert preview_rate(longer) * longer.seconds * 2 * shown_channels(longer) == pytest.approx(PREVIEW_VALUES)


@pytest.mark.parametrize("damage", [lambda data: data[: len(data) // 2], lambda _: b"no recording", lambda _: b""])
def test_damage_is_found(rrd_file, tmp_path, damage):
    path = tmp_path / "damaged.rrd"
    path.write_bytes(damage(rrd_file.read_bytes()))
    assert len(check_rrd(path)) >= 1


def test_missing_content_and_file_are_named(tmp_path):
    import rerun as rr

    stream = rr.RecordingStream("other")
    stream.save(tmp_path / "other.rrd")
    stream.log("/something", rr.TextLog("else"))
    stream.disconnect()
    assert any("/preview/" in problem for problem in check_rrd(tmp_path / "other.rrd"))
    assert check_rrd(tmp_path / "none.rrd") == ["there is no such file"]


def test_a_failed_run_is_not_written(rub_run, tmp_path):
    failed = dataclasses.replace(rub_run, recording=None, labels=None)
    with pytest.raises(ValueError, match="nothing to show"):
        write_rrd(failed, tmp_path / "failed.rrd")
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_nothing(rub_run, tmp_path):
    """Writing stops at 100 kB, as on a full disk."""
    _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, hard))
    try:
        with pytest.raises(OSError, match="too large"):
            write_rrd(rub_run, tmp_path / "full.rrd")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
    assert list(tmp_path.iterdir()) == []


def test_nothing_of_a_recording_stays_behind(rub_run, tmp_path):
    """A stream of Rerun that is not released keeps two threads and its data."""
    write_rrd(rub_run, tmp_path / "first.rrd")
    threads = len(list(Path("/proc/self/task").iterdir()))
    for _ in range(4):
        write_rrd(rub_run, tmp_path / "more.rrd")
    assert len(list(Path("/proc/self/task").iterdir())) <= threads
