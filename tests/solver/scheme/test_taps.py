"""Taps of every kind against what the state itself says."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from rubgen.reduction.model import Recovery
from rubgen.scenario import ContactLaw
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import steady_state
from rubgen.solver.scheme.energy_kernels import CONTACT, FRICTION, NORMAL
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.solver.wants import Wants
from rubgen.taps import (
    DEFAULT_TAPS,
    CasingAcceleration,
    CentreDisplacement,
    ContactTorque,
    RingStrain,
    RootStrain,
    SupportForce,
    TipTiming,
)

OPENING = np.linspace(4e-4, 0, 258)


def rubbing(system, **options):
    """One turn with contact: the stepper after it, and its taps by row."""
    stepper = rub_free_stepper(system, ContactLaw(friction=0.2), 256, **options)
    stepper.run_turn(OPENING)
    assert stepper.result.summary[0] > 0.01
    return stepper, stepper.result.taps


def recovery(system, **values):
    zero = np.zeros(system.casing_start)
    defaults = {"torsion_stiffness": 1.0, "torsion_damping": 0.0, "casing_radius": 0.21, "casing_thickness": 2e-3}
    defaults |= {"blisk_mass": 1.0}
    rows = {"root_strain": lambda _blade: zero, "torsion": zero, "chord_slope": 0.0}
    return Recovery(**(defaults | rows | values))


def test_order_and_number_of_taps_change_no_bit(small_system):
    system = small_system(speed=500.0, clearance=-2e-4)
    stepper, usual = rubbing(system)
    more = (ContactTorque(name="torque"), TipTiming(name="probe", angle_deg=17), *reversed(DEFAULT_TAPS))
    other, taps = rubbing(system, taps=more)
    np.testing.assert_array_equal(taps[1:], usual[::-1])
    np.testing.assert_array_equal(other.coordinates.now, stepper.coordinates.now)
    none, nothing = rubbing(system, taps=())
    assert nothing.shape == (0, 256)
    np.testing.assert_array_equal(none.coordinates.now, stepper.coordinates.now)


def test_directions_between_the_axes(small_system):
    angle = 33.0
    c, s = np.cos(np.deg2rad(angle)), np.sin(np.deg2rad(angle))
    taps = (*DEFAULT_TAPS, CentreDisplacement(name="u", angle_deg=angle), SupportForce(name="f", angle_deg=angle))
    _, taps = rubbing(small_system(speed=500.0, clearance=-2e-4), taps=taps)
    np.testing.assert_allclose(taps[11], c * taps[0] + s * taps[1], rtol=1e-12, atol=1e-18)
    np.testing.assert_allclose(taps[12], c * taps[6] + s * taps[7], rtol=1e-12, atol=1e-9)


def test_accelerations_at_any_angle_are_those_of_the_ring(small_system):
    """Orders 1 to 3 of radial acceleration: seven angles give the series, which gives every other angle."""
    angles = [360 * k / 7 for k in range(7)]
    taps = tuple(CasingAcceleration(name=f"a{k}", angle_deg=a) for k, a in enumerate([*angles, 100.0]))
    _, signals = rubbing(small_system(speed=500.0, clearance=-2e-4), taps=taps)
    spectrum = np.fft.fft(signals[:7], axis=0) / 7
    orders = np.array([0, 1, 2, 3, -3, -2, -1])
    expected = (np.exp(1j * orders * np.deg2rad(100.0)) @ spectrum).real
    # The 36 nodes are interpolated: cubic, error 1e-4 of order 3.
    np.testing.assert_allclose(signals[7], expected, atol=1e-3 * np.abs(expected).max())


def test_the_contact_torque_is_what_the_drive_pays_for(small_system):
    system = small_system(speed=500.0, clearance=-2e-4)
    stepper, (torque,) = rubbing(system, taps=(ContactTorque(name="torque"),))
    assert torque.min() < -1
    assert torque.max() <= 0.1 * -torque.min()  # friction brakes
    works = stepper.state.works
    drive = works[CONTACT] - works[NORMAL] - works[FRICTION]
    assert -system.speed * stepper.dt * torque.sum() == pytest.approx(drive, rel=1e-2)


@pytest.mark.parametrize("order", [1, 2, 3])
def test_ring_strain_of_inextensible_modes(small_system, order):
    """u_r = a cos n t, u_t = -a sin n t / n: no stretch, a change of curvature a (n^2 - 1) cos n t / R^2."""
    system = small_system(ovality=0.0, clearance=8e-3, unbalance=0.0)
    angle = 25.0
    system = replace(system, recovery=recovery(system))
    stepper = rub_free_stepper(system, ContactLaw(), 256, taps=(RingStrain(name="strain", angle_deg=angle),))
    q = steady_state(system)
    q[system.casing_start + 2 * (order - 1)] = 1e-3 / system.casing_modes[0, 0, 2 * (order - 1)]
    stepper.set_coordinates(q, q)
    stepper.run_turn()
    expected = 1e-3 * 1e-3 * (order**2 - 1) / 0.21**2 * np.cos(order * np.deg2rad(angle))
    assert stepper.result.taps[0, 0] == pytest.approx(expected, rel=1e-9, abs=1e-15)


def test_what_a_system_without_recovery_cannot_give(small_system):
    with pytest.raises(ValueError, match="not reduced from a machine"):
        rub_free_stepper(small_system(), ContactLaw(), 256, taps=(RootStrain(name="s", blade=0),))


@pytest.mark.parametrize("chord_slope", [0.0, 0.3])
def test_blades_of_a_steady_whirl_arrive_when_geometry_says(small_system, operation, chord_slope):
    """Static in the turning frame: blade k is under the probe at theta = phi - angle_k - atan(y / x), once a turn."""
    system = small_system(clearance=2e-3, ovality=1e-3)
    system = replace(system, recovery=recovery(system, chord_slope=chord_slope))
    probes = (TipTiming(name="a", angle_deg=0), TipTiming(name="b", angle_deg=200.3, axial_m=4e-3))
    response = integrate(system, operation(system, settle_turns=40), ContactLaw(), Wants(taps=probes))
    place = steady_state(system)[: 3 * system.n_blades].reshape(-1, 3) + system.tip_static
    for probe in probes:
        seen = response.arrivals[probe.name]
        along = place[seen.blade, 1] - chord_slope * place[seen.blade, 2]
        turn = np.arctan2(along + chord_slope * probe.axial_m, system.tip_radius + place[seen.blade, 0])
        theta = np.deg2rad(probe.angle_deg) - system.blade_angles[seen.blade] - turn
        off = np.angle(np.exp(1j * (theta - 2 * np.pi * seen.step / 256)))
        assert np.abs(off).max() < 1e-10
        np.testing.assert_allclose(seen.displacement, along, atol=1e-12)
        assert np.all(np.bincount(seen.blade) == 100)
        assert np.all(np.diff(seen.step) > 0)
        assert -1 < seen.step[0] < 256 / 6
        assert 100 * 256 - 256 / 6 - 1 < seen.step[-1] < 100 * 256


def test_arrivals_of_vibrating_blades(small_system):
    """Against the roots of a spline through every step of the same motion."""
    system = small_system(speed=500.0)
    start = steady_state(system)
    start[: 3 * system.n_blades] += 1e-3 * np.random.default_rng(4).standard_normal(3 * system.n_blades)
    probe, turns, steps = np.deg2rad(77.0), 3, 512
    runs = [rub_free_stepper(system, ContactLaw(), steps, taps=(TipTiming(name="p", angle_deg=77),)) for _ in range(2)]
    wide = np.full(steps + 2, 0.1)
    for stepper in runs:
        stepper.set_coordinates(start, start)
    states, seen = [start], []
    for turn in range(turns):
        runs[0].run_turn(wide, clock=turn * steps)
        seen.append(runs[0].taps.timing.arrivals[: int(runs[0].result.summary[3])].copy())
        for s in range(steps):
            runs[1].step(s, wide)
            states.append(runs[1].coordinates.now)
    q = np.array(states)[:, : 3 * system.n_blades].reshape(len(states), -1, 3) + system.tip_static
    seen = np.concatenate(seen)
    assert len(seen) == turns * system.n_blades
    assert np.ptp(seen[:, 3]) > 5e-4
    for _, blade, at, displacement in seen:
        k = int(blade)
        y, x = (CubicSpline(np.arange(len(q)), q[:, k, axis]) for axis in (1, 0))

        def beyond(step, k=k, x=x, y=y):
            angle = 2 * np.pi * step / steps + system.blade_angles[k] - probe
            return np.angle(np.exp(1j * (angle + np.arctan2(y(step), system.tip_radius + x(step)))))

        exact = brentq(beyond, at - 1, at + 1, xtol=1e-12)
        assert at == pytest.approx(exact, abs=2e-4)  # of a step: linear between two of them
        assert displacement == pytest.approx(float(y(exact)), abs=1e-6)
