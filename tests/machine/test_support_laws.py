"""Laws of the disk support: each stands twice in its file, and the compiled form is the plain one."""

import math
import sys

import numpy as np
import pytest

from rubgen.machine import SqueezeFilm
from rubgen.machine.support_laws.breathing_spring import BreathingSpring
from rubgen.machine.support_laws.disk_support import LAWS, SUPPORT_LAWS
from rubgen.machine.support_laws.loose_spring import LooseSpring
from rubgen.machine.support_laws.whirling_film import WhirlingFilm
from rubgen.reduction import TurningForces
from rubgen.solver.supports.turning_forces import force_derivatives

EXAMPLES = {
    "squeeze_film": SqueezeFilm(radius_m=0.05, length_m=0.03, clearance_m=5e-4, viscosity_pa_s=0.05),
    "loose_spring": LooseSpring(lost_n_per_m=3e6, gap_m=2e-5, direction_rad=1.1),
    "breathing_spring": BreathingSpring(lost_n_per_m=3e6, direction_rad=0.4),
    "whirling_film": WhirlingFilm(swirl_n_per_m=2e6, soft_n_per_m=4e6, scale_m=2e-4),
}
PLACES = [
    (theta, u, v)
    for theta, u, v in zip(
        np.random.default_rng(1).uniform(0, 2 * np.pi, 9),
        np.random.default_rng(2).uniform(-3e-4, 3e-4, (9, 2)),
        np.random.default_rng(3).normal(size=(9, 2)),
        strict=True,
    )
]


def turned(angle):
    return np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])


def test_every_law_has_an_example():
    assert [type(law) for law in EXAMPLES.values()] == list(LAWS)
    assert list(EXAMPLES)[: len(SUPPORT_LAWS)] == list(SUPPORT_LAWS)


@pytest.mark.parametrize("key", EXAMPLES)
def test_the_terms_of_a_law_make_its_force(key):
    law = EXAMPLES[key]
    for theta, u, v in PLACES:
        s_x, s_y, xx, xy, yx, yy = law.terms(np.array(law.numbers), math.cos(theta), math.sin(theta), *u)
        expected = [s_x, s_y] - np.array([[xx, xy], [yx, yy]]) @ v
        np.testing.assert_allclose(law.force(theta, u, v), expected, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("key", EXAMPLES)
def test_the_force_is_alike_in_all_directions_where_the_law_says_so(key):
    """Turned with the motion, or with the angle of the blisk: a law that is alike does not feel either."""
    law = EXAMPLES[key]
    alike = []
    for theta, u, v in PLACES:
        R = turned(0.7)
        alike.append(np.allclose(law.force(theta, R @ u, R @ v), R @ law.force(theta, u, v), rtol=1e-12))
        alike.append(np.allclose(law.force(theta + 0.7, u, v), law.force(theta, u, v), rtol=1e-12))
    assert all(alike) is not law.TURNS


@pytest.mark.parametrize("key", EXAMPLES)
def test_the_force_is_linear_where_the_law_says_so(key):
    law = EXAMPLES[key]
    alike = [
        np.allclose(2 * law.force(theta, u / 2, v / 2), law.force(theta, u, v), rtol=1e-12) for theta, u, v in PLACES
    ]
    assert all(alike) is law.LINEAR


@pytest.mark.parametrize("key", EXAMPLES)
def test_complex_steps_differentiate_the_force(key):
    """Against central differences, also on both sides of a corner of the force."""
    law, step = EXAMPLES[key], 1e-9
    for theta, u, v in PLACES:
        by_u, by_v = force_derivatives(TurningForces(laws=(law,)), 0.0, np.array(theta), u, v)
        for i, along in enumerate(np.eye(2)):
            expected = (law.force(theta, u + step * along, v) - law.force(theta, u - step * along, v)) / (2 * step)
            np.testing.assert_allclose(by_u[:, i], expected, rtol=1e-4, atol=1e-4 * np.abs(by_u).max() + 1e-6)
            expected = law.force(theta, u, v + along) - law.force(theta, u, v)
            np.testing.assert_allclose(by_v[:, i], expected, rtol=1e-9, atol=1e-9 * np.abs(by_v).max())


def test_a_loose_spring_acts_in_one_direction_at_rest():
    """Whatever the blisk's angle: nothing before the gap, and the lost stiffness beyond it, along the direction."""
    law = EXAMPLES["loose_spring"]
    e = np.array([math.cos(1.1), math.sin(1.1)])
    across = np.array([-e[1], e[0]])
    for theta in np.linspace(0, 6, 7):
        R = turned(theta)  # from the turning frame to the inertial one
        for place, expected in ((5e-5, 3e6 * 3e-5), (1e-5, 0.0), (-9e-5, 0.0)):
            u = R.T @ (place * e + 4e-5 * across)
            np.testing.assert_allclose(R @ law.force(theta, u, np.zeros(2)), expected * e, atol=1e-9)


def test_a_crack_is_open_where_it_points_down_and_closed_where_it_points_up():
    law = EXAMPLES["breathing_spring"]
    e = np.array([math.cos(0.4), math.sin(0.4)])
    for inertial, share in ((-math.pi / 2, 1.0), (0.0, 0.5), (math.pi, 0.5), (math.pi / 2, 0.0)):
        found = law.force(np.array(inertial - 0.4), 1e-4 * e, np.zeros(2))
        np.testing.assert_allclose(found, 3e6 * share * 1e-4 * e, atol=1e-9)


@pytest.mark.parametrize("key", EXAMPLES)
def test_a_law_stiffens_no_more_than_it_says(key):
    """The largest eigenvalue of -df/du, symmetric part, over many places within the law's limit."""
    law, rng = EXAMPLES[key], np.random.default_rng(5)
    u = rng.uniform(-1, 1, (2000, 2)) * min(1e-3, 0.7 * law.limit_m)
    theta = rng.uniform(0, 6, 2000)
    by_u, _ = force_derivatives(TurningForces(laws=(law,)), 0.0, theta, u, np.zeros((2000, 2)))
    stiffest = np.linalg.eigvalsh(-(by_u + by_u.transpose(0, 2, 1)) / 2).max()
    assert stiffest <= law.stiffening_n_per_m * (1 + 1e-9) + 1e-9 * np.abs(by_u).max()
    assert stiffest >= 0.5 * law.stiffening_n_per_m


@pytest.mark.parametrize("law", LAWS)
def test_what_is_compiled_stands_in_the_file_of_the_law(law):
    """The key of compiled kernels is made of these files."""
    names = set(law.terms.__code__.co_names)
    own = vars(sys.modules[law.__module__])
    for name in names & set(own):
        assert own[name] is math or isinstance(own[name], int | float), name
