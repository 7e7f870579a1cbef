"""Unbalances at any angle, several of them, and on blades."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import Unbalance
from rubgen.reduction import reduce
from rubgen.scenario import Reduction

SPEED = 500.0


def force_of(machine, acceleration=0.0):
    system = reduce(machine, Reduction()).at_speed(SPEED, acceleration)
    return system, system.force


def test_an_unbalance_stands_at_its_angle(small):
    system, force = force_of(replace(small, unbalance_kg_m=2e-3, unbalance_angle_deg=30.0))
    assert force[system.centre] == pytest.approx(2e-3 * SPEED**2 * np.cos(np.pi / 6))
    assert force[system.centre + 1] == pytest.approx(2e-3 * SPEED**2 * np.sin(np.pi / 6))


def test_turning_the_unbalance_by_a_blade_pitch_turns_the_rub_free_motion(small):
    moved = [force_of(replace(small, unbalance_kg_m=2e-3, unbalance_angle_deg=angle)) for angle in (0.0, 120.0)]
    q = [np.linalg.solve(system.K, force) for system, force in moved]
    tips = [each[:9].reshape(3, 3) for each in q]
    np.testing.assert_allclose(np.roll(tips[0], 1, axis=0), tips[1], atol=1e-8 * np.abs(tips[0]).max())


def test_two_unbalances_that_face_each_other_leave_no_force(small):
    machine = replace(small, unbalance_kg_m=1e-3, unbalances=(Unbalance(kg_m=1e-3, angle_deg=180.0),))
    _, force = force_of(machine)
    assert np.abs(force).max() < 1e-12 * SPEED**2


def test_an_unbalance_at_a_tip_moves_the_disk_like_one_on_it_and_pulls_the_blade(small):
    none = replace(small, unbalance_kg_m=0.0)
    on_disk, on_tip = (
        force_of(replace(none, unbalances=(Unbalance(kg_m=1e-3, **place),)))
        for place in ({"angle_deg": 120.0}, {"blade": 1})
    )
    disk, tip = (np.linalg.solve(system.K, force) for system, force in (on_disk, on_tip))
    c = on_disk[0].centre
    # The blade is stiff along its span beside the support: the disk follows the same total force.
    np.testing.assert_allclose(tip[c : c + 2], disk[c : c + 2], rtol=0.05)
    assert tip[3] > disk[3]


def test_the_euler_force_of_an_unbalance_is_square_to_it(small):
    machine = replace(small, unbalance_kg_m=2e-3, unbalance_angle_deg=90.0, unbalances=(Unbalance(kg_m=1e-3, blade=2),))
    bare = replace(small, unbalance_kg_m=0.0)
    system, pushed = force_of(machine, 100.0)
    change = pushed - force_of(machine)[1] - (force_of(bare, 100.0)[1] - force_of(bare)[1])
    expected = np.zeros_like(change)
    expected[system.centre] = 2e-3 * 100.0
    expected[7] = -1e-3 * 100.0
    np.testing.assert_allclose(change, expected, atol=1e-9)


def test_an_unbalance_has_one_place_and_its_blade_exists(small):
    for keys in ({}, {"angle_deg": 0.0, "blade": 1}):
        with pytest.raises(ValueError, match="must have angle_deg or blade; give one of the two"):
            Unbalance(kg_m=1e-3, **keys)
    with pytest.raises(ValueError, match="there is no blade 3; give 0 to 2"):
        replace(small, unbalances=(Unbalance(kg_m=1e-3, blade=3),))
