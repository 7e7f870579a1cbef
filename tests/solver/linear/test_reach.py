"""A set in which nothing can rub is told before it is made, from the motion without rub."""

import math
import warnings
from dataclasses import replace

import pytest

from rubgen.balancing.screen import reaches
from rubgen.dataset.making.generate import generate
from rubgen.dataset.reading.open import DataSet
from rubgen.errors import RubgenWarning
from rubgen.pipeline import simulate
from rubgen.planning.plan import Reach
from rubgen.scenario import Labelling, load_recipe, make_scenario, parse_recipe
from rubgen.scenario.load import RECIPES
from rubgen.solver.linear.reach import deepest, no_rub_warning
from rubgen.solver.refusal import no_run_warning

SLOW = {
    "name": "slow",
    "runs": 2,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [690, 1190]}},
    "sensors": {"sample_rate_hz": 2560},
    "labels": {"lyapunov": False},
    "output": {"formats": ["parquet"], "signal_seconds": 0.2},
}


@pytest.mark.parametrize("speed", [8000.0, 3000.0])
def test_the_penetration_is_that_of_the_run(speed):
    scenario = replace(make_scenario(speed_rpm=speed), labelling=Labelling(lyapunov=False), signal_seconds=0.1)
    response = simulate(scenario).response
    depth, at = deepest(scenario)
    assert at == pytest.approx(speed)
    assert depth == pytest.approx(response.free_penetration, abs=1e-7)
    rubs = bool(response.contact_steps_per_turn.any())
    assert rubs == (depth > 0) == (no_rub_warning([scenario, scenario]) is None) == (speed > 5000)


def test_speeds_in_rad_per_s_are_asked_about_where_they_would_rub():
    text = no_rub_warning([parse_recipe(SLOW).scenario(index) for index in range(2)])
    assert text.startswith(
        "no blade can reach the casing in any of the 2 runs looked at: the largest free penetration "
    )
    assert "; were rad/s meant? A blade would: " in text
    for values in ({"speed_rpm": 4000}, {"clearance_m": 2e-3}):
        scenario = make_scenario(**values)
        assert "rad/s" not in no_rub_warning([scenario, scenario])
        assert no_rub_warning([scenario]) is None  # one run without rub may be meant
    assert "in this run" in no_rub_warning([make_scenario(speed_rpm=1000.0)])


AIR = {"speed_rpm": 8000, "clearance_m": 9e-4}
GROWING = [
    ({"fault": "closing-clearance", "closing_m": 6e-4}, True),
    ({"fault": "closing-clearance", "closing_m": 1e-5}, False),
    ({"fault": "growing-unbalance", "kg_m": 1e-2}, True),
    ({"fault": "bow", "bow_m": 1e-5, "growth_s": 0.1}, True),
    ({"fault": "bow", "bow_m": 1e-5}, False),
]


@pytest.mark.parametrize(("fault", "may_rub"), GROWING)
def test_what_grows_within_the_record_may_use_up_the_gap(fault, may_rub):
    """Only the run shows it then: no warning, and a plan that counts the run. What cannot reach is warned of."""
    scenario = make_scenario(**AIR, **fault)
    depth, _ = deepest(scenario)
    assert (depth == math.inf) is may_rub
    assert (no_rub_warning([scenario] * 2) is None) is may_rub
    assert Reach(depth_m=depth).can_rub is may_rub
    assert reaches(scenario) is (False if "growth_s" not in fault and fault["fault"] == "bow" else None)
    there = make_scenario(**AIR | {"clearance_m": 1e-5}, **fault)
    assert 0 < deepest(there)[0] < math.inf


def test_a_run_up_is_looked_at_over_its_speeds():
    recipe = load_recipe(RECIPES / "run-up.toml")
    depth, speed = deepest(recipe.scenario(0))
    assert depth > 0
    assert speed > 8000


@pytest.mark.parametrize("name", [None, "rig", "speed-sweep", "three-lobes", "run-up"])
def test_what_is_shipped_can_rub(name):
    recipe = load_recipe(RECIPES / f"{name}.toml" if name else None)
    assert no_rub_warning([recipe.scenario(index) for index in range(3)]) is None


GROWN = {"speed_rpm": 16_000, "ovality_m": 0.0, "clearance_m": 3e-4}
FAILING = [
    (GROWN, "refused", "speed_rpm = 16000: blade tips grow by "),
    ({"lateral_damping": 0.0, "speed_rpm": 12_000}, "unstable", "unstable: largest real part of the eigenvalues "),
]


@pytest.mark.parametrize(("keys", "status", "reason"), FAILING, ids=["grown", "unstable"])
def test_a_set_of_which_no_run_can_be_made_is_told_before(keys, status, reason, tmp_path):
    failing, good = make_scenario(signal_seconds=0.1, **keys), make_scenario(signal_seconds=0.1)
    assert no_rub_warning([failing] * 2) is None or status != "refused"
    assert no_run_warning([failing, good]) is None
    assert no_run_warning([failing]).startswith(f"the run cannot be integrated: {reason}")
    recipe = SLOW | {"vary": keys, "output": {"formats": ["parquet"], "signal_seconds": 0.1}}
    with pytest.warns(RubgenWarning) as found:
        made = generate(recipe, tmp_path / "set", workers=1)
    assert [str(each.message) for each in found][-1].startswith(
        f"none of the 2 runs looked at can be integrated: {reason}"
    )
    assert made.status == {status: 2}


def test_a_set_that_cannot_rub_is_warned_of_once_and_made(tmp_path):
    with pytest.warns(RubgenWarning, match="no blade can reach the casing in any of the 2 runs") as found:
        generate(SLOW, tmp_path / "set", workers=1)
    assert len(found) == 1
    assert not DataSet(tmp_path / "set").runs["rub"].any()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        generate(SLOW, tmp_path / "set", workers=1)
