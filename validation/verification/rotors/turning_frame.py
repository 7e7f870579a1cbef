"""Uneven supports, a squeeze film and gravity in the turning frame, against an integration in inertial axes.

A disk has lateral supports and carries a mass on an elastic, internally damped link that turns with it. Springs and
dampers of the supports differ along X and Y, and gravity acts. In one case a squeeze film acts on the disk. From
rest the unbalance drives the disk, first without contact, then in rub with the ring of the annular rub, around a
centre that gravity has moved. The other method is scipy's, on the equations in inertial axes, where supports and
weight are constant and the link turns. Without contact it is DOP853. With contact it is LSODA with the stiff
penalty of the misaligned ring, compared after the rub has settled (the chatter of the first impacts differs between
a penalty and a plastic impact). The scheme is of second order in dt without contact and of first order with
contact; two runs are extrapolated to dt = 0.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag

from rubgen.arrays import FloatArray
from rubgen.machine import SqueezeFilm
from rubgen.reduction import SpinningSystem, TurningForces
from rubgen.scenario import ContactLaw
from rubgen.solver.speed.start import rub_free_stepper
from validation.verification.rotors.jeffcott import (
    CLEARANCE,
    FRICTION,
    SPEED,
    STATOR_DAMPING,
    STATOR_MASS,
    STATOR_STIFFNESS,
    jeffcott_system,
    penalty_contact,
)
from validation.verification.row import Row, relative, within

TITLE = "Uneven supports, squeeze film and gravity, against inertial axes"
DISK_MASS, DISK_STIFFNESS, DISK_DAMPING = 8.0, 1e7, 1500.0
LINK_MASS, LINK_STIFFNESS, LINK_DAMPING = 2.0, 1.5e7, 500.0
GRAVITY = 50.0
"""Five times the earth's, for a sag that is worth the name on such stiff springs."""
FILM = SqueezeFilm(radius_m=0.05, length_m=0.02, clearance_m=6e-4, viscosity_pa_s=0.2)


@dataclass(frozen=True)
class Case:
    """Supports: differences from the mean along X in N/m and N s/m, and the film; unbalance in kg m."""

    stiffness: float
    damping: float
    film: SqueezeFilm | None
    unbalance: float


CASES = {
    "uneven springs and dampers": Case(2.5e6, -600.0, None, 1.6e-3),
    "squeeze film on uneven springs": Case(2.5e6, 0.0, FILM, 2.4e-3),
}
TURNS, EARLY, STEPS = 20, 3, 2048
FREE_CLEARANCE = 1.0


def system_of(case: Case, clearance: float) -> SpinningSystem:
    """The two masses and the ring, as the solver takes them: the link's mass is the one "tip"."""
    whirl = np.array([[0.0, -1.0], [1.0, 0.0]])
    ring = jeffcott_system()
    M = np.diag([LINK_MASS, LINK_MASS, 1.0, DISK_MASS, DISK_MASS])
    K, C = np.diag([0.0, 0.0, 1e6, 0.0, 0.0]), np.diag([0.0, 0.0, 100.0, 0.0, 0.0])
    link = np.array([[1.0, 0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0, -1.0]])
    K += LINK_STIFFNESS * link.T @ link
    C += LINK_DAMPING * link.T @ link
    for pair in (slice(0, 2), slice(3, 5)):
        C[pair, pair] += 2 * SPEED * M[pair, pair] @ whirl
        K[pair, pair] -= SPEED**2 * M[pair, pair]
    C[3:, 3:] += DISK_DAMPING * np.eye(2)
    K[3:, 3:] += DISK_STIFFNESS * np.eye(2) + SPEED * DISK_DAMPING * whirl
    weight = np.zeros((7, 2))
    weight[:2], weight[3:5] = GRAVITY * LINK_MASS * np.eye(2), GRAVITY * DISK_MASS * np.eye(2)
    force = np.zeros(7)
    force[3] = case.unbalance * SPEED**2
    laws = (case.film,) if case.film else ()
    return replace(
        ring,
        M=block_diag(M, ring.M[5:, 5:]),
        C=block_diag(C, ring.C[5:, 5:]),
        K=block_diag(K, ring.K[5:, 5:]),
        force=force,
        surface=replace(ring.surface, mean_radius=clearance),
        lateral_stiffness=DISK_STIFFNESS,
        lateral_damping=DISK_DAMPING,
        turning=TurningForces(stiffness=case.stiffness, damping=case.damping, laws=laws, weight=weight),
    )


def by_scheme(case: Case, clearance: float, steps: int) -> FloatArray:
    """Impulse, x and y of disk, link's mass and ring at the end of each turn (turns, 7), from the solver at rest."""
    system = system_of(case, clearance)
    stepper = rub_free_stepper(system, ContactLaw(friction=FRICTION), steps, screen=False)
    # At rest in inertial axes at the origin: q = 0 and q' = 0 there, so the first step backward is a dt^2 / 2.
    weight = np.zeros(7) if system.turning is None or system.turning.weight is None else system.turning.weight[:, 1]
    stepper.set_coordinates(np.linalg.solve(system.M, system.force - weight) * stepper.dt**2 / 2, np.zeros(7))
    turns = []
    for _ in range(TURNS):
        stepper.run_turn()
        q = stepper.coordinates.now
        turns.append(np.concatenate([stepper.result.summary[:1], q[3:5], q[:2], q[5:] / STATOR_MASS**0.5]))
    return np.array(turns)


def film_force(film: SqueezeFilm | None, z: complex, v: complex) -> complex:
    """-C_rr and -C_tt times the velocity along and across the eccentricity."""
    if film is None:
        return 0j
    share, centred = abs(z) / film.clearance_m, film.centred_damping_n_s_per_m
    along = z / abs(z) if z else 1 + 0j
    radial, across = (v * along.conjugate()).real, (v * along.conjugate()).imag
    radial *= centred * (1 + 2 * share**2) / (1 - share**2) ** 2.5
    across *= centred / (1 - share**2) ** 1.5
    return -complex(radial, across) * along


def in_inertial_axes(case: Case, clearance: float) -> FloatArray:
    """The same (turns, 7) in inertial axes: constant supports and weight, a link that turns."""
    contact = penalty_contact(LINK_MASS, clearance)
    k, c = (np.array([mean + part, mean - part]) for mean, part in (
        (DISK_STIFFNESS, case.stiffness), (DISK_DAMPING, case.damping)
    ))  # fmt: skip

    def slope(t: float, y: FloatArray) -> FloatArray:
        z, tip, ring, v, tip_v, ring_v = y[0:12:2] + 1j * y[1:12:2]
        normal, force = contact(complex(tip - ring), complex(tip_v - ring_v))
        link = LINK_STIFFNESS * (tip - z) + LINK_DAMPING * (tip_v - v - 1j * SPEED * (tip - z))
        push = case.unbalance * SPEED**2 * np.exp(1j * SPEED * t) + film_force(case.film, complex(z), complex(v))
        push -= complex(k[0] * z.real + c[0] * v.real, k[1] * z.imag + c[1] * v.imag)
        a = (push + link) / DISK_MASS - 1j * GRAVITY
        tip_a = -(link + force) / LINK_MASS - 1j * GRAVITY
        ring_a = (force - STATOR_STIFFNESS * ring - STATOR_DAMPING * ring_v) / STATOR_MASS
        slopes = np.array([v, tip_v, ring_v, a, tip_a, ring_a])
        return np.append(np.stack([slopes.real, slopes.imag], axis=1).ravel(), normal)

    times = 2 * np.pi / SPEED * np.arange(TURNS + 1)
    span, rest, longest = (0, times[-1]), np.zeros(13), times[1] / 200
    if clearance == FREE_CLEARANCE:
        y = solve_ivp(slope, span, rest, "DOP853", times, rtol=1e-11, atol=1e-16, max_step=longest).y
    else:
        y = solve_ivp(slope, span, rest, "LSODA", times, rtol=1e-9, atol=1e-13, max_step=longest).y
    return np.vstack([np.diff(y[12]), y[:6, 1:]]).T


def rows() -> Iterator[Row]:
    """Where disk, link's mass and ring are without and with contact; the impulse of the contact."""
    for name, case in CASES.items():
        for clearance, motion in ((FREE_CLEARANCE, "free"), (CLEARANCE, "rub")):
            source = "scipy in inertial axes, " + ("DOP853" if motion == "free" else "LSODA with a stiff penalty")
            expected = in_inertial_axes(case, clearance)
            coarse, fine = (by_scheme(case, clearance, steps) for steps in (STEPS, 2 * STEPS))
            found = (4 * fine - coarse) / 3 if motion == "free" else 2 * fine - coarse
            if motion == "rub":
                quantity = f"{name}, {motion}: impulse a turn, N s"
                yield relative(quantity, source, expected[-1, 0], found[-1, 0], 2e-4)
            for turn in (EARLY, TURNS) if motion == "free" else (TURNS,):
                for part, column in (("disk", 1), ("link's mass", 3)):
                    for axis, offset in (("X", 0), ("Y", 1)):
                        exact, ours = expected[turn - 1, column + offset], found[turn - 1, column + offset]
                        quantity = f"{name}, {motion}: {part} {axis} after {turn} turns, m"
                        yield within(quantity, source, exact, ours, 1e-12 if motion == "free" else 1e-8)
