"""Loose support, oil whirl and crack: the laws that they make of a machine, and machines that cannot have them."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import RubgenWarning, UserError
from rubgen.labels.labels import Motion
from rubgen.machine import load_machine
from rubgen.machine.faults.crack import Crack
from rubgen.machine.faults.loose_support import LooseSupport
from rubgen.machine.faults.oil_whirl import OilWhirl
from rubgen.pipeline import simulate
from rubgen.reduction import reduce
from rubgen.scenario import Reduction, make_scenario, parse_recipe
from rubgen.scenario.checks.feasible import check_feasible
from rubgen.units import rad_per_s

SPEED = rad_per_s(8000)
RECIPE = {"name": "r", "runs": 1, "machine": "zeng2019", "vary": {"gravity_m_per_s2": 9.81}}


@pytest.fixture(scope="module")
def preset():
    return replace(load_machine("zeng2019"), gravity_m_per_s2=9.81)


def law_of(machine, fault, speed=SPEED):
    """The one law of the reduced machine with this fault."""
    (law,) = reduce(replace(machine, faults=(fault,)), Reduction()).at_speed(speed).turning.laws
    return law


def test_a_loose_support_loses_its_share_of_the_lateral_stiffness(preset):
    law = law_of(preset, LooseSupport(lost_stiffness=0.4, gap_m=1e-5, direction_deg=60))
    assert law.numbers == pytest.approx((0.4e8, 1e-5, 0.5, math.sqrt(0.75)))


def test_a_crack_takes_its_share_of_the_lateral_stiffness(preset):
    assert law_of(preset, Crack(crack_loss=0.2, angle_deg=60)).numbers == pytest.approx((0.2e8, 0.5, math.sqrt(0.75)))


def test_the_oil_turns_in_the_damper_of_the_support(preset):
    """Its cross-coupled stiffness is the skew part of the dampers' own, from another path: the reduced matrices."""
    fault = OilWhirl(swirl_ratio=0.4, film_stiffness=0.3, film_scale_m=5e-4)
    system = reduce(preset, Reduction()).at_speed(SPEED)
    law = law_of(preset, fault)
    assert law.swirl_n_per_m == pytest.approx(0.4 * system.lateral_damping * SPEED, rel=2e-3)  # mass without mesh
    assert (law.soft_n_per_m, law.scale_m) == (pytest.approx(0.7e8), 5e-4)
    assert law_of(preset, fault, 2 * SPEED).swirl_n_per_m == pytest.approx(2 * law.swirl_n_per_m)


def test_a_machine_that_cannot_have_a_fault_is_one_line():
    with pytest.raises(UserError, match=r"^faults: crack: gravity_m_per_s2 = 0, .* give the machine gravity_m_per_s2"):
        make_scenario(fault="crack", crack_loss=0.2)
    scenario = make_scenario(fault="oil-whirl")
    undamped = replace(scenario.machine, damping=replace(scenario.machine.damping, lateral=0.0))
    with pytest.raises(UserError, match=r"^faults: oil-whirl: damping.lateral = 0, "):
        check_feasible(replace(scenario, machine=undamped))


def test_a_crack_that_the_unbalance_would_open_is_doubted():
    """Its warning tells both displacements; with a hundredth of the unbalance there is none."""
    given = {"speed_rpm": 4300, "gravity_m_per_s2": 9.81, "fault": "crack", "crack_loss": 0.2}
    with pytest.warns(
        RubgenWarning, match=r"^crack_loss = 0.2: the unbalance moves the disk by 38.* um, its sag is 11.6"
    ):
        make_scenario(**given)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        make_scenario(**given, unbalance_kg_m=1.45e-4)


@pytest.mark.parametrize(
    ("kind", "key", "value"),
    [
        ("loose-support", "lost_stiffness", 1.0),
        ("loose-support", "gap_m", 0.2),
        ("crack", "crack_loss", 0.6),
        ("oil-whirl", "swirl_ratio", 1.0),
        ("oil-whirl", "film_stiffness", 0.0),
        ("oil-whirl", "film_scale_m", 0.0),
    ],
)
def test_values_out_of_bounds_are_refused_where_they_stand(kind, key, value):
    needed = {"loose-support": {"lost_stiffness": 0.5}, "crack": {"crack_loss": 0.1}, "oil-whirl": {}}[kind]
    table = {"kind": kind, **needed, key: value}
    with pytest.raises(UserError, match=rf"^r.toml: faults\.0\.{key} = {value:g}"):
        parse_recipe({**RECIPE, "faults": [table]}, source="r.toml")


def test_oil_whirl_in_the_preset_is_below_half_the_speed_and_needs_no_contact():
    """Its frequency is the largest line between f_r / 4 and 3 f_r / 4, by the labels' own spectrum and by another."""
    scenario = make_scenario(speed_rpm=8000, clearance_m=4e-3, signal_seconds=0.5, lyapunov=False, fault="oil-whirl")
    run = simulate(scenario)
    assert (run.labels.rub, run.labels.motion) == (False, Motion.QUASI_PERIODIC)
    steps = run.response.steps_per_turn
    z = (run.response.taps["blisk_x"] + 1j * run.response.taps["blisk_y"])[-64 * steps :]
    lines = np.abs(np.fft.fft(z * np.hanning(z.size)))[: 64 * 2]
    assert 0.44 <= (16 + np.argmax(lines[16:48])) / 64 <= 0.47
    assert lines[16:48].max() > lines[64]
