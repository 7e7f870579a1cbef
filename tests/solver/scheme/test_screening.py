"""Screening saves gaps and changes nothing, where its bounds hold; where they do not, nothing is screened."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.scenario import ContactLaw
from rubgen.solver.speed.start import rub_free_stepper
from validation.verification.rotors.jeffcott import ROTOR_STIFFNESS, jeffcott_system

SMOOTH = ContactLaw()


def runs(system):
    """The state after a few turns of a start from rest, and the impulse of each, screened and not."""
    for screen in (True, False):
        stepper, impulses = rub_free_stepper(system, ContactLaw(friction=0.1), 512, screen=screen), []
        stepper.set_coordinates(*np.zeros((2, len(system.M))))
        for turn in range(8):
            stepper.run_turn(clock=turn * 512)
            impulses.append(stepper.result.summary[0])
        yield stepper.coordinates.now, np.array(impulses)


@pytest.mark.parametrize("stiffness", [1e7, 6.4e6, 5e6])
def test_a_rotor_on_the_axis_touches_in_whatever_direction(stiffness):
    """Its one tip stands on the axis: at and above the critical speed its whirl is aside of the tip's radial axis."""
    system = jeffcott_system()
    K = system.K.copy()
    K[:2, :2] += (stiffness - ROTOR_STIFFNESS) * np.eye(2)
    screened, every = runs(replace(system, K=K))
    assert every[1][-1] > 1
    np.testing.assert_array_equal(screened[1], every[1])
    np.testing.assert_array_equal(screened[0], every[0])


def test_only_where_the_bounds_hold_is_screened(small_system):
    system = small_system()
    wide, narrow = (
        replace(system.surface, mean_radius=r, amplitude=np.array([a])) for r, a in ((0.2, -1e-3), (0.2, 0.02))
    )
    assert rub_free_stepper(replace(system, surface=wide), SMOOTH, 256).model.laws.screen
    assert not rub_free_stepper(replace(system, surface=wide), SMOOTH, 256, screen=False).model.laws.screen
    assert not rub_free_stepper(replace(system, surface=narrow), SMOOTH, 256).model.laws.screen
    away = system.tip_static + np.array([0.0, 0.25 * system.tip_radius, 0.0])
    assert not rub_free_stepper(replace(system, tip_static=away), SMOOTH, 256).model.laws.screen


@pytest.mark.parametrize("law", [SMOOTH, ContactLaw(restitution=0.3)])
def test_what_steps_know_of_gaps_is_the_same_without_screening(small_system, law):
    """The losses of later contacts begin with these gaps; an unknown one is computed anew, with other rounding."""
    pair = [rub_free_stepper(small_system(speed=500.0), law, 256, screen=screen) for screen in (True, False)]
    known, touched = 0, 0
    for step in range(3 * 256):
        opening = np.full(258, 4e-4 * max(0.0, 1 - step / 512))
        counts = [stepper.step(step % 256, opening)[1] for stepper in pair]
        gaps = [stepper.state.contact.step_gaps for stepper in pair]
        np.testing.assert_array_equal(*gaps)
        assert counts[0] == counts[1]
        known, touched = known + np.isfinite(gaps[0][1]).sum(), touched + counts[0]
    assert known >= touched > 50
