"""One step: its margin, its gaps, its end, and a step in contact against dense matrices."""

import numpy as np
import pytest

from rubgen.contact.clearance_kernels import casing_displacement_bound
from rubgen.contact.geometry_kernels import FAR_AWAY
from rubgen.scenario import ContactLaw
from rubgen.solver.scheme.contact_step_kernels import previous_gap, starting_margin
from rubgen.solver.scheme.state_kernels import OK, Coordinates
from rubgen.solver.scheme.step_kernels import advance, has_diverged
from rubgen.solver.speed.start import rub_free_stepper
from tests.contact_calls import gap_and_foot

STEPS = 96


@pytest.fixture
def stepper(small_system):
    return rub_free_stepper(small_system(), ContactLaw(restitution=0.5), STEPS)


def test_the_margin_is_wider_by_what_restitution_sends_back(stepper):
    laws, gaps = stepper.model.laws, np.full((3, 6), np.nan)
    assert starting_margin(laws, gaps) == laws.margin
    gaps[0, :3], gaps[1:] = [2e-5, -3e-5, -1e-5], -1.0
    assert starting_margin(laws, gaps) == pytest.approx(laws.margin + 0.5 * 3e-5)
    assert starting_margin(laws._replace(restitution=0.0), gaps) == laws.margin


def test_the_gap_of_the_step_before_is_the_scheme_s_where_known_else_the_geometry_s(stepper):
    system, work, model, blade = stepper.system, stepper.state.contact, stepper.model, 4
    q = np.random.default_rng(1).normal(size=(3, len(system.M))) * 1e-4
    coordinates, turn = Coordinates(*q, np.zeros(len(system.M))), np.exp(0.6j)

    def found():
        return previous_gap(
            model.surface, model.tips, np.zeros(0), blade, coordinates, 2e-4, turn.real, turn.imag, work
        )

    work.step_gaps[:] = np.nan
    radial, tangential, _ = q[0, 3 * blade : 3 * blade + 3] + system.tip_static[blade]
    point = (system.tip_radius + radial + 1j * tangential) * turn * np.exp(1j * system.blade_angles[blade])
    start = system.casing_start
    expected = gap_and_foot(model.surface, q[0, start:], np.array([point.real, point.imag]), 2e-4)[0]
    assert found() == pytest.approx(expected, abs=1e-15)
    work.step_gaps[0, blade] = 7e-6
    assert found() == 7e-6


def test_a_run_has_diverged_where_a_tip_or_a_casing_node_is_beyond_its_limit_or_no_number(stepper):
    system, surface, laws = stepper.system, stepper.model.surface, stepper.model.laws
    start, blades = system.casing_start, system.n_blades

    def diverged(**numbers):
        q = np.zeros(len(system.M))
        for number, value in numbers.items():
            q[int(number[1:])] = value
        return has_diverged(surface, laws, q, start, blades)

    limit = laws.tip_limit
    assert not diverged(_0=0.99 * limit, _17=-0.99 * limit)
    assert diverged(_17=-1.01 * limit)
    assert diverged(_5=np.nan)
    assert not diverged(_18=9.0)  # of the disk centre nothing is asked
    largest = np.sqrt((system.casing_modes[:, :, 2] ** 2).sum(axis=1)).max()
    nearly = 0.999 * laws.casing_limit / largest
    assert casing_displacement_bound(surface, np.eye(system.n_casing)[2] * nearly) > laws.casing_limit
    assert not diverged(**{f"_{start + 2}": nearly})
    assert diverged(**{f"_{start + 2}": 1.01 * nearly})
    assert diverged(**{f"_{start + 2}": np.nan})


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_step_in_contact_balances_and_no_force_pulls_and_no_blade_enters(small_system, friction):
    """A q_n+1 = f - K q_n + 2 M / dt^2 q_n - (M / dt^2 - C / (2 dt)) q_n-1 + B lam, 0 <= lam, 0 <= gap, lam gap = 0."""
    system = small_system(speed=500.0, clearance=-2e-4)
    stepper, opening = rub_free_stepper(system, ContactLaw(friction=friction), STEPS), np.zeros(STEPS + 2)
    before, now, after = stepper.state.motions
    code, count = advance(stepper.model, 0, opening, before, now, after, stepper.state)
    assert code == OK
    work, dt, start = stepper.state.contact, stepper.dt, system.casing_start
    lam, blades = work.lam[:count], work.blade[:count]
    force = system.force.copy()
    for m, blade in enumerate(blades):
        force[3 * blade : 3 * blade + 3] += lam[m] * work.full_tip[m]
        force[start:] += lam[m] * work.full_casing[m]
    old, q, new = (stepper.blocks.to_q(motion.z) for motion in (before, now, after))
    A, back = system.M / dt**2 + system.C / (2 * dt), system.M / dt**2 - system.C / (2 * dt)
    right = force - system.K @ q + 2 * system.M / dt**2 @ q - back @ old
    np.testing.assert_allclose(new, np.linalg.solve(A, right), atol=1e-10 * np.abs(new).max())
    gaps = work.step_gaps[2, blades]
    assert lam.max() > 10.0
    assert lam.min() >= 0
    assert np.abs(gaps[lam > 0]).max() < 1e-12
    assert gaps.min() > -1e-12
    assert np.isnan(np.delete(work.step_gaps[2], blades)).all()


def test_forces_that_move_tips_by_millions_of_metres_ask_of_all_blades_and_of_no_more(small_system):
    """Behind the sixth blade stand two that do not exist, FAR_AWAY: no margin may reach them."""
    system = small_system(speed=500.0, clearance=-2e-4)
    stepper = rub_free_stepper(system, ContactLaw(), STEPS)
    soft = {name: 1e-13 * getattr(stepper.model, name) for name in ("tip_compliance", "casing_compliance")}
    model = stepper.model._replace(laws=stepper.model.laws._replace(margin=1e-12), **soft)
    _, _, after = stepper.state.motions
    code, count = advance(model, 0, np.zeros(STEPS + 2), *stepper.state.motions, stepper.state)
    assert code == OK
    assert np.abs(after.tips).max() > FAR_AWAY
    assert stepper.state.contact.blade[:count].tolist() == list(range(system.n_blades))


@pytest.mark.parametrize("margin", [1e-12, 1e-5])
def test_a_blade_that_the_forces_on_others_push_in_is_solved_in_the_same_step(small_system, margin):
    """A narrow margin leaves it out at first. The step is solved again, and is that of a margin around all blades."""
    system = small_system(speed=500.0, clearance=-2e-4)

    def stepped(opening, margin):
        stepper = rub_free_stepper(system, ContactLaw(friction=0.2), STEPS)
        model = stepper.model._replace(laws=stepper.model.laws._replace(margin=margin))
        code, count = advance(model, 0, np.full(STEPS + 2, opening), *stepper.state.motions, stepper.state)
        assert code == OK
        forces = np.zeros(system.n_blades)
        forces[stepper.state.contact.blade[:count]] = stepper.state.contact.lam[:count]
        return stepper.coordinates.after, forces, stepper.state.contact.gap

    free = stepped(0.0, 1.0)[2]
    pushed_in = 0
    for least in np.sort(free)[1:6]:
        opening = 1e-10 - least  # this blade is just inside of the surface, those before it are not
        (q, forces, _), (wide, all_forces, gaps) = stepped(opening, margin), stepped(opening, 1.0)
        pushed_in += int(((all_forces > 0) & (gaps > 0)).sum())
        np.testing.assert_allclose(forces, all_forces, rtol=1e-9, atol=1e-9 * all_forces.max())
        np.testing.assert_allclose(q, wide, atol=1e-14)
    assert pushed_in > 0
