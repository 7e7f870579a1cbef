import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.scenario import ContactLaw
from rubgen.solver import exponent
from rubgen.solver.exponent import changed_after, is_settled, lyapunov
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.stability import slowest_decay
from rubgen.solver.observers.companion import Companion, piece_ends
from rubgen.solver.observers.symmetry import turned_back
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.solver.wants import Wants

STEPS = 256


def in_contact(system, restitution: float = 0.0, snapshots: list[int] | None = None) -> tuple[Stepper, np.ndarray]:
    """A stepper that has settled into a rub, and an opening of zero."""
    law, closed = ContactLaw(friction=0.1, restitution=restitution), np.zeros(STEPS + 2)
    stepper = rub_free_stepper(system, law, STEPS)
    stepper.take_snapshots(snapshots or piece_ends(STEPS))
    stepper.run_turn(np.linspace(6e-4, 0, STEPS + 2))
    for _ in range(12):
        stepper.run_turn(closed)
    return stepper, closed


def test_the_run_keeps_its_bits(small_system, operation):
    system = small_system(speed=500.0)
    short = operation(system, record_turns=40, settle_turns=60)
    for law in (ContactLaw(friction=0.1), ContactLaw(friction=0.1, restitution=0.5)):
        alone, beside = (integrate(system, short, law, Wants(companion=asked)) for asked in (False, True))
        assert alone.impulse_per_turn.min() > 0
        assert np.array_equal(alone.section_q, beside.section_q)
        assert np.array_equal(alone.section_v, beside.section_v)
        assert np.array_equal(alone.taps["contact_force"], beside.taps["contact_force"])
        assert alone.energy == beside.energy
        assert (alone.companion_growth.size, beside.companion_growth.size) == (0, 40)
        assert np.isfinite(beside.companion_growth).all()


def test_without_contact_the_exponent_is_the_slowest_decay(small_system, operation):
    system = small_system(clearance=2e-3, casing_damping=0.02, lateral_damping=0.1)
    response = integrate(
        system, operation(system, record_turns=400, settle_turns=60), ContactLaw(), Wants(companion=True)
    )
    assert response.contact_steps_per_turn.sum() == 0
    found = lyapunov(response.companion_growth)
    assert found.per_turn == pytest.approx(-slowest_decay(system) * response.turn_seconds, rel=1e-2)
    assert found.is_negative


@pytest.mark.parametrize("unsettled", [False, True])
def test_the_companion_stops_once_the_exponent_is_settled(small_system, operation, monkeypatch, unsettled):
    """Up to there its growths, and all else of the run, are those beside a companion that goes on."""
    system, law = small_system(speed=500.0), ContactLaw(friction=0.1)
    whole = operation(system, record_turns=230, settle_turns=60)
    if unsettled:
        monkeypatch.setattr(exponent, "SETTLED_ERRORS", 1e9)
    short = integrate(system, whole, law, Wants(companion=True))
    full = integrate(system, whole, law, Wants(companion=True, companion_stops=False))
    assert full.impulse_per_turn.min() > 0
    turns = short.companion_growth.size
    assert turns == 230 if unsettled else turns in (150, 200)
    assert np.array_equal(short.companion_growth, full.companion_growth[:turns])
    assert np.array_equal(short.section_q, full.section_q)
    assert short.energy == full.energy
    assert lyapunov(short.companion_growth).is_negative == lyapunov(full.companion_growth).is_negative


def test_an_exponent_is_settled_beyond_six_errors_and_a_hundredth_a_turn():
    scatter = np.random.default_rng(1).standard_normal(600)
    assert [n for n in range(1, 300) if is_settled(0.1 + 0.05 * scatter[:n])] == [150, 200, 250]
    assert not any(is_settled(0.1 + 0.5 * scatter[:n]) for n in range(1, 300))
    assert not any(is_settled(0.009 + 1e-6 * scatter[:n]) for n in range(1, 300))
    assert is_settled([0.1, np.nan])


def test_a_motion_that_changes_after_its_exponent_was_settled_is_made_again(small_system, operation, monkeypatch):
    """The impulses of the record, as they were found or not, decide alone."""
    system, law = small_system(speed=500.0), ContactLaw(friction=0.1)
    asked = operation(system, record_turns=230, settle_turns=60)
    monkeypatch.setattr(exponent, "CHANGE", 1e-9)
    assert integrate(system, asked, law, Wants(companion=True)).companion_growth.size == 230


def test_transient_chaos_and_a_regular_episode_are_changes():
    rng = np.random.default_rng(2)
    chaos, regular = 1 + 0.1 * rng.standard_normal(500), 1 + 1e-6 * rng.standard_normal(500)
    pairs = 1 + 0.2 * (-1) ** np.arange(500) + 1e-3 * rng.standard_normal(500)
    late = np.concatenate([chaos[:300], regular[300:]])
    assert not changed_after(chaos, 150, 0.5)
    assert not changed_after(regular, 150, -0.02)
    assert changed_after(late, 150, 0.5)
    assert changed_after(np.concatenate([chaos[:300], pairs[300:]]), 150, 0.5)
    assert not changed_after(late, 400, -0.02)
    assert changed_after(late[::-1], 150, -0.02)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_pieces_multiply_to_the_growth_of_a_second_run(small_system, restitution):
    system = small_system(speed=500.0)
    stepper, closed = in_contact(system, restitution)
    companion = Companion(stepper)
    second = rub_free_stepper(system, ContactLaw(friction=0.1, restitution=restitution), STEPS)
    rows = stepper.blocks.to_q(companion.state.motions[0].z), stepper.blocks.to_q(companion.state.motions[1].z)
    second.set_coordinates(*rows)
    second.state.contact.step_gaps[:] = stepper.state.contact.step_gaps
    before = np.array([second.coordinates.before, second.coordinates.now]) - np.array(
        [stepper.coordinates.before, stepper.coordinates.now]
    )
    stepper.run_turn(closed)
    second.run_turn(closed)
    touched = stepper.result.summary[1]
    growth = companion.run_turn(closed)
    after = np.array([second.coordinates.before, second.coordinates.now]) - np.array(
        [stepper.coordinates.before, stepper.coordinates.now]
    )

    def size(away):
        d_v = (away[1] - away[0]) / stepper.dt
        return np.sqrt(d_v @ system.M @ d_v + system.speed**2 * away[1] @ system.M @ away[1])

    assert touched > 20
    assert len(growth) == 16
    assert growth.sum() == pytest.approx(np.log(size(after) / size(before)), abs=2e-3)
    assert size(before) == pytest.approx(companion.closeness)


def test_a_turn_of_odd_steps_ends_with_its_last_piece():
    assert piece_ends(1024) == list(range(64, 1025, 64))
    assert piece_ends(9) == list(range(1, 10))
    assert piece_ends(100)[-1] == 100


def test_an_exponent_of_ten_turns_is_refused(small_system, operation):
    with pytest.raises(UserError, match=r"record_turns = 10: a Lyapunov exponent needs at least 32 turns.*raise it"):
        integrate(small_system(), operation(small_system(), record_turns=10), ContactLaw(), Wants(companion=True))


def test_modes_of_a_ring_turn_back_by_their_order(small_system):
    system = small_system()
    share = 1 / 3
    back = turned_back(system.casing_modes, share)
    for order in (1, 2, 3):
        angle = 2 * np.pi * share * order
        pair = slice(2 * order - 2, 2 * order)
        expected = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
        assert back[pair, pair] == pytest.approx(np.array(expected), abs=1e-12)
    assert np.linalg.norm(back @ back @ back - np.eye(6)) < 1e-12


def test_without_contact_all_symmetry_states_are_alike(small_system, operation):
    for lobes in (2, 3):
        system = small_system(clearance=3e-3, lobes=lobes)
        response = integrate(system, operation(system, record_turns=20, settle_turns=60), ContactLaw())
        assert response.symmetry_states.shape == (lobes, 2, len(system.M))
        q, orbit = response.symmetry_states[:, 0], np.abs(response.section_q[-1]).max()
        assert np.abs(q - q[0]).max() < 1e-6 * orbit


def test_a_rub_of_two_equal_lobes_is_alike_after_half_a_turn(small_system, operation):
    system = small_system(speed=500.0)
    response = integrate(system, operation(system, settle_turns=200), ContactLaw(friction=0.1))
    assert response.contact_steps_per_turn.min() > 0
    first, second = response.symmetry_states[:, 0]
    stray = np.abs(response.section_q[-20:] - response.section_q[-1]).max()
    assert np.abs(second - first).max() < 1e-3 * np.abs(first).max() + 2 * stray
    assert np.abs(second[-6:]).max() > 1e-6
    assert second == pytest.approx(response.section_q[-1], abs=1e-3 * np.abs(second).max())
