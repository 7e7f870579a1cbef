"""A rigid rotor in a squeeze film damper.

Coefficients: the pressure of a short bearing with a full film, p = 6 mu (z^2 - L^2 / 4) h' / h^3, is integrated by
quadrature. Orbit: around the centre of even springs the rotor moves on a circle. At its eccentricity spring,
inertia and C_tt balance the unbalance, which is an equation for one number. The film turns C_tt (e Omega)^2 into
heat. Free whirl about the centre decays with the film's C_0 added to the damper. Free whirl about the orbit decays
with the eigenvalues of its two equations, which were differentiated by hand in polar coordinates. The rotor is the
rotor of the uneven supports.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.machine import SqueezeFilm
from rubgen.reduction import SpinningSystem, TurningForces, reduce
from rubgen.scenario import ContactLaw, Operation, Reduction
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import eigenvalues
from rubgen.solver.supports.turning_forces import turning_force
from rubgen.units import rev_per_min
from validation.verification.rotors.rigid_rotor import rigid_rotor
from validation.verification.rotors.rotors import NO_DAMPING, STIFF, UNBALANCE, annulus_inertia, plain_rotor
from validation.verification.row import Row, relative

TITLE = "Squeeze film damper"
REST, RATIO, THICKNESS = 200.0, 0.02, 0.1
MASS = annulus_inertia(plain_rotor(THICKNESS).disk)[0]
FILM = SqueezeFilm(radius_m=0.06, length_m=0.016, clearance_m=6e-5, viscosity_pa_s=1e-3)
SPEEDS = (0.8, 1.0, 1.3)
ECCENTRICITIES = (0.0, 0.3, 0.6, 0.9)
STIFFNESS, DAMPING = MASS * REST**2, 2 * RATIO * MASS * REST


def rotor(speed: float, unbalance: float = UNBALANCE) -> SpinningSystem:
    """The rotor at `speed` in rad/s on even springs with the film beside them."""
    support = replace(STIFF, lateral_stiffness_n_per_m=STIFFNESS, squeeze_film=FILM)
    machine = plain_rotor(THICKNESS, support, replace(NO_DAMPING, lateral=RATIO))
    return reduce(replace(machine, unbalance_kg_m=unbalance), Reduction()).at_speed(speed)


def by_quadrature(share: float, *, along: bool) -> float:
    """C_rr or C_tt in N s/m at the eccentricity ratio `share`: mu R L^3 times the integral of cos^2 or sin^2 / h^3."""
    shape = np.cos if along else np.sin

    def pressure(phi: float) -> float:
        return float(shape(phi) ** 2 / (FILM.clearance_m * (1 - share * np.cos(phi))) ** 3)

    integral = quad(pressure, 0, 2 * np.pi, epsrel=1e-12)[0]
    return FILM.viscosity_pa_s * FILM.radius_m * FILM.length_m**3 * float(integral)


def tangential(e: float) -> float:
    """C_tt in N s/m at the eccentricity e, and the dampers beside the spring."""
    return float(DAMPING + FILM.centred_damping_n_s_per_m / (1 - (e / FILM.clearance_m) ** 2) ** 1.5)


def orbit(speed: float) -> float:
    """Eccentricity in m of the circle: |k - m Omega^2 + i C_tt Omega| e = U Omega^2."""

    def balance(e: float) -> float:
        return abs(complex(STIFFNESS - MASS * speed**2, tangential(e) * speed)) * e - UNBALANCE * speed**2

    return float(brentq(balance, 0.0, 0.999 * FILM.clearance_m, xtol=1e-16))


def orbit_eigenvalues(speed: float) -> ComplexArray:
    """Eigenvalues about the orbit, in the turning frame: x along the eccentricity e, y across.

    The film gives -C_rr x' + C_tt Omega y along and -C_tt y' - (C_tt + e dC_tt/de) Omega x across.
    """
    e = orbit(speed)
    share = e / FILM.clearance_m
    radial = DAMPING + FILM.centred_damping_n_s_per_m * (1 + 2 * share**2) / (1 - share**2) ** 2.5
    across = tangential(e)
    slope = 3 * FILM.centred_damping_n_s_per_m * share / FILM.clearance_m / (1 - share**2) ** 2.5
    stiff = STIFFNESS - MASS * speed**2
    C = np.array([[radial, -2 * MASS * speed], [2 * MASS * speed, across]])
    K = np.array([[stiff, -across * speed], [(across + e * slope) * speed, stiff]])
    first_order: FloatArray = np.block([[np.zeros((2, 2)), np.eye(2)], [-K / MASS, -C / MASS]])
    return np.linalg.eigvals(first_order).astype(np.complex128)


def rows() -> Iterator[Row]:
    """Coefficients, orbits, heat, decay."""
    for share in ECCENTRICITIES:
        for name, direction in (("C_rr", np.array([1.0, 0.0])), ("C_tt", np.array([0.0, 1.0]))):
            u = np.array([share * FILM.clearance_m, 0.0])
            found = -turning_force(TurningForces(laws=(FILM,)), 0.0, np.zeros(()), u, direction) @ direction
            expected = by_quadrature(share, along=name == "C_rr")
            quantity = f"squeeze film: {name} at eccentricity {share:g}, N s/m"
            yield relative(quantity, "quadrature of the short bearing's pressure", expected, found, 1e-9)
    for ratio in SPEEDS:
        speed = ratio * REST
        system = rotor(speed)
        centre = rub_free_motion(system).at(0.0)[system.centre : system.centre + 2]
        quantity, source = f"squeeze film at {ratio:g} omega_0", "|k - m Omega^2 + i C_tt Omega| e = U Omega^2"
        yield relative(f"{quantity}: eccentricity of the orbit, m", source, orbit(speed), np.hypot(*centre), 2e-4)
        expected_values, found_values = orbit_eigenvalues(speed), eigenvalues(system)
        expected = expected_values[np.argmax(expected_values.real)]
        nearest = found_values[np.argmin(np.abs(found_values - expected))]
        quantity, source = f"{quantity}: slowest motion about the orbit", "the two equations, differentiated by hand"
        yield relative(f"{quantity}, decay rate, 1/s", source, expected.real, nearest.real, 5e-4)
    yield from heat()
    yield from centred_decay()


def heat() -> Iterator[Row]:
    """Loss of a run that circles."""
    speed, turns = REST, 20
    rpm, half = rev_per_min(speed), turns // 2
    operation = Operation(speed_rpm=rpm, settle_turns=half, record_turns=half, closing_turns=5)
    system = rigid_rotor(
        speed, mass=MASS, stiffness=STIFFNESS, damping=DAMPING, unbalance=UNBALANCE, forces=TurningForces(laws=(FILM,))
    )
    response = integrate(system, operation, ContactLaw())
    e = orbit(speed)
    expected = -(tangential(e) - DAMPING) * (e * speed) ** 2 * 2 * np.pi / speed
    quantity, source = "squeeze film: heat of a turn, J", "C_tt (e Omega)^2 T"
    yield relative(quantity, source, expected, response.energy.support_laws_loss / turns, 1e-5)


def centred_decay() -> Iterator[Row]:
    """Decay of lateral whirl about the centre, without unbalance."""
    speed = 0.5 * REST
    decay = (DAMPING + FILM.centred_damping_n_s_per_m) / (2 * MASS)
    forward = complex(-decay, np.sqrt(REST**2 - decay**2) - speed)
    values = eigenvalues(rotor(speed, unbalance=0.0))
    found = values[np.argmin(np.abs(values - forward))]
    yield relative("squeeze film: decay rate about the centre, 1/s", "(c + C_0) / 2 m", -decay, found.real, 1e-4)
