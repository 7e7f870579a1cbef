"""Legal but surely wrong: one warning a key, with its neighbour that does not warn; what is shipped warns nothing."""

import re
import warnings
from dataclasses import replace

import pytest

from rubgen.errors import RubgenWarning, UserError
from rubgen.machine import preset_names
from rubgen.machine.load import PRESETS
from rubgen.scenario import load_recipe, make_scenario, parse_recipe
from rubgen.scenario.checks.feasible import check_feasible
from rubgen.scenario.checks.plausible import implausible
from rubgen.scenario.load import RECIPES
from rubgen.sensors.load import load_sensor_set, sensor_set_names

MINIMAL = {"name": "a", "runs": 1, "machine": "zeng2019"}
TEXT = (PRESETS / "zeng2019.toml").read_text()
VARIED = {  # key: what warns, what the warning says, a neighbour that does not
    "clearance_m": (0.22, "55 % of the radius of the blade tips; were mm meant, 0.00022 m?", 2e-3),
    "ovality_m": (0.05, "12.5 % of the radius of the blade tips", 0.015),
    "casing_thickness_m": (0.13, "32.2 % of the radius of the casing", 0.013),
    "unbalance_kg_m": (1.0, "moves the centre of mass of the blisk 0.00846 m off the axis", 0.1),
    "speed_rpm": (120_000.0, "the blade tips move at 5,030 m/s, more than 1,000", 20_000.0),
    "gravity_m_per_s2": (9810.0, "the earth has 9.81; were mm/s2 meant, 9.81 m/s2?", 9.81),
    "lateral_damping": (0.999, "machines have 0.001 to 0.3; were % meant, 0.00999?", 0.3),
    "disk_support_stiffness_n_per_m": (
        100.0,
        "on it the blisk has a frequency of 0.15 Hz; were N/um meant, 1e+08 N/m?",
        1e7,
    ),
    "casing_support_stiffness_n_per_m": (
        0.1,
        "on it the casing has a frequency of 0.26 Hz; were N/um meant, 100000 N/m?",
        1e3,
    ),
    "support_anisotropy": (0.99, "one direction has less than a 19th of the other; were % meant, 0.0099?", 0.5),
    "unbalance_angle_deg": (1.5708, "pi / 2; were rad meant, 90 degrees?", 1.5),
}


def warned(tables):
    tables = {"output": {"signal_seconds": 0.1}, **tables}
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        parse_recipe({**MINIMAL, **tables}, source="r.toml")
    assert all(issubclass(each.category, RubgenWarning) for each in found)
    return [str(each.message) for each in found]


def made(*machine, **keys):
    """A scenario and what it was warned of."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        scenario = make_scenario(*machine, **keys)
    return scenario, [str(each.message) for each in found]


@pytest.mark.parametrize("key", VARIED)
def test_a_varied_value_that_is_surely_not_meant(key):
    wrong, message, right = VARIED[key]
    assert warned({"vary": {key: wrong}}) == [f"r.toml: {key} = {wrong:g}: {message}"]
    assert warned({"vary": {key: {"uniform": sorted([right, wrong])}}}) == [f"r.toml: {key} = {wrong:g}: {message}"]
    assert warned({"vary": {key: right}}) == []


@pytest.mark.parametrize(
    ("sensors", "vary", "message"),
    [
        (
            {"sample_rate_hz": 25.6},
            {},
            "sample_rate_hz = 25.6: no channel shows the rotation, which has up to 166.7 Hz;",
        ),
        ({"sample_rate_hz": 25.6}, {}, "were kHz meant, 25600 Hz?"),
        (
            {},
            {"speed_rpm": 300},
            "sample_rate_hz = 25600: needs 16,384 steps a turn instead of 1,024, a run takes up to",
        ),
        ({"sample_rate_hz": 1e6}, {}, "sample_rate_hz = 1e+06: needs 16,384 steps a turn instead of 1,024"),
    ],
)
def test_a_rate_that_is_surely_not_meant(sensors, vary, message):
    found = warned(
        {"sensors": sensors, "vary": vary, "simulation": {"record_turns": 2000}, "output": {"signal_seconds": 0.3}}
    )
    assert len(found) == 1
    assert message in found[0]


def test_rates_that_may_be_meant():
    assert warned({"sensors": {"sample_rate_hz": 1000}}) == []
    assert warned({"sensors": {"sample_rate_hz": 200_000}}) == []
    assert warned({"vary": {"speed_rpm": 1000}}) == []


MACHINES = [
    (
        "2.06e11",
        "206.0",
        "disk.material.youngs_modulus_pa = 206: no solid of a machine has it; were GPa meant, 2.06e+11 ",
    ),
    (
        "2.06e11",
        "2.06e5",
        "disk.material.youngs_modulus_pa = 206000: no solid of a machine has it; were MPa meant, 2.06",
    ),
    (
        "7850.0",
        "7.85",
        "disk.material.density_kg_per_m3 = 7.85: no solid of a machine has it; were g/cm3 meant, 7850 k",
    ),
    ("poisson_ratio = 0.3", "poisson_ratio = -0.3", "disk.material.poisson_ratio = -0.3: metals have 0.25 to 0.35"),
    (
        "97.968e-3",
        "97.968",
        "disk.bore_thickness_m = 97.968: larger than the disk's diameter, 0.5 m; were mm meant, 0.",
    ),
    (
        "3.8551e-3",
        "3.8551",
        "blades.root_thickness_m = 3.8551: larger than the chord there, 0.047692 m; were mm meant,",
    ),
    ("50.887", "0.888", None),
    (
        "angle_deg = 50.887\ntip_angle_deg = 75.887",
        "angle_deg = 0.88815\ntip_angle_deg = 1.3245",
        "blades.root_angle_d",
    ),
    ("lobes = 2", "lobes = 2\nlobe_angle_deg = 0.785", None),
    (
        "lobes = 2",
        "lobes = 2\nlobe_angle_deg = 1.571",
        "casing.lobe_angle_deg = 1.571: pi / 2; were rad meant, 90 deg",
    ),
    ("2.06e11", "7e10", None),
    ("7850.0", "1600.0", None),
]


@pytest.mark.parametrize(("old", "new", "message"), MACHINES)
def test_a_machine_in_other_units(old, new, message, tmp_path):
    assert old in TEXT
    (tmp_path / "m.toml").write_text(TEXT.replace(old, new, 1))
    scenario, found = made(str(tmp_path / "m.toml"))
    assert found == list(implausible(scenario))
    assert (len(found) > 0) == (message is not None)
    assert message is None or found[0].startswith(message)


def test_a_sensor_at_an_angle_in_radians(tmp_path):
    sensor = '[[sensors]]\nname = "{}"\nkind = "proximity"\nangle_deg = {}\n'
    (tmp_path / "s.toml").write_text('name = "s"\n' + sensor.format("p", 1.5708) + sensor.format("q", 1.6))
    scenario = make_scenario()
    scenario = replace(scenario, sensing=replace(scenario.sensing, set=load_sensor_set("s.toml", tmp_path)))
    assert list(implausible(scenario)) == ["angle_deg of p = 1.5708: pi / 2; were rad meant, 90 degrees?"]


CANNOT = {
    "ovality_m": (8.0, "must be below the radius of the blade tips, 0.4 m; were mm meant, 0.008 m?", 0.39),
    "clearance_m": (0.4, "must be below the radius of the blade tips, 0.4 m; were mm meant, 0.0004 m?", 0.39),
    "casing_thickness_m": (1.3, "must be below the radius of the casing, 0.404298 m; were mm meant, 0.0013 m?", 0.4),
    "unbalance_kg_m": (
        14503.0,
        "would move the centre of mass 123 m off the axis, outside of the blisk; were g m",
        40.0,
    ),
}


@pytest.mark.parametrize("key", CANNOT)
def test_what_cannot_be_meant_is_an_error(key):
    wrong, message, neighbour = CANNOT[key]
    with pytest.raises(UserError) as caught:
        parse_recipe({**MINIMAL, "vary": {key: wrong}})
    assert f"recipe: {key} = {wrong:g}: {message}" in str(caught.value)
    check_feasible(made(**{key: neighbour})[0])


@pytest.mark.parametrize(
    "path", [None, *sorted(RECIPES.glob("*.toml"))], ids=lambda path: path.stem if path else "mini"
)
def test_recipes_that_are_shipped_warn_nothing(path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_recipe(path)


def test_presets_and_sensor_sets_that_are_shipped_warn_nothing():
    for name in preset_names():
        assert list(implausible(make_scenario(name))) == []
    for name in sensor_set_names():
        scenario = make_scenario()
        sensing = replace(scenario.sensing, set=load_sensor_set(name))
        assert list(implausible(replace(scenario, sensing=sensing))) == []


def test_a_key_is_warned_of_once_in_a_recipe():
    tables = {"vary": {"clearance_m": {"choice": [0.1, 0.2, 0.3]}, "speed_rpm": {"uniform": [7000, 9000]}}}
    found = warned(tables)
    assert len(found) == 1
    assert re.match(r"r.toml: clearance_m = 0.1: 25 % of", found[0])


def test_a_fault_that_begins_after_the_record_is_warned_of():
    keys = {"fault": "closing-clearance", "closing_m": 1e-5}
    make_scenario(**keys, start_s=2.9)
    with pytest.warns(RubgenWarning, match="^start_s of closing-clearance = 3: it never begins, the record lasts 3 s"):
        make_scenario(**keys, start_s=3)


def test_a_friction_that_vary_replaces_is_warned_of():
    law, drawn = {"contact": {"friction": 0.01}}, {"vary": {"friction": 0.02}}
    said = "r.toml: contact.friction = 0.01: vary.friction replaces it in every run; leave one of the two out"
    assert warned(law | drawn) == [said]
    assert warned(law) == warned(drawn) == []


def test_a_bow_of_millimetres_is_warned_of():
    assert made(fault="bow", bow_m=5e-4)[1] == []
    said = "faults.0.bow_m = 0.01: shafts are bent by 1e-6 to 5e-4 m; were mm meant, 1e-05 m?"
    assert made(fault="bow", bow_m=0.01)[1] == [said]
