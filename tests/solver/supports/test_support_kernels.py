"""Uneven supports, a squeeze film, gravity and loads in one step, against the law itself and dense matrices.

A (q_n+1 - q*) = E f + weight,   f = p - k_a Q u_n - D v_abs,   D = c_a Q + C(u_n)
v_abs = (u_n+1 - u_n-1) / (2 dt) + Omega e_z x u_n
"""

import numpy as np
import pytest
from kernel_arrays import contact_work

from rubgen.linalg.blocks import aligned
from rubgen.machine import SqueezeFilm
from rubgen.machine.support_laws.breathing_spring import BreathingSpring
from rubgen.machine.support_laws.disk_support import LAWS as LAWS_OF_SUPPORTS
from rubgen.machine.support_laws.loose_spring import LooseSpring
from rubgen.machine.support_laws.whirling_film import WhirlingFilm
from rubgen.solver.supports.support_kernels import (
    ANISOTROPY,
    GRAVITY,
    LAWS,
    LAWS_LOSS,
    LOADS,
    SUPPORT_WORKS,
    Support,
    SupportState,
    add_support_works,
    push_supports,
    resist_contacts,
    turned,
    yield_to_contacts,
)

SPEED, DT, THETA = 300.0, 1e-3, 0.7
COSINE, SINE = np.cos(THETA), np.sin(THETA)
CLEARANCE = 5e-4
PLACES = np.array([3, 0, 9, 12, 5, 1, 14, 7])
"""Numbers of z that O_d and the weight can move; `TIPS` are two blades' tips among them, `CENTRE` is O_d."""
TIPS, CENTRE = PLACES[:6], PLACES[6:]
E = np.eye(16)[:, CENTRE]
Q = np.array([[np.cos(2 * THETA), -np.sin(2 * THETA)], [-np.sin(2 * THETA), -np.cos(2 * THETA)]])
CASES = {
    "springs": {"stiffness": 6e5},
    "dampers": {"damping": 900.0},
    "film": {"film": 1.7e3},
    "loads": {"loads": 1},
    "loose": {"law": LooseSpring(lost_n_per_m=3e6, gap_m=1e-5, direction_rad=-1.1)},
    "crack": {"law": BreathingSpring(lost_n_per_m=3e6, direction_rad=0.4)},
    "whirl": {"law": WhirlingFilm(swirl_n_per_m=2e6, soft_n_per_m=4e6, scale_m=2e-4)},
    "all": {"stiffness": 6e5, "damping": 900.0, "film": 1.7e3, "loads": 1},
}
STEP = 3
"""Number of the step, by which the loads have changed."""
LOAD_ROWS = np.array([[10.0, 0.0, -20.0, 0.0], [30.0, -25.0, 15.0, 5.0], [-8.0, 12.0, 40.0, 3.0]])
SLOPES = 0.1 * LOAD_ROWS[::-1]


class Step:
    """One step's dense matrices and states for a case, and what the kernels take of them."""

    def __init__(self, case, seed=1):
        rng = np.random.default_rng(seed)
        root, skew = rng.normal(size=(2, 8, 8))
        self.A = 8e6 * np.eye(16)  # kg/s2, not symmetric
        self.A[np.ix_(PLACES, PLACES)] = 8e6 * (np.eye(8) + 0.1 * root @ root.T + 0.2 * (skew - skew.T))
        self.weight = np.zeros((16, 2))
        self.weight[PLACES] = rng.normal(size=(8, 2)) * 80
        inverse = np.linalg.inv(self.A)
        constants = {"stiffness": 0.0, "damping": 0.0, "film": 0.0, "loads": 0} | CASES[case]
        film, loaded, law = constants.pop("film"), constants.pop("loads"), constants.pop("law", None)
        count = 3 if loaded else 0
        laws = np.zeros((0, 1))
        if film:
            laws = np.array([[LAWS_OF_SUPPORTS.index(SqueezeFilm), film, CLEARANCE]])
        if law:
            laws = np.array([[LAWS_OF_SUPPORTS.index(type(law)), *law.numbers]])
        self.support = Support(
            active=True,
            yields=case != "loads",
            loads=LOAD_ROWS[:count].copy(),
            slopes=SLOPES[:count].copy(),
            growing=np.zeros((0, count, 4)),
            **constants,
            laws=laws,
            limit=CLEARANCE if film else np.inf,
            centre=CENTRE,
            places=PLACES,
            columns=aligned((inverse @ np.column_stack([E, -self.weight]))[PLACES]),
            weight=aligned(self.weight[PLACES]),
            compliance=aligned(E.T @ inverse @ E),
            rows=aligned(E.T @ inverse),
            tip_columns=aligned((inverse @ E)[TIPS]),
            tip_rows=aligned((E.T @ inverse).T[TIPS]),
        )
        self.before, self.now, self.free = (aligned(row) for row in rng.normal(size=(3, 16)) * 2e-4)
        self.now[CENTRE] = [2.1e-4, -1.6e-4]
        self.u = self.now[CENTRE]
        self.uneven = CASES[case].get("damping", 0.0) * Q
        rest = 1 - self.u @ self.u / CLEARANCE**2
        self.squeeze = CASES[case].get("film", 0.0) * rest**-1.5
        self.squeeze = self.squeeze * (np.eye(2) + 3 * np.outer(self.u, self.u) / CLEARANCE**2 / rest)
        self.D = self.uneven + self.squeeze
        rows = (LOAD_ROWS + STEP * SLOPES)[:count]
        turn = np.exp(1j * THETA * np.arange(count))
        self.load = np.array([(turn @ (rows[:, i] + 1j * rows[:, i + 1])).real for i in (0, 2)])
        self.uneven_spring = -constants["stiffness"] * Q @ self.u
        self.law = law.force(np.array(THETA), self.u, np.zeros(2)) if law else np.zeros(2)
        assert np.any(self.law) == bool(law)
        self.spring = self.uneven_spring + self.law + self.load
        self.with_drag = self.A + E @ self.D @ E.T / (2 * DT)
        self.state = SupportState(
            np.full((2, 2), np.nan), np.zeros((2, 2)), np.full((3, 2), np.nan), np.zeros(SUPPORT_WORKS)
        )

    def push(self):
        """What the kernel makes of q*; whether O_d is inside the film."""
        after = self.free.copy()
        inside = push_supports(self.support, SPEED, DT, STEP, COSINE, SINE, self.before, self.now, after, self.state)
        return inside, aligned(after)

    def absolute_velocity(self, after):
        relative = (after - self.before)[CENTRE] / (2 * DT)
        return relative + SPEED * np.array([-self.u[1], self.u[0]])


def test_the_support_axes_turn_backward_at_twice_the_angle():
    """Q is inertial diag(1, -1) seen from the turning frame: R^T diag(1, -1) R."""
    R = np.array([[COSINE, -SINE], [SINE, COSINE]])
    w = np.array([0.3, -1.2])
    np.testing.assert_allclose(turned(COSINE, SINE, *w), R.T @ np.diag([1.0, -1.0]) @ R @ w, rtol=1e-14)


@pytest.mark.parametrize("case", CASES)
def test_a_push_solves_the_implicit_law(case):
    step = Step(case)
    inside, after = step.push()
    assert inside
    force = step.spring - step.D @ step.absolute_velocity(after)
    np.testing.assert_allclose(step.state.force, [force, force, step.load], rtol=1e-9)
    weight = -step.weight @ [SINE, COSINE]
    missing = step.A @ (after - step.free) - E @ force - weight
    assert np.abs(missing).max() < 1e-10 * np.abs(step.A @ (after - step.free)).max()
    untouched = np.setdiff1d(np.arange(16), PLACES)
    np.testing.assert_array_equal(after[untouched], step.free[untouched])
    if step.support.yields:
        np.testing.assert_allclose(step.state.drag, step.D, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_a_film_ends_at_its_clearance(share):
    step = Step("film")
    step.now[CENTRE] = share * CLEARANCE * np.array([0.6, -0.8])
    inside, after = step.push()
    assert inside == (share < 1)
    if not inside:
        np.testing.assert_array_equal(after, step.free)


@pytest.mark.parametrize("case", CASES)
def test_contacts_feel_the_drag(case):
    """The compliance of contacts, and their force, are those of A + E D E^T / (2 dt)."""
    step, rng = Step(case), np.random.default_rng(3)
    step.push()
    work = contact_work(2)
    work.blade[:] = [1, 0]
    work.normal_tip[:], work.full_tip[:] = rng.normal(size=(2, 2, 3))
    normal, full = np.zeros((2, 16, 2))
    for m, blade in enumerate(work.blade):
        own = TIPS[3 * blade : 3 * blade + 3]
        normal[own, m], full[own, m] = work.normal_tip[m], work.full_tip[m]
    work.W[:] = normal.T @ np.linalg.solve(step.A, full)
    yield_to_contacts(2, step.support, step.state, work)
    np.testing.assert_allclose(work.W, normal.T @ np.linalg.solve(step.with_drag, full), rtol=1e-9)


@pytest.mark.parametrize("case", CASES)
def test_supports_resist_the_jump_that_contacts_make(case):
    step = Step(case)
    step.push()
    free = step.state.force[0].copy()
    load = np.random.default_rng(4).normal(size=16) * 1e3
    force = aligned(load)
    resist_contacts(step.support, step.state, force)
    jump = np.linalg.solve(step.with_drag, load)
    np.testing.assert_allclose(np.linalg.solve(step.A, force), jump, rtol=1e-9, atol=1e-12 * np.abs(jump).max())
    np.testing.assert_allclose(step.state.force[:2], [free, free - step.D @ jump[CENTRE] / (2 * DT)], rtol=1e-9)


@pytest.mark.parametrize("case", CASES)
def test_works_are_each_force_times_the_way(case):
    step = Step(case)
    _, after = step.push()
    change = aligned(0.5 * (after - step.before))
    sizes = add_support_works(step.support, SPEED, DT, COSINE, SINE, step.now, change, step.state)
    velocity, way = step.absolute_velocity(after), change[CENTRE]
    expected = np.zeros(SUPPORT_WORKS)
    expected[ANISOTROPY] = (step.uneven_spring - step.uneven @ velocity) @ way
    expected[LOADS] = step.load @ way
    expected[LAWS] = (step.law - step.squeeze @ velocity) @ way
    expected[GRAVITY] = -(step.weight @ [SINE, COSINE]) @ change
    expected[LAWS_LOSS] = DT * velocity @ (step.law - step.squeeze @ velocity)
    np.testing.assert_allclose(step.state.works, expected, rtol=1e-8, atol=1e-12)
    assert sizes == pytest.approx(np.abs(expected[:LAWS_LOSS]).sum(), rel=1e-8)
    if "law" not in CASES[case]:
        assert (step.state.works[LAWS_LOSS] < 0) == ("film" in CASES[case])
    add_support_works(step.support, SPEED, DT, COSINE, SINE, step.now, change, step.state)
    np.testing.assert_allclose(step.state.works, 2 * expected, rtol=1e-8, atol=1e-12)
