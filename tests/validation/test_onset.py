from dataclasses import replace
from math import cos, pi

import pytest

from rubgen.contact import casing_surface
from rubgen.contact.geometry import blade_tips
from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.linear.rub_free import free_penetration, rub_free_motion
from rubgen.units import rad_per_s
from validation.onset import ONSET_RPM, chord_inset, fit_unbalance_and_clearance, tip_growth


def test_preset_stands_where_the_fit_puts_it():
    machine = load_machine("zeng2019")
    unbalance, clearance = fit_unbalance_and_clearance(machine)
    assert machine.unbalance_kg_m == pytest.approx(unbalance, rel=1e-4)
    assert machine.casing.clearance_m == pytest.approx(clearance, abs=5e-8)


def test_growth_without_unbalance_is_the_steady_centrifugal_one():
    """The independent model of the preset's reference found 109.6 um at 6,720 and 242.8 um at 10,000 rev/min."""
    machine = replace(load_machine("zeng2019"), unbalance_kg_m=0.0)
    assert tip_growth(machine, 6720.0) == pytest.approx(109.6e-6, rel=5e-3)
    assert tip_growth(machine, 10000.0) == pytest.approx(242.8e-6, rel=5e-3)


def test_chords_of_a_round_casing_are_a_regular_polygon():
    machine = load_machine("zeng2019")
    round_casing = replace(machine, casing=replace(machine.casing, ovality_m=0.0))
    assert chord_inset(round_casing) == pytest.approx(round_casing.casing_mean_radius_m * (1 - cos(pi / 180)), rel=1e-9)


def test_with_the_clearance_fitted_for_chords_the_tips_just_touch_at_the_onset():
    """By the solver's own surface and clearance; with the preset's clearance they are 56 um inside."""
    machine = load_machine("zeng2019")
    unbalance, clearance = fit_unbalance_and_clearance(machine, "chords")
    assert unbalance == pytest.approx(machine.unbalance_kg_m, rel=1e-4)
    fitted = replace(machine, unbalance_kg_m=unbalance, casing=replace(machine.casing, clearance_m=clearance))
    for one, depth in ((fitted, 0.0), (machine, 56.2e-6)):
        system = reduce(one, Reduction()).at_speed(rad_per_s(ONSET_RPM))
        surface = casing_surface(system, ContactLaw(surface="chords"))
        found = free_penetration(rub_free_motion(system, 1024), surface, blade_tips(system))
        assert found == pytest.approx(depth, abs=0.5e-6)
