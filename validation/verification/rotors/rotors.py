"""Rigid rotors: whirl, damping and unbalance seen from the turning frame.

A disk of uniform thickness with three very light blades is reduced like every machine. Frequencies are given in the
inertial frame: the spin is added to a forward whirl of the turning frame and subtracted from a backward one. The
mesh of 2 x 24 elements has 1e-5 less inertia than the annulus. The disk is not quite rigid; the error is the square
of the ratio of the whirl frequency to the disk's own frequency, 6e-5 for the thin disk. Rounding against the
penalty of the couplings adds up to 4e-5 if supports are very soft.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.blisk import assemble_blisk, rigid_motions
from rubgen.machine import Damping, Disk, DiskSupport, Machine, load_machine
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from rubgen.solver.linear.stability import eigenvalues
from validation.verification.row import Row, relative, within

TITLE = "Rigid rotors"
NO_DAMPING = Damping(lateral=0, tilt=0, axial=0, torsion=0, blade=0, casing=0)
STIFF = DiskSupport(
    lateral_stiffness_n_per_m=1e9,
    axial_stiffness_n_per_m=1e9,
    tilt_stiffness_nm_per_rad=1e8,
    torsion_stiffness_nm_per_rad=1e8,
)
THIN, THICK = 0.004, 0.3
THIN_REST, THICK_REST, LATERAL_REST, LATERAL_RATIO = 5.0, 50.0, 200.0, 0.1
UNBALANCE = 1e-3


def plain_rotor(thickness: float, support: DiskSupport = STIFF, damping: Damping = NO_DAMPING) -> Machine:
    """A disk of even thickness with blades that weigh nothing to speak of."""
    preset = load_machine("zeng2019")
    disk = replace(
        preset.disk,
        bore_thickness_m=thickness,
        rim_thickness_m=thickness,
        radial_elements=2,
        circumferential_elements=24,
    )
    feather = replace(preset.blades.material, density_kg_per_m3=1e-3)
    blades = replace(preset.blades, count=3, elements=2, length_m=0.02, material=feather)
    return replace(preset, disk=disk, blades=blades, disk_support=support, damping=damping, unbalance_kg_m=UNBALANCE)


def annulus_inertia(disk: Disk) -> tuple[float, float, float]:
    """Mass m in kg, I_d and I_p in kg m2 of the annulus."""
    a, b, h = disk.bore_radius_m, disk.rim_radius_m, disk.rim_thickness_m
    mass = disk.material.density_kg_per_m3 * np.pi * (b**2 - a**2) * h
    polar = mass * (a**2 + b**2) / 2
    return mass, polar / 2 + mass * h**2 / 12, polar


def tilt_whirl(thickness: float, rest: float, speed: float) -> tuple[FloatArray, FloatArray]:
    """Inertial frequencies (2,) of backward and forward tilting whirl: closed form, found.

    I_d w^2 - I_p Omega w - k = 0 with k = I_d rest^2; in the turning frame w shows as |w - Omega|.
    """
    _, diametral, polar = annulus_inertia(plain_rotor(thickness).disk)
    support = replace(STIFF, tilt_stiffness_nm_per_rad=diametral * rest**2)
    whirl = np.sort(np.roots([diametral, -polar * speed, -diametral * rest**2]).real)
    found = 2 * np.pi * reduce(plain_rotor(thickness, support), Reduction()).blisk_frequencies_hz(speed)[:2]
    shown = np.abs(whirl - speed)
    in_turning_frame = found[np.argsort(np.argsort(shown))]
    return np.abs(whirl), np.abs(np.sign(whirl - speed) * in_turning_frame + speed)


def lateral_roots(ratio: float) -> tuple[complex, complex]:
    """Root of forward lateral whirl in the turning frame at Omega = ratio x 200 rad/s: closed form, found.

    Dampers of 10 % in the inertial frame: there the root is -zeta w + i w sqrt(1 - zeta^2) at any speed.
    """
    mass, _, _ = annulus_inertia(plain_rotor(0.1).disk)
    rest, zeta = LATERAL_REST, LATERAL_RATIO
    support = replace(STIFF, lateral_stiffness_n_per_m=mass * rest**2)
    machine = plain_rotor(0.1, support, replace(NO_DAMPING, lateral=zeta))
    inertial = complex(-zeta * rest, rest * np.sqrt(1 - zeta**2))
    forward = inertial - 1j * ratio * rest
    values = eigenvalues(reduce(machine, Reduction()).at_speed(ratio * rest))
    return forward, complex(values[np.argmin(np.abs(values - forward))])


def unbalance_response(ratio: float) -> tuple[complex, complex]:
    """O_d x + i y of the turning frame at Omega = ratio x 200 rad/s with 10 % damping: closed form, found."""
    mass, _, _ = annulus_inertia(plain_rotor(0.1).disk)
    rest, zeta = LATERAL_REST, LATERAL_RATIO
    support = replace(STIFF, lateral_stiffness_n_per_m=mass * rest**2)
    system = reduce(plain_rotor(0.1, support, replace(NO_DAMPING, lateral=zeta)), Reduction()).at_speed(ratio * rest)
    q = np.linalg.solve(system.K, system.force)
    exact = UNBALANCE / mass * ratio**2 / complex(1 - ratio**2, 2 * zeta * ratio)
    return exact, complex(q[system.centre], q[system.centre + 1])


def rows() -> Iterator[Row]:
    """Campbell diagram of tilting, damped whirl, unbalance, centrifugal stiffness of rigid motions."""
    source = "J_p = 2 J_d: sqrt(Omega^2 + 1) -+ Omega"
    thin = tilt_whirl(THIN, THIN_REST, THIN_REST)[1] / THIN_REST
    for name, expected, found in zip(("backward", "forward"), (0.414214, 2.414214), thin, strict=True):
        yield within(f"thin tilting disk at Omega = 1: {name} whirl", source, expected, found, 3e-4)
    source = "I_d w^2 - I_p Omega w - k = 0"
    for ratio in (0.0, 0.5, 1.0, 2.0):
        whirl = tilt_whirl(THICK, THICK_REST, ratio * THICK_REST)
        for name, expected, found in zip(("backward", "forward"), *whirl, strict=True):
            quantity = f"thick tilting disk, Omega = {ratio:g} omega_0: {name} whirl, rad/s"
            yield relative(quantity, source, expected, found, 1e-4)
    for ratio in (0.2, 0.9, 3.0):
        root, found_root = lateral_roots(ratio)
        source = "-zeta w +- i w sqrt(1 - zeta^2), shifted by the spin"
        quantity = f"lateral whirl, dampers at rest, Omega = {ratio:g} omega_0"
        yield relative(f"{quantity}: decay rate, 1/s", source, root.real, found_root.real, 1e-4)
        yield relative(f"{quantity}: frequency, rad/s", source, root.imag, found_root.imag, 1e-4)
    for ratio in (0.5, 0.95, 2.0):
        exact, found_response = unbalance_response(ratio)
        quantity, source = f"unbalance response at Omega = {ratio:g} omega_0", "Jeffcott rotor in closed form"
        yield relative(f"{quantity}: amplitude, m", source, abs(exact), abs(found_response), 2e-4)
        yield within(f"{quantity}: phase, rad", source, np.angle(exact), np.angle(found_response), 2e-4)
    yield from rigid_projection()


def rigid_projection() -> Iterator[Row]:
    """K_sigma - S of the preset's full blisk on rigid-body motions: -m, 0, I_p - I_d, 0."""
    machine = load_machine("zeng2019")
    model = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
    R = rigid_motions(model)
    inertia = np.einsum("ij,ij->j", R, model.M @ R)
    found = np.einsum("ij,ij->j", R, (model.K_sigma - model.S) @ R)
    names = ("lateral, kg", "axial, kg", "tilt, kg m2", "torsion, kg m2")
    expected = (-inertia[0], 0.0, inertia[5] - inertia[3], 0.0)
    for name, value, ours in zip(names, expected, found[[0, 2, 3, 5]], strict=True):
        quantity = f"centrifugal stiffness of rigid motion at 1 rad/s: {name}"
        yield within(quantity, "-m, 0, I_p - I_d, 0 of any turning body", value, ours, 1e-9 * inertia[0])
