import dataclasses
import resource

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.io.mcap import check_mcap, read_mcap, write_mcap


@pytest.fixture
def good(rub_run, tmp_path):
    path = tmp_path / "run.mcap"
    write_mcap(rub_run, path)
    return path


def test_a_good_file_has_no_problems(good):
    assert check_mcap(good) == []


def test_a_file_of_another_run_is_found(good, rub_run):
    own = rub_run.scenario.index
    assert check_mcap(good, f"run-{own:06d}") == []
    assert check_mcap(good, f"run-{own + 1:06d}") == [f"holds run-{own:06d}"]


@pytest.mark.parametrize("seed", range(12))
def test_any_flipped_bit_is_found(good, seed):
    data = bytearray(good.read_bytes())
    position = int(np.random.default_rng(seed).integers(8, len(data) - 8))
    data[position] ^= 1 << seed % 8
    good.write_bytes(data)
    assert check_mcap(good) != []
    with pytest.raises(UserError, match=r"run\.mcap: .*generate it again"):
        read_mcap(good)


@pytest.mark.parametrize("share", [0.0, 0.001, 0.5, 0.999])
def test_a_file_cut_short_is_found(good, share):
    data = good.read_bytes()
    good.write_bytes(data[: int(share * len(data))])
    assert len(check_mcap(good)) == 1
    with pytest.raises(UserError, match="damaged"):
        read_mcap(good)


def test_a_missing_file_is_named(tmp_path):
    assert "cannot be read (No such file" in check_mcap(tmp_path / "none.mcap")[0]
    with pytest.raises(UserError, match=r"none\.mcap: cannot be read"):
        read_mcap(tmp_path / "none.mcap")


def test_a_file_of_another_format_is_not_called_damaged(tmp_path):
    path = tmp_path / "run.parquet"
    path.write_bytes(b"PAR1" + bytes(100))
    with pytest.raises(
        UserError, match=r"run\.parquet: a run is read from its \.mcap file alone; write one with rubgen"
    ):
        read_mcap(path)


def test_a_recording_shorter_than_asked_is_found(rub_run, tmp_path):
    channels = dict(rub_run.recording.channels)
    channel = channels["casing_acc_90"]
    channels["casing_acc_90"] = dataclasses.replace(channel, values=channel.values[:-5])
    recording = dataclasses.replace(rub_run.recording, channels=channels)
    with pytest.raises(ValueError, match="size"):
        write_mcap(dataclasses.replace(rub_run, recording=recording), tmp_path / "short.mcap")
    shorter = {name: dataclasses.replace(c, values=c.values[:-5]) for name, c in rub_run.recording.channels.items()}
    recording = dataclasses.replace(rub_run.recording, channels=shorter)
    write_mcap(dataclasses.replace(rub_run, recording=recording), tmp_path / "short.mcap")
    assert "/raw/contact_force: 7675 samples, the scenario asks 7680" in check_mcap(tmp_path / "short.mcap")


def test_a_failed_run_is_not_written(rub_run, tmp_path):
    failed = dataclasses.replace(rub_run, recording=None, labels=None)
    with pytest.raises(ValueError, match="nothing to record"):
        write_mcap(failed, tmp_path / "failed.mcap")
    assert list(tmp_path.iterdir()) == []


def test_nothing_half_written_is_left(rub_run, tmp_path, monkeypatch):
    monkeypatch.setattr("rubgen.io.mcap.write.labels_to_json", lambda _: {"bad": object()})
    with pytest.raises(TypeError):
        write_mcap(rub_run, tmp_path / "run.mcap")
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_nothing(rub_run, tmp_path):
    """Writing stops at 100 kB, as on a full disk."""
    _, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, hard))
    try:
        with pytest.raises(OSError, match="too large"):
            write_mcap(rub_run, tmp_path / "full.mcap")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
    assert list(tmp_path.iterdir()) == []
