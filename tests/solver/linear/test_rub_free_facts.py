"""What the solver tells of the orbit and of the motion without contact, against closed forms and other methods."""

import numpy as np
import pytest

from rubgen.contact.geometry import blade_tips, casing_surface, node_radii
from rubgen.labels.motion.whirl import WhirlDirection, whirl
from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import free_penetration, rub_free_motion
from rubgen.units import rad_per_s
from validation.run_up import predicted_onset, reach

SMOOTH = ContactLaw()


@pytest.fixture(scope="module")
def preset():
    return reduce(load_machine("zeng2019"), Reduction())


def penetration(system, contact=SMOOTH):
    return free_penetration(rub_free_motion(system), casing_surface(system, contact), blade_tips(system))


def test_penetration_is_the_reach_beyond_the_clearance_and_begins_with_rub(preset):
    clearance = preset.machine.casing.clearance_m
    for rpm in (6000.0, 8500.0):
        expected = reach(preset, rad_per_s(rpm), 0.0) - clearance
        assert penetration(preset.at_speed(rad_per_s(rpm))) == pytest.approx(expected, abs=2e-9)
    onset = predicted_onset(preset, 0.0)
    assert (
        penetration(preset.at_speed(rad_per_s(onset - 0.1))) < 0 < penetration(preset.at_speed(rad_per_s(onset + 0.1)))
    )


@pytest.mark.parametrize("case", ["gravity", "springs"])
def test_penetration_of_a_periodic_motion(small_system, turning, case):
    """Place by place in the inertial frame, with the radius of the surface in closed form."""
    system = turning(small_system(turned_nodes=5), case)
    motion = rub_free_motion(system)
    deepest = -np.inf
    for theta in np.linspace(0, 2 * np.pi, 2001):
        u = motion.at(theta)[: system.centre].reshape(-1, 3) + system.tip_static
        P = (system.tip_radius + u[:, 0] + 1j * u[:, 1]) * np.exp(1j * (theta + system.blade_angles))
        lobes = np.cos(system.surface.order[0] * (np.angle(P) - system.surface.phase[0]))
        deepest = max(deepest, (abs(P) - system.surface.mean_radius - system.surface.amplitude[0] * lobes).max())
    assert penetration(system) == pytest.approx(deepest, abs=2e-8)


def test_chords_lie_inside_and_are_entered_deeper(small_system):
    """Of a circle of 36 nodes the chords lie R (1 - cos 5 deg) inside, and some tip passes the middle of one."""
    system = small_system(ovality=0.0)
    radius = node_radii(system.surface, 36)[0]
    deeper = penetration(system, ContactLaw(surface="chords")) - penetration(system)
    assert deeper == pytest.approx(radius * (1 - np.cos(np.pi / 36)), rel=1e-3)


def test_a_run_knows_its_penetration_and_its_circular_orbit(small_system, operation):
    system = small_system(clearance=5e-3)
    run = integrate(system, operation(system, record_turns=3, settle_turns=3), ContactLaw())
    assert run.free_penetration == pytest.approx(penetration(system), abs=1e-6)  # the scheme's own motion
    x, y = rub_free_motion(system).at(0.0)[system.centre : system.centre + 2]
    speed = np.sin(2 * np.pi / 256) / (2 * np.pi / 256) * system.speed  # of a central difference
    expected = np.array([0, 0, 1, speed**2, speed]) * (x**2 + y**2)
    np.testing.assert_allclose(run.orbit[-1], expected, rtol=1e-3, atol=1e-9 * np.hypot(x, y))
    assert whirl(run.orbit).index == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(("speed", "direction"), [(500.0, WhirlDirection.FORWARD), (830.0, WhirlDirection.BACKWARD)])
def test_between_two_critical_speeds_uneven_supports_whirl_backward(small_system, turning, operation, speed, direction):
    """As every lightly damped rotor on uneven springs does; index against forward and backward circles by FFT."""
    light = {"clearance": 5e-3, "lateral_damping": 1e-3, "unbalance": 1e-5}
    system = turning(small_system(speed=speed, **light), "springs", stiffness=2e6)
    run = integrate(system, operation(system, record_turns=2, settle_turns=2), ContactLaw())
    found = whirl(run.orbit)
    theta = 2 * np.pi * np.arange(64) / 64
    motion = rub_free_motion(system, 256)
    turned = np.array([motion.at(angle)[system.centre :][:2] for angle in theta])
    circles = np.abs(np.fft.fft((turned[:, 0] + 1j * turned[:, 1]) * np.exp(1j * theta))) ** 2
    forward, backward = circles[1], circles[-1]
    assert found.direction is direction
    share = (forward - backward) / (forward + backward)
    assert found.index == pytest.approx(share, abs=4e-4)  # speeds of the scheme are right to (2 phi)^2 / 6


def test_mass_of_the_preset_is_that_of_its_volume(preset):
    """The disk's linear thickness and the blades' linear chord and thickness, integrated by Simpson's rule (exact)."""
    disk, blades = preset.machine.disk, preset.machine.blades

    def simpson(first, last, length):
        return length / 6 * (first[0] * first[1] + (first[0] + last[0]) * (first[1] + last[1]) + last[0] * last[1])

    inner, outer = (disk.bore_radius_m, disk.bore_thickness_m), (disk.rim_radius_m, disk.rim_thickness_m)
    root, tip = (blades.root_chord_m, blades.root_thickness_m), (blades.tip_chord_m, blades.tip_thickness_m)
    volume = 2 * np.pi * simpson(inner, outer, outer[0] - inner[0]) + 36 * simpson(root, tip, blades.length_m)
    assert preset.at_speed(700.0).recovery.blisk_mass == pytest.approx(7850.0 * volume, rel=1e-3)


def test_amplitudes_of_windows_are_those_of_one_spectrum(small_system, operation):
    """The mean of six windows' complex amplitudes is the line of a spectrum over all their turns."""
    system = small_system(speed=500.0)
    run = integrate(system, operation(system, record_turns=100, settle_turns=60), ContactLaw(friction=0.1))
    assert run.impulse_per_turn.min() > 0
    assert run.window_orders.shape == (7, len(run.taps), 20)
    for row, tap in enumerate(run.taps.values()):
        whole = tap[: 96 * 256]
        lines = 2 / whole.size * np.fft.rfft(whole)[96 * np.arange(1, 21)]
        np.testing.assert_allclose(
            run.window_orders[:6, row].mean(axis=0), lines, rtol=0, atol=1e-9 * np.abs(tap).max()
        )
        last = 2 / (4 * 256) * np.fft.rfft(tap[-4 * 256 :])[4 * np.arange(1, 21)]
        np.testing.assert_allclose(run.window_orders[6, row], last, rtol=0, atol=1e-9 * np.abs(tap).max())
