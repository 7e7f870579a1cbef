"""`free_penetration_m` in place of the clearance: the clearance follows, so near misses and grazing rubs are drawn."""

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.pipeline import simulate
from rubgen.scenario import make_scenario, parse_recipe
from rubgen.scenario.scenario import scenario_dict
from rubgen.scenario.vary import DIMENSIONS, KEYS, sobol_point
from rubgen.solver.linear.reach import deepest, with_clearance

BASE = {"name": "graze", "runs": 4, "machine": "zeng2019"}
DEPTH = {"uniform": [-1e-4, 5e-5]}


def test_a_run_has_the_drawn_penetration_and_another_clearance():
    recipe = parse_recipe({**BASE, "vary": {"free_penetration_m": DEPTH, "speed_rpm": {"uniform": [7000, 9500]}}})
    for index in range(4):
        drawn = recipe.scenario(index)
        found = with_clearance(drawn)
        assert -1e-4 <= drawn.free_penetration_m <= 5e-5
        assert found.free_penetration_m is None
        assert deepest(found)[0] == pytest.approx(drawn.free_penetration_m, abs=1e-9)
        assert deepest(drawn) == deepest(found)
    assert "free_penetration_m" not in scenario_dict(found)


def test_a_run_up_has_the_penetration_of_its_worst_speed():
    """The orbit peaks at the critical speed, 8,780 rev/min, inside the run-up, and at neither end."""
    run_up = {"profile": "run-up", "end_speed_rpm": 10000, "duration_s": 1, "signal_seconds": 0.1}
    drawn = make_scenario(speed_rpm=8000, free_penetration_m=2e-5, **run_up)
    depth, speed = deepest(with_clearance(drawn))
    assert depth == pytest.approx(2e-5, abs=1e-9)
    assert 8250 <= speed <= 9750
    with pytest.raises(UserError, match=rf"^free_penetration_m = 0.01: at {speed:g} rev/min it needs a clearance of -"):
        with_clearance(make_scenario(speed_rpm=8000, free_penetration_m=0.01, **run_up))


@pytest.mark.parametrize("more", [{}, {"gravity_m_per_s2": 9.81, "fault": "casing-off-centre", "offset_m": 5e-5}])
@pytest.mark.parametrize(("depth", "rubs"), [(-2e-6, False), (2e-6, True)])
def test_a_rub_begins_at_depth_0(depth, rubs, more):
    """Two micrometres to either side of grazing, with faults and gravity too."""
    scenario = make_scenario(speed_rpm=8000, free_penetration_m=depth, lyapunov=False, signal_seconds=0.1, **more)
    run = simulate(scenario)
    assert run.labels.rub == rubs
    assert run.labels.amounts.free_penetration == pytest.approx(depth, abs=1e-7)
    assert run.scenario.machine.casing.clearance_m != scenario.machine.casing.clearance_m
    again = simulate(make_scenario(**run_keys(run), lyapunov=False, signal_seconds=0.1, **more))
    np.testing.assert_array_equal(again.response.section_q, run.response.section_q)


def run_keys(run):
    return {"speed_rpm": 8000, "clearance_m": run.scenario.machine.casing.clearance_m}


def test_it_has_a_dimension_of_its_own():
    point = sobol_point(3, 5)
    assert len(KEYS) < DIMENSIONS
    assert point["free_penetration_m"] not in [value for key, value in point.items() if key != "free_penetration_m"]


def test_mistakes_are_one_line():
    with pytest.raises(UserError, match=r"^r: vary.free_penetration_m: stands beside clearance_m, which follows from"):
        parse_recipe({**BASE, "vary": {"free_penetration_m": DEPTH, "clearance_m": 3e-4}}, source="r")
    with pytest.raises(UserError, match=r"^free_penetration_m: stands beside clearance_m"):
        make_scenario(free_penetration_m=0, clearance_m=3e-4)
    with pytest.raises(UserError, match=r"^free_penetration_m = 0.01: at 8000 rev/min it needs a clearance of -"):
        simulate(make_scenario(speed_rpm=8000, free_penetration_m=0.01))
