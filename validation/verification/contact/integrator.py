"""The integrator without contact.

Central differences are of second order. The free motion of the Jeffcott rotor of the annular rub, gyroscopic and
damped, is compared with the matrix exponential. Single modes of the preset at 8,000 rev/min are released with 2,048
steps a turn. The factor by which such a mode changes from turn to turn is compared with exp(s T) of the linear
eigenvalue s. The error of the scheme at a frequency w is (w dt)^2 / 24. The spin raises w to at most |s| + Omega.
The tolerance of decay rate and frequency is twice this error.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.linalg as la

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.machine import load_machine
from rubgen.reduction import SpinningSystem, reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.linear.rub_free import steady_state
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.units import rad_per_s
from validation.verification.rotors.jeffcott import jeffcott_system
from validation.verification.row import Row, within

TITLE = "Integration without contact"
SPEED_RPM, STEPS, TURNS = 8000.0, 2048, 12
OPEN = 1e-2


def first_order_form(system: SpinningSystem) -> FloatArray:
    """The matrix of (q, q')' = A (q, q')."""
    n = len(system.M)
    accelerations = -la.solve(system.M, np.hstack([system.K, system.C]))
    return np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), accelerations])


def free_motion_error(steps: int) -> float:
    """Error after one turn of a free motion, over its size, against the matrix exponential."""
    system = jeffcott_system()
    stepper, A, n = rub_free_stepper(system, ContactLaw(), steps), first_order_form(system), len(system.M)
    rng = np.random.default_rng(3)
    start = np.concatenate([1e-5 * rng.normal(size=n), 1e-2 * rng.normal(size=n)])
    rest = steady_state(system)
    stepper.set_coordinates(rest + (la.expm(-A * stepper.dt) @ start)[:n], rest + start[:n])
    stepper.run_turn(np.full(steps + 2, OPEN))
    exact = (la.expm(A * stepper.dt * steps) @ start)[:n]
    return float(np.abs(stepper.coordinates.now - rest - exact).max() / np.abs(exact).max())


def modes_at_speed(system: SpinningSystem) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues with positive frequency (n,) and their vectors (n, n) in displacements."""
    values, vectors = la.eig(first_order_form(system))
    kept = values.imag > 0
    return values[kept], vectors[: len(system.M), kept]


def turn_multiplier(system: SpinningSystem, value: complex, vector: ComplexArray) -> complex:
    """exp(s T) of a mode that the scheme lets go, from its states at whole turns.

    z_k+2 - 2 Re(m) z_k+1 + |m|^2 z_k = 0 in the least-squares sense (Prony); of the two roots the one nearer to
    the linear one.
    """
    stepper, rest = rub_free_stepper(system, ContactLaw(), STEPS), steady_state(system)
    shape = 1e-5 * vector / np.abs(vector).max()
    before = (shape * np.exp(-value * stepper.dt)).real
    stepper.set_coordinates(rest + before, rest + shape.real)
    states = []
    for _ in range(TURNS):
        states.append(stepper.coordinates.now - rest)
        stepper.run_turn(np.full(STEPS + 2, OPEN))
    z = np.array(states)
    columns = np.column_stack([z[1:-1].ravel(), -z[:-2].ravel()])
    twice_real, square = np.linalg.lstsq(columns, z[2:].ravel())[0]
    roots = np.roots([1, -twice_real, square])
    turn = 2 * np.pi / system.speed
    return complex(roots[np.argmin(np.abs(roots - np.exp(value * turn)))])


def chosen_modes(system: SpinningSystem, values: ComplexArray, vectors: ComplexArray) -> dict[str, int]:
    """Modes by the share of O_d, of the blades' tips or of a casing mode in them."""
    size = np.abs(vectors) ** 2 * np.diag(system.M)[:, None]
    share = size / size.sum(axis=0)
    blades = share[: 3 * system.n_blades].sum(axis=0)
    clear = np.where((blades > 0.999) & (np.abs(values) < 2000), np.abs(values), np.inf)
    return {
        "most lateral mode": int(np.argmax(share[system.centre] + share[system.centre + 1])),
        "slowest mode of the blades alone": int(np.argmin(clear)),
        "first casing mode": int(np.argmax(share[system.casing_start])),
        "last casing mode": int(np.argmax(share[-1])),
    }


def rows() -> Iterator[Row]:
    """Order against the matrix exponential, decay rates and frequencies against eigenvalues."""
    errors = [free_motion_error(steps) for steps in (512, 1024, 2048)]
    order = float(np.log2(errors[1] / errors[2]))
    yield within("integrator: observed order of a free motion", "matrix exponential, order 2", 2.0, order, 0.05)
    system = reduce(load_machine("zeng2019"), Reduction()).at_speed(rad_per_s(SPEED_RPM))
    values, vectors = modes_at_speed(system)
    turn = 2 * np.pi / system.speed
    for name, mode in chosen_modes(system, values, vectors).items():
        value = complex(values[mode])
        error = np.log(turn_multiplier(system, value, vectors[:, mode]) / np.exp(value * turn)) / turn
        quantity, source = f"preset at 8,000 rev/min, {name}", "linear eigenvalue"
        w = abs(value) + system.speed
        slack = w * (w * turn / STEPS) ** 2 / 12
        yield within(f"{quantity}: decay rate, 1/s", source, -value.real, -(value + error).real, slack)
        yield within(f"{quantity}: frequency, rad/s", source, value.imag, (value + error).imag, slack)
