"""What observers make of made turns: touches, passages under probes, orders of windows."""

import numpy as np
import pytest

from rubgen.solver.observers.orbit import Orbit
from rubgen.solver.observers.orders import WindowOrders, turn_orders
from rubgen.solver.observers.sections import Sections
from rubgen.solver.observers.tail import Tail, tip_arrivals
from rubgen.solver.observers.touches import contact_events
from rubgen.solver.response import ORDERS, WINDOW_TURNS
from rubgen.solver.scheme.turn_kernels import TurnResult
from rubgen.solver.speed.turn import Turn, TurnFrames
from rubgen.taps import CentreDisplacement, TipTiming

STEPS = 64
ANGLE = 2 * np.pi * np.arange(STEPS) / STEPS


def made_turn(number, taps, *, recording=True):
    """A turn of taps (taps, STEPS); its section, impulse, contact steps and orbit sums tell its number."""
    result = TurnResult(
        taps=taps, section=np.full((2, 3), [[number], [10.0 * number]]),
        summary=np.array([number / 2, number, 0.0, 0.0]), orbit=np.full(5, float(STEPS * number)),
        frames=np.zeros((0, 0)),
    )  # fmt: skip
    return Turn(
        number=number, code=0, step=STEPS, first_step=number * STEPS, end_step=(number + 1) * STEPS,
        recording=recording, result=result, touches=[], arrivals=np.array([[0.0, 1.0, number, 0.0]]),
        opening=np.zeros(STEPS + 2), frames=TurnFrames(np.zeros(0, int), np.zeros((0, 0))), tip_growth=np.zeros((1, 3)),
    )  # fmt: skip


def test_touches_stand_in_order_of_their_last_step_then_of_their_blade():
    """Columns: blade, start, steps, impulse times cos psi and sin psi, impulse, friction and normal loss."""
    rows = np.array(
        [
            [3, 0, 50, -0.2, 0.0, 0.4, -1.0, -2.0],
            [1, 20, 5, 0.3, -1e-18, 0.3, -3.0, -4.0],
            [0, 45, 5, 0.0, -0.1, 0.2, -5.0, -6.0],
        ]
    )
    events = contact_events([rows[:2], rows[2:]])
    assert events.blade.tolist() == [1, 0, 3]
    assert events.start_step.tolist() == [20, 45, 0]
    assert events.steps.tolist() == [5, 5, 50]
    np.testing.assert_allclose(events.angle, [0.0, 1.5 * np.pi, np.pi])
    assert events.impulse.tolist() == [0.3, 0.2, 0.4]
    assert events.friction_loss.tolist() == [-3.0, -5.0, -1.0]
    assert events.normal_loss.tolist() == [-4.0, -6.0, -2.0]
    assert contact_events([]).blade.size == 0


def test_passages_are_told_apart_by_probe_and_stand_in_order_of_time():
    turns = [np.array([[1, 4, 7.5, 0.1], [0, 2, 3.25, 0.2]]), np.array([[1, 5, 6.5, 0.3], [1, 3, 9.0, 0.4]])]
    seen = tip_arrivals(turns, ["a", "b"])
    assert seen["a"].blade.tolist() == [2]
    assert seen["b"].blade.tolist() == [5, 4, 3]
    assert seen["b"].step.tolist() == [6.5, 7.5, 9.0]
    assert seen["b"].displacement.tolist() == [0.3, 0.1, 0.4]


@pytest.mark.parametrize("first", [0, 5, WINDOW_TURNS])
def test_window_orders_are_the_mean_amplitudes_of_whole_windows_and_of_the_rest(first):
    """A cos(3 theta + phase) whose A and phase change from turn to turn; turns before a window do not count."""
    last, rng = 2 * WINDOW_TURNS + 4, np.random.default_rng(1)
    observer, amplitude = WindowOrders(2, STEPS), rng.normal(size=(last, 2)) @ [1, 1j]
    for number in range(first, last):
        wave = (amplitude[number] * np.exp(3j * ANGLE)).real
        observer.turn(made_turn(number, np.stack([wave, 2 * wave + 7.0])))
    windows = observer.result()["window_orders"]
    starts = range(-(-first // WINDOW_TURNS) * WINDOW_TURNS, last, WINDOW_TURNS)
    expected = np.array([amplitude[start : start + WINDOW_TURNS].mean() for start in starts])
    assert windows.shape == (len(expected), 2, ORDERS)
    np.testing.assert_allclose(windows[:, 0, 2], expected, atol=1e-12)
    np.testing.assert_allclose(windows[:, 1, 2], 2 * expected, atol=1e-12)
    assert np.abs(np.delete(windows, 2, axis=2)).max() < 1e-12


def test_window_orders_leave_out_the_settling_and_turns_without_taps():
    observer, wave = WindowOrders(1, STEPS), np.cos(ANGLE)[None]
    observer.turn(made_turn(-1, wave))
    observer.turn(made_turn(0, wave, recording=False))
    assert observer.result()["window_orders"].shape == (0, 1, ORDERS)


def test_orders_of_a_turn_at_a_steady_speed_are_those_of_its_fourier_series():
    taps = np.stack([3 * np.cos(2 * ANGLE + 0.4) + 5.0, np.sin(7 * ANGLE)])
    orders = turn_orders(taps, np.append(ANGLE, 2 * np.pi))
    expected = np.zeros((2, ORDERS), complex)
    expected[0, 1], expected[1, 6] = 3 * np.exp(0.4j), -1j
    np.testing.assert_allclose(orders, expected, atol=1e-13)


def test_sections_orbit_and_tail_keep_the_turns_that_are_asked_of_them():
    tap, probe = CentreDisplacement(name="x", angle_deg=0), TipTiming(name="p", angle_deg=0)
    sections, orbit, tail = Sections(4, 3), Orbit(2), Tail((tap, probe), 3)
    for number in range(-2, 4):
        turn = made_turn(number, np.full((1, STEPS), float(number)), recording=number != 2)
        for observer in (sections, orbit, tail):
            observer.turn(turn)
        turn.result.section[:] = turn.result.taps[:] = np.nan  # the next turn writes over them
    found = sections.result() | orbit.result() | tail.result()
    np.testing.assert_array_equal(found["section_q"], np.repeat([[0.0], [1.0], [2.0], [3.0]], 3, axis=1))
    np.testing.assert_array_equal(found["section_v"], 10 * found["section_q"])
    assert found["impulse_per_turn"].tolist() == [0.0, 0.5, 1.0, 1.5]
    assert found["contact_steps_per_turn"].tolist() == [0, 1, 2, 3]
    assert found["orbit"].tolist() == [[1.0] * 5, [3.0] * 5]
    np.testing.assert_array_equal(found["taps"]["x"], np.repeat([0.0, 1.0, 3.0], STEPS))
    assert found["arrivals"]["p"].step.tolist() == [0.0, 1.0, 3.0]


def test_an_orbit_of_all_turns_is_kept_where_no_number_is_given():
    orbit = Orbit(None)
    for number in range(5):
        orbit.turn(made_turn(number, np.zeros((1, STEPS))))
    assert orbit.result()["orbit"][:, 0].tolist() == [0, 1, 2, 3, 4]
