"""Linear faults of a rigid rotor on springs, in closed form.

The machine is the disk of uniform thickness of the rigid rotors, from the keys of a machine file to the harmonic
balance. The mass of the mesh is 1e-5 below the mass of the annulus, and the disk is not quite rigid.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rubgen.machine.faults.bow import Bow
from rubgen.machine.faults.misalignment import Misalignment
from rubgen.reduction import SpinningSystem, reduce
from rubgen.scenario import Reduction
from rubgen.solver.linear.rub_free import rub_free_motion
from validation.verification.rotors.rotors import NO_DAMPING, STIFF, UNBALANCE, annulus_inertia, plain_rotor
from validation.verification.row import Row, relative, within

TITLE = "Linear faults of a rigid rotor"
REST, RATIO, THICKNESS = 200.0, 0.1, 0.1
MASS = annulus_inertia(plain_rotor(THICKNESS).disk)[0]
STIFFNESS, DRAG = MASS * REST**2, 2 * RATIO * MASS * REST
MISALIGNMENT = Misalignment(parallel_m=5e-5, angular_deg=0.1, direction_deg=35.0, coupling_stiffness_n_per_m=3e5)
BOW = 4e-5


def system_with(fault: Misalignment | Bow, speed: float) -> SpinningSystem:
    """The rotor with a fault at a speed in rad/s."""
    support = replace(STIFF, lateral_stiffness_n_per_m=STIFFNESS)
    machine = plain_rotor(THICKNESS, support, replace(NO_DAMPING, lateral=RATIO))
    return reduce(replace(machine, faults=(fault,)), Reduction()).at_speed(speed)


def inertial_order(system: SpinningSystem, order: int, places: int = 64) -> tuple[complex, complex]:
    """Complex amplitudes of X and Y of the disk centre at an order of the inertial frame, from the harmonic balance."""
    motion, c = rub_free_motion(system), system.centre
    theta = 2 * np.pi * np.arange(places) / places
    u = np.array([motion.at(angle)[c : c + 2] for angle in theta]) @ np.array([1, 1j]) * np.exp(1j * theta)
    scale = 1 if order == 0 else 2
    x, y = (scale * np.mean(part * np.exp(-1j * order * theta)) for part in (u.real, u.imag))
    return complex(x), complex(y)


def receptance(speed: float, order: int) -> complex:
    """1 / (k - m w^2 + i c w) at w = order Omega."""
    w = order * speed
    return 1 / complex(STIFFNESS - MASS * w**2, DRAG * w)


def misalignment_rows() -> Iterator[Row]:
    """Orders 0, 2 and 3 of the response, at two speeds: half the critical speed, where 2X resonates, and above."""
    offset = 5e-5 + np.deg2rad(0.1) * 0.1 / 2
    along = 3e5 * offset * cmath.exp(1j * np.deg2rad(35.0))
    for ratio in (0.5, 1.5):
        system = system_with(MISALIGNMENT, ratio * REST)
        for order, share in ((0, 1.0), (2, 0.5), (3, 0.1)):
            x, y = inertial_order(system, order)
            exact = share * receptance(ratio * REST, order)
            quantity = f"misalignment at {ratio:g} omega_0: order {order}"
            source = "k_c (Delta + alpha Z / 2) share / (k - m w^2 + i c w)"
            yield relative(f"{quantity} along X, m", source, abs(exact * along.real), abs(x), 2e-4)
            yield relative(f"{quantity} along Y, m", source, abs(exact * along.imag), abs(y), 2e-4)


def bow_rows() -> Iterator[Row]:
    """Slow roll, the critical speed and above it, with the unbalance at a right angle; and the cancellation."""
    source = "(k b + U Omega^2) / (k - m Omega^2 + i c Omega)"
    for ratio in (0.01, 1.0, 2.0):
        speed = ratio * REST
        x, y = inertial_order(system_with(Bow(bow_m=BOW, angle_deg=90.0), speed), 1)
        exact = (1j * STIFFNESS * BOW + UNBALANCE * speed**2) * receptance(speed, 1)
        found = (x + 1j * y) / 2  # X + i Y = 2 r e^(i theta): a forward circle
        quantity = f"bow and unbalance at {ratio:g} omega_0"
        yield relative(f"{quantity}: radius, m", source, abs(exact), abs(found), 2e-4)
        yield within(f"{quantity}: phase, rad", source, np.angle(exact), np.angle(found), 2e-4)
    opposed = system_with(Bow(bow_m=UNBALANCE / MASS, angle_deg=180.0), REST)
    alone = system_with(Bow(bow_m=0.0), REST)
    share = abs(inertial_order(opposed, 1)[0]) / abs(inertial_order(alone, 1)[0])
    yield within("bow of U / m against the unbalance at omega_0: radius over that without bow", "0", 0.0, share, 1e-3)


def rows() -> Iterator[Row]:
    """Misalignment and bow."""
    yield from misalignment_rows()
    yield from bow_rows()
