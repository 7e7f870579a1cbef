import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from rubgen.contact import blade_tips, casing_surface
from rubgen.contact.clearance_kernels import (
    angle_error,
    casing_displacement_bound,
    tip_angle,
)
from rubgen.contact.contact_kernels import largest_approach
from rubgen.contact.geometry import periodic_derivative, with_zeros
from rubgen.reduction.model import CasingSurface, SpinningSystem
from tests.contact_calls import gap_and_foot, screened

NODES, RADIUS = 60, 0.4
MARGINS = (2e-5, 1e-3)


def ring(ovality=8e-3, lobes=2.0, orders=(1, 2, 4), phase=0.3, static=0.0):
    """A ring with inextensional modes of those orders and nine blades; the matrices do not matter here."""
    t = 2 * np.pi * np.arange(NODES) / NODES
    fields = [np.stack(exact_mode(n, t), axis=1) for n in orders]
    n, c, blades = 27 + 2 + len(orders), len(orders), 9
    rng = np.random.default_rng(1)
    return SpinningSystem(
        speed=700.0,
        M=np.eye(n),
        C=np.zeros((n, n)),
        K=np.eye(n),
        force=np.zeros(n),
        n_blades=blades,
        n_casing=c,
        tip_radius=RADIUS,
        blade_angles=2 * np.pi * np.arange(blades) / blades,
        tip_static=static * rng.normal(size=(blades, 3)),
        surface=CasingSurface(
            mean_radius=RADIUS + 4e-4 + ovality / 2,
            amplitude=np.array([-ovality / 2]),
            order=np.array([lobes]),
            phase=np.array([phase]),
        ),
        casing_modes=np.stack(fields, axis=-1),
        lateral_stiffness=1.0,
        lateral_damping=0.0,
    )


def exact_mode(n, t):
    radial, tangential = np.cos(n * t), -np.sin(n * t) / n
    return radial * np.cos(t) - tangential * np.sin(t), radial * np.sin(t) + tangential * np.cos(t)


def exact_curve(system, q, t, orders=(1, 2, 4)):
    curve = system.surface
    r = curve.mean_radius + curve.amplitude[0] * np.cos(curve.order[0] * (t - curve.phase[0]))
    x, y = r * np.cos(t), r * np.sin(t)
    for amplitude, n in zip(q, orders, strict=True):
        ux, uy = exact_mode(n, t)
        x, y = x + amplitude * ux, y + amplitude * uy
    return x, y


def random_points(system, seed, count=40):
    """Points at most 1 mm inside or outside of the undeformed surface."""
    rng = np.random.default_rng(seed)
    t = rng.uniform(0, 2 * np.pi, count)
    curve = system.surface
    r = curve.mean_radius + curve.amplitude[0] * np.cos(curve.order[0] * (t - curve.phase[0]))
    r += rng.uniform(-1e-3, 1e-3, count)
    return np.stack([r * np.cos(t), r * np.sin(t)], axis=1), t


def test_gap_and_foot_are_those_of_the_nearest_point_of_the_exact_curve():
    system, q = ring(), np.array([3e-4, -5e-4, 2e-4])
    surface = casing_surface(system)
    for point, angle in zip(*random_points(system, 2), strict=True):

        def distance(t, point=point):
            x, y = exact_curve(system, q, t)
            return np.hypot(point[0] - x, point[1] - y)

        near = angle + np.linspace(-0.02, 0.02, 401)
        best = near[np.argmin(distance(near))]
        found = minimize_scalar(distance, bounds=(best - 2e-4, best + 2e-4), options={"xatol": 1e-11}, method="bounded")
        gap, psi, tx, ty = gap_and_foot(surface, q, point)
        # Hermite interpolation between 60 nodes: (n h)^4 / 384, X and Y carrying orders n - 1 and n + 1 of each mode.
        assert abs(gap) == pytest.approx(found.fun, abs=6e-8)
        assert np.angle(np.exp(1j * (psi - found.x))) == pytest.approx(0, abs=2e-5)
        x, y = exact_curve(system, q, psi)
        inward = (point[0] - x) * -ty + (point[1] - y) * tx
        assert np.sign(inward) == np.sign(gap)
        assert np.hypot(tx, ty) == pytest.approx(1, abs=1e-14)
        assert tx * -np.sin(psi) + ty * np.cos(psi) > 0.99  # counter-clockwise


def test_opening_moves_the_whole_surface_outward():
    system = ring(ovality=0.0)
    surface = casing_surface(system)
    gap = gap_and_foot(surface, np.zeros(3), np.array([0.0, RADIUS]), opening=1.5e-4)[0]
    assert gap == pytest.approx(4e-4 + 1.5e-4, abs=1e-15)


def test_the_undeformed_surface_has_no_chords():
    system = ring(ovality=0.0)
    surface = casing_surface(system)
    for angle in np.linspace(0, 0.3, 50):
        gap = gap_and_foot(surface, np.zeros(3), RADIUS * np.array([np.cos(angle), np.sin(angle)]))[0]
        assert gap == pytest.approx(4e-4, abs=1e-15)


def test_normal_and_gap_are_continuous_across_nodes():
    system, q = ring(), np.array([0.0, 1e-3, -1e-3])
    surface = casing_surface(system)
    h = 2 * np.pi / NODES
    for node in range(0, NODES, 7):
        sides = [
            gap_and_foot(surface, q, RADIUS * np.array([np.cos(a), np.sin(a)]))
            for a in (node * h - 1e-9, node * h + 1e-9)
        ]
        np.testing.assert_allclose(sides[0], sides[1], atol=2e-8) if node else None
        assert sides[0][2:] == pytest.approx(sides[1][2:], abs=1e-8)


def test_reach_bounds_the_displacement_everywhere():
    system, rng = ring(), np.random.default_rng(4)
    surface = casing_surface(system)
    t = np.linspace(0, 2 * np.pi, 2000)
    for _ in range(20):
        q = rng.normal(size=3)
        x, y = (sum(a * exact_mode(n, t)[c] for a, n in zip(q, (1, 2, 4), strict=True)) for c in (0, 1))
        largest, bound = np.hypot(x, y).max(), casing_displacement_bound(surface, q)
        assert largest <= bound < 4 * largest


def test_screening_bound_lies_below_the_true_gap_and_near_it():
    system = ring(static=2e-4)
    surface, tips = casing_surface(system), blade_tips(system)
    rng = np.random.default_rng(5)
    tightness, decided = [], []
    for _ in range(50):
        q = np.concatenate([rng.normal(size=29) * 3e-4, rng.normal(size=3) * 2e-4])
        theta = rng.uniform(0, 2 * np.pi)
        displacement = q[:27].reshape(9, 3).T
        found = {margin: screened(surface, tips, q[29:], displacement, theta, 1e-4, margin, 0.01) for margin in MARGINS}
        free = found[2e-5][0]
        for k in range(9):
            place = system.tip_static[k] + q[3 * k : 3 * k + 3]
            point = (RADIUS + place[0] + 1j * place[1]) * np.exp(1j * (theta + system.blade_angles[k]))
            curve, angle = system.surface, np.angle(point)
            radius = curve.mean_radius + curve.amplitude[0] * np.cos(2 * (angle - curve.phase[0])) + 1e-4
            tightness.append(radius - abs(point) - free[k])
            deformed = gap_and_foot(surface, q[29:], np.array([point.real, point.imag]), 1e-4)[0]
            at = tip_angle(tips, k, displacement, theta)
            assert abs(point / abs(point) - np.exp(1j * at)) < angle_error(0.01)
            for margin, (_, bounds, enough, _) in found.items():
                clear = bounds[k] > enough
                assert deformed > margin or not clear
                if deformed > margin:
                    decided.append(clear)
    assert min(tightness) >= 0
    assert max(tightness) < 1e-6
    assert np.mean(decided) > 0.9


@pytest.mark.parametrize("moved", ["tips", "casing", "both"])
def test_no_gap_closes_by_more_than_the_largest_approach(moved):
    system, rng = ring(ovality=2e-3), np.random.default_rng(9)
    surface, closest = casing_surface(system), 0.0
    for _ in range(30):
        free, change = rng.normal(size=(2, 32)) * 2e-4
        change[29:] *= moved != "tips"
        change[:27] *= moved != "casing"
        new = free + change
        tips_new, tips_free = (with_zeros(q[:27].reshape(9, 3).T) for q in (new, free))
        bound = largest_approach(surface, tips_new, tips_free, new, free, 29)
        for k in range(9):
            gaps = []
            for q in (free, free + change):
                tip = (RADIUS + q[3 * k] + 1j * q[3 * k + 1]) * np.exp(1j * system.blade_angles[k])
                gaps.append(gap_and_foot(surface, q[29:], np.array([tip.real, tip.imag]))[0])
            closest = max(closest, (gaps[0] - gaps[1]) / bound)
    assert 0.3 < closest <= 1


def test_spectral_derivative_is_exact_below_the_highest_order():
    for nodes in (24, 25):
        t = 2 * np.pi * np.arange(nodes) / nodes
        np.testing.assert_allclose(
            periodic_derivative(np.stack([np.sin(3 * t), np.cos(7 * t)], axis=1)),
            np.stack([3 * np.cos(3 * t), -7 * np.sin(7 * t)], axis=1),
            atol=1e-12,
        )
