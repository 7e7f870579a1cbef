import re
from dataclasses import replace

import numpy as np
import pytest

from rubgen.scenario import ContactLaw
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.solver.observers.divergence import ADVICE
from rubgen.solver.scheme.energy_kernels import CONTACT, FRICTION, NORMAL
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper
from rubgen.taps import ContactTorque
from tests.contact_calls import gap_and_foot

TORQUE = (ContactTorque(name="contact_torque"),)


def drive_work(stepper: Stepper) -> float:
    """What a rigid drive would supply in the last turn, J: -Omega times the integral of the contact torque (row 0)."""
    return float(-stepper.model.laws.speed * stepper.model.laws.dt * stepper.result.taps[0].sum())


@pytest.fixture(scope="module")
def rub(small_system, operation):
    system = small_system(speed=500.0)
    return system, integrate(system, operation(system), ContactLaw(friction=0.1))


def test_the_rub_happens_and_the_identity_holds(rub):
    _, response = rub
    assert response.status is Status.OK
    assert np.all(response.impulse_per_turn > 1)
    assert np.all(response.contact_steps_per_turn > 50)
    balance = response.energy
    works = balance.unbalance + balance.damping + balance.circulatory + balance.contact
    assert abs(balance.contact) > 1
    assert abs(balance.end - balance.start - works) <= 1e-8 * balance.absolute_work
    assert response.energy.residual < 1e-10


def test_no_loss_is_ever_a_gain(rub):
    _, response = rub
    balance, events = response.energy, response.events
    assert balance.normal_loss < 0
    assert balance.friction_loss < 0
    assert balance.damping < 0
    allowed = 1e-8 * balance.absolute_work
    assert events.normal_loss.max() <= allowed
    assert events.friction_loss.max() <= allowed


def test_touches_add_up_to_the_impulse_of_the_record(rub):
    _, response = rub
    events = response.events
    assert events.impulse.sum() == pytest.approx(response.impulse_per_turn.sum(), rel=1e-12)
    tap = response.taps["contact_force"]
    assert tap.sum() * response.dt == pytest.approx(response.impulse_per_turn[-100:].sum(), rel=1e-12)
    assert np.count_nonzero(tap) == response.contact_steps_per_turn[-100:].sum()
    assert set(events.blade) == set(range(6))
    assert np.all(events.start_step >= 0)
    end = events.start_step + events.steps
    assert np.all(np.diff(end) >= 0)
    assert end.max() <= 100 * response.steps_per_turn
    for blade in range(6):
        mine = events.blade == blade
        assert np.all(events.start_step[mine][1:] > end[mine][:-1])


def test_touches_lie_where_the_tips_were(rub):
    system, response = rub
    events = response.events
    middle = events.start_step + 0.5 * events.steps
    theta = 2 * np.pi * (middle + 0.5) / response.steps_per_turn
    away = np.angle(np.exp(1j * (events.angle - theta - system.blade_angles[events.blade])))
    assert np.abs(away).max() < 0.1


def test_two_lobes_give_two_zones_at_the_minor_axis(rub):
    _, response = rub
    events = response.events
    doubled = np.sum(events.impulse * np.exp(2j * events.angle)) / events.impulse.sum()
    assert doubled.real > 0.3


def test_sections_are_the_states_at_whole_turns(rub):
    system, response = rub
    x = response.taps["blisk_x"][:: response.steps_per_turn]
    np.testing.assert_allclose(x, response.section_q[-len(x) :, system.centre], rtol=0, atol=1e-18)
    y = response.taps["blisk_y"]
    speed = (y[response.steps_per_turn + 1] - y[response.steps_per_turn - 1]) / (2 * response.dt)
    inertial = response.section_v[1, system.centre + 1] + system.speed * response.section_q[1, system.centre]
    assert inertial == pytest.approx(speed, rel=1e-3)


def test_accelerations_are_outward_and_those_of_the_section(rub):
    """A casing on springs, pushed outward at its zones: acceleration integrates to the modes' motion."""
    system, response = rub
    start, steps = system.casing_start, response.steps_per_turn
    modes = response.section_q[:, start:]
    radial = system.casing_modes[9, 1]  # node 9 of 36 stands at 90 degrees, where Y is outward
    acceleration = response.taps["casing_acc_90"].reshape(-1, steps)
    velocity = response.section_v[:, start:] @ radial
    gained = response.dt * (acceleration[:-1].sum(axis=1) - 0.5 * (acceleration[:-1, 0] - acceleration[1:, 0]))
    np.testing.assert_allclose(gained, np.diff(velocity), atol=1e-9 * np.abs(acceleration).max() * response.dt * steps)
    assert np.abs(modes @ radial).max() > 1e-5


def test_orders_of_two_and_three_lobes(small_system, operation):
    for lobes, speed, clearance, damping in ((2, 400.0, 5e-5, 0.1), (3, 350.0, 3e-5, 0.4)):
        system = small_system(lobes=lobes, speed=speed, clearance=clearance, casing_damping=damping)
        response = integrate(system, operation(system, steps_per_turn=384, settle_turns=120), ContactLaw(friction=0.1))
        assert response.status is Status.OK
        signals = {name: np.abs(np.fft.rfft(tap))[::100][:10] for name, tap in response.taps.items()}
        orders = np.arange(10)
        force, blisk = signals["contact_force"], signals["blisk_x"]
        assert force[lobes] > 1e-4 * force[0]
        assert force[orders % lobes != 0].max() < 1e-9 * force.max()
        allowed = (orders % lobes == 1) | (orders % lobes == lobes - 1)
        assert blisk[allowed][1:].max() > 1e-3 * blisk[1]
        assert blisk[~allowed].max() < 1e-9 * blisk[1]


def complementary_steps(system, law, turns=4, steps=256):
    stepper = rub_free_stepper(system, law, steps)
    opening = np.concatenate([np.linspace(5e-4, 0, (turns - 2) * steps), np.zeros(2 * steps + 2)])
    for turn in range(turns):
        for s in range(steps):
            code, count = stepper.step(s, opening[turn * steps :])
            assert code == 0
            yield stepper, s, opening[turn * steps + s + 2], count


def test_complementarity_in_every_step_with_contact(small_system):
    system = small_system(speed=500.0)
    touched = 0
    for stepper, s, opening, count in complementary_steps(system, ContactLaw(friction=0.2)):
        work = stepper.state.contact
        lam, gap = work.lam[:count], work.step_gaps[1][work.blade[:count]]
        assert np.all(lam >= 0)
        assert np.all(gap >= -1e-15)
        assert np.all(lam * gap <= 1e-14 * max(lam.max(initial=0), 1))
        theta = 2 * np.pi * (s + 1) / stepper.steps
        tips = stepper.coordinates.now[: 3 * system.n_blades].reshape(-1, 3) + system.tip_static
        point = (system.tip_radius + tips[:, 0] + 1j * tips[:, 1]) * np.exp(1j * (theta + system.blade_angles))
        for k in range(system.n_blades):
            q_casing = stepper.coordinates.now[system.casing_start :]
            true = gap_and_foot(stepper.model.surface, q_casing, np.array([point[k].real, point[k].imag]), opening)[0]
            # What is left is the change of the geometry by the contact itself, of second order.
            assert true > -1e-8
        touched += np.count_nonzero(lam)
    assert touched > 200


def test_restitution_throws_back_with_the_same_share(small_system):
    system = small_system(speed=500.0)
    touched = 0
    for stepper, _, _, count in complementary_steps(system, ContactLaw(restitution=0.6)):
        work = stepper.state.contact
        for m in range(count):
            if work.lam[m] > 0:
                before = work.b[m] - work.gap[work.blade[m]]
                assert work.step_gaps[1][work.blade[m]] == pytest.approx(-before, abs=1e-14)
                touched += 1
    assert touched > 50


def test_restitution_reaches_a_blade_that_leaves_by_itself(small_system):
    """From 100 um inside, a share of 0.6 throws it 60 um out, not the 30 um, beyond the margin, where it would be."""
    system = small_system()
    stepper = rub_free_stepper(system, ContactLaw(restitution=0.6), 256)
    angle = 2 * np.pi / 256
    radial, tangential, _ = stepper.coordinates.now[:3] + system.tip_static[0]
    tip = (system.tip_radius + radial + 1j * tangential) * np.exp(1j * angle)
    free = gap_and_foot(stepper.model.surface, np.zeros(system.n_casing), np.array([tip.real, tip.imag]))[0]
    stepper.state.contact.step_gaps[0, 0] = -1e-4
    assert stepper.model.laws.margin < 3e-5
    code, count = stepper.step(0, np.full(258, 3e-5 - free))
    assert code == 0
    assert stepper.state.contact.blade[:count].tolist() == [0]
    assert stepper.state.contact.gap[0] == pytest.approx(3e-5, abs=1e-7)
    assert stepper.state.contact.lam[0] > 0
    assert stepper.state.contact.step_gaps[1, 0] == pytest.approx(6e-5, rel=1e-9)


def test_screening_changes_no_bit(small_system):
    system = small_system(speed=500.0)
    ends = []
    for screen in (True, False):
        stepper = rub_free_stepper(system, ContactLaw(friction=0.15), 256, screen=screen)
        impulse = 0.0
        for turn in range(12):
            stepper.run_turn(np.full(258, 5e-4 * max(0, 1 - turn / 6)))
            impulse += stepper.result.summary[0]
        ends.append(
            np.concatenate([stepper.coordinates.now, stepper.state.works, stepper.result.taps.ravel(), [impulse]])
        )
    assert ends[0][-1] > 1
    np.testing.assert_array_equal(ends[0], ends[1])


def test_turning_casing_and_start_together_changes_nothing(small_system):
    ends = []
    for nodes in (0, 5, 16):
        system = small_system(speed=500.0, turned_nodes=nodes)
        stepper = rub_free_stepper(system, ContactLaw(friction=0.1), 256, start_angle=2 * np.pi * nodes / 36)
        impulse = 0.0
        for turn in range(8):
            stepper.run_turn(np.full(258, 5e-4 * max(0, 1 - turn / 5)))
            impulse += stepper.result.summary[0]
        ends.append(np.append(stepper.coordinates.now / np.abs(stepper.coordinates.now).max(), impulse))
    assert ends[0][-1] > 1
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-8)
    np.testing.assert_allclose(ends[2], ends[0], atol=1e-8)


@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_the_drive_pays_for_contact_and_impact_loss_does_not_vanish_with_the_step(small_system, friction):
    """Contact work less its losses tends to -Omega integral of the contact torque, with the first power of the step."""
    apart, losses = [], []
    for steps in (512, 1024, 2048):
        law = ContactLaw(friction=friction)
        stepper, limit = rub_free_stepper(small_system(casing_damping=0.4), law, steps, taps=TORQUE), 0.0
        for turn in range(40):
            if turn == 30:
                stepper.state.works[:], limit = 0, 0.0
            stepper.run_turn(5e-4 * closing_ramp((turn + np.arange(-1, steps + 1) / steps) / 20))
            limit += drive_work(stepper)
        contact, normal, rubbing = (stepper.state.works[work] for work in (CONTACT, NORMAL, FRICTION))
        apart.append(contact - normal - rubbing - limit)
        losses.append(normal)
    assert limit > 5
    assert np.array(apart[:2]) / apart[1:] == pytest.approx([2, 2], rel=0.1)
    assert losses[1] == pytest.approx(losses[2], rel=0.05)
    assert losses[2] < -0.5


def test_a_deep_rub_diverges_with_its_branch_turn_and_rates_of_growth(small_system, operation):
    system = small_system(ovality=3e-2)
    system = replace(system, tip_static=np.tile([1e-2, 0.0, 0.0], (system.n_blades, 1)))
    response = integrate(system, operation(system), ContactLaw(friction=0.3))
    assert response.status is Status.DIVERGED
    found = re.fullmatch(
        r"(the casing left 5 mm|blade \d bent beyond 5 mm) in turn \d+ of \d+, step \d+ of 256; (growing|no steady "
        r"growth, an excursion of an irregular motion): rate over the last (\d+) turns blades (\S+) a turn "
        r"\((\S+) 1/s\) about (\S+) mm, casing (\S+) a turn \(\S+ 1/s\) about (\S+) mm"
        r"; (of 24 such runs .*)",
        response.reason,
    )
    assert found
    branch = "casing" if found[1].startswith("the casing") else "blade"
    assert found[len(found.groups())] == ADVICE[branch]
    turns, *numbers = (float(number) for number in found.groups()[2:-1])
    assert found[2] == "growing"
    assert 1 <= turns <= 10
    assert max(numbers[0], numbers[3]) * turns > np.log(2)
    assert numbers[0] / response.turn_seconds == pytest.approx(numbers[1], rel=0.01)


def test_contact_on_the_inner_surface_keeps_the_identity_and_pays_for_the_sections_turn(small_system, operation):
    """Of six works the identity leaves nothing over; a thicker ring of the same stiffness moves otherwise."""
    law, ends = ContactLaw(friction=0.3, half_thickness=True), []
    for half in (0.0, 3e-3):
        system = replace(small_system(speed=500.0), half_thickness=half)
        response = integrate(system, operation(system, record_turns=5, settle_turns=45), law)
        assert response.status is Status.OK
        assert response.energy.residual < 1e-10
        assert response.energy.friction_loss < -1
        ends.append(response.section_q[-1])
    assert np.abs(ends[1] - ends[0]).max() > 1e-6


def test_works_on_the_inner_surface_add_up_to_what_the_drive_pays(small_system):
    apart = []
    for steps in (512, 1024):
        law = ContactLaw(friction=0.2, half_thickness=True)
        stepper, limit = rub_free_stepper(small_system(casing_damping=0.4), law, steps, taps=TORQUE), 0.0
        for turn in range(30):
            if turn == 20:
                stepper.state.works[:], limit = 0, 0.0
            stepper.run_turn(5e-4 * closing_ramp((turn + np.arange(-1, steps + 1) / steps) / 15))
            limit += drive_work(stepper)
        contact, normal, rubbing = (stepper.state.works[work] for work in (CONTACT, NORMAL, FRICTION))
        apart.append(abs(contact - normal - rubbing - limit) / limit)
    assert apart[1] < 0.02
    assert apart[0] / apart[1] == pytest.approx(2, rel=0.15)
