"""The liner's kernels against the definition of a periodic cubic B-spline (scipy) and of Archard's law."""

import numpy as np
import pytest
from kernel_arrays import contact_work
from scipy.interpolate import BSpline

from rubgen.contact.contact_kernels import wear_liner, wear_where_lined
from rubgen.contact.liner_kernels import REMOVED, WORK, Liner, Wear, remove, spline_weights, worn_depth

LINER = Liner(bins=24, thickness=1e-3, rate=2e-11, area=5e-4)
DT = 1e-5
HAT = BSpline.basis_element(np.arange(-2.0, 3.0))


def basis(psi):
    """Share (bins,) of each coefficient in the depth at a polar angle."""
    away = psi * LINER.bins / (2 * np.pi) - np.arange(LINER.bins)
    away -= LINER.bins * np.round(away / LINER.bins)
    return np.where(np.abs(away) < 2, HAT(np.clip(away, -2, 2)), 0.0)


def some_wear(rng):
    """A liner that has worn by a fifth at most, and where it stood two steps and one step before."""
    depth = rng.uniform(1e-4, 2e-4, LINER.bins)
    return Wear(depth=depth, earlier=depth * np.array([[0.6], [0.9]]), sums=np.zeros(2))


def two_contacts_of_three(rng):
    """Blades 2 and 0 press, blade 1 between them in the list does not."""
    work = contact_work(3)
    work.blade[:] = [2, 1, 0]
    work.lam[:] = [800.0, 0.0, 300.0]
    work.sliding[:] = [40.0, 90.0, 70.0]
    work.psi[:] = rng.uniform(-np.pi, np.pi, 3)
    return work


def test_spline_weights_are_the_cubic_b_spline():
    for s in np.linspace(0, 1, 11):
        assert spline_weights(s) == pytest.approx(HAT(np.array([1 + s, s, 1 - s, 2 - s])), abs=1e-15)


def test_the_depth_and_its_derivatives_are_those_of_scipys_spline():
    rng = np.random.default_rng(1)
    coefficients = rng.normal(size=LINER.bins)
    around = np.arange(-3, LINER.bins + 3)  # periodic: three more on each side
    spline = BSpline(np.arange(-5, LINER.bins + 5), coefficients[around % LINER.bins], 3)
    scale = LINER.bins / (2 * np.pi)
    for psi in rng.uniform(0, 2 * np.pi, 30):
        expected = [scale**order * spline(scale * psi, nu=order) for order in range(3)]
        assert worn_depth(coefficients, psi) == pytest.approx(expected, rel=1e-10, abs=1e-10)
        assert worn_depth(coefficients, psi - 4 * np.pi) == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_what_is_removed_at_an_angle_goes_to_the_coefficients_by_their_share():
    rng = np.random.default_rng(2)
    wear = some_wear(rng)
    for psi in rng.uniform(-7, 7, 20):
        expected = wear.depth + 1e-9 / LINER.area * basis(psi)
        remove(LINER, psi, 1e-9, wear)
        np.testing.assert_allclose(wear.depth, expected, rtol=1e-13)
    assert wear.sums[REMOVED] == pytest.approx(20e-9, rel=1e-12)


def test_a_coefficient_stops_at_the_thickness_and_the_rest_is_not_removed():
    wear = some_wear(np.random.default_rng(3))
    before, volume = wear.depth.copy(), 2e-3 * LINER.area
    remove(LINER, 1.0, volume, wear)
    expected = np.minimum(before + volume / LINER.area * basis(1.0), LINER.thickness)
    assert expected.max() == LINER.thickness
    np.testing.assert_allclose(wear.depth, expected, rtol=1e-13)
    assert wear.sums[REMOVED] == pytest.approx(LINER.area * (expected - before).sum(), rel=1e-12)
    assert wear.sums[REMOVED] < 0.9 * volume


def test_each_pressing_contact_wears_by_archards_law_at_its_foot():
    rng = np.random.default_rng(4)
    wear, work = some_wear(rng), two_contacts_of_three(rng)
    before, oldest, older = wear.depth.copy(), *wear.earlier.copy()
    wear_liner(3, LINER, DT, work, wear)
    grown, receding = np.zeros(LINER.bins), 0.0
    for blade, force, sliding in ((2, 800.0, 40.0), (0, 300.0, 70.0)):
        at = basis(work.psi[blade])
        grown += LINER.rate * force * sliding * DT / LINER.area * at
        receding += force * (at @ before - at @ oldest) / 2
    np.testing.assert_allclose(wear.depth - before, grown, rtol=1e-9, atol=1e-18)
    assert wear.sums[REMOVED] == pytest.approx(LINER.rate * DT * (800 * 40 + 300 * 70), rel=1e-12)
    assert wear.sums[WORK] == pytest.approx(receding, rel=1e-12)
    np.testing.assert_array_equal(wear.earlier, [older, before])


def test_without_a_liner_nothing_wears():
    rng = np.random.default_rng(5)
    wear, work = some_wear(rng), two_contacts_of_three(rng)
    before = wear.depth.copy()
    wear_where_lined(3, LINER._replace(bins=0), DT, work, wear)
    np.testing.assert_array_equal(wear.depth, before)
    wear_where_lined(3, LINER, DT, work, wear)
    assert wear.depth.sum() > before.sum()
