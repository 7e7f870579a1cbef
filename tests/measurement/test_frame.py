"""The frame between the disk's support and the sensors, against closed forms and an independent integration."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rubgen.errors import UserError
from rubgen.machine.frame import Frame, FrameMode
from rubgen.measurement import margin_seconds, measure
from rubgen.measurement.frame import FrameMotion, accelerations, spread
from rubgen.scenario import Sensing
from rubgen.scenario.surroundings import Surroundings
from rubgen.sensors.kinds.accelerometer import Accelerometer
from rubgen.sensors.kinds.housing_accelerometer import HousingAccelerometer
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.sensor_set import SensorSet
from rubgen.taps import DEFAULT_TAPS
from rubgen.units import STANDARD_GRAVITY

DT = 1e-5
MODE = FrameMode(frequency_hz=1200, damping=0.02, modal_mass_kg=40, direction_deg=0)
STEPS = np.arange(6000)


def motion(*modes: FrameMode, x: float = 0.0, y: float = 0.0) -> FrameMotion:
    """A frame under a sine of 700 Hz with these amplitudes along X and Y."""
    sine = np.sin(2 * np.pi * 700 * DT * STEPS)
    return FrameMotion(frame=Frame(modes=modes), force=(x * sine, y * sine), dt=DT)


def test_a_mode_follows_an_independent_integration_of_a_force_that_is_linear_between_the_steps():
    force = np.random.default_rng(0).standard_normal(400).cumsum()
    force -= force[0]
    time, w = DT * np.arange(force.size), 2 * np.pi * MODE.frequency_hz

    def rate(t, state):
        pushed = np.interp(t, time, force) / MODE.modal_mass_kg
        return [state[1], pushed - 2 * MODE.damping * w * state[1] - w**2 * state[0]]

    solved = solve_ivp(rate, (0, time[-1]), [0, 0], t_eval=time, rtol=1e-9, atol=1e-15, max_step=DT)
    expected = [rate(t, state)[1] for t, state in zip(time, solved.y.T, strict=True)]
    found = accelerations(MODE, force, DT)
    assert found == pytest.approx(np.array(expected), abs=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("hertz", [170.0, 1200.0, 5000.0])
def test_a_sine_has_the_amplitude_of_the_closed_form(hertz):
    """The accelerance -W^2 / (m (w^2 - W^2 + 2 i d w W)); the force between steps is a chord of the sine."""
    turned = 2 * np.pi * hertz * DT * np.arange(20_000)
    late = slice(10_000, None)
    found = 2 * np.mean((accelerations(MODE, 80 * np.sin(turned), DT) * np.exp(-1j * turned))[late]) * 1j
    w, driven = 2 * np.pi * MODE.frequency_hz, 2 * np.pi * hertz
    expected = -80 * driven**2 / (MODE.modal_mass_kg * (w**2 - driven**2 + 2j * MODE.damping * w * driven))
    assert abs(found - expected) < ((driven * DT) ** 2 / 12 + 2e-3) * abs(expected)


def test_a_force_moves_the_housing_along_the_direction_of_the_mode_alone():
    turned = replace(MODE, direction_deg=90)
    assert np.abs(motion(turned, x=100).of_housing(90)).max() < 1e-12
    moved = motion(turned, y=100)
    assert np.abs(moved.of_housing(90)).max() > 1
    assert np.abs(moved.of_housing(0)).max() < 1e-12
    assert moved.of_housing(90) == pytest.approx(motion(MODE, x=100).of_housing(0), abs=1e-12)
    assert moved.of_housing(150) == pytest.approx(moved.of_housing(90) * np.cos(np.deg2rad(60)), abs=1e-12)


def test_the_casing_has_as_many_waves_as_the_mode_says():
    mode = replace(MODE, casing_order=3, casing_angle_deg=20, casing_share=0.5)
    moved = motion(mode, x=100)
    for angle in (20, 35, 80, 200):
        expected = 0.5 * np.cos(3 * np.deg2rad(angle - 20)) * moved.of_housing(0)
        assert moved.of_casing(angle) == pytest.approx(expected, abs=1e-12)


def test_a_mode_that_the_steps_do_not_show_is_left_out():
    assert not motion(replace(MODE, frequency_hz=0.51 / DT), x=100).of_housing(0).any()
    assert motion(replace(MODE, frequency_hz=0.49 / DT), x=100).of_housing(0).any()


def test_a_frame_remembers_until_its_slowest_mode_has_decayed():
    frame = Frame(modes=(MODE,))
    struck = np.zeros(60_000)
    struck[1] = 1.0
    after = int(frame.memory_seconds / DT)
    rung = np.abs(FrameMotion(frame=frame, force=(struck, struck), dt=DT).of_housing(0))
    # As large as at first but for the mass itself: the blow is an acceleration of one step.
    assert rung[after:].max() == pytest.approx(1e-4 * rung[3:200].max(), rel=0.1)
    assert Frame(modes=(replace(MODE, frequency_hz=5000), MODE)).memory_seconds == frame.memory_seconds
    assert margin_seconds(Sensing(), 0.1, frame) == margin_seconds(Sensing(), 0.1) + frame.memory_seconds


def test_another_machine_of_the_kind_has_other_frequencies_and_masses():
    frame = Frame(modes=(MODE,) * 60)
    assert spread(frame, 0.0, np.random.default_rng(0)) == frame
    other = spread(frame, 0.05, np.random.default_rng(0))
    ratios = np.log([(mode.frequency_hz / 1200, mode.modal_mass_kg / 40) for mode in other.modes])
    assert ratios.std(axis=0) == pytest.approx([0.05, 0.05], rel=0.3)
    assert abs(np.corrcoef(ratios.T)[0, 1]) < 0.3
    assert {mode.damping for mode in other.modes} == {MODE.damping}
    spread(frame, 1.0, np.random.default_rng(0))  # stays within the bounds of a frequency


SENSORS = (
    Accelerometer(name="casing", angle_deg=45),
    HousingAccelerometer(name="housing", angle_deg=0),
    HousingAccelerometer(name="g", angle_deg=90, unit="g"),
)


@pytest.fixture
def recorded(make_synthetic_run):
    run = make_synthetic_run()
    sensing = Sensing(noise=0.0, adc_bits=24, keep_clean=True, set=SensorSet(name="s", sensors=SENSORS))
    tap = next(iter(run.response.taps.values()))
    sine = 500 * np.sin(2 * np.pi * 700 * run.response.dt * np.arange(tap.size))
    taps = run.response.taps | {"support_force_x": sine, "support_force_y": 0 * sine, "casing_acc_45": 0 * sine}
    frame = Frame(modes=(MODE, replace(MODE, direction_deg=90)))

    def channels(surroundings=None, frame=frame):
        rng, response = np.random.default_rng(3), replace(run.response, taps=taps)
        return measure(response, sensing, seconds=0.1, rng=rng, surroundings=surroundings, frame=frame).channels

    return channels


def rms_of(mode: FrameMode, hertz: float, force: float) -> float:
    w, driven = 2 * np.pi * mode.frequency_hz, 2 * np.pi * hertz
    return force * driven**2 / abs(mode.modal_mass_kg * (w**2 - driven**2 + 2j * mode.damping * w * driven)) / 2**0.5


def test_the_housing_feels_the_force_without_surroundings_and_the_casing_by_its_path(recorded):
    silent, path = recorded(), recorded(Surroundings(path_gain=0.5))
    expected = rms_of(MODE, 700, 500)
    assert silent["housing"].values.std() == pytest.approx(expected, rel=0.01)
    assert silent["housing"].clean == pytest.approx(silent["housing"].values, abs=1e-3)
    assert np.abs(silent["g"].values).max() < 1e-3
    assert not silent["casing"].clean.any()
    assert path["casing"].values.std() == pytest.approx(0.5 * np.cos(np.pi / 4) * expected, rel=0.01)
    assert not path["casing"].clean.any()
    assert np.array_equal(path["housing"].values, silent["housing"].values)


def test_the_housing_feels_the_background_as_one_body(recorded):
    loud = recorded(Surroundings(background_m_per_s2=200, speed_exponent=0))
    felt = [loud["housing"].values - loud["housing"].clean, (loud["g"].values - loud["g"].clean) * STANDARD_GRAVITY]
    # Slope 1 leaves about a tenth of the power above the band of the channel.
    assert np.mean(np.square(felt)) ** 0.5 == pytest.approx(190, rel=0.25)
    assert abs(np.corrcoef(felt)[0, 1]) < 0.3


def test_what_needs_a_frame_says_that_there_is_none(recorded):
    with pytest.raises(UserError, match=r"^housing_acc_x: .*\[frame\]"):
        recorded(frame=None)
    with pytest.raises(UserError, match=r"path_gain: .*\[frame\]"):
        recorded(Surroundings(path_gain=1), frame=None)


def test_the_set_of_the_field_has_what_machines_carry():
    field = load_sensor_set("field")
    kinds = [sensor.kind for sensor in field.sensors]
    assert {kind: kinds.count(kind) for kind in kinds} == {
        "proximity": 2,
        "accelerometer": 2,
        "housing_accelerometer": 2,
        "once_per_rev": 1,
    }
    assert not {tap.name for tap in field.taps} & {"housing_acc_x", "housing_acc_y"}
    assert set(DEFAULT_TAPS) < set(field.taps)
