"""The motion in MCAP: read back as it was, and what a damaged file still gives."""

import dataclasses

import numpy as np
import pytest
from mcap.reader import make_reader

from rubgen.errors import UserError
from rubgen.io.mcap import check_mcap, read_mcap, write_mcap
from rubgen.io.mcap.foxglove import transform_descriptor_set
from rubgen.io.mcap.read import salvage_mcap
from rubgen.measurement.motion import MotionFrames, motion_frames


@pytest.fixture
def good(rub_run, tmp_path):
    path = tmp_path / "run.mcap"
    write_mcap(rub_run, path)
    return path


def test_frames_read_back_to_float32(rub_run, good):
    sent, read = motion_frames(rub_run.response, rub_run.recording), read_mcap(good).frames
    for name in MotionFrames.__dataclass_fields__:
        expected = getattr(sent, name)
        exact = expected if name in ("time", "angle", "dense") else expected.astype(np.float32)
        np.testing.assert_array_equal(getattr(read, name), exact)
    assert check_mcap(good) == []


def test_the_turning_frame_is_foxgloves(rub_run, good):
    frames = motion_frames(rub_run.response, rub_run.recording)
    with good.open("rb") as stream:
        found = list(make_reader(stream).iter_messages(topics=["/tf"]))
    assert len(found) == frames.time.size
    schema = found[0][0]
    assert (schema.name, schema.encoding, schema.data) == (
        "foxglove.FrameTransform",
        "protobuf",
        transform_descriptor_set(),
    )
    assert [message.log_time for _, _, message in found] == [round(1e9 * time) for time in frames.time]


def test_a_run_without_a_track_has_no_motion(rub_run, tmp_path):
    bare = dataclasses.replace(rub_run, response=dataclasses.replace(rub_run.response, track=None))
    write_mcap(bare, tmp_path / "bare.mcap")
    assert read_mcap(tmp_path / "bare.mcap").frames is None
    assert check_mcap(tmp_path / "bare.mcap") == []


def test_a_good_file_has_lost_nothing(good):
    run, lost = salvage_mcap(good)
    assert lost == []
    assert not any(np.isnan(values).any() for values in run.signals.values())


def test_a_damaged_chunk_is_named_and_the_rest_is_there(rub_run, good):
    data = bytearray(good.read_bytes())
    data[len(data) // 3] ^= 1
    good.write_bytes(data)
    run, lost = salvage_mcap(good)
    assert len(lost) == 1
    assert lost[0].startswith("everything between ")
    gone = kept = 0
    for name, channel in rub_run.recording.channels.items():
        values = run.signals[name]
        there = np.isfinite(values)
        assert values.size == channel.values.size
        assert values[there].tobytes() == channel.values[there].tobytes()
        gone, kept = gone + np.count_nonzero(~there), kept + np.count_nonzero(there)
    assert gone > 0
    assert kept > 0


def test_a_file_cut_short_gives_its_beginning(rub_run, good):
    data = good.read_bytes()
    good.write_bytes(data[: 2 * len(data) // 3])
    run, lost = salvage_mcap(good)
    assert "cannot be followed to its end" in lost[-1]
    values = run.signals["contact_force"]
    assert np.isfinite(values[:1024]).all()
    assert np.isnan(values[-1])


@pytest.mark.parametrize("content", [b"", b"nothing of the kind", None])
def test_what_is_no_file_of_rubgen_is_refused(tmp_path, content):
    path = tmp_path / "other.mcap"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(UserError, match=r"other\.mcap"):
        salvage_mcap(path)
