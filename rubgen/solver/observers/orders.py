"""Compute the amplitudes of taps (true signals) at orders of the rotation in each turn, over its angle."""

from typing import Any

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.solver.observers.observer import Observer
from rubgen.solver.response import ORDERS, WINDOW_TURNS, ChangingSpeed
from rubgen.solver.speed.driver import SpeedDriver
from rubgen.solver.speed.turn import Turn


class WindowOrders(Observer):
    """Computes complex amplitudes of a steady run's taps at its orders, window by window.

    A window's amplitude is the amplitude of the mean of its turns. The first step of a turn is at theta = 0. Turns
    before the first whole window are left out; the last window may be shorter.
    """

    def __init__(self, taps: int, steps: int) -> None:
        self.sum, self.turns = np.zeros((taps, steps)), 0
        angle = 2 * np.pi / steps * np.multiply.outer(np.arange(steps), np.arange(1, ORDERS + 1))
        self.wave = 2 / steps * np.concatenate([np.cos(angle), -np.sin(angle)], axis=1)
        self.windows: list[ComplexArray] = []

    def turn(self, turn: Turn) -> None:
        """Add a turn.

        A turn before the record, without recording, or before the first window is left out. Windows begin at turns 0,
        16, 32, ... of the record.
        """
        if turn.number < 0 or not turn.recording or (self.turns == 0 and turn.number % WINDOW_TURNS):
            return
        self.sum += turn.result.taps
        self.turns += 1
        if self.turns == WINDOW_TURNS:
            self._close()

    def result(self) -> dict[str, Any]:
        """Return the field `window_orders` (windows, taps, 20) of all turns so far."""
        if self.turns:
            self._close()
        windows = np.array(self.windows, dtype=np.complex128).reshape(len(self.windows), len(self.sum), ORDERS)
        return {"window_orders": windows}

    def _close(self) -> None:
        parts = self.sum @ self.wave / self.turns
        self.windows.append(parts[:, :ORDERS] + 1j * parts[:, ORDERS:])
        self.sum[:], self.turns = 0.0, 0


class ChangingOrders(Observer):
    """Computes speed and orders of each turn of a record at a changing speed."""

    def __init__(self, driver: SpeedDriver, record: int) -> None:
        self.driver, self.record = driver, record
        self.orders: list[ComplexArray] = []

    def turn(self, turn: Turn) -> None:
        """Add the orders of a turn of the record."""
        if turn.number >= 0:
            time = np.arange(turn.first_step, turn.end_step + 1) * self.driver.stepper.dt
            self.orders.append(turn_orders(turn.result.taps, self.driver.rotation.angle(time)))

    def result(self) -> dict[str, Any]:
        """Return the field `changing_speed` with the orders of each turn, and an empty field `window_orders`."""
        changing = ChangingSpeed(
            rotation=self.driver.rotation,
            turn_steps=np.array([self.driver.first_step(number) for number in range(self.record + 1)]),
            orders=np.array(self.orders),
        )
        return {
            "changing_speed": changing,
            "window_orders": np.zeros((0, len(self.driver.stepper.result.taps), ORDERS), complex),
        }


def turn_orders(taps: FloatArray, theta: FloatArray) -> ComplexArray:
    """Compute complex amplitudes (taps, 20) at k = 1 .. 20 of `taps` (taps, steps) over the angle of one turn.

    2 / (theta_last - theta_0) sum x exp(-i k theta) dtheta by the trapezoidal rule at the angles `theta` (steps + 1,)
    of the steps, rad. The mean is removed before. The steps are treated as exactly one turn. Each end is off by at most
    half a step, an error of a share 1 / steps.
    """
    weight = np.zeros(taps.shape[1])
    weight += 0.5 * np.diff(theta)
    weight[1:] += 0.5 * np.diff(theta)[:-1]
    weight[0] += 0.5 * (theta[-1] - theta[-2])
    wave = np.exp(-1j * np.multiply.outer(theta[:-1], np.arange(1, ORDERS + 1)))
    return np.asarray(2 / weight.sum() * ((taps - taps.mean(axis=1, keepdims=True)) @ (weight[:, None] * wave)))
