"""Signals that follow the shaft's angle over the measured steps, against their definition step by step."""

import numpy as np
import pytest

from rubgen.machine.faults.fault import Strikes
from rubgen.measurement.strikes import force_of
from rubgen.measurement.tail import BLOCK, Tail

TURN, SPEED = 60, 700.0
DT = 2 * np.pi / SPEED / TURN


def steady(steps, turn=TURN):
    """The step after the last one is at theta = 0."""
    angle = np.mod(2 * np.pi / TURN * np.arange(-steps, 0), 2 * np.pi)
    return Tail(dt=DT, angle=angle, speed=np.full(steps, SPEED), seconds=steps * DT, blades=5, turn=turn)


def running_up(steps):
    """Speed from half of SPEED to SPEED; theta is 0 mod 2 pi at the step after the last one."""
    rate = SPEED / 2 / (steps * DT)
    time = DT * np.arange(-steps, 0)
    turned = SPEED * time + rate * time**2 / 2
    return turned, Tail(dt=DT, angle=np.mod(turned, 2 * np.pi), speed=SPEED + rate * time, seconds=steps * DT, blades=5)


def test_time_and_turned_angle_end_one_step_before_zero():
    tail = steady(150)
    np.testing.assert_allclose(tail.time, DT * np.arange(-150, 0), rtol=1e-14)
    np.testing.assert_allclose(tail.turned, SPEED * tail.time, rtol=1e-12)
    turned, changing = running_up(400)
    np.testing.assert_allclose(changing.turned, turned, atol=1e-9)


@pytest.mark.parametrize("order", [0.0, 1.0, 2.0, 5.0, 36.0, 3.0, 0.37, 2.5])
def test_a_wave_of_any_order_turns_that_many_times_with_the_shaft(order):
    turned, changing = running_up(400)
    for tail, angle in ((steady(150), SPEED * steady(150).time), (changing, turned)):
        wave = tail.wave(order)
        np.testing.assert_allclose(wave, np.exp(1j * order * angle), atol=1e-10)


@pytest.mark.parametrize("steps", [TURN // 2, TURN, TURN + 7, 4 * TURN])
def test_a_signal_of_one_turn_stands_at_every_turn_and_ends_with_the_tail(steps):
    tail = steady(steps)
    assert tail.once.angle.size == min(steps, TURN)
    whole = np.cos(3 * tail.turned + 0.4)
    np.testing.assert_allclose(tail.everywhere(np.cos(3 * tail.once.turned + 0.4)), whole, atol=1e-11)
    unknown = steady(steps, turn=None)
    assert unknown.once is unknown


@pytest.mark.parametrize("steps", [1, BLOCK - 1, BLOCK, 2 * BLOCK + 5])
def test_sinusoids_are_their_sum_step_by_step(steps):
    rng = np.random.default_rng(steps)
    amplitudes, advances = rng.normal(size=(3, 2)) @ [1, 1j], rng.uniform(0, np.pi, 3)
    n = np.arange(-steps, 0)
    expected = sum((a * np.exp(1j * w * n)).real for a, w in zip(amplitudes, advances, strict=True))
    np.testing.assert_allclose(steady(steps).sinusoids(amplitudes, advances), expected, atol=1e-9)
    assert not steady(steps).sinusoids(np.zeros(0, dtype=complex), np.zeros(0)).any()


def test_an_order_is_resolved_by_more_than_two_steps_a_period():
    tail = steady(TURN)
    assert tail.resolved(TURN / 2 - 0.01).all()
    assert not tail.resolved(TURN / 2 + 0.01).any()
    _, changing = running_up(400)
    shown = changing.resolved(TURN / 2 / 0.7501)
    assert shown[0]
    assert not shown[-1]
    np.testing.assert_array_equal(shown, changing.speed < 0.7501 * SPEED)


def test_a_blow_keeps_its_impulse_its_moment_and_its_direction():
    """Between two steps it is shared by them; before the first and from the last step on there is none."""
    turned, changing = running_up(400)
    for place, inside in ((-0.5, False), (0.0, True), (17.25, True), (398.75, True), (399.0, False), (400.5, False)):
        angle = np.interp(place, np.arange(400), turned) if 0 <= place <= 399 else turned[0] - 1 if place < 0 else 1.0
        blow = Strikes(turned=np.array([angle]), impulse_n_s=np.array([3.0]), direction_rad=np.array([2.0]))
        x, y = force_of(blow, turned, changing.dt)
        if not inside:
            assert not x.any()
            assert not y.any()
            continue
        assert changing.dt * x.sum() == pytest.approx(3.0 * np.cos(2.0), rel=1e-12)
        assert changing.dt * y.sum() == pytest.approx(3.0 * np.sin(2.0), rel=1e-12)
        assert (x @ np.arange(400)) / x.sum() == pytest.approx(place, abs=1e-9)
        assert np.count_nonzero(np.abs(x) > 1e-6 * np.abs(x).max()) == (1 if place == 0.0 else 2)


def test_blows_in_one_step_add_up():
    turned, changing = running_up(50)
    middle = (turned[10] + turned[11]) / 2
    blows = Strikes(turned=np.full(3, middle), impulse_n_s=np.array([1.0, 2.0, 4.0]), direction_rad=np.zeros(3))
    x, y = force_of(blows, turned, changing.dt)
    np.testing.assert_allclose(changing.dt * x[10:12], [3.5, 3.5], rtol=1e-9)
    np.testing.assert_allclose(y, 0, atol=1e-9)
