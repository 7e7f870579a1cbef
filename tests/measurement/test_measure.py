import time
from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.measurement import Recording, margin_seconds, measure
from rubgen.measurement.shaft import NOTCH_ANGLE
from rubgen.scenario import Sensing
from rubgen.solver.response import ContactEvents, EnergyBalance, Response, Status

SPEED = 2 * np.pi * 150.0  # 9,000 rev/min
STEPS = 1024
DT = 1 / 150.0 / STEPS
SENSING = Sensing(sample_rate_hz=25600.0, keep_clean=True)
NO_EVENTS = ContactEvents(
    blade=np.zeros(0, np.int64),
    start_step=np.zeros(0, np.int64),
    steps=np.zeros(0, np.int64),
    angle=np.zeros(0),
    impulse=np.zeros(0),
    friction_loss=np.zeros(0),
    normal_loss=np.zeros(0),
)
NO_ENERGY = EnergyBalance(**dict.fromkeys(EnergyBalance.__annotations__, 0.0))


def response_of(seconds: float, **signals: np.ndarray) -> Response:
    """A response whose taps are 0 but for the given signals; theta = 0 one step after the last."""
    count = int(np.ceil((seconds + margin_seconds(SENSING)) / DT))
    names = [sensor.tap.name for sensor in SENSING.set.sampled]
    taps = {name: signals.get(name, np.zeros(count)) for name in names}
    return Response(
        status=Status.OK,
        reason="",
        speed=SPEED,
        dt=DT,
        steps_per_turn=STEPS,
        settle_turns=100,
        record_turns=500,
        taps=taps,
        section_q=np.zeros((500, 125)),
        section_v=np.zeros((500, 125)),
        impulse_per_turn=np.zeros(500),
        contact_steps_per_turn=np.zeros(500, np.int64),
        events=NO_EVENTS,
        energy=NO_ENERGY,
        n_blades=36,
        n_casing=11,
    )


def time_before_end(seconds: float) -> np.ndarray:
    """Time of each step of the tail, 0 at the step after its last one."""
    count = int(np.ceil((seconds + margin_seconds(SENSING)) / DT))
    return (np.arange(count) - count) * DT


def record(response: Response, seconds: float, sensing: Sensing = SENSING, seed: int = 0) -> Recording:
    return measure(response, sensing, seconds=seconds, rng=np.random.default_rng(seed))


def test_every_sample_stands_where_rotation_angle_and_first_sample_say() -> None:
    # blisk_x is cos theta in mm: the clean channel must be cos of the angle that the recording claims for each sample.
    seconds = 0.1
    response = response_of(seconds, blisk_x=1e-3 * np.cos(SPEED * time_before_end(seconds)))
    recording = record(response, seconds)
    clean = recording.channels["proximity_x"].clean
    assert clean is not None
    assert clean.size == 2560
    time_of_sample = np.arange(2560) / 25600
    assert clean == pytest.approx(1e-3 * np.cos(recording.rotation_angle + SPEED * time_of_sample), abs=1e-7)
    start = recording.start_seconds
    assert clean[0] == pytest.approx(1e-3 * np.cos(SPEED * start), abs=1e-7)  # record starts at theta = 0 too
    last_sample = start + 2559 / 25600
    end = 500 * response.turn_seconds
    assert end - margin_seconds(SENSING) < last_sample < end - margin_seconds(SENSING) / 2 + 2 / 25600


def test_recording_does_not_depend_on_what_the_tail_holds_before_it() -> None:
    signal = 1e-3 * np.random.default_rng(3).standard_normal(time_before_end(0.2).size)
    long = response_of(0.2, blisk_y=signal)
    short = response_of(0.1, blisk_y=signal[-time_before_end(0.1).size :])
    longer, shorter = (record(r, 0.1).channels["proximity_y"].values for r in (long, short))
    assert np.array_equal(longer, shorter)


def test_once_per_rev_arrivals_are_exact_and_pulses_match_them() -> None:
    seconds = 0.2
    recording = record(response_of(seconds), seconds)
    arrivals = recording.once_per_rev
    assert arrivals.size == 30  # 0.2 s at 150 Hz
    assert np.diff(arrivals) == pytest.approx(1 / 150, rel=1e-12)
    turns = (recording.rotation_angle + SPEED * arrivals) / (2 * np.pi)
    assert turns == pytest.approx(np.round(turns), abs=1e-9)
    assert 0 <= arrivals.min() <= arrivals.max() < seconds
    pulse = recording.channels["once_per_rev"].values
    rising = np.flatnonzero(np.diff(pulse) > 0) + 1
    assert set(np.unique(pulse)) == {0.0, 1.0}
    assert np.ceil(arrivals * 25600)[-rising.size :] == pytest.approx(rising)
    assert pulse.mean() == pytest.approx(NOTCH_ANGLE / (2 * np.pi), abs=0.005)


def test_noise_has_the_stated_level_is_white_and_differs_between_channels() -> None:
    seconds = 0.5
    recording = record(response_of(seconds), seconds, replace(SENSING, adc_bits=24, noise=2.0))
    channels = [recording.channels[sensor.name] for sensor in SENSING.set.sampled]
    noise = np.stack([channel.values for channel in channels]).astype(float)
    assert noise.std(axis=1) == pytest.approx([channel.noise_rms for channel in channels], rel=0.03)
    assert channels[0].noise_rms == 2 * SENSING.set.sampled[0].noise_rms
    scaled = noise / noise.std(axis=1, keepdims=True)
    assert np.abs(np.corrcoef(noise) - np.eye(len(channels))).max() < 0.05
    assert np.abs((scaled[:, 1:] * scaled[:, :-1]).mean(axis=1)).max() < 0.05


def test_noise_of_a_channel_does_not_depend_on_the_other_signals() -> None:
    quiet = record(response_of(0.1), 0.1)
    size = time_before_end(0.1).size
    loud = record(response_of(0.1, blisk_x=np.full(size, 1e-3), casing_acc_0=np.full(size, 1e4)), 0.1)
    assert np.array_equal(quiet.channels["tip_clearance_90"].values, loud.channels["tip_clearance_90"].values)
    assert np.array_equal(quiet.channels["casing_acc_90"].values, loud.channels["casing_acc_90"].values)
    other = record(response_of(0.1), 0.1, seed=1)
    assert not np.array_equal(quiet.channels["casing_acc_90"].values, other.channels["casing_acc_90"].values)


def test_range_clips_the_values_and_leaves_the_clean_signal() -> None:
    size = time_before_end(0.1).size
    channel = record(response_of(0.1, blisk_x=np.full(size, 5e-3)), 0.1).channels["proximity_x"]
    assert channel.clean is not None
    assert channel.values == pytest.approx(channel.range_max - channel.resolution, rel=1e-6)
    assert channel.clean == pytest.approx(5e-3, rel=1e-6)


@pytest.mark.parametrize("bits", [8, 16])
def test_without_noise_values_lie_on_the_adc_grid_within_half_a_step(bits: int) -> None:
    signal = 1e-3 * np.sin(3 * SPEED * time_before_end(0.1))
    recording = record(response_of(0.1, blisk_x=signal), 0.1, replace(SENSING, noise=0.0, adc_bits=bits))
    channel = recording.channels["proximity_x"]
    assert channel.clean is not None
    assert channel.noise_rms == 0
    assert channel.resolution == pytest.approx((channel.range_max - channel.range_min) / 2**bits)
    assert np.abs(channel.values - channel.clean).max() <= channel.resolution / 2 * 1.001
    code = (channel.values.astype(float) - channel.range_min) / channel.resolution
    assert code == pytest.approx(np.round(code), abs=2e-3)


def test_clean_is_kept_on_request_only() -> None:
    response = response_of(0.1)
    assert all(c.clean is None for c in record(response, 0.1, replace(SENSING, keep_clean=False)).channels.values())
    assert all(c.clean is not None for c in record(response, 0.1).channels.values())


def test_channels_carry_what_a_reader_needs() -> None:
    recording = record(response_of(0.1), 0.1)
    assert list(recording.channels)[:2] == ["proximity_x", "proximity_y"]
    assert list(recording.channels)[-1] == "once_per_rev"
    for name, channel in recording.channels.items():
        assert channel.name == name
        assert channel.values.dtype == np.float32
        assert channel.values.shape == (2560,)
        assert channel.range_min < channel.range_max
        assert all([channel.unit, channel.quantity, channel.axis, channel.location])


def test_asking_for_more_than_the_tail_holds_is_a_user_error() -> None:
    with pytest.raises(UserError, match=r"signal_seconds = 0\.2: .*at most 0\.1"):
        record(response_of(0.1), 0.2)


def test_a_sample_rate_that_the_steps_cannot_feed_is_a_user_error() -> None:
    with pytest.raises(UserError, match=r"sample_rate_hz = 100000: at most 60000 Hz"):
        record(response_of(0.1), 0.05, replace(SENSING, sample_rate_hz=100_000.0))


def test_one_second_of_all_channels_is_measured_fast() -> None:
    response = response_of(1.0)
    record(response, 1.0)  # compiles
    times = []
    for _ in range(3):
        start = time.process_time()
        record(response, 1.0)
        times.append(time.process_time() - start)
    assert min(times) < 0.6  # 0.2 s of processor time expected
