"""Which blades are near, and the compliance between contacts, against the gaps of single points and dense matrices."""

import numpy as np
import pytest
from kernel_arrays import contact_work
from test_contact_geometry import RADIUS, ring

from rubgen.contact import blade_tips, casing_surface
from rubgen.contact.contact_kernels import build_casing_response, build_compliance, find_near, gap_at
from rubgen.contact.geometry import with_zeros
from tests.contact_calls import gap_and_foot

BLADES, MODES, THETA, OPENING = 9, 3, 0.9, 1e-4
START = 3 * BLADES + 2
NO_WEAR = np.zeros(0)


@pytest.fixture
def near():
    """Surface, tips and coordinates in which about half of the tips are in the surface; the gap of each blade."""
    system, rng = ring(static=2e-4), np.random.default_rng(3)
    surface, tips = casing_surface(system), blade_tips(system)
    q = np.concatenate([rng.normal(size=START) * 1e-3, rng.normal(size=MODES) * 2e-4])
    q[0 : 3 * BLADES : 3] += np.linspace(-1e-3, 9e-3, BLADES)
    gaps = []
    for k in range(BLADES):
        place = system.tip_static[k] + q[3 * k : 3 * k + 3]
        point = (RADIUS + place[0] + 1j * place[1]) * np.exp(1j * (THETA + system.blade_angles[k]))
        gaps.append(gap_and_foot(surface, q[START:], np.array([point.real, point.imag]), OPENING))
    return surface, tips, q, np.array(gaps)


def test_the_gap_of_one_blade(near):
    surface, tips, q, gaps = near
    for k in range(BLADES):
        found = gap_at(surface, tips, NO_WEAR, k, q, START, OPENING, np.cos(THETA), np.sin(THETA), np.zeros(8))
        assert found == pytest.approx(gaps[k, 0], abs=1e-15)


@pytest.mark.parametrize("margin", [-1.0, 0.0, 1e-3, 1.0])
def test_near_blades_are_those_whose_gap_is_below_the_margin(near, margin):
    surface, tips, q, gaps = near
    work = contact_work(BLADES, MODES)
    work.bounds[:] = np.inf
    work.bounds[:BLADES] = -np.inf  # nothing is known: every tip is looked at
    displacement = with_zeros(q[: 3 * BLADES].reshape(BLADES, 3).T[:2])
    blind = q.copy()
    blind[0 : 3 * BLADES : 3] = blind[1 : 3 * BLADES : 3] = np.nan  # must be taken from `displacement`
    turned = np.cos(THETA), np.sin(THETA)
    count, penetrates = find_near(
        surface, tips, NO_WEAR, blind, displacement, START, OPENING, *turned, margin, margin, work
    )
    expected = np.flatnonzero(gaps[:, 0] < margin)
    assert count == expected.size
    assert penetrates == np.any(gaps[expected, 0] < 0)
    np.testing.assert_array_equal(work.blade[:count], expected)
    np.testing.assert_allclose(work.gap[expected], gaps[expected, 0], atol=1e-15)
    assert np.isnan(np.delete(work.gap, expected)).all()
    np.testing.assert_allclose(work.psi[expected], gaps[expected, 1], atol=1e-14)
    np.testing.assert_allclose(work.tangent[expected], gaps[expected, 2:], atol=1e-14)


def test_a_blade_whose_bound_is_far_is_not_looked_at(near):
    """A slope of 1 widens the margin by half: 2e-4 to 3e-4."""
    surface, tips, q, _ = near
    work = contact_work(BLADES, MODES)
    work.bounds[:] = np.inf
    work.bounds[[2, 5]] = 2.9e-4, 3.1e-4
    displacement = with_zeros(q[: 3 * BLADES].reshape(BLADES, 3).T[:2])
    q[: 3 * BLADES] = np.nan
    turned = np.cos(THETA), np.sin(THETA)
    find_near(surface, tips, NO_WEAR, q, displacement, START, OPENING, *turned, 2e-4, 3e-4, work)
    np.testing.assert_array_equal(np.flatnonzero(np.isfinite(q[: 3 * BLADES])), [6, 7])


def test_the_compliance_of_contacts_is_that_of_dense_matrices():
    """W = B_n^T A^-1 B with an A^-1 that is not symmetric, for blades in any order."""
    rng, count, blades, modes = np.random.default_rng(4), 3, 4, 3
    work = contact_work(blades, modes)
    work.blade[:count] = [3, 0, 2]
    for array in (work.normal_tip, work.full_tip, work.normal_casing, work.full_casing):
        array[:count] = rng.normal(size=(count, array.shape[1]))
    tips, casing = rng.normal(size=(3 * blades, 3 * blades)), rng.normal(size=(modes, modes))
    inverse = np.zeros((3 * blades + modes, 3 * blades + modes))
    inverse[: 3 * blades, : 3 * blades], inverse[3 * blades :, 3 * blades :] = tips, casing
    normal, full = np.zeros((2, len(inverse), count))
    for m, blade in enumerate(work.blade[:count]):
        own = slice(3 * blade, 3 * blade + 3)
        normal[own, m], full[own, m] = work.normal_tip[m], work.full_tip[m]
        normal[3 * blades :, m], full[3 * blades :, m] = work.normal_casing[m], work.full_casing[m]
        build_casing_response(m, np.ascontiguousarray(casing.T), work)
        np.testing.assert_allclose(work.casing_response[m], casing @ work.full_casing[m], rtol=1e-12)
    build_compliance(count, np.ascontiguousarray(tips.T), work)
    np.testing.assert_allclose(work.W[:count, :count], normal.T @ inverse @ full, rtol=1e-10)
    assert np.isnan(work.W[count:]).all()
