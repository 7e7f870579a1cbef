"""One run-up of the preset through the onset of rub, from the machine to its labels, channels and files."""

import numpy as np
import pytest
from mcap.reader import make_reader

from rubgen import make_scenario, simulate
from rubgen.dataset.reading.replaying import replay_of_mcap
from rubgen.io.mcap import check_mcap, write_mcap
from rubgen.io.parquet.read import read_table
from rubgen.io.parquet.write import write_parquet
from rubgen.units import rev_per_min

ONSET_RPM = 6720.0


@pytest.fixture(scope="module")
def run():
    scenario = make_scenario(
        speed_rpm=6650, profile="run-up", end_speed_rpm=6850, duration_s=0.3, friction=0.01, settle_turns=60,
        signal_seconds=0.3,
    )  # fmt: skip
    return simulate(scenario)


def test_rub_begins_at_the_steady_onset(run):
    """The preset is fitted to 6,720 rev/min; the tips' whirl lags the speed by some 1 / (2 zeta f), 5 ms: 3 rev/min."""
    assert rev_per_min(run.labels.history.onset_speed) == pytest.approx(ONSET_RPM, abs=10)
    assert [change.rub for change in run.labels.history.changes] == [False, True]
    assert run.response.energy.residual < 1e-8


def test_pulses_and_the_pulse_channel_follow_the_speed(run):
    recording, rotation = run.recording, run.response.changing_speed.rotation
    times = recording.once_per_rev + recording.start_seconds
    turns = rotation.angle(times) / (2 * np.pi)
    np.testing.assert_allclose(turns, np.rint(turns), atol=1e-9)
    assert np.all(np.diff(np.rint(turns)) == 1)
    assert np.all(np.diff(np.diff(times)) < 0)
    pulses = recording.channels["once_per_rev"].values
    rises = (np.flatnonzero(np.diff(pulses) > 0) + 1) / recording.sample_rate_hz
    nearest = np.abs(rises[:, None] - recording.once_per_rev).min(axis=1)
    assert nearest.max() <= 1 / recording.sample_rate_hz
    angle = float(rotation.angle(recording.start_seconds))
    assert np.mod(angle, 2 * np.pi) == pytest.approx(recording.rotation_angle, abs=1e-9)


def test_the_channels_show_the_orbit_at_the_angle_of_the_record(run):
    """Before the onset the disk centre whirls with the unbalance: its channel is the section turned by theta."""
    recording, response = run.recording, run.response
    rotation, centre = response.changing_speed.rotation, 3 * response.n_blades
    sample = round((0.05 - recording.start_seconds) * recording.sample_rate_hz)
    theta = float(rotation.angle(recording.start_seconds + sample / recording.sample_rate_hz))
    q = response.section_q[int(theta / (2 * np.pi)), centre : centre + 2]
    expected = (q[0] + 1j * q[1]) * np.exp(1j * theta)
    seen = [float(recording.channels[f"proximity_{axis}"].values[sample]) for axis in "xy"]
    assert seen[0] + 1j * seen[1] == pytest.approx(expected, abs=0.03 * abs(expected))


def test_files_hold_the_labels_over_time(run, tmp_path):
    write_mcap(run, tmp_path / "run.mcap")
    assert check_mcap(tmp_path / "run.mcap") == []
    with (tmp_path / "run.mcap").open("rb") as stream:
        times = [message.log_time for _, _, message in make_reader(stream).iter_messages(topics=["/labels/motion"])]
    onset = run.labels.history.changes[1].time - run.recording.start_seconds
    assert times == [0, pytest.approx(onset * 1e9, abs=1)]
    begin = replay_of_mcap(tmp_path / "run.mcap").replay.recording.start_seconds
    assert begin == pytest.approx(run.recording.start_seconds, abs=run.response.dt)
    write_parquet(run, tmp_path / "run.parquet")
    row = read_table(tmp_path / "run.parquet").to_pylist()[0]
    assert row["change_rub"] == [0, 1]
    assert row["end_speed_rpm"] == 6850
    assert len(row["blisk_x_window_amplitudes"]) == 20 * len(row["window_starts_s"])
