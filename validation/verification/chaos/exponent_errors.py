"""Stated errors of Lyapunov exponents, against what the exponents of many records of 500 turns really are off by.

Each growth comes from the variational equation, without a companion trajectory. The exponent is zero on the tori of
forced van der Pol oscillators, x'' - mu (1 - x^2) x' + x = F cos(w t). There the label must not call any exponent
positive or negative. Oscillators that lock to the force (as longer records show) are left out. In chaos, the
scatter of the exponents divided by the stated error (both rms over the records) must lie in 0.7 to 1. It may be
below 1 because the error is the largest of three estimates.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.solver.exponent import Exponent, lyapunov
from validation.verification.row import Row, within

TITLE = "Errors of Lyapunov exponents"
TURNS = 500
SETTLING, LONG_RECORD, STEPS = 200, 2000, 60
OSCILLATORS, RECORDS = 100, 300
LOCKED = 1e-3
"""A mean growth beyond this over the long record, by the period: not a torus."""
LOGISTIC, HENON = 3.9, (1.4, 0.3)


def van_der_pol_growths(damping: FloatArray, force: FloatArray, frequency: FloatArray) -> FloatArray:
    """Growths a period (LONG_RECORD, n) of small differences beside n oscillators, Runge-Kutta of order four."""
    state = np.array([0.5, 0.1, 1.0, 0.3])[:, None] * np.ones_like(damping)
    dt = 2 * np.pi / frequency / STEPS

    def rates(phase: float, y: FloatArray) -> FloatArray:
        x, v, dx, dv = y
        free = 1 - x * x
        push = damping * free * v - x + force * np.cos(2 * np.pi * phase)
        return np.stack([v, push, dv, damping * free * dv - (2 * damping * x * v + 1) * dx])

    growth = np.zeros((SETTLING + LONG_RECORD, damping.size))
    for period in range(len(growth)):
        for step in range(STEPS):
            phases = (step / STEPS, (step + 0.5) / STEPS, (step + 1) / STEPS)
            a = rates(phases[0], state)
            b = rates(phases[1], state + dt / 2 * a)
            c = rates(phases[1], state + dt / 2 * b)
            d = rates(phases[2], state + dt * c)
            state = state + dt / 6 * (a + 2 * b + 2 * c + d)
        size = np.hypot(state[2], state[3])
        growth[period] = np.log(size)
        state[2:] /= size
    return growth[SETTLING:]


def logistic_growths(rng: np.random.Generator) -> FloatArray:
    """Growths a turn (TURNS, RECORDS) of x -> 3.9 x (1 - x)."""
    x, growth = rng.uniform(0.1, 0.9, RECORDS), np.zeros((TURNS, RECORDS))
    for turn in range(TURNS):
        growth[turn] = np.log(np.abs(LOGISTIC * (1 - 2 * x)))
        x = LOGISTIC * x * (1 - x)
    return growth


def henon_growths(rng: np.random.Generator) -> FloatArray:
    """Growths a turn (TURNS, RECORDS) of Henon's map."""
    a, b = HENON
    (x, y), away = rng.uniform(-0.1, 0.1, (2, RECORDS)), np.array([[1.0], [0.3]]) * np.ones(RECORDS)
    growth = np.zeros((SETTLING + TURNS, RECORDS))
    for turn in range(len(growth)):
        away = np.stack([-2 * a * x * away[0] + away[1], b * away[0]])
        x, y = 1 - a * x**2 + y, b * x
        size = np.hypot(*away)
        growth[turn], away = np.log(size), away / size
    return growth[SETTLING:]


def of_records(growth: FloatArray) -> list[Exponent]:
    """The exponent of each column."""
    return [exponent for record in growth.T if (exponent := lyapunov(record)) is not None]


def rows() -> Iterator[Row]:
    """Tori, then chaos."""
    rng = np.random.default_rng(0)
    damping, force, frequency = (rng.uniform(*ends, OSCILLATORS) for ends in ((0.1, 1.5), (0.05, 0.5), (1.2, 2.3)))
    growth = van_der_pol_growths(damping, force, frequency)
    tori = of_records(growth[:TURNS, np.abs(growth.mean(axis=0)) < LOCKED])
    quantity = f"van der Pol oscillators that have a sign, of {len(tori)} tori"
    yield within(quantity, "zero on a torus", 0.0, sum(each.is_positive or each.is_negative for each in tori), 0.0)
    for name, growth in (("logistic map, r = 3.9", logistic_growths(rng)), ("Henon's map", henon_growths(rng))):
        chaos = of_records(growth)
        error = np.sqrt(np.mean([each.error**2 for each in chaos]))
        share = float(np.std([each.per_turn for each in chaos]) / error)
        yield within(f"{name}: scatter over stated error", f"{RECORDS} records, 0.7 to 1", 0.85, share, 0.15)
