"""A run that never touches, made from one turn: equal to the same run integrated, and never made of another."""

from dataclasses import fields, replace

import numpy as np
import pytest

import rubgen
from rubgen.labels import label
from rubgen.labels.registry import CONTACT, MOTION, ORDERS
from rubgen.scenario import ContactLaw, Liner, make_scenario
from rubgen.solver import integrate as solver
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import CLEARANCE_MARGIN
from rubgen.solver.wants import Wants
from rubgen.taps import DEFAULT_TAPS, TipTiming

FREE = {"clearance": 5e-3, "casing_damping": 0.02, "lateral_damping": 0.1}
CASES = [(None, 0.0), (None, 0.05), ("gravity", 0.0), ("springs", 0.05), ("dampers", 0.0)]


def both(system, operation, **wanted):
    """The same run from one turn and integrated."""
    return (integrate(system, operation, ContactLaw(), Wants(repeats_free_turn=r, **wanted)) for r in (True, False))


@pytest.mark.parametrize(("forces", "uneven"), CASES)
def test_one_turn_makes_the_run(small_system, turning, operation, forces, uneven):
    system = small_system(uneven_blade=uneven, **FREE)
    system = turning(system, forces) if forces else system
    seconds = 120 * 2 * np.pi / system.speed  # reaches back into the closing
    asked = operation(system, record_turns=100, settle_turns=40)
    once, full = both(system, asked, tail_seconds=seconds, companion=True, taps=DEFAULT_TAPS)
    assert full.impulse_per_turn.sum() == 0
    for name, signal in full.taps.items():
        np.testing.assert_allclose(once.taps[name], signal, rtol=0, atol=1e-9 * np.abs(signal).max() + 1e-12)
    for name in ("section_q", "section_v", "orbit", "window_orders", "symmetry_states"):
        expected = getattr(full, name)
        scale = max(np.abs(expected).max(), system.speed * np.abs(full.section_q).max())
        np.testing.assert_allclose(getattr(once, name), expected, rtol=0, atol=1e-9 * scale)
    assert np.array_equal(once.track.step, full.track.step)
    np.testing.assert_allclose(once.track.q, full.track.q, rtol=0, atol=1e-9 * np.abs(full.track.q).max())
    for work in fields(full.energy):
        scale = full.energy.absolute_work + abs(full.energy.end)
        assert getattr(once.energy, work.name) == pytest.approx(getattr(full.energy, work.name), abs=1e-9 * scale)
    found, expected = label(once), label(full)
    for column in (*CONTACT, *MOTION, *ORDERS):
        assert np.array_equal(column.value(found), column.value(expected)), column.name
    assert found.lyapunov.turns == expected.lyapunov.turns
    assert found.lyapunov.per_turn == pytest.approx(expected.lyapunov.per_turn, rel=0.1)


def test_arrivals_are_those_of_the_integrated_run(small_system, operation):
    system = small_system(**FREE)
    once, full = both(system, operation(system, settle_turns=40), taps=(TipTiming(name="probe", angle_deg=30),))
    assert np.array_equal(once.arrivals["probe"].blade, full.arrivals["probe"].blade)
    np.testing.assert_allclose(once.arrivals["probe"].step, full.arrivals["probe"].step, rtol=0, atol=1e-7)


def test_channels_and_labels_of_the_preset_are_the_same_to_the_last_code(monkeypatch):
    scenario = make_scenario("zeng2019", speed_rpm=7000.0, clearance_m=5e-4)
    scenario = replace(scenario, operation=replace(scenario.operation, settle_turns=60, record_turns=200))
    once = rubgen.simulate(scenario)
    monkeypatch.setattr(solver, "never_touches", lambda *_: False)
    full = rubgen.simulate(scenario)
    assert not np.array_equal(once.response.section_q[-1], full.response.section_q[0])  # it was made otherwise
    for name, channel in full.recording.channels.items():
        assert np.array_equal(once.recording.channels[name].values, channel.values), name
    assert once.labels.motion == full.labels.motion
    assert once.labels.lyapunov.turns == full.labels.lyapunov.turns
    assert once.labels.lyapunov.is_negative
    assert full.labels.lyapunov.is_negative


@pytest.mark.parametrize("case", ["film", "liner", "near", "touch"])
def test_all_other_runs_are_integrated(small_system, turning, operation, case, monkeypatch):
    def never(*_, **__):
        raise AssertionError("made from one turn")

    monkeypatch.setattr(solver.RepeatedDriver, "run_turns", never)
    system, law, wants = small_system(**FREE), ContactLaw(), Wants(repeats_free_turn=True)
    short = operation(system, record_turns=5, settle_turns=45)
    with pytest.raises(AssertionError, match="one turn"):
        integrate(system, short, law, wants)
    if case == "film":
        system = turning(system, "film")
    elif case == "liner":
        law = ContactLaw(liner=Liner(thickness_m=1e-4, wear_m2_per_n=4e-10, width_m=0.02))
    else:
        gap = -integrate(system, short, law).free_penetration
        keep = 0.9 * CLEARANCE_MARGIN if case == "near" else -1e-6
        system = small_system(**{**FREE, "clearance": FREE["clearance"] - gap + keep})
    assert integrate(system, short, law, wants).record_turns == 5
