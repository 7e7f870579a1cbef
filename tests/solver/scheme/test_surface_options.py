"""Runs on the surfaces that are options: chords, and a liner that wears."""

import numpy as np
import pytest

from rubgen.contact.liner_kernels import REMOVED, WORK
from rubgen.errors import UserError
from rubgen.scenario import ContactLaw, Liner, parse_recipe
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.solver.scheme.energy_kernels import CONTACT, FRICTION, NORMAL
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper, start_opening
from rubgen.solver.wants import Wants
from rubgen.taps import DEFAULT_TAPS, ContactTorque

LINER = Liner(thickness_m=1e-3, wear_m2_per_n=4e-12, width_m=0.02, bins=240)
LAWS = {
    "chords": ContactLaw(friction=0.1, surface="chords"),
    "liner": ContactLaw(friction=0.1, liner=LINER),
    "all": ContactLaw(friction=0.1, surface="chords", half_thickness=True, liner=LINER),
}


def run_turns(system, law, steps=256, turns=12, screen=True, taps=DEFAULT_TAPS):
    stepper = rub_free_stepper(system, law, steps, screen=screen, taps=taps)
    opening, impulse = start_opening(system, stepper.model.surface.inset), []
    for turn in range(turns):
        assert stepper.run_turn(opening * closing_ramp((turn + np.arange(-1, steps + 1) / steps) / 6))[0] == 0
        impulse.append(stepper.result.summary[0])
    return stepper, np.array(impulse)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_screening_changes_no_bit(small_system, law):
    screened, impulse = run_turns(small_system(speed=500.0), law)
    every, again = run_turns(small_system(speed=500.0), law, screen=False)
    assert impulse[-1] > 0.1
    np.testing.assert_array_equal(screened.coordinates.now, every.coordinates.now)
    np.testing.assert_array_equal(screened.state.works, every.state.works)
    np.testing.assert_array_equal(impulse, again)
    np.testing.assert_array_equal(screened.state.wear.depth, every.state.wear.depth)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())
def test_the_energy_identity_holds_and_nothing_is_gained(small_system, operation, law):
    system = small_system(speed=500.0)
    response = integrate(system, operation(system, record_turns=10, settle_turns=45), law)
    assert response.status is Status.OK
    assert response.energy.residual < 1e-10
    assert response.energy.normal_loss < 0
    assert response.energy.friction_loss < 0
    assert response.energy.wear_loss <= 0


def test_the_start_opens_chords_until_nothing_touches(small_system):
    stepper = rub_free_stepper(small_system(), LAWS["chords"], 256)
    opening = start_opening(stepper.system, stepper.model.surface.inset)
    assert opening > start_opening(stepper.system) + 0.9 * 0.2 * (1 - np.cos(np.pi / 36))
    stepper.run_turn(np.full(258, opening))
    assert stepper.result.summary[1] == 0


def test_chords_hit_a_turning_tip_at_every_node(small_system, operation):
    """Blades that would just slide along a circle touch 36 chords a turn, each ends between two nodes."""
    system = small_system(ovality=0.0, unbalance=0.0, clearance=6e-4, casing_damping=0.4)
    runs = {}
    for law in (ContactLaw(), ContactLaw(surface="chords")):
        runs[law.surface] = integrate(system, operation(system, record_turns=20, settle_turns=60), law)
    assert not runs["smooth"].impulse_per_turn.any()
    touches = len(runs["chords"].events.blade) / 20 / 6
    assert 18 < touches < 80
    # 36 chords lie 0.76 mm inside of the circle; grown blades are 0.2 mm from it.
    assert runs["chords"].impulse_per_turn.min() > 0.1


def test_a_liner_wears_where_it_is_touched_until_the_rub_is_over(small_system, operation):
    system = small_system(speed=500.0)
    law = ContactLaw(friction=0.1, liner=Liner(thickness_m=2e-3, wear_m2_per_n=4e-10, width_m=0.02))
    response = integrate(system, operation(system, record_turns=100, settle_turns=400), law)
    worn = response.worn
    assert worn.volume == pytest.approx(worn.removed, rel=1e-12)
    assert 1e-5 < worn.depth.max() < 2e-3
    assert response.impulse_per_turn.sum() < 1e-3
    lobes = np.abs(np.fft.rfft(worn.depth))[:3]
    assert lobes[2] > 2 * lobes[1]


def test_volume_follows_from_force_and_sliding(small_system):
    """Archard's law over a turn: rate times the impulse times the tips' speed, which varies by what blades swing."""
    stepper, _ = run_turns(small_system(speed=500.0), LAWS["liner"], turns=10)
    before = stepper.state.wear.sums[REMOVED]
    stepper.run_turn()
    worn = stepper.state.wear.sums[REMOVED] - before
    speed = 500.0 * 0.2
    assert stepper.result.summary[0] > 0.1
    assert worn == pytest.approx(LINER.wear_m2_per_n * stepper.result.summary[0] * speed, rel=0.05)


def test_the_drive_pays_for_wear_as_for_other_losses(small_system):
    """Contact less normal, friction and wear losses tends to the drive's limit with the step."""
    law = ContactLaw(liner=Liner(thickness_m=5e-3, wear_m2_per_n=2e-10, width_m=0.02, bins=120))
    apart, wears, torque = [], [], (ContactTorque(name="contact_torque"),)
    for steps in (1024, 2048, 4096):
        stepper, _ = run_turns(small_system(speed=500.0, casing_damping=0.4), law, steps=steps, turns=6, taps=torque)
        stepper.state.works[:], stepper.state.wear.sums[:] = 0, 0  # until now the closing surface did work
        limit, laws = 0.0, stepper.model.laws
        for _ in range(3):
            stepper.run_turn()
            limit -= laws.speed * laws.dt * stepper.result.taps[0].sum()
        contact, normal, rubbing = (stepper.state.works[work] for work in (CONTACT, NORMAL, FRICTION))
        wears.append(stepper.state.wear.sums[WORK])
        apart.append(contact - normal - rubbing + wears[-1] - limit)
    assert wears[2] == pytest.approx(wears[1], rel=0.1)
    assert np.array(apart[:2]) / apart[1:] == pytest.approx([2, 2], rel=0.2)
    assert abs(apart[2]) < 0.1 * wears[2]


def test_a_worn_liner_is_seen_by_the_clearance_on_a_ray(small_system):
    system = small_system(clearance=2e-3, unbalance=0.0)
    new, worn = (rub_free_stepper(system, ContactLaw(liner=LINER), 256) for _ in range(2))
    worn.state.wear.depth[:] = 3e-4
    for stepper in (new, worn):
        stepper.run_turn()
    np.testing.assert_allclose(worn.result.taps[9] - new.result.taps[9], 3e-4, rtol=1e-9)


def test_there_is_no_exponent_while_the_liner_wears(small_system, operation):
    system = small_system(speed=500.0)
    asked = operation(system, record_turns=40, settle_turns=50)
    wearing = integrate(system, asked, LAWS["liner"], Wants(companion=True))
    assert np.isnan(wearing.companion_growth).any()
    hard = integrate(system, asked, ContactLaw(friction=0.1), Wants(companion=True))
    assert np.isfinite(hard.companion_growth).all()


def test_a_recipe_asks_for_the_options_and_is_told_what_is_wrong_with_them():
    recipe = {"name": "a", "runs": 1, "machine": "zeng2019"}
    liner = {"thickness_m": 1e-3, "wear_m2_per_n": 1e-11, "width_m": 0.04}
    contact = parse_recipe({**recipe, "contact": {"surface": "chords", "liner": liner}}).scenario(0).contact
    assert contact == ContactLaw(surface="chords", liner=Liner(**liner))
    for wrong, message in (
        ({"surface": "round"}, "contact.surface = 'round': unknown value; allowed: smooth, chords"),
        (
            {"liner": {**liner, "thickness_m": 0.0}},
            "contact.liner.thickness_m = 0: must be at least 1e-07 and at most 100; change the value",
        ),
        (
            {"liner": {**liner, "bins": 10}},
            "contact.liner.bins = 10: must be at least 36 and at most 3,600; change the value",
        ),
    ):
        with pytest.raises(UserError) as caught:
            parse_recipe({**recipe, "contact": wrong})
        assert message in str(caught.value)
