"""A single run by its keys: all that `rubgen simulate` takes, and every mistake in one line."""

import re
from inspect import getdoc, signature
from pathlib import Path

import numpy as np
import pytest

import rubgen
from rubgen.cli.option_texts import TEXTS
from rubgen.errors import RubgenWarning, UserError
from rubgen.scenario import load_recipe, make_scenario, parse_recipe
from rubgen.scenario.load import RECIPES
from rubgen.scenario.scenario import scenario_dict
from rubgen.scenario.vary import KEYS, PARAMETERS


def test_every_key_reaches_the_scenario():
    scenario = make_scenario(
        "zeng2019-fitted",
        profile="run-up",
        speed_rpm=6650,
        end_speed_rpm=6850,
        duration_s=2.0,
        settle_turns=60,
        steps_per_turn=2048,
        sample_rate_hz=12800,
        sensors="rig",
        signal_seconds=0.3,
        seed=5,
        lyapunov=False,
    )
    operation, sensing = scenario.operation, scenario.sensing
    assert scenario.machine.name == "zeng2019-fitted"
    assert (operation.profile, operation.speed_rpm, operation.end_speed_rpm) == ("run-up", 6650, 6850)
    assert (operation.duration_s, operation.settle_turns, operation.steps_per_turn) == (2.0, 60, 2048)
    assert (sensing.sample_rate_hz, sensing.set.name) == (12800, "rig")
    assert (scenario.signal_seconds, scenario.seed, scenario.labelling.lyapunov) == (0.3, 5, False)
    steady = make_scenario(record_turns=700, friction=0.05)
    assert (steady.operation.record_turns, steady.contact.friction, steady.labelling.lyapunov) == (700, 0.05, True)
    fluctuating = make_scenario(profile="fluctuating", duration_s=2, fluctuation_rpm=50, fluctuation_period_s=0.5)
    assert (fluctuating.operation.fluctuation_rpm, fluctuating.operation.fluctuation_period_s) == (50, 0.5)


def test_it_is_the_run_of_a_recipe_with_the_same_values():
    recipe = {"name": "one", "runs": 1, "seed": 4, "machine": "zeng2019", "vary": {"speed_rpm": 8000, "lobes": 3}}
    assert make_scenario(speed_rpm=8000, lobes=3, seed=4) == parse_recipe(recipe).scenario(0)


def test_every_key_is_described_with_its_default_and_ends_with_its_unit():
    text, parameters = getdoc(make_scenario), signature(make_scenario).parameters
    assert set(KEYS) <= set(parameters)
    _, ends, *items = re.split(r"\nA name ends with its unit: |\n- ", text)
    for name, parameter in parameters.items():
        described = [item for item in items if f"`{name}`" in item.split(": ")[0]] or [
            item for item in items if f"`{name}`" in item
        ]
        assert len(described) == 1, name
        default = re.search(r"(\S+) when not given", TEXTS.get(name, ""))
        assert default is None or default[1] in described[0]
        kinds = {"machine": parameter.POSITIONAL_OR_KEYWORD, "fault_keys": parameter.VAR_KEYWORD}
        assert parameter.kind is kinds.get(name, parameter.KEYWORD_ONLY)
    units = {"m": "m", "s": "s", "deg": "deg"} | {unit: end for end, unit in re.findall(r"(\w+) \(([^)]+)\)", ends)}
    for entry in PARAMETERS:
        assert entry.unit == "1" or entry.key.endswith(f"_{units[entry.unit]}")
    assert rubgen.make_scenario is make_scenario


def test_numbers_of_numpy_are_numbers():
    keys = {"speed_rpm": np.float32(6780), "lobes": np.int32(4), "record_turns": np.int64(600), "seed": np.int64(3)}
    scenario = make_scenario(Path("zeng2019"), **keys)
    assert scenario_dict(scenario) == scenario_dict(make_scenario(speed_rpm=6780, lobes=4, record_turns=600, seed=3))
    assert type(scenario.operation.record_turns) is int


RUN_UP = {"profile": "run-up", "end_speed_rpm": 12000, "duration_s": 2}
BAD = [
    (
        {"end_speed_rpm": 9000},
        'end_speed_rpm = 9000: the profile "steady" has none; leave it out or give the profile "run',
    ),
    ({"duration_s": 2}, 'duration_s = 2: the profile "steady" has none'),
    (
        {"fluctuation_rpm": 0.0},
        'fluctuation_rpm = 0: the profile "steady" has none; leave it out or give the profile "fluctuating"',
    ),
    (RUN_UP | {"fluctuation_period_s": 0.5}, 'fluctuation_period_s = 0.5: the profile "run-up" has none'),
    (
        RUN_UP | {"record_turns": 600},
        'record_turns = 600: the profile "run-up" has none; leave it out or give the profile "steady"',
    ),
    (RUN_UP | {"lyapunov": True}, 'lyapunov = true: the profile "run-up" has none'),
    ({"profile": "run-up", "duration_s": 2}, 'end_speed_rpm: the profile "run-up" needs it; add it'),
    ({"profile": "coast-down", "end_speed_rpm": 9e3}, 'duration_s: the profile "coast-down" needs it; add it'),
    (RUN_UP | {"end_speed_rpm": 9000}, "end_speed_rpm = 9000: a run-up ends above its start, speed_rpm = 10000"),
    ({"profile": "runup"}, "profile = 'runup': unknown value; did you mean run-up? allowed: steady, run-up, "),
    ({"speed_rmp": 9000}, "speed_rmp: unknown key; did you mean speed_rpm? allowed: machine, speed_rpm, "),
    ({"speed_rpm": "6000"}, "speed_rpm = '6000': must be a number; write it without quotes"),
    ({"clearance_m": True}, "clearance_m = true: must be a number"),
    ({"friction": {"uniform": [0, 0.1]}}, "friction = { uniform = [0, 0.1] }: must be a number"),
    ({"speed_rpm": np.array([1.0, 2.0])}, "speed_rpm = array([1., 2.]): must be a number"),
    ({"speed_rpm": 10**400}, "speed_rpm: an integer that does not fit in 64 bits"),
    ({"seed": 2**63}, "seed: an integer that does not fit in 64 bits"),
    ({"record_turns": 1.5}, "record_turns = 1.5: must be a whole number"),
    ({"record_turns": 20}, "record_turns = 20: labels need at least 500 turns"),
    ({"settle_turns": "long"}, "settle_turns = 'long': must be"),
    ({"lyapunov": "no"}, "lyapunov = 'no': must be true or false"),
    ({"signal_seconds": 9}, "signal_seconds = 9: the record lasts 3 s"),
    ({"sensors": "rgi"}, "sensors.set = 'rgi': no such set; did you mean rig?"),
    ({"sensors": 3}, "sensors = 3: must be a text"),
    ({"machine": None}, "machine: this key is missing; add it"),
    ({"machine": Path("gone.toml")}, "gone.toml: there is no such file"),
]


@pytest.mark.parametrize(("keys", "message"), BAD)
def test_a_mistake_is_one_line_that_says_how_to_mend_it(keys, message):
    with pytest.raises(UserError) as caught:
        make_scenario(**keys)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert not str(caught.value).startswith(":")


def test_the_run_up_of_a_recipe_and_of_keys_are_one():
    recipe = load_recipe(RECIPES / "run-up.toml")
    first = recipe.scenario(0)
    operation = first.operation
    keys = {name: getattr(operation, name) for name in ("speed_rpm", "profile", "end_speed_rpm", "duration_s")}
    assert make_scenario(**keys).operation.rotation == operation.rotation


def test_a_value_that_is_surely_not_meant_is_warned_of():
    with pytest.warns(RubgenWarning, match="clearance_m = 0.22: "):
        make_scenario(clearance_m=0.22)
