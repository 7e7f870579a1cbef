"""A rigid rotor on supports that differ along X and Y, and its weight.

The machine is the disk of uniform thickness of the rigid rotors, from the keys of a machine file through the
reduction to the harmonic balance. Runs and Floquet exponents use a bare mass, because their steps would otherwise
follow the very light blades. In inertial axes X and Y are two oscillators: m x'' + c_X x' + k_X x = U Omega^2
cos(Omega t), and the same for y with sin and -m g. A forward circle of radius F and a backward circle of radius B
make X = F + B, Y = F - B. In the turning frame F is at rest, B turns twice per revolution, and the sag once.
Between the two critical speeds the backward circle is larger. The mass of the mesh is 1e-5 below the mass of the
annulus, and the disk is not quite rigid. The error of the scheme is (omega dt)^2 / 12 with 1,024 steps a turn: 3e-6
at the frequency of the spin, and about 4e-5 at the frequencies in the turning frame.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from rubgen.reduction import ReducedModel, SpinningSystem, TurningForces, reduce
from rubgen.scenario import ContactLaw, Operation, Reduction
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import eigenvalues
from rubgen.units import rev_per_min
from validation.verification.rotors.rigid_rotor import rigid_rotor, weight_of
from validation.verification.rotors.rotors import NO_DAMPING, STIFF, UNBALANCE, annulus_inertia, plain_rotor
from validation.verification.row import Row, relative, within

TITLE = "Rigid rotor on uneven supports"
REST, ANISOTROPY, RATIO, DAMPING_ANISOTROPY, GRAVITY = 200.0, 0.2, 0.1, 0.3, 9.81
THICKNESS = 0.1
SLOW, BETWEEN, FAST = 0.6, 1.0, 1.5
MASS = annulus_inertia(plain_rotor(THICKNESS).disk)[0]
CRITICAL = {"X": REST * np.sqrt(1 + ANISOTROPY), "Y": REST * np.sqrt(1 - ANISOTROPY)}


def rotor(damping: float = RATIO) -> ReducedModel:
    """The rotor whose mean lateral frequency is REST."""
    support = replace(
        STIFF,
        lateral_stiffness_n_per_m=MASS * REST**2,
        lateral_stiffness_anisotropy=ANISOTROPY,
        lateral_damping_anisotropy=DAMPING_ANISOTROPY if damping else 0.0,
    )
    machine = plain_rotor(THICKNESS, support, replace(NO_DAMPING, lateral=damping))
    return reduce(replace(machine, gravity_m_per_s2=GRAVITY), Reduction())


def bare_mass(speed: float) -> SpinningSystem:
    """The same as a mass with nothing else."""
    k, c = MASS * REST**2, 2 * RATIO * MASS * REST
    forces = TurningForces(stiffness=ANISOTROPY * k, damping=DAMPING_ANISOTROPY * c, weight=weight_of(MASS, GRAVITY))
    return rigid_rotor(speed, mass=MASS, stiffness=k, damping=c, unbalance=UNBALANCE, forces=forces)


def circles(system: SpinningSystem) -> tuple[complex, complex, complex]:
    """Forward and backward circle and the sag, as x + i y in inertial axes at theta = 0, from the harmonic balance."""
    c = system.centre
    harmonics = rub_free_motion(system).harmonics[:, c : c + 2]
    # Of Re(h e^(i m theta)) for x and y, x + i y has the part e^(-i m theta) (h_x* + i h_y*) / 2.
    back = (harmonics.conj() @ np.array([1, 1j])) / 2
    return complex(harmonics[0] @ np.array([1, 1j])), complex(back[2]), complex(back[1])


def oscillator(speed: float, sign: int) -> complex:
    """Response of X (sign 1) or Y (-1) to U Omega^2 e^(i Omega t), in closed form."""
    k = MASS * REST**2 * (1 + sign * ANISOTROPY)
    c = 2 * RATIO * MASS * REST * (1 + sign * DAMPING_ANISOTROPY)
    return UNBALANCE * speed**2 / complex(k - MASS * speed**2, c * speed)


def critical_speed(axis: str) -> float:
    """Speed in rad/s at which the undamped response along an axis changes its sign."""
    sign, model = 1 if axis == "X" else -1, rotor(damping=0.0)

    def inverse(speed: float) -> float:
        forward, backward, _ = circles(model.at_speed(speed))
        return 1 / (forward + sign * backward).real

    return float(brentq(inverse, 0.95 * CRITICAL[axis], 1.05 * CRITICAL[axis], xtol=1e-6))


def rows() -> Iterator[Row]:
    """Split critical speeds, whirl on both sides of and between them, sag, decay rates."""
    for axis, expected in CRITICAL.items():
        quantity = f"uneven supports: critical speed along {axis}, rad/s"
        yield relative(quantity, "sqrt(k / m)", expected, critical_speed(axis), 1e-4)
    source, model = "two oscillators in inertial axes", rotor()
    for ratio in (SLOW, BETWEEN, FAST):
        x, y = oscillator(ratio * REST, 1), oscillator(ratio * REST, -1)
        forward, backward, sag = circles(model.at_speed(ratio * REST))
        # X e^(i Omega t) with its real part along X, Y with its imaginary part along Y.
        for name, exact, found in (("forward", (x + y) / 2, forward), ("backward", (x - y).conjugate() / 2, backward)):
            quantity = f"uneven supports at {ratio:g} omega_0: {name} circle"
            yield relative(f"{quantity}, m", source, abs(exact), abs(found), 2e-4)
            yield within(f"{quantity}, phase, rad", source, np.angle(exact), np.angle(found), 1e-4)
        quantity = f"uneven supports at {ratio:g} omega_0: sag, m, once per turn in the turning frame"
        yield relative(quantity, "g / omega_Y^2", -GRAVITY / CRITICAL["Y"] ** 2, sag.imag, 1e-4)
    yield from sag_of_a_run()
    yield from decay_rates()


def sag_of_a_run() -> Iterator[Row]:
    """Mean places and support forces of a run without rub."""
    speed = SLOW * REST
    operation = Operation(speed_rpm=rev_per_min(speed), settle_turns=10, record_turns=10, closing_turns=5)
    response = integrate(bare_mass(speed), operation, ContactLaw())
    turn = response.steps_per_turn
    sag, bearing = (response.taps[name][-turn:].mean() for name in ("blisk_y", "support_force_y"))
    yield relative("uneven supports: mean sag of a run, m", "g / omega_Y^2", -GRAVITY / CRITICAL["Y"] ** 2, sag, 1e-4)
    yield relative("uneven supports: mean force on the support, N", "the weight", -MASS * GRAVITY, bearing, 1e-4)
    size = np.abs(response.section_q).max()
    drift = np.abs(response.section_q - response.section_q[0]).max() / size
    yield within("uneven supports: drift of a run from its harmonic balance, share", "0", 0.0, float(drift), 1e-10)


def decay_rates() -> Iterator[Row]:
    """Floquet exponents beside c / (2 m); frequencies beside omega_d + Omega modulo the two turns of the supports."""
    speed = FAST * REST
    exponents = eigenvalues(bare_mass(speed))
    for axis, sign in (("X", 1), ("Y", -1)):
        decay = RATIO * REST * (1 + sign * DAMPING_ANISOTROPY)
        frequency = np.sqrt(CRITICAL[axis] ** 2 - decay**2)
        expected = np.array([complex(-decay, side * frequency + speed) for side in (1, -1)])
        period = 2 * speed
        away = (exponents[:, None] - expected).imag
        away -= period * np.round(away / period)
        nearest = np.argmin(np.hypot(away, (exponents[:, None] - expected).real), axis=0)[0]
        quantity = f"uneven supports, whirl along {axis}"
        yield relative(f"{quantity}: decay rate, 1/s", "c / 2 m", -decay, exponents[nearest].real, 2e-4)
        found = expected[0].imag + away[nearest, 0]
        source = "sqrt(k / m - (c / 2 m)^2) + Omega modulo 2 Omega"
        yield relative(f"{quantity}: frequency, rad/s", source, expected[0].imag, found, 2e-4)
