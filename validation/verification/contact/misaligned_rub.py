"""A Jeffcott rotor that rubs on part of a misaligned ring, against another integration.

The rotor and the ring of the annular rub have less unbalance and a side force on the ring. From rest, the rotor's
whirl grows until it hits the ring. It settles to one touch a turn, a quarter or two fifths of a turn long. The
other method is scipy's LSODA on the equations in inertial axes with a stiff damped penalty: 1e11 N/m and five times
critical damping, which is a plastic impact in the limit. With 1e12 N/m its impulse changes by 5e-5. The solver's
scheme is of first order in dt, so 2,048 and 4,096 steps a turn are extrapolated to dt = 0.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.integrate import solve_ivp

from rubgen.arrays import FloatArray
from rubgen.scenario import ContactLaw
from rubgen.solver.speed.start import rub_free_stepper
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
    jeffcott_system,
    penalty_contact,
)
from validation.verification.row import Row, relative, within

TITLE = "Rub on part of a misaligned ring"
CASES = {"light": (1.5e-3, 2000.0), "heavy": (1.8e-3, 3000.0)}
TURNS, STEPS, EARLY = 30, 2048, 3
RETURN = 0.01
"""A point of the section has come back when it is nearer than this share of its size: as clusters in the labels."""


def by_scheme(unbalance: float, side_force: float, steps: int) -> FloatArray:
    """Impulse, rotor x and y, ring x and y at the end of each turn (turns, 5), from the solver."""
    system = jeffcott_system(unbalance, side_force)
    stepper = rub_free_stepper(system, ContactLaw(friction=FRICTION), steps, screen=False)
    acceleration = np.linalg.solve(system.M, system.force)
    stepper.set_coordinates(acceleration * stepper.dt**2 / 2, np.zeros(len(system.M)))
    turns = []
    for _ in range(TURNS):
        stepper.run_turn()
        rotor, ring = stepper.coordinates.now[:2], stepper.coordinates.now[-2:] / STATOR_MASS**0.5
        turns.append(np.concatenate([stepper.result.summary[:1], rotor, ring]))
    return np.array(turns)


def by_penalty(unbalance: float, side_force: float) -> FloatArray:
    """The same (turns, 5) by LSODA with a stiff penalty."""
    contact = penalty_contact(ROTOR_MASS, CLEARANCE)

    def slope(t: float, y: FloatArray) -> FloatArray:
        z, v, ring, ring_v = y[0] + 1j * y[1], y[2] + 1j * y[3], y[4] + 1j * y[5], y[6] + 1j * y[7]
        normal, force = contact(complex(z - ring), complex(v - ring_v))
        push = unbalance * SPEED**2 * np.exp(1j * SPEED * t)
        a = (push - force - ROTOR_STIFFNESS * z - ROTOR_DAMPING * v) / ROTOR_MASS
        ring_a = (side_force + force - STATOR_STIFFNESS * ring - STATOR_DAMPING * ring_v) / STATOR_MASS
        return np.array([v.real, v.imag, a.real, a.imag, ring_v.real, ring_v.imag, ring_a.real, ring_a.imag, normal])

    times = 2 * np.pi / SPEED * np.arange(TURNS + 1)
    y = solve_ivp(slope, (0, times[-1]), np.zeros(9), "LSODA", times, rtol=1e-9, atol=1e-13, max_step=times[1] / 200).y
    return np.vstack([np.diff(y[8]), y[[0, 1, 4, 5], 1:]]).T


def repeats_after(turns: FloatArray) -> int:
    """Turns after which rotor and ring at the end of a run come back: its class, period-k; 0 where they do not."""
    places = turns[:, 1:]
    size = np.abs(places[-1]).max()
    back = (np.abs(places[-1] - places[-1 - k]).max() <= RETURN * size for k in range(1, 9))
    return next((k for k, returned in enumerate(back, start=1) if returned), 0)


def rows() -> Iterator[Row]:
    """Impulse a turn, where rotor and ring are early and in the end, and the class of motion."""
    source = "scipy LSODA with a stiff penalty"
    for name, (unbalance, side_force) in CASES.items():
        expected = by_penalty(unbalance, side_force)
        coarse, fine = (by_scheme(unbalance, side_force, steps) for steps in (STEPS, 2 * STEPS))
        found = 2 * fine - coarse
        quantity = f"misaligned ring, {name} rub"
        yield relative(f"{quantity}: impulse a turn, N s", source, expected[-1, 0], found[-1, 0], 2e-4)
        classes = repeats_after(expected), repeats_after(found)
        yield within(f"{quantity}: turns after which it repeats", source, *classes, 0)
        for turn in (EARLY, TURNS):
            for part, column in (("rotor", 1), ("ring", 3)):
                for axis, offset in (("X", 0), ("Y", 1)):
                    exact, ours = expected[turn - 1, column + offset], found[turn - 1, column + offset]
                    yield within(f"{quantity}: {part} {axis} after {turn} turns, m", source, exact, ours, 1e-8)
