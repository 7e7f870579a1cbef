"""Quantities of vibration analysis against signals of known amplitude and phase."""

from types import SimpleNamespace

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.features.condition import condition
from rubgen.sensors.load import load_sensor_set

RATE = 25600.0
SPEED_HZ = 100.0
FIELD = load_sensor_set("field")
NAMES = [each.name for each in FIELD.sampled]
PROBES = [each for each in FIELD.sampled if each.kind == "proximity"]
HOUSING = next(each for each in FIELD.sampled if each.kind == "housing_accelerometer")


def made_up(sensors=FIELD, seconds=1.0):
    """A circle of 3 V and a 2X of 0.5 V at the probes, a sine of 40 Hz at the housing, nothing elsewhere."""
    time = np.arange(RATE * seconds) / RATE
    turn = 2 * np.pi * SPEED_HZ * time
    signals = {each.name: np.zeros(time.size, np.float32) for each in sensors.sampled}
    for probe in PROBES:
        place = 3 * np.cos(turn - np.deg2rad(probe.angle_deg)) + 0.5 * np.cos(2 * turn - np.deg2rad(75))
        signals[probe.name] = np.float32(-10 + place)
    signals[HOUSING.name] = np.float32(2.0 * np.cos(2 * np.pi * 40 * time) + 5.0 * np.cos(2 * np.pi * 3000 * time))
    pulses = np.arange(seconds * SPEED_HZ) / SPEED_HZ

    def recorded(runs, _names):
        yield from ((run_id, signals, pulses) for run_id in runs)

    return SimpleNamespace(
        sensors=sensors,
        inputs=tuple(signals),
        units={each.name: each.unit for each in sensors.sampled},
        sample_rate_hz=RATE,
        ok=SimpleNamespace(index=["run-000000"]),
        recorded=recorded,
        check_has_signals=lambda _: None,
    )


def test_quantities_are_those_of_the_signal():
    frame = condition(made_up()).set_index("channel")
    assert list(frame.index) == NAMES
    for probe in PROBES:
        row = frame.loc[probe.name]
        assert row["amplitude_1x"] == pytest.approx(3, rel=1e-3)
        assert abs((row["phase_1x_deg"] - probe.angle_deg + 180) % 360 - 180) < 0.1
        assert row["amplitude_2x"] == pytest.approx(0.5, rel=1e-3)
        assert row["phase_2x_deg"] == pytest.approx(75, abs=0.1)
        assert row["not_1x_rms"] == pytest.approx(0.5 / np.sqrt(2), rel=1e-3)
        assert row["overall_rms"] == pytest.approx(np.sqrt(4.5 + 0.125), rel=1e-3)
        assert row["gap_voltage_v"] == pytest.approx(-10, rel=1e-4)
        assert np.isnan(row["velocity_rms_mm_per_s"])
    turn = np.linspace(0, 2 * np.pi, 5000)
    in_line = 0.5 * np.cos(2 * turn - np.deg2rad(75))  # the same at both probes
    angles = np.deg2rad([probe.angle_deg for probe in PROBES])
    readings = 3 * np.cos(turn[:, None] - angles) + in_line[:, None]
    place = readings @ np.linalg.inv(np.column_stack([np.cos(angles), np.sin(angles)])).T
    assert frame.loc[PROBES[0].name, "s_max"] == pytest.approx(np.hypot(*place.T).max(), rel=1e-3)


def test_velocity_is_the_integral_within_its_band():
    factor = HOUSING.scale[0]
    found = condition(made_up()).set_index("channel").loc[HOUSING.name, "velocity_rms_mm_per_s"]
    assert found == pytest.approx(1e3 * 2.0 / factor / (2 * np.pi * 40) / np.sqrt(2), rel=1e-4)


def test_a_zone_comes_from_limits_alone():
    data = made_up()
    name = PROBES[0].name
    for bounds, zone in (((7, 8, 9), "A"), ((1, 7, 8), "B"), ((1, 2, 7), "C"), ((1, 2, 3), "D")):
        frame = condition(data, {name: ("overall_peak_to_peak", *bounds)}).set_index("channel")
        assert frame.loc[name, "zone"] == zone
        assert frame["zone"].isna().sum() == len(NAMES) - 1
    assert "zone" not in condition(data)


def test_without_a_tacho_there_are_no_orders():
    plain = load_sensor_set("field")
    sensors = SimpleNamespace(
        sensors=[each for each in plain.sensors if each.kind != "once_per_rev"], sampled=plain.sampled
    )
    frame = condition(made_up(sensors)).set_index("channel")
    assert frame[["amplitude_1x", "phase_1x_deg", "not_1x_rms"]].isna().all(axis=None)
    assert frame["overall_rms"].notna().all()


@pytest.mark.parametrize(
    ("limits", "message"),
    [
        ({"proximity_q": ("overall_rms", 1, 2, 3)}, "no channel 'proximity_q'; did you mean proximity"),
        ({PROBES[0].name: ("overall", 1, 2, 3)}, "no quantity 'overall'"),
        ({PROBES[0].name: ("overall_rms", 1, 2)}, "give a quantity and three limits"),
        ({PROBES[0].name: ("overall_rms", 1, 3, 2)}, "must be numbers above 0 that rise"),
        ({PROBES[0].name: ("overall_rms", 1, "2", 3)}, "must be numbers above 0 that rise"),
    ],
)
def test_mistaken_limits_are_one_line(limits, message):
    with pytest.raises(UserError, match=message) as caught:
        condition(made_up(), limits)
    assert "\n" not in str(caught.value)
