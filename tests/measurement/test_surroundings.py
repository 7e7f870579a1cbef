"""What surroundings add to the taps: levels, spectra, and what sensors at two places have in common."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.measurement import measure
from rubgen.measurement.surroundings import BAND_HZ, Disturbances
from rubgen.measurement.tail import Tail
from rubgen.scenario.surroundings import Surroundings, Tone
from rubgen.taps import CasingAcceleration, CentreDisplacement, SupportForce

RPM, BLADES, STEPS = 10_000.0, 36, 1024
SPEED = RPM * 2 * np.pi / 60
DT = 60 / RPM / STEPS
TURNS = 64


def felt(surroundings: Surroundings, seed: int = 0, speed: float = SPEED, turns: int = TURNS) -> Disturbances:
    steps = np.arange(turns * STEPS)
    dt = 2 * np.pi / speed / STEPS
    tail = Tail(
        dt=dt,
        angle=np.mod(speed * dt * steps, 2 * np.pi),
        speed=np.full(steps.size, speed),
        seconds=dt * (steps.size - 1),
        blades=BLADES,
        turn=STEPS,
    )
    return Disturbances(surroundings, tail, np.random.default_rng(seed))


def casing(angle: float) -> CasingAcceleration:
    return CasingAcceleration(name=f"a{angle:.0f}", angle_deg=angle)


def probe(angle: float) -> CentreDisplacement:
    return CentreDisplacement(name=f"p{angle:.0f}", angle_deg=angle)


def spectrum(signal: np.ndarray, dt: float = DT) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies in Hz, and the mean square of each line."""
    power = 2 * np.abs(np.fft.rfft(signal) / signal.size) ** 2
    return np.fft.rfftfreq(signal.size, dt), power


def mean_square(surroundings: Surroundings, speed: float = SPEED) -> float:
    values = [felt(surroundings, seed, speed).by(casing(angle)) for seed in range(6) for angle in range(0, 360, 24)]
    return float(np.mean(np.square(values)))


def test_the_background_has_its_rms_over_the_circumference():
    # 13 random fields with some 7,700 lines each, 6 times: the relative error of the mean square is below 1 %.
    assert mean_square(Surroundings(background_m_per_s2=30.0, background_slope=0.0)) == pytest.approx(900, rel=0.03)


def test_background_and_blade_passing_rise_with_the_speed():
    slow = Surroundings(background_m_per_s2=30.0, background_slope=0.0, speed_exponent=2.0)
    assert mean_square(slow, SPEED / 2) == pytest.approx(900 / 16, rel=0.03)
    passing = Surroundings(blade_passing_m_per_s2=8.0, speed_exponent=3.0)
    assert mean_square(passing, SPEED / 2) == pytest.approx(64 / 64, rel=1e-9)


@pytest.mark.parametrize("slope", [0.0, 1.0, 2.0])
def test_the_background_falls_as_its_slope_says_within_its_band(slope):
    surroundings = Surroundings(background_m_per_s2=1.0, background_slope=slope)
    hann = np.sqrt(8 / 3) * np.hanning(256 * STEPS)  # the tail is no period of the background: without it, lines leak
    powers = [spectrum(hann * felt(surroundings, seed, turns=256).by(casing(40))) for seed in range(20)]
    frequency, power = powers[0][0], np.mean([each for _, each in powers], axis=0)
    octaves = [(500 * 2**k, 1000 * 2**k) for k in range(5)]
    levels = np.log2([power[(frequency >= low) & (frequency < high)].sum() for low, high in octaves])
    assert np.diff(levels) == pytest.approx(1 - slope, abs=0.15)
    outside = (frequency < 0.9 * BAND_HZ[0]) | (frequency > 1.1 * BAND_HZ[1])
    assert power[outside].sum() < 2e-3


@pytest.mark.parametrize("apart", [15, 30, 90])
def test_places_share_the_background_by_their_distance(apart):
    surroundings = Surroundings(background_m_per_s2=1.0, background_slope=0.0)
    products = []
    for seed in range(8):
        field = felt(surroundings, seed)
        products += [np.mean(field.by(casing(at)) * field.by(casing(at + apart))) for at in range(0, 360 - apart, 45)]
    expected = (1 + np.cos(np.deg2rad(apart) * np.arange(1, 7)).sum()) / 7
    assert np.mean(products) == pytest.approx(expected, abs=0.02)


def test_blade_passing_turns_with_the_blades():
    field = felt(Surroundings(blade_passing_m_per_s2=5.0))
    first = field.by(casing(0))
    odd = Disturbances(field.surroundings, replace(field.tail, blades=35), np.random.default_rng(0))
    # With 36 blades a quarter turn is a whole number of passages, which shows no direction.
    assert odd.by(casing(90)) == pytest.approx(np.roll(odd.by(casing(0)), STEPS // 4), abs=1e-9)
    frequency, power = spectrum(first)
    lines = frequency[power > 1e-12]
    assert lines == pytest.approx(RPM / 60 * BLADES * np.array([1, 2, 3]))
    assert np.sqrt(power.sum()) == pytest.approx(5.0)
    assert power[power > 1e-12] == pytest.approx(power.max() / np.array([1, 4, 9]))


def test_tones_stand_at_their_order_or_frequency_with_their_rms():
    frequency_hz = 3 * RPM / 60 / TURNS * 8  # a whole number of periods in the record
    tones = (Tone(order=3.25, level_m_per_s2=2.0), Tone(frequency_hz=frequency_hz, level_m_per_s2=1.0))
    frequency, power = spectrum(felt(Surroundings(tones=tones)).by(casing(10)))
    assert set(np.flatnonzero(power > 1e-9)) == {round(3.25 * TURNS), 24}
    assert frequency[24] == pytest.approx(frequency_hz)
    assert mean_square(Surroundings(tones=tones)) == pytest.approx(5.0, rel=1e-9)  # of each run, not in the mean


def test_what_the_steps_do_not_resolve_is_left_out_and_no_alias_is_heard():
    above = (Tone(order=STEPS - 24, level_m_per_s2=5.0), Tone(frequency_hz=0.99 / DT, level_m_per_s2=5.0))
    assert not felt(Surroundings(tones=above)).by(casing(0)).any()
    coarse = felt(Surroundings(blade_passing_m_per_s2=5.0))
    coarse = Disturbances(coarse.surroundings, replace(coarse.tail, blades=200), np.random.default_rng(0))
    _, power = spectrum(coarse.by(casing(0)))
    assert set(np.flatnonzero(power > 1e-9)) == {200 * TURNS, 400 * TURNS}  # the third has 1.7 steps a period


def test_a_tone_changes_no_other():
    first, second = Tone(order=3.25, level_m_per_s2=2.0), Tone(order=2.0, level_m_per_s2=0.0)
    one, two = (felt(Surroundings(tones=tones)).by(casing(10)) for tones in ((first,), (first, second)))
    assert np.array_equal(one, two)


def test_a_longer_tail_of_another_set_of_sensors_hears_the_same():
    around = Surroundings(
        background_m_per_s2=3, tones=(Tone(order=2.3, level_m_per_s2=2), Tone(frequency_hz=77.7, level_m_per_s2=1))
    )
    whole = felt(around)
    short = replace(whole.tail, angle=whole.tail.angle[5000:], speed=whole.tail.speed[5000:])
    later = Disturbances(around, short, np.random.default_rng(0))
    assert later.by(casing(40)) == pytest.approx(whole.by(casing(40))[5000:], abs=1e-9)


def test_a_steady_speed_is_heard_as_any_other():
    """Where every turn is alike, one turn and few exponentials make the signals; they are those of each step."""
    tones = tuple(Tone(order=order, level_m_per_s2=2) for order in (1, 2, 3.7, 12))
    around = Surroundings(
        background_m_per_s2=3, blade_passing_m_per_s2=4, runout_m=5e-6, shaft_drift_m=1e-5,
        tones=(*tones, Tone(frequency_hz=777.7, level_m_per_s2=1)),
    )  # fmt: skip
    for cut in (0, 1500):
        tail = felt(around).tail
        tail = replace(tail, angle=tail.angle[cut:], speed=tail.speed[cut:])
        for tap in (casing(40), probe(40)):
            one, each = (
                Disturbances(around, replace(tail, turn=turn), np.random.default_rng(0)).by(tap)
                for turn in (STEPS, None)
            )
            assert one == pytest.approx(each, abs=1e-9 * np.abs(each).max())


def test_runout_is_seen_a_quarter_turn_later_by_a_probe_at_90_degrees():
    field = felt(Surroundings(runout_m=4e-6))
    first, second = field.by(probe(0)), field.by(probe(90))
    assert second == pytest.approx(np.roll(first, STEPS // 4), abs=1e-15)
    _, power = spectrum(first)
    assert np.sqrt(2 * power[TURNS * np.array([1, 2, 3])]) == pytest.approx(4e-6 / np.array([1, 2, 3]))


def test_the_shaft_drifts_by_its_length_in_one_direction():
    field = felt(Surroundings(shaft_drift_m=1e-5))
    moved = [(field.by(probe(angle))[-1] - field.by(probe(angle))[0]) for angle in (0, 90)]
    assert np.hypot(*moved) == pytest.approx(1e-5)


def test_other_taps_feel_nothing():
    field = felt(Surroundings(background_m_per_s2=10, runout_m=1e-5, blade_passing_m_per_s2=3))
    assert field.by(SupportForce(name="force", angle_deg=0)) is None


@pytest.fixture
def measured(make_synthetic_run):
    run = make_synthetic_run(keep_clean=True)

    def channels(surroundings, *names):
        sensing = run.scenario.sensing
        if names:
            sensors = tuple(each for each in sensing.set.sensors if each.name in names)
            sensing = replace(sensing, set=replace(sensing.set, sensors=sensors))
        rng = np.random.default_rng(3)
        return measure(run.response, sensing, seconds=0.2, rng=rng, surroundings=surroundings).channels

    return channels


def test_accelerometers_and_probes_alone_feel_them_and_ideal_signals_do_not(measured):
    silent = measured(None)
    loud = measured(Surroundings(background_m_per_s2=300, runout_m=1e-4))
    changed = {name for name in silent if not np.array_equal(silent[name].values, loud[name].values)}
    assert changed == {name for name in silent if name.startswith(("casing_acc", "proximity"))}
    assert all(np.array_equal(silent[name].clean, loud[name].clean) for name in silent)
    added = loud["casing_acc_90"].values - silent["casing_acc_90"].values
    assert 100 < np.std(added) < 900


def test_a_sensor_feels_the_same_whatever_other_sensors_there_are(measured):
    around = Surroundings(background_m_per_s2=300, tones=(Tone(order=2.5, level_m_per_s2=50),))
    difference = measured(around)["casing_acc_0"].values - measured(around, "casing_acc_0")["casing_acc_0"].values
    assert np.abs(difference).max() < 20  # the noise of the sensor is another: 1 m/s2
