from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.machine.faults.loose_support import LooseSupport
from rubgen.machine.faults.oil_whirl import OilWhirl
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.scheme.model import speed_part
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.interpolation import SpeedInterpolation, chebyshev_speeds, lagrange_weights
from rubgen.units import rad_per_s


def test_lagrange_weights_give_back_a_polynomial():
    nodes = chebyshev_speeds(300.0, 900.0)
    assert nodes[0] == 300
    assert nodes[-1] == 900
    assert np.all(np.diff(nodes) > 0)
    assert np.diff(nodes)[0] < 0.5 * np.diff(nodes).max()  # densest at the ends
    curve = np.polynomial.Polynomial(np.random.default_rng(1).normal(size=nodes.size), domain=[300, 900])
    at = np.linspace(300, 900, 37)
    np.testing.assert_allclose(lagrange_weights(nodes, at) @ curve(nodes), curve(at), atol=1e-12)


@pytest.mark.parametrize("acceleration", [0.0, -210.0])
def test_interpolated_matrices_are_those_made_at_that_speed(acceleration):
    faults = (OilWhirl(), LooseSupport(lost_stiffness=0.5))
    model = reduce(replace(load_machine("zeng2019"), faults=faults), Reduction())
    speeds = chebyshev_speeds(rad_per_s(3000), rad_per_s(12000))
    alike = [model.at_speed(speed, push) for speed in (speeds[0], speeds[-1]) for push in (0.0, 300.0)]
    stepper = Stepper(alike[2], ContactLaw(), 1024, alike=alike)
    interpolation = SpeedInterpolation(
        lambda *at: speed_part(model.at_speed(*at), stepper.blocks, stepper.dt), speeds, 300.0
    )
    wanted = rad_per_s(np.array([3333.0, 7654.3, 11900.0]))
    for speed, part in zip(wanted, interpolation.at(wanted, np.full(3, acceleration)), strict=True):
        exact = speed_part(model.at_speed(speed, acceleration), stepper.blocks, stepper.dt)
        for name in ("now", "before", "inverse", "constant"):
            found, true = getattr(part.scheme, name), getattr(exact.scheme, name)
            np.testing.assert_allclose(found, true, atol=1e-13 * np.abs(true).max(), err_msg=name)
        for name in ("tip_compliance", "casing_compliance"):
            found, true = getattr(part, name), getattr(exact, name)
            np.testing.assert_allclose(found, true, atol=1e-13 * np.abs(true).max())
        for name in ("damping", "circulatory", "M", "K"):
            found, true = getattr(part.energy, name).entries, getattr(exact.energy, name).entries
            np.testing.assert_allclose(found, true, atol=1e-13 * np.abs(true).max(), err_msg=name)
        np.testing.assert_allclose(part.energy.force, exact.energy.force, rtol=1e-11, atol=1e-9)
        np.testing.assert_allclose(part.tips.static, exact.tips.static, rtol=1e-9, atol=1e-15)
        assert interpolation.mean_growth(np.array(speed)) == pytest.approx(exact.tips.static[0].mean(), rel=1e-9)
        np.testing.assert_array_equal(part.support.laws[:, 0].astype(int), exact.support.laws[:, 0].astype(int))
        np.testing.assert_allclose(part.support.laws, exact.support.laws, rtol=1e-12)


def test_parts_last_until_the_next_call_but_one(small_system):
    """Calls with more and fewer parts than before give the numbers of a single part each time."""
    systems = [small_system(speed=speed) for speed in (300.0, 400.0)]
    stepper = Stepper(systems[1], ContactLaw(), 256, alike=systems)
    speeds = chebyshev_speeds(300.0, 400.0)

    def part_at(speed, acceleration):
        system = small_system(speed=speed)
        pushed = replace(system, K=system.K + acceleration * np.triu(system.C), force=system.force + acceleration)
        return speed_part(pushed, stepper.blocks, stepper.dt)

    interpolation, rng = SpeedInterpolation(part_at, speeds, 50.0), np.random.default_rng(7)
    before = []
    for count in (1, 5, 3, 5, 7, 2, 7):
        wanted = rng.uniform(300, 400, count), rng.uniform(-50, 50, count)
        parts = list(interpolation.at(*wanted))
        for speed, acceleration, part in [*before, *zip(*wanted, parts, strict=True)]:
            exact = part_at(speed, acceleration)
            for found, true in ((part.scheme.now, exact.scheme.now), (part.energy.K, exact.energy.K)):
                found, true = (each if isinstance(each, np.ndarray) else each.entries for each in (found, true))
                np.testing.assert_allclose(found, true, atol=1e-11 * np.abs(true).max())
            assert not part.scheme.now.flags.writeable
            np.testing.assert_allclose(part.energy.force, exact.energy.force, rtol=1e-9, atol=1e-9)
        before = list(zip(*wanted, parts, strict=True))
