"""Turns whose taps nobody reads make none, and nothing else of a run knows of it."""

import numpy as np

from rubgen.labels import label
from rubgen.labels.to_json import labels_to_json
from rubgen.scenario import ContactLaw
from rubgen.solver.integrate import integrate
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper
from rubgen.solver.wants import Wants
from rubgen.taps import DEFAULT_TAPS, TipTiming

STEPS = 256
TAPS = (*DEFAULT_TAPS, TipTiming(name="probe", angle_deg=40.0, axial_m=1e-3))


def run_turns(system, recording):
    stepper, ends = rub_free_stepper(system, ContactLaw(friction=0.1), STEPS, taps=TAPS), []
    for turn, recorded in enumerate(recording):
        opening = 5e-4 * closing_ramp((turn + np.arange(-1, STEPS + 1) / STEPS) / 6)
        _, _, ended = stepper.run_turn(opening, turn * STEPS, recording=recorded)
        result = stepper.result
        kept = [
            result.section.ravel(),
            result.frames.ravel(),
            result.summary[:3],
            stepper.touches.ended[:ended].ravel(),
        ]
        ends.append(np.concatenate([*kept, stepper.coordinates.now, stepper.state.works]))
    return stepper, np.concatenate(ends)


def test_a_turn_without_taps_moves_alike(small_system):
    system = small_system(speed=500.0)
    every, recorded = run_turns(system, [True] * 12)
    last, unrecorded = run_turns(system, [False] * 11 + [True])
    assert every.result.summary[1] > 10
    np.testing.assert_array_equal(unrecorded, recorded)
    np.testing.assert_array_equal(last.result.taps, every.result.taps)
    assert every.result.summary[3] == last.result.summary[3] == system.n_blades


def test_a_turn_without_taps_leaves_those_of_the_last_and_no_arrivals(small_system):
    stepper, _ = run_turns(small_system(speed=500.0), [True] * 12)
    taps = stepper.result.taps.copy()
    stepper.run_turn(recording=False)
    np.testing.assert_array_equal(stepper.result.taps, taps)
    assert stepper.result.summary[3] == 0


def test_a_longer_tail_is_the_same_run(small_system, operation):
    system = small_system(speed=500.0)
    long = operation(system, record_turns=150, settle_turns=60)
    turn = 2 * np.pi / system.speed
    short, longer, whole = (
        integrate(system, long, ContactLaw(friction=0.1), Wants(tail_seconds=turns * turn, taps=TAPS))
        for turns in (0.0, 130.5, 1e3)
    )
    assert short.impulse_per_turn.min() > 0
    assert [response.taps["contact_force"].size // STEPS for response in (short, longer, whole)] == [100, 131, 210]
    for other in (longer, whole):
        np.testing.assert_array_equal(other.section_q, short.section_q)
        assert other.energy == short.energy
        assert len(short.orbit) == 100
        np.testing.assert_array_equal(other.orbit, short.orbit)
        for name, tap in short.taps.items():
            np.testing.assert_array_equal(other.taps[name][-tap.size :], tap)
        windows = short.window_orders
        assert len(other.window_orders) > len(windows) == 6
        np.testing.assert_array_equal(other.window_orders[-len(windows) :], windows)
        assert labels_to_json(label(other)) == labels_to_json(label(short))
        arrivals, before = other.arrivals["probe"], short.arrivals["probe"]
        assert arrivals.step.size > before.step.size > 99 * system.n_blades
        np.testing.assert_array_equal(arrivals.step[-before.step.size :], before.step)
