"""Turns that are run in one call of the kernel are the same as turns that are run one by one."""

import numpy as np
import pytest

from rubgen.scenario import ContactLaw
from rubgen.solver.scheme.energy_kernels import ABSOLUTE, CIRCULATORY, DAMPING, UNBALANCE
from rubgen.solver.scheme.state_kernels import DIVERGED, OK
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper

STEPS, TURNS = 256, 10
"""Two turns more than the stepper has room for before it is asked."""
OPENING = 5e-4 * closing_ramp((np.arange(TURNS)[:, None] + np.arange(-1, STEPS + 1) / STEPS) / 6)


def stepper_of(system):
    stepper = rub_free_stepper(system, ContactLaw(friction=0.1), STEPS)
    stepper.take_snapshots([100, STEPS])
    return stepper


def outputs(stepper, ended):
    parts = [*stepper.result, stepper.touches.ended[:ended], stepper.snapshots.z, stepper.snapshots.step_gaps]
    return [np.array(part) for part in (*parts, stepper.end.works, stepper.end.support_works)]


def test_turns_in_one_call_are_turns_one_by_one(small_system):
    """Every output of every turn, the works and the stored energy have the same bits, and the touches go on."""
    system = small_system(speed=500.0)
    together, single = stepper_of(system), stepper_of(system)
    energies, touched = [], 0
    for turn, (code, step, ended) in enumerate(together.run_turns(OPENING, 0)):
        assert (code, step, ended) == single.run_turn(OPENING[turn], turn * STEPS)
        for many, one in zip(outputs(together, ended), outputs(single, ended), strict=True):
            np.testing.assert_array_equal(many, one)
        energies.append([float(together.end.energy), single.energy()])
        touched += ended
    assert len(energies) == TURNS
    assert touched > 20
    np.testing.assert_array_equal(*np.transpose(energies))
    np.testing.assert_array_equal(together.coordinates.now, single.coordinates.now)
    np.testing.assert_array_equal(together.touches.open, single.touches.open)


@pytest.mark.parametrize("failing", [0, 3])
def test_a_turn_that_fails_is_the_last(small_system, failing):
    """The surface closes far beyond the tips in one turn: that turn is returned with its step, and none after it."""
    opening = OPENING.copy()
    opening[failing:] = -0.1
    together, single = stepper_of(small_system(speed=500.0)), stepper_of(small_system(speed=500.0))
    found = list(together.run_turns(opening, 0))
    expected = [single.run_turn(opening[turn], turn * STEPS) for turn in range(failing)]
    codes = [OK]
    while codes[-1] == OK:
        codes.append(single.step(len(codes) - 1, opening[failing])[0])
    assert found[:-1] == expected
    assert found[-1][:2] == (DIVERGED, len(codes) - 2)
    assert codes[-1] == DIVERGED
    # A single step moves on even where it fails: what the turn left as its last motion is the present one there.
    np.testing.assert_array_equal(together.coordinates.after, single.coordinates.now)


@pytest.mark.parametrize("failing", [False, True])
def test_works_that_wait_are_in_every_turn(small_system, failing):
    """Works of large matrices are added four steps at once: the same to rounding in a turn of 98 steps, with the same
    bits of the motion; also where the turn ends early."""
    steps, ends = 98, []
    for waits in (False, True):
        stepper = rub_free_stepper(small_system(speed=500.0), ContactLaw(friction=0.1), steps)
        energy = stepper.model.energy._replace(waits=waits)
        stepper.model = stepper.model._replace(energy=energy)
        opening = np.full(steps + 2, 5e-5)
        if failing:
            opening[43:] = -0.1
        code, step, _ = stepper.run_turn(opening)
        assert (code, step) == ((DIVERGED, 42) if failing else (OK, 98))
        ends.append((stepper.coordinates.now, stepper.end.works.copy()))
    (motion, works), (same, waited) = ends
    np.testing.assert_array_equal(motion, same)
    assert (works[[UNBALANCE, DAMPING, CIRCULATORY]] != 0).all()
    np.testing.assert_allclose(waited, works, rtol=0, atol=1e-13 * works[ABSOLUTE])
