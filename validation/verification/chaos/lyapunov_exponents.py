"""Largest Lyapunov exponents from a companion trajectory, against known exponents.

Every row uses the solver's own kernel (`bring_back`) to set the distance of a companion trajectory back, and the
labels' own function to compute the exponent. Runs of maps and of the Lorenz system are so long that their scatter
is below the tolerance. The Jeffcott rotor runs through the solver with its contact. The exponent of full annular
rub is the largest real part of the eigenvalues of the motion that stays in contact, a quadratic eigenvalue problem.
1,024 and 2,048 steps a turn are extrapolated to dt = 0.

The impact oscillator uses the solver's scheme. The place of an impact between two steps changes its map by the
first power of dt, and within one step the map of the scheme contracts by sqrt(r), not by r. For r > 0, an exponent
of the continuous system therefore needs an initial distance of the companion trajectory that is larger than the
motion of the mass in a step. Contact without restitution, the default, does not need this: two steps of a touch
contract the distance to zero, which is right.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import scipy.linalg as la

from rubgen.arrays import FloatArray
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.exponent import Exponent, lyapunov
from rubgen.solver.integrate import integrate
from rubgen.solver.observers.companion_kernels import bring_back
from rubgen.solver.wants import Wants
from rubgen.units import rev_per_min
from validation.verification.chaos.flow_kernels import lorenz_steps
from validation.verification.contact.impact_oscillator import REGULAR, RESTITUTION, free_flight, orbit_in_closed_form
from validation.verification.contact.wall import Wall
from validation.verification.rotors.jeffcott import (
    CLEARANCE,
    FRICTION,
    ROTOR_DAMPING,
    ROTOR_MASS,
    ROTOR_STIFFNESS,
    SPEED,
    STATOR_DAMPING,
    STATOR_MASS,
    STATOR_STIFFNESS,
    annular_rub,
    jeffcott_system,
)
from validation.verification.row import Row, relative, within

TITLE = "Largest Lyapunov exponents"
CLOSE = 1e-9
STEPS, RECORD = 1024, 200
PERIOD_STEPS, PERIODS, APART = 10000.3, 2000, 1e-2


def companion_exponent(advance: Callable[[FloatArray], None], start: FloatArray, times: int, close: float) -> Exponent:
    """The exponent for one `advance` of a state (n,) in place, renormalised after each."""
    state = start.copy()
    companion = state + close * np.cos(1.0 + np.arange(len(state)))
    growth = np.zeros(times)
    for i in range(times):
        advance(state)
        advance(companion)
        size = float(np.linalg.norm(companion - state))
        growth[i] = np.log(size / close)
        bring_back(state, close / size, companion)
    exponent = lyapunov(growth)
    if exponent is None:
        raise ArithmeticError("the companion could not follow")
    return exponent


def logistic(r: float) -> Callable[[FloatArray], None]:
    """X -> r x (1 - x)."""

    def advance(x: FloatArray) -> None:
        x[0] = r * x[0] * (1 - x[0])

    return advance


def henon(state: FloatArray) -> None:
    """Henon's map with a = 1.4, b = 0.3."""
    state[0], state[1] = 1 - 1.4 * state[0] ** 2 + state[1], 0.3 * state[0]


def impact_exponent() -> Exponent:
    """The exponent of the oscillator's orbit with one impact a period, by the period."""
    dt = 2 * np.pi / REGULAR / PERIOD_STEPS
    start = orbit_in_closed_form(REGULAR)[0] + np.pi
    x = free_flight(REGULAR, np.pi / REGULAR + dt * np.array([-1.0, 0.0]))
    main, companion = (Wall(np.eye(1), np.eye(1), dt, RESTITUTION) for _ in range(2))
    for wall, away in ((main, 0.0), (companion, APART)):
        wall.before[0], wall.now[0] = x + away
    growth, done = np.zeros(PERIODS), 0
    for period in range(PERIODS):
        end = round((period + 1) * PERIOD_STEPS)
        force = np.cos(start + REGULAR * dt * np.arange(done, end))
        main.run(force)
        companion.run(force)
        states = np.array([[w.now[0], (w.now[0] - w.before[0]) / dt] for w in (main, companion)])
        size = float(np.linalg.norm(states[1] - states[0]))
        growth[period], done = np.log(size / APART), end
        bring_back(main.now, APART / size, companion.now)
        bring_back(main.before, APART / size, companion.before)
    exponent = lyapunov(growth)
    if exponent is None:
        raise ArithmeticError("the companion could not follow")
    return exponent


def rub_eigenvalue() -> float:
    """Largest real part, 1/s, of the eigenvalues of synchronous full annular rub that stays in contact.

    With L = m (s + i Omega)^2 + c (s + i Omega) + k of rotor and stator, w the stator's displacement and psi the turn
    of the line of centres, both from the rub in closed form, in axes along and across that line,
    L_s w = (1 + i mu)(nu + i N psi),  L_r (w + i c psi) = -(1 + i mu)(nu + i N psi).
    """
    force = annular_rub().force
    M, C, K = np.zeros((3, 4, 4))
    parts = ((STATOR_MASS, STATOR_DAMPING, STATOR_STIFFNESS), (ROTOR_MASS, ROTOR_DAMPING, ROTOR_STIFFNESS))
    place = np.array([[1.0, 0, 0], [0, 1.0, CLEARANCE]])
    for (mass, damping, stiffness), rows, shape in zip(
        parts, (slice(0, 2), slice(2, 4)), (place * [1, 1, 0], place), strict=True
    ):
        whirl = np.array([[0.0, -1.0], [1.0, 0.0]])
        M[rows, :3] = mass * shape
        C[rows, :3] = (damping * np.eye(2) + 2 * SPEED * mass * whirl) @ shape
        K[rows, :3] = ((stiffness - mass * SPEED**2) * np.eye(2) + damping * SPEED * whirl) @ shape
    # (1 + i mu)(nu + i N psi), real and imaginary part, on the stator; the opposite on the rotor.
    for row, sign in ((0, 1), (2, -1)):
        K[row : row + 2, 2] -= sign * force * np.array([-FRICTION, 1.0])
        K[row : row + 2, 3] -= sign * np.array([1.0, FRICTION])
    zero, one = np.zeros((4, 4)), np.eye(4)
    values = la.eigvals(np.block([[zero, one], [-K, -C]]), np.block([[one, zero], [zero, M]]))
    finite = values[np.isfinite(values) & (np.abs(values) < 1e3 * SPEED)]
    return float(finite.real.max())


def rub_exponent(steps: int) -> float:
    """The solver's exponent of the rub, 1/turn; what takes no part is damped away faster than the rub."""
    system = jeffcott_system()
    C = system.C.copy()
    idle = np.arange(2, 5)
    C[idle, idle] = 1500.0
    operation = Operation(speed_rpm=rev_per_min(SPEED), steps_per_turn=steps, settle_turns=150, record_turns=RECORD)
    response = integrate(replace(system, C=C), operation, ContactLaw(friction=FRICTION), Wants(companion=True))
    exponent = lyapunov(response.companion_growth)
    return exponent.per_turn if exponent else np.nan


def rows() -> Iterator[Row]:
    """Maps, a flow, an impact oscillator, a rotor that rubs."""
    found = companion_exponent(logistic(4.0), np.array([0.3]), 20000, CLOSE)
    yield within("Lyapunov exponent of the logistic map, r = 4", "ln 2", np.log(2), found.per_turn, 0.005)
    found = companion_exponent(logistic(3.2), np.array([0.3]), 2000, CLOSE)
    expected = np.log(abs(4 + 2 * 3.2 - 3.2**2)) / 2
    yield within("Lyapunov exponent of period 2, r = 3.2", "ln|4 + 2r - r^2| / 2", expected, found.per_turn, 1e-3)
    found = companion_exponent(henon, np.array([0.1, 0.1]), 20000, CLOSE)
    yield within("Lyapunov exponent of Henon's map", "Sprott 2003: 0.41922", 0.41922, found.per_turn, 0.004)
    state = np.array([1.0, 1.0, 20.0])
    lorenz_steps(state, 0.005, 20000)
    found = companion_exponent(lambda x: lorenz_steps(x, 0.005, 20), state, 60000, CLOSE)
    quantity, source = "Lyapunov exponent of the Lorenz system", "Sprott 2003: 0.90563"
    yield within(quantity, source, 0.90563, found.per_turn / 0.1, 0.006)
    found = impact_exponent()
    yield relative("Lyapunov exponent of the impact oscillator, an impact", "ln r", np.log(0.8), found.per_turn, 0.01)
    found_rub = 2 * rub_exponent(2 * STEPS) - rub_exponent(STEPS)
    quantity, source = "Lyapunov exponent of a Jeffcott rub, 1/turn", "eigenvalue in contact"
    yield relative(quantity, source, rub_eigenvalue() * 2 * np.pi / SPEED, found_rub, 0.01)
