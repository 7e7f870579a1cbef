"""Directions of contact force and slip, from positions in the inertial frame alone."""

import numpy as np
import pytest

from rubgen.arrays import frozen
from rubgen.contact.contact_kernels import build_rows
from rubgen.contact.geometry_kernels import casing_rows
from rubgen.scenario import ContactLaw
from rubgen.solver.scheme.energy_kernels import CONTACT, FRICTION, NORMAL, add_contact_works
from rubgen.solver.scheme.state_kernels import Coordinates
from rubgen.solver.speed.start import rub_free_stepper
from tests.contact_calls import gap_and_foot

MU, THETA, BLADE = 0.3, 0.7, 2


class Touch:
    """One blade at the casing in a random state, bent by millimetres and moving at tens of m/s in all directions."""

    def __init__(self, system, seed):
        self.system, self.stepper = system, rub_free_stepper(system, ContactLaw(friction=MU), 256)
        rng = np.random.default_rng(seed)
        self.q, self.v = rng.normal(size=(2, len(system.M))) * [[2e-3], [40.0]]
        self.q[system.casing_start :] *= 0.1
        self.v[3 * BLADE + 2] = 30.0
        self.work = self.stepper.state.contact
        found = gap_and_foot(self.stepper.model.surface, self.q[system.casing_start :], self.place(self.q, THETA)[:2])
        self.gap, self.psi, self.tangent = found[0], found[1], found[2:]
        self.rows = np.zeros((2, system.n_casing))
        casing_rows(self.stepper.model.surface, self.psi, self.rows)
        self.work.blade[0], self.work.psi[BLADE], self.work.tangent[BLADE] = BLADE, self.psi, self.tangent
        turned = np.cos(THETA), np.sin(THETA)
        build_rows(
            self.stepper.model.surface, self.stepper.model.tips, 0, self.q, self.v, system.speed, MU, *turned, self.work
        )

    def place(self, q, theta):
        """Inertial position (3,) of the tip."""
        radial, tangential, axial = q[3 * BLADE : 3 * BLADE + 3] + self.system.tip_static[BLADE]
        turn = np.exp(1j * (theta + self.system.blade_angles[BLADE]))
        point = (self.system.tip_radius + radial + 1j * tangential) * turn
        return np.array([point.real, point.imag, axial])

    def along(self, change):
        """Tip displacement (3,) in the inertial axes per unit of a change of q, theta fixed."""
        return self.place(self.q + change, THETA) - self.place(self.q, THETA)


@pytest.fixture(params=range(4))
def touch(request, small_system):
    return Touch(small_system(speed=500.0), request.param)


def test_friction_opposes_the_slip_seen_from_outside(touch):
    h = 1e-7
    before, after = (touch.place(touch.q + s * h * touch.v, THETA + s * h * touch.system.speed) for s in (-1, 1))
    tip = (after - before) / (2 * h)
    casing = touch.rows @ touch.v[touch.system.casing_start :]
    slip = np.array([(tip[:2] - casing) @ touch.tangent, tip[2]])
    # Millimetres of bend change the slip by 500 rad/s x 2 mm = 1 m/s of 100.
    np.testing.assert_allclose(touch.work.slip[0], -slip / np.linalg.norm(slip), atol=1e-7)


def test_rows_do_the_work_of_the_force_on_tip_and_casing(touch):
    """Delta q . B is the work of n + mu tau on the tip's move and of its opposite, in the plane, on the casing's."""
    normal = np.array([-touch.tangent[1], touch.tangent[0], 0.0])
    along, axial = touch.work.slip[0]
    force = normal + MU * np.array([*(along * touch.tangent), axial])
    start, rng = touch.system.casing_start, np.random.default_rng(1)
    for full, acting in ((True, force), (False, normal)):
        on_tip, on_casing = (
            (touch.work.full_tip[0], touch.work.full_casing[0])
            if full
            else (touch.work.normal_tip[0], touch.work.normal_casing[0])
        )
        change = rng.normal(size=len(touch.q))
        assert on_tip @ change[3 * BLADE : 3 * BLADE + 3] == pytest.approx(acting @ touch.along(change), rel=1e-9)
        assert on_casing @ change[start:] == pytest.approx(-acting[:2] @ (touch.rows @ change[start:]), rel=1e-9)


def test_the_normal_row_is_the_slope_of_the_gap(touch):
    start = touch.system.casing_start
    numbers = [3 * BLADE, 3 * BLADE + 1, 3 * BLADE + 2, *range(start, len(touch.q))]
    h, slopes = 1e-7, []
    for number in numbers:
        gaps = []
        for side in (-h, h):
            q = touch.q.copy()
            q[number] += side
            gaps.append(gap_and_foot(touch.stepper.model.surface, q[start:], touch.place(q, THETA)[:2])[0])
        slopes.append((gaps[1] - gaps[0]) / (2 * h))
    expected = np.concatenate([touch.work.normal_tip[0], touch.work.normal_casing[0]])
    np.testing.assert_allclose(expected, slopes, atol=1e-7)


def test_works_of_a_contact_are_those_of_its_force(touch):
    """One step of motion d = v dt: lam B.d, the normal and the friction loss, and the torque e_z.(P x F)."""
    stepper, work, lam, dt = touch.stepper, touch.work, 700.0, touch.stepper.dt
    d = touch.v * dt
    coordinates = Coordinates(touch.q, touch.q, touch.q, d)
    work.lam[0], work.step_gaps[0, BLADE], work.step_gaps[2, BLADE] = lam, 5e-5, -3e-5
    step = 40
    model = stepper.model
    angles = model.angles._replace(cosine=np.full(257, np.cos(THETA)), sine=np.full(257, np.sin(THETA)))
    normal, friction, torque = add_contact_works(
        0, frozen(model._replace(angles=angles)), step, np.zeros(258), coordinates, stepper.state
    )
    inward = np.array([-touch.tangent[1], touch.tangent[0]])
    along, axial = work.slip[0]
    force = lam * (inward + MU * along * touch.tangent)
    tip_move, casing_move = touch.along(d), touch.rows @ d[touch.system.casing_start :]
    lever = np.array([-touch.place(touch.q, THETA)[1], touch.place(touch.q, THETA)[0]])
    turn = touch.system.speed * dt * lever
    slip = (tip_move[:2] + turn - casing_move) @ touch.tangent, tip_move[2]
    works = stepper.state.works
    assert works[CONTACT] == pytest.approx(
        force @ (tip_move[:2] - casing_move) + MU * lam * axial * tip_move[2], rel=1e-9
    )
    assert works[NORMAL] == normal == pytest.approx(0.5 * lam * -8e-5)
    assert abs(slip[1]) > 0.1 * abs(slip[0])  # the axial part counts
    assert works[FRICTION] == friction == pytest.approx(-MU * lam * np.hypot(*slip), rel=1e-9)
    assert torque == pytest.approx(force @ lever, rel=1e-9)
