"""What does not fit its type is said in plain words: key, value, what is allowed, how to mend it; never pydantic's."""

import re

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rubgen.errors import UserError
from rubgen.machine import Material, load_machine
from rubgen.machine.load import PRESETS
from rubgen.machine.problems import nearest
from rubgen.scenario import Recipe, parse_recipe
from rubgen.sensors.load import parse_sensor_set

MINIMAL = {"name": "a", "runs": 1, "machine": "zeng2019"}
RAW = re.compile(r"Input should|pydantic|https?:|union_tag|valid (tuple|dictionary|integer|string)|Field required")
RECIPES = {
    "64 bits": ({"seed": 2**63}, "r.toml: seed: an integer that does not fit in 64 bits; give a smaller one"),
    "negative seed": (
        {"seed": -1},
        "r.toml: seed = -1: must be at least 0 and at most 9,223,372,036,854,775,807; change the value",
    ),
    "true for a number": ({"seed": True}, "r.toml: seed = true: must be a number; change the value"),
    "quoted number": (
        {"simulation": {"record_turns": "1000"}},
        "r.toml: simulation.record_turns = '1000': must be a number; write it without quotes",
    ),
    "a union says all that it takes": (
        {"simulation": {"settle_turns": 0}},
        "r.toml: simulation.settle_turns = 0: must be at least 1 and at most 1,000,000 or 'auto'; change the value",
    ),
    "turns without end": (
        {"simulation": {"record_turns": 10**9}},
        "r.toml: simulation.record_turns = 1000000000: must be at least 500 and at most 1,000,000; change the value",
    ),
    "runs without end": (
        {"runs": 1e12},
        "r.toml: runs = 1e+12: must be at least 1 and at most 1,000,000; change the value",
    ),
    "range without a word": (
        {"vary": {"speed_rpm": [6500, 12000]}},
        "r.toml: vary.speed_rpm = [6500, 12000]: a range is written { uniform = [6500, 12000] }; give a number o",
    ),
    "range by min and max": (
        {"vary": {"friction": {"min": 0, "max": 0.1}}},
        "r.toml: vary.friction: a range is written { uniform = [0, 0.1] }; give a number or a table of one key: ",
    ),
    "values without a word": (
        {"vary": {"lobes": [2, 3, 4]}},
        "r.toml: vary.lobes = [2, 3, 4]: values to choose from are written { choice = [2, 3, 4] }; give a nu",
    ),
    "decimal comma in quotes": (
        {"vary": {"friction": "0,02"}},
        "r.toml: vary.friction = '0,02': no such distribution; give a number or a table of one key: uniform, ",
    ),
    "decimal commas in a list": (
        {"vary": {"friction": {"uniform": [0, 1, 0, 2]}}},
        "r.toml: vary.friction.uniform = [0, 1, 0, 2]: must be a list of 2 values; decimals have a point, a comma ",
    ),
    "half a pair": (
        {"vary": {"friction": {"uniform": [0.1]}}},
        "r.toml: vary.friction.uniform = [0.1]: must be a list of 2 values; decimals have a point, a comma part",
    ),
    "percent": (
        {"vary": {"friction": 2}},
        "r.toml: vary.friction = 2: must be at least 0 and at most 0.3; 2 % is written 0.02",
    ),
    "percent elsewhere": (
        {"contact": {"restitution": 30}},
        "r.toml: contact.restitution = 30: must be at least 0 and at most 1; 30 % is written 0.3",
    ),
    "number for a table": (
        {"contact": {"liner": 3}},
        "r.toml: contact.liner = 3: must be a table of the keys bins, thickness_m, wear_m2_per_n, width_m; change the ",
    ),
    "list for a table": (
        {"labels": [1]},
        "r.toml: labels = [1]: must be a table of the keys lyapunov; change the value",
    ),
    "text for a list": (
        {"output": {"formats": "mcap"}},
        "r.toml: output.formats = 'mcap': must be a list in square brackets; change the value",
    ),
    "near value": (
        {"operation": {"profile": "runup"}},
        "r.toml: operation.profile = 'runup': unknown value; did you mean run-up? allowed: steady, run-up, ",
    ),
    "1 for true": (
        {"labels": {"lyapunov": 1}},
        "r.toml: labels.lyapunov = 1: must be true or false; change the value",
    ),
    "the first in the order of the file": (
        {"vary": {"speed_rpm": "x", "friction": "y"}, "labels": 3, "name": ""},
        "r.toml: vary.speed_rpm = 'x': no such distribution; give a number or a table of one key: uniform, ",
    ),
}


def problem(data, source="r.toml"):
    with pytest.raises(UserError) as caught:
        parse_recipe(data, source=source)
    return str(caught.value)


@pytest.mark.parametrize("case", RECIPES.values(), ids=RECIPES.keys())
def test_a_recipe_is_refused_in_plain_words(case):
    change, message = case
    order = {key: value for key, value in change.items() if key not in MINIMAL}
    text = problem({**order, **MINIMAL, **change})
    assert text.startswith(message)
    assert "\n" not in text


def test_all_problems_are_counted():
    order = {"vary": {"speed_rpm": "x", "friction": "0,02"}, "labels": 3}
    assert problem({**order, **MINIMAL, "name": ""}).endswith("log_uniform, normal, choice (4 problems in all)")
    only = problem({**MINIMAL, "vary": {"friction": "0,02"}})
    assert only.endswith("choice; decimals have a point, write 0.02")


UNKNOWN = {
    "key of another table": ({"speed_rpm": 9000}, "speed_rpm: unknown key; did you mean vary.speed_rpm? allowed: "),
    "key of another table in a table": (
        {"output": {"sample_rate_hz": 1}},
        "output.sample_rate_hz: unknown key; did you mean sensors.sample_rate_hz? allowed: formats, signal_seconds",
    ),
    "near key of another table": (
        {"signal_second": 1},
        "signal_second: unknown key; did you mean output.signal_seconds? allowed: ",
    ),
    "channels": ({"channels": ["p"]}, "channels: unknown key; did you mean sensors.set? allowed: "),
    "channels of sensors": ({"sensors": {"channels": []}}, "sensors.channels: unknown key; did you mean set? allowed"),
    "table": ({"simulaton": {}}, "simulaton: unknown key; did you mean simulation? allowed: "),
    "capitals": ({"Seed": 3}, "Seed: unknown key; did you mean seed? allowed: "),
    "one word of a key": ({"vary": {"speed": 1}}, "vary.speed: unknown key; did you mean speed_rpm? allowed: "),
    "all but a unit of several words": (
        {"surroundings": {"background": 30}},
        "surroundings.background: unknown key; did you mean background_m_per_s2? allowed: ",
    ),
    "deep": (
        {"contact": {"liner": {"thickness": 1, "wear_m2_per_n": 1, "width_m": 1}}},
        "contact.liner.thickness: unknown key; did you mean thickness_m? allowed: bins, thickness_m, wear",
    ),
    "a key that is two lines": ({"a\nb": 1}, "'a\\nb': unknown key; allowed: balance, contact, "),
}


@pytest.mark.parametrize("case", UNKNOWN.values(), ids=UNKNOWN.keys())
def test_an_unknown_key_is_led_to_the_known_one(case):
    change, message = case
    text = problem(MINIMAL | change)
    assert text.startswith(f"r.toml: {message}")
    assert "\n" not in text


def test_a_misspelt_key_is_one_problem_not_two():
    text = problem({"name": "a", "rums": 1, "machine": "zeng2019"})
    assert text.startswith("r.toml: rums: unknown key; did you mean runs?")
    assert "problems in all" not in text


@pytest.mark.parametrize(
    "change",
    [
        {"machine": "a" * 5000},
        {"sensors": {"set": "b" * 5000}},
        {"output": {"formats": ["mcap"] * 5000}},
        {"vary": {"friction": [0.1] * 5000}},
        {"vary": {"friction": [["c" * 5000]] * 3}},
        {"operation": {"forbidden_speed_rpm": ["x"] * 5000}},
    ],
)
def test_a_message_about_a_long_value_is_short(change):
    assert len(problem(MINIMAL | change)) < 1000


@pytest.mark.parametrize("pair", [[], ["x", "y"], [{}, {}, {}]])
def test_twenty_thousand_problems_are_said_as_the_first(pair):
    """Comparing each with each took minutes."""
    text = problem(MINIMAL | {"operation": {"forbidden_speed_rpm": [pair] * 20_000}})
    assert text.startswith("r.toml: operation.forbidden_speed_rpm.0")
    assert text.endswith("(more than 500 problems in all)")


def test_tables_in_one_another_without_end():
    deep = {}
    for _ in range(3000):
        deep = {"a": deep}
    assert problem(MINIMAL | {"x": deep}) == "r.toml: x.a.a: tables or lists in one another without end; write it flat"


def test_numbers_of_numpy_are_numbers():
    recipe = parse_recipe({**MINIMAL, "vary": {"speed_rpm": np.int64(9000), "friction": np.float32(0.25)}})
    assert recipe.scenario(0).operation.speed_rpm == 9000
    assert recipe.scenario(0).contact.friction == 0.25
    assert Material(youngs_modulus_pa=np.float64(2e11), poisson_ratio=0, density_kg_per_m3=np.int64(7850))


MACHINES = {
    "nodes": ("nodes = 180", "nodes = 1000000", "casing.nodes = 1000000: must be at least 12 and at most 1,440; ch"),
    "elements": ("elements = 20", "elements = 100000", "blades.elements = 100000: must be at least 1 and at most 200;"),
    "blades": ("count = 36", "count = 1e6", "blades.count = 1000000: must be at least 2 and at most 1,000; change"),
    "key of a table": ("[disk]", "clearance_m = 3e-4\n[disk]", "clearance_m: unknown key; did you mean casing.clear"),
    "the material of that part": (
        "[casing]",
        "[casing]\ndensity_kg_per_m3 = 7850",
        "casing.density_kg_per_m3: unknown key; did you mean casing.material.density_kg_per_m3?",
    ),
    "the seed of mistuning": (
        "count = 36",
        "count = 36\nmistuning = { relative_std = 0.1, seed = 0x8000000000000000 }",
        "blades.mistuning.seed: an integer that does not fit in 64 bits",
    ),
    "quoted": ("count = 36", 'count = "36"', "blades.count = '36': must be a number; write it without quotes"),
}


@pytest.mark.parametrize("case", MACHINES.values(), ids=MACHINES.keys())
def test_a_machine_is_refused_in_plain_words(case, tmp_path):
    old, new, message = case
    text = (PRESETS / "zeng2019.toml").read_text()
    assert old in text
    path = tmp_path / "M.TOML"  # the ending may be written in capitals
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(UserError) as caught:
        load_machine("M.TOML", tmp_path)
    assert str(caught.value).startswith(f"{path}: {message}")


SENSOR = 'name = "m"\n[[sensors]]\nname = "p"\nkind = "proximity"\nangle_deg = 30\n'
SENSOR_SETS = {
    "kind as a number": ("kinds = { proximity = 3 }\n" + SENSOR, "kinds.proximity = 3: must be a table; write [kinds."),
    "kinds as a number": ("kinds = 3\n" + SENSOR, "kinds = 3: must be tables; write [kinds.proximity], say"),
    "kind as a list": (SENSOR.replace('"proximity"', "[]"), "sensors.0.kind = []: unknown kind of sensor; allowed: "),
    "value of a kind": (SENSOR + "[kinds.proximity]\nnoise_rms = -1", "kinds.proximity.noise_rms = -1: must be at le"),
    "key of a kind": (
        SENSOR + "[kinds.proximity]\nnoize_rms = 1",
        "kinds.proximity.noize_rms: unknown key; did you me",
    ),
    "key of another kind": (SENSOR + "blade = 3", "sensors.0.blade: unknown key; allowed: adc_bits, angle_deg, bandwi"),
    "one table for a list": (
        SENSOR.replace("[[", "[").replace("]]", "]"),
        "sensors = { name = 'p', kind = 'proximity'",
    ),
    "numbers for tables": ('name = "m"\nsensors = [3]', "sensors.0 = 3: must be a table"),
    "name": (SENSOR.replace('"p"', '"p q"'), "sensors.0.name = 'p q': must begin with a letter and go on with letters"),
}


@pytest.mark.parametrize("case", SENSOR_SETS.values(), ids=SENSOR_SETS.keys())
def test_a_sensor_set_is_refused_in_plain_words(case, tmp_path):
    text, message = case
    (tmp_path / "s.toml").write_text(text)
    with pytest.raises(UserError) as caught:
        parse_sensor_set(tmp_path / "s.toml")
    assert str(caught.value).startswith(f"{tmp_path / 's.toml'}: {message}")


LEAVES = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5) | st.dates()
VALUES = st.recursive(LEAVES, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner))
TABLES = [key for key, field in Recipe.model_fields.items() if hasattr(field.annotation, "__mro__")]


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.sampled_from(TABLES), VALUES | st.dictionaries(st.sampled_from(["set", "formats", "liner", "x"]), VALUES))
def test_whatever_stands_in_a_recipe_works_or_is_refused_in_one_plain_line(key, value):
    try:
        parse_recipe({**MINIMAL, key: value}, source="r.toml")
    except UserError as error:
        text = str(error)
        assert "\n" not in text
        assert not RAW.search(text)


@pytest.mark.parametrize("value", ["1e-300", "0.5", "1e30", "1e300", "inf"])
def test_a_modulus_with_which_nothing_can_be_factorised_is_refused(value, tmp_path):
    text = (PRESETS / "zeng2019.toml").read_text().replace("2.06e11", value, 1)
    (tmp_path / "m.toml").write_text(text)
    with pytest.raises(UserError, match=r"disk.material.youngs_modulus_pa = \S+: must be (at least 1 and|a finite)"):
        load_machine("m.toml", tmp_path)


def test_of_a_thousand_names_forty_are_listed():
    names = [f"acc_{number}" for number in range(1000)]
    text = nearest("acc_99x", names)
    assert text.startswith("did you mean acc_99")
    assert text.endswith("acc_39 and 960 more")
    assert nearest("b", names[:40]).endswith("acc_38, acc_39")


@pytest.mark.parametrize("key", ["\n", "a\r\nb", "", "two words"])
def test_a_key_that_toml_would_quote_is_shown_in_quotes(key):
    with pytest.raises(UserError) as told:
        parse_recipe({**MINIMAL, "name": {key: None}}, source="r.toml")
    assert f"name = {{ {key!r} = None }}: must be a text" in str(told.value)
    assert "\n" not in str(told.value)
