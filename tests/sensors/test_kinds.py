"""What each kind of sensor records of known signals, in its unit, and how faults reach the channel."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.measurement import margin_seconds, measure
from rubgen.scenario import Sensing
from rubgen.sensors.kinds.accelerometer import Accelerometer
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.kinds.tip_clearance import ClearanceProbe
from rubgen.sensors.kinds.torque import Torque
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.sensor import RunoutOrder
from rubgen.sensors.sensor_set import SensorSet
from rubgen.taps import DEFAULT_TAPS, CentreDisplacement
from rubgen.units import STANDARD_GRAVITY


def record(rub_run, *sensors, noise=0.0, runout=(), **taps):
    """Ideal and real channels of these sensors on the made signals, some of them replaced."""
    sensing = Sensing(
        noise=noise, adc_bits=24, keep_clean=True, set=SensorSet(name="t", sensors=sensors, shaft_runout=runout)
    )
    response = replace(rub_run.response, taps=rub_run.response.taps | taps)
    return measure(response, sensing, seconds=0.2, rng=np.random.default_rng(0))


def test_taps_are_those_of_every_run_and_the_set_s_own_once():
    assert load_sensor_set("default").taps == DEFAULT_TAPS
    pair = SensorSet(
        name="p", sensors=tuple(Proximity(name=n, angle_deg=a) for n, a in (("a", 45), ("b", 45), ("c", 0)))
    )
    assert pair.taps == (*DEFAULT_TAPS, CentreDisplacement(name="blisk_45", angle_deg=45))
    assert pair.sampled[2].tap.name == "blisk_x"
    names = [tap.name for tap in load_sensor_set("rig").taps]
    assert len(set(names)) == len(names)


def test_a_tap_s_name_differs_wherever_its_angle_does():
    """A millionth of a millionth of a degree makes another true signal: taps are found by their names."""
    names = [Accelerometer(name="a", angle_deg=angle).tap.name for angle in (90, 90 + 1e-12, 22.5, 1e-12, 0, -0.0)]
    assert names[0] == "casing_acc_90"
    assert names[2:] == ["casing_acc_22p5", "casing_acc_1em12", "casing_acc_0", "casing_acc_0"]
    assert len(set(names)) == 5


def test_units(rub_run):
    made = 2e-4 * np.sin(np.arange(rub_run.response.taps["blisk_x"].size) * 0.01)
    channels = record(
        rub_run,
        Proximity(name="m", angle_deg=0),
        Proximity(name="um", angle_deg=0, unit="um"),
        Proximity(name="v", angle_deg=0, unit="V", sensitivity_v_per_m=8000, bias_v=-9),
        Accelerometer(name="si", angle_deg=0),
        Accelerometer(name="g", angle_deg=0, unit="g"),
        ClearanceProbe(name="gap", angle_deg=90, unit="mm"),
        blisk_x=made,
    ).channels
    m = channels["m"].clean.astype(float)
    assert np.abs(m).max() > 1e-4
    assert channels["um"].clean == pytest.approx(1e6 * m, rel=1e-5, abs=1e-4)
    assert channels["v"].clean == pytest.approx(-9 + 8000 * m, rel=1e-5)
    assert (channels["v"].quantity, channels["m"].quantity) == ("gap voltage", "displacement")
    assert channels["g"].clean * STANDARD_GRAVITY == pytest.approx(channels["si"].clean, rel=1e-5, abs=1e-3)
    assert (channels["um"].range_min, channels["v"].range_max) == pytest.approx((-2000, -9 + 16))
    assert (channels["gap"].range_min, channels["gap"].unit) == (-1, "mm")


def test_runout_turns_with_the_shaft_under_each_probe(rub_run):
    """Order 1 of 5 um at phase 40 degrees: a probe at phi sees 5 um cos(phi - theta - 40 deg)."""
    still = np.zeros_like(rub_run.response.taps["blisk_x"])
    recording = record(
        rub_run,
        Proximity(name="x", angle_deg=0),
        Proximity(name="y", angle_deg=90),
        runout=(RunoutOrder(order=1, amplitude_m=5e-6, phase_deg=40),),
        blisk_x=still,
        blisk_y=still,
    )
    theta = recording.rotation_angle + rub_run.response.speed * np.arange(recording.samples) / 25600
    for name, phi in (("x", 0), ("y", 90)):
        expected = 5e-6 * np.cos(np.deg2rad(phi - 40) - theta)
        assert recording.channels[name].values == pytest.approx(expected, abs=2e-9)
        assert not recording.channels[name].clean.any()


def test_a_late_slow_clock_takes_the_signal_later(rub_run):
    rate = 2 * np.pi * 200
    time = rub_run.response.dt * np.arange(rub_run.response.taps["blisk_x"].size)
    made = 1e-3 * np.sin(rate * time)
    channels = record(
        rub_run,
        Proximity(name="true", angle_deg=0),
        Proximity(name="late", angle_deg=0, clock_offset_s=2e-4, clock_ppm=500),
        Proximity(name="early", angle_deg=0, clock_offset_s=-3e-4),
        blisk_x=made,
    ).channels
    samples = np.arange(channels["true"].values.size) / 25600
    phase = np.arctan2(*[(channels["true"].clean * wave(rate * samples)).sum() for wave in (np.cos, np.sin)])
    assert channels["true"].values == pytest.approx(1e-3 * np.sin(rate * samples + phase), abs=2e-6)
    late = 2e-4 + 500e-6 * samples
    assert channels["late"].values == pytest.approx(1e-3 * np.sin(rate * (samples + late) + phase), abs=2e-6)
    assert channels["early"].values == pytest.approx(1e-3 * np.sin(rate * (samples - 3e-4) + phase), abs=2e-6)
    assert channels["late"].clean == pytest.approx(channels["true"].clean, abs=1e-9)


def test_margins_hold_clocks_and_what_filters_remember():
    plain = Sensing(set=SensorSet(name="a", sensors=(Torque(name="t"),)))
    late = SensorSet(name="b", sensors=(Torque(name="t", clock_offset_s=0.01), Torque(name="u", clock_offset_s=-0.02)))
    assert margin_seconds(replace(plain, set=late)) == pytest.approx(margin_seconds(plain) + 0.03)
    ringing = SensorSet(name="c", sensors=(Torque(name="t", resonance_hz=1000, resonance_damping=0.01),))
    assert margin_seconds(replace(plain, set=ringing)) > margin_seconds(plain) + 0.1


def test_each_sensor_of_a_rig_records_its_fault_beside_the_truth(rig_run):
    recording = rig_run.recording
    for sensor in rig_run.scenario.sensing.set.sampled:
        channel, (low, high) = recording.channels[sensor.name], sensor.full_range
        assert channel.unit == sensor.unit
        assert low < channel.clean.min() < channel.clean.max() < high
        difference = channel.values.astype(float) - channel.clean
        # The median, for dropouts hold a value for 2 ms.
        assert 0 < np.median(np.abs(difference)) < 0.1 * max(np.ptp(channel.clean), 0.1 * (high - low))
        assert channel.resolution == pytest.approx((high - low) / 2 ** (sensor.adc_bits or 16))
    offset = recording.channels["tip_clearance_30"]
    assert (offset.values - offset.clean).mean() == pytest.approx(0.012, abs=2e-3)


def test_noise_of_a_sensor_depends_on_its_place_alone(rub_run):
    probes = [Proximity(name=n, angle_deg=0, noise_rms=1e-6) for n in "abc"]
    all_three = record(rub_run, *probes, noise=1.0).channels
    first_two = record(rub_run, *probes[:2], noise=1.0).channels
    assert np.array_equal(all_three["b"].values, first_two["b"].values)
    assert not np.array_equal(all_three["a"].values, all_three["b"].values)
