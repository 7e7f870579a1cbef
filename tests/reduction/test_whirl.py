"""Whirl and damping seen from the turning frame, against the theory of rigid rotors."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag, eigvals

from rubgen.machine import Damping, DiskSupport
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s

NO_DAMPING = Damping(lateral=0, tilt=0, axial=0, torsion=0, blade=0, casing=0)


def plain_disk(preset, thickness, **support):
    """A disk of even thickness with blades that weigh nothing to speak of, on the given springs."""
    springs = {
        "lateral_stiffness_n_per_m": 1e9,
        "axial_stiffness_n_per_m": 1e9,
        "tilt_stiffness_nm_per_rad": 1e8,
        "torsion_stiffness_nm_per_rad": 1e8,
    }
    mesh = {"radial_elements": 2, "circumferential_elements": 12}
    disk = replace(preset.disk, bore_thickness_m=thickness, rim_thickness_m=thickness, **mesh)
    feather = replace(preset.blades.material, density_kg_per_m3=1e-3)
    blades = replace(preset.blades, count=3, elements=2, length_m=0.02, material=feather)
    return replace(preset, disk=disk, blades=blades, disk_support=DiskSupport(**(springs | support)))


def inertia(machine):
    """m, I_d, I_p of the annulus."""
    disk = machine.disk
    a, b, h = disk.bore_radius_m, disk.rim_radius_m, disk.rim_thickness_m
    mass = disk.material.density_kg_per_m3 * np.pi * (b**2 - a**2) * h
    polar = mass * (a**2 + b**2) / 2
    return mass, polar / 2 + mass * h**2 / 12, polar


def slowest(system, count):
    """Eigenvalues of the damped system with the smallest frequencies, by |s|, those of positive imaginary part."""
    n = len(system.M)
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [-system.K, -system.C]])
    values = eigvals(companion, block_diag(np.eye(n), system.M))
    values = values[values.imag > 0]
    return values[np.argsort(np.abs(values))][:count]


@pytest.mark.parametrize("thickness", [0.01, 0.1, 0.3])
@pytest.mark.parametrize("ratio", [0.0, 0.5, 1.0, 2.0])
def test_tilting_disk_whirls_as_a_gyroscope(preset, thickness, ratio):
    # Inertial frame: I_d w^2 - I_p Omega w - k = 0. Forward w shows as w - Omega, backward (w < 0) as |w - Omega|.
    _, diametral, polar = inertia(plain_disk(preset, thickness))
    rest = 5.0
    machine = plain_disk(preset, thickness, tilt_stiffness_nm_per_rad=diametral * rest**2)
    speed = ratio * rest
    whirl = np.roots([diametral, -polar * speed, -diametral * rest**2])
    found = 2 * np.pi * reduce(machine, Reduction()).blisk_frequencies_hz(speed)[:2]
    np.testing.assert_allclose(found, np.sort(np.abs(whirl - speed)), rtol=3e-4)


def test_thin_tilting_disk_has_the_tabled_frequencies(preset):
    # J_p = 2 J_d, k / J_d = 1: sqrt(Omega^2 + 1) +- Omega in the inertial frame, 2.414214 and 0.414214 at Omega = 1.
    machine = plain_disk(preset, 0.004)
    rest = 1.0
    _, diametral, _ = inertia(machine)
    machine = plain_disk(preset, 0.004, tilt_stiffness_nm_per_rad=diametral * rest**2)
    found = 2 * np.pi * reduce(machine, Reduction()).blisk_frequencies_hz(rest)[:2]
    np.testing.assert_allclose(np.add(found, [1, -1]), [2.414214, 0.414214], atol=5e-4)


@pytest.mark.parametrize("ratio", [0.2, 0.9, 3.0])
def test_lateral_dampers_in_the_inertial_frame_damp_whirl_at_any_speed(preset, ratio):
    # A rigid rotor's lateral roots, -zeta w +- i w sqrt(1 - zeta^2), know nothing of the speed: the turning frame
    # only shifts them by -+ i Omega. Damping of the co-rotating velocity would make forward whirl unstable at ratio 3.
    mass, _, _ = inertia(plain_disk(preset, 0.1))
    rest, zeta = 20.0, 0.1
    damping = replace(NO_DAMPING, lateral=zeta)
    machine = replace(plain_disk(preset, 0.1, lateral_stiffness_n_per_m=mass * rest**2), damping=damping)
    speed = ratio * rest
    inertial = complex(-zeta * rest, rest * np.sqrt(1 - zeta**2))
    forward, backward = inertial - 1j * speed, inertial + 1j * speed
    expected = sorted([complex(s.real, abs(s.imag)) for s in (forward, backward)], key=abs)
    found = slowest(reduce(machine, Reduction()).at_speed(speed), 2)
    np.testing.assert_allclose(found, expected, atol=1e-4 * rest)  # the coarse mesh has 1e-4 less mass


def test_tilt_damper_has_its_ratio_at_rest(preset):
    _, diametral, _ = inertia(plain_disk(preset, 0.1))
    machine = plain_disk(preset, 0.1, tilt_stiffness_nm_per_rad=diametral * 20.0**2)
    found = slowest(reduce(replace(machine, damping=replace(NO_DAMPING, tilt=0.07)), Reduction()).at_speed(1e-6), 2)
    np.testing.assert_allclose(-found.real / np.abs(found), 0.07, rtol=1e-3)


@pytest.mark.parametrize("thickness", [0.1, 0.6])
@pytest.mark.parametrize("ratio", [0.5, 3.0])
def test_tilt_dampers_in_the_inertial_frame_damp_whirl_at_any_speed(preset, thickness, ratio):
    # Inertial frame, th_x + i th_y: I_d s^2 + (c - i I_p Omega) s + k = 0, turned by -i Omega. The thicker rotor is a
    # drum, I_p < I_d: its forward tilt whirl is overtaken, and damping of the co-rotating tilt would make it unstable.
    _, diametral, polar = inertia(plain_disk(preset, thickness))
    assert (polar < diametral) is (thickness == 0.6)
    rest, zeta = 10.0, 0.1
    machine = plain_disk(preset, thickness, tilt_stiffness_nm_per_rad=diametral * rest**2)
    speed = ratio * rest
    drag = 2 * zeta * rest * diametral
    inertial = np.roots([diametral, drag - 1j * polar * speed, diametral * rest**2])
    expected = sorted([complex(s.real, abs(s.imag - speed)) for s in inertial], key=abs)
    found = slowest(reduce(replace(machine, damping=replace(NO_DAMPING, tilt=zeta)), Reduction()).at_speed(speed), 2)
    np.testing.assert_allclose(found, expected, atol=1e-3 * rest)
    assert found.real.max() < 0


@pytest.mark.parametrize("number", [2, 5])
def test_axial_and_torsion_dampers_have_their_ratio_at_any_speed(preset, number):
    # Along and about Z nothing is transported by the rotation: a plain oscillator at any speed.
    mass, _, polar = inertia(plain_disk(preset, 0.1))
    spring, name, load = {
        2: ("axial_stiffness_n_per_m", "axial", mass),
        5: ("torsion_stiffness_nm_per_rad", "torsion", polar),
    }[number]
    machine = plain_disk(preset, 0.1, **{spring: load * 20.0**2})
    found = slowest(
        reduce(replace(machine, damping=replace(NO_DAMPING, **{name: 0.07})), Reduction()).at_speed(60.0), 1
    )
    np.testing.assert_allclose(found, 20 * complex(-0.07, np.sqrt(1 - 0.07**2)), atol=1e-3 * 20)


def test_blade_damping_is_elastic_and_leaves_a_rigid_shift_alone(preset):
    machine = replace(preset, damping=replace(NO_DAMPING, blade=0.004))
    system = reduce(machine, Reduction()).at_speed(700.0)
    internal, angle = (system.C + system.C.T) / 2, system.blade_angles
    shift = np.zeros(len(internal))
    shift[: system.centre : 3], shift[1 : system.centre : 3], shift[system.centre] = np.cos(angle), -np.sin(angle), 1.0
    # Were the supports' springs in beta K, the shift would meet 1e8 N/m times beta, 3e-2 of the largest entry.
    np.testing.assert_allclose(internal @ shift, 0, atol=1e-8 * np.abs(internal).max())
    assert internal[0, 0] > 0


def test_modes_of_the_preset_have_their_damping_ratios(preset):
    model = reduce(preset, Reduction())
    values = slowest(model.at_speed(1e-6), 60)
    ratio, hertz = -values.real / np.abs(values), np.abs(values) / (2 * np.pi)
    assert ratio[np.argmin(abs(hertz - 68.55))] == pytest.approx(0.10, rel=0.03)  # tilt
    assert ratio[np.argmin(abs(hertz - 144.8))] == pytest.approx(0.10, rel=0.15)  # lateral, coupled with blades
    blades = (hertz > 157) & (hertz < 158)  # two or more nodal diameters: blades alone
    assert np.count_nonzero(blades) >= 1
    np.testing.assert_allclose(ratio[blades], 0.004, rtol=0.02)


@pytest.mark.parametrize("rpm", [100, 6000, 12500, 15000])
def test_preset_is_stable_at_speed(preset, rpm):
    assert slowest(reduce(preset, Reduction()).at_speed(rad_per_s(rpm)), 250).real.max() < -1.0
