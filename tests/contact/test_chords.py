"""The polygon through the casing's nodes: the paper's surface, kept to show what it does."""

import numpy as np
import pytest
from test_contact_geometry import NODES, RADIUS, ring

from rubgen.contact import blade_tips, casing_surface
from rubgen.contact.geometry_kernels import chord_radius, undeformed_radius
from rubgen.scenario import ContactLaw
from tests.contact_calls import gap_and_foot, screened

CHORDS = ContactLaw(surface="chords")
STEP = 2 * np.pi / NODES


def nodes_of(system):
    t = STEP * np.arange(NODES)
    curve = system.surface
    return (curve.mean_radius + curve.amplitude[0] * np.cos(2 * (t - curve.phase[0]))) * np.exp(1j * t)


def test_the_surface_is_the_straight_line_between_two_nodes():
    system = ring()
    surface, nodes = casing_surface(system, CHORDS), nodes_of(system)
    for psi in np.linspace(0, 2 * np.pi, 400, endpoint=False):
        first = int(psi / STEP) % NODES
        start, along = nodes[first], nodes[(first + 1) % NODES] - nodes[first]
        point = undeformed_radius(surface, psi)[0] * np.exp(1j * psi)
        assert abs(np.imag((point - start) * np.conj(along)) / abs(along)) < 1e-15


def test_derivatives_of_the_chord_are_those_of_its_radius():
    h = 1e-5
    for angle in (0.2 * STEP, 0.7 * STEP):
        radius, slope, bend = chord_radius(0.4, 0.402, angle, STEP)
        before, after = (chord_radius(0.4, 0.402, angle + side * h, STEP)[0] for side in (-1, 1))
        assert slope == pytest.approx((after - before) / (2 * h), rel=1e-6)
        assert bend == pytest.approx((after - 2 * radius + before) / h**2, rel=1e-4)


def test_chords_of_a_circle_lie_inside_by_the_sagitta_and_no_more_than_the_bound():
    for ovality in (0.0, 8e-3):
        system = ring(ovality=ovality)
        smooth, chords = casing_surface(system), casing_surface(system, CHORDS)
        inside, slopes = [], []
        for psi in np.linspace(0, 2 * np.pi, 3000, endpoint=False):
            radius, slope, _ = undeformed_radius(chords, psi)
            inside.append(undeformed_radius(smooth, psi)[0] - radius)
            slopes.append(abs(slope))
        assert chords.inset >= max(inside) > 0.95 * chords.inset
        assert chords.slope * (1 + 1e-12) >= max(slopes) > 0.9 * chords.slope
        if ovality == 0:
            assert max(inside) == pytest.approx((RADIUS + 4e-4) * (1 - np.cos(STEP / 2)), rel=1e-3)
    assert smooth.inset == 0.0
    assert smooth.slope == smooth.steepness


def test_the_gap_is_the_distance_to_the_chord_also_beyond_a_corner():
    system = ring(ovality=0.0)
    surface, nodes = casing_surface(system, CHORDS), nodes_of(system)
    apothem = abs(nodes[0]) * np.cos(STEP / 2)
    for psi in [*np.linspace(0.01, 6.2, 100), 3 * STEP + 1e-9, 3 * STEP - 1e-9]:
        for away in (-1e-4, 1e-5, 1e-3):
            radius = undeformed_radius(surface, psi)[0] - away
            point = radius * np.array([np.cos(psi), np.sin(psi)])
            gap, _, tx, ty = gap_and_foot(surface, np.zeros(3), point)
            middle = STEP * (np.floor(psi / STEP) + 0.5)
            expected = apothem - radius * np.cos(psi - middle)
            assert gap == pytest.approx(expected, abs=1e-12)
            assert np.array([-ty, tx]) == pytest.approx([-np.cos(middle), -np.sin(middle)], abs=1e-12)


def test_the_screening_bounds_hold_for_chords_in_a_deformed_casing():
    system = ring(static=2e-4)
    surface, tips, rng = casing_surface(system, CHORDS), blade_tips(system), np.random.default_rng(5)
    decided = []
    for _ in range(60):
        q = np.concatenate([rng.normal(size=29) * 3e-4, rng.normal(size=3) * 2e-4])
        theta = rng.uniform(0, 2 * np.pi)
        displacement = q[:27].reshape(9, 3).T
        free, bounds, enough, _ = screened(surface, tips, q[29:], displacement, theta, 1e-4, 2e-5, 0.01)
        for k in range(9):
            place = system.tip_static[k] + q[3 * k : 3 * k + 3]
            point = (RADIUS + place[0] + 1j * place[1]) * np.exp(1j * (theta + system.blade_angles[k]))
            gap = gap_and_foot(surface, q[29:], np.array([point.real, point.imag]), 1e-4)[0]
            radius = undeformed_radius(surface, np.angle(point))[0] + 1e-4
            assert free[k] <= radius - abs(point)
            clear = bounds[k] > enough
            assert gap > 2e-5 or not clear
            decided.append(clear)
    assert 0.3 < np.mean(decided) < 1
