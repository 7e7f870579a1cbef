"""True signals of a step, each against its definition in the inertial frame."""

import numpy as np
import pytest
from scipy.optimize import brentq

from rubgen.linalg.blocks import aligned, padded
from rubgen.linalg.vector_kernels import LANES
from rubgen.scenario import ContactLaw, Liner
from rubgen.solver.scheme.motion_kernels import recover
from rubgen.solver.scheme.state_kernels import Coordinates
from rubgen.solver.scheme.tap_kernels import (
    CONTACT_FORCE,
    CONTACT_TORQUE,
    FORCE_X,
    FORCE_Y,
    SPEED_X,
    SPEED_Y,
    Rays,
    Timing,
    X,
    Y,
    angle_beyond,
    casing_radius_on_ray,
    is_near,
    read_shaft,
    record_arrivals,
    record_taps,
    sum_functionals,
    tip_radius_on_ray,
)
from rubgen.solver.scheme.taps import SOURCES, TapLayout
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.taps import DEFAULT_TAPS

STEPS, STEP = 96, 11
LAW = ContactLaw(friction=0.1, liner=Liner(thickness_m=1e-3, wear_m2_per_n=4e-12, width_m=0.02, bins=240))


@pytest.fixture(scope="module")
def stepper(small_system, turning):
    return rub_free_stepper(turning(small_system(), "all"), LAW, STEPS)


def motion_of(stepper, q):
    """A motion as a step leaves it."""
    motion = stepper.state.motions[0]
    motion = type(motion)(*(aligned(np.zeros_like(array)) for array in motion))
    motion.z[:] = stepper.blocks.to_z(q)
    recover(stepper.model.harmonics, motion, stepper.state.scratch.share)
    return motion


def three_states(stepper, seed):
    """Coordinates (3, n) at three steps, 0.1 mm apart."""
    return np.random.default_rng(seed).normal(size=(3, len(stepper.system.M))) * 1e-4


def coordinates_of(q):
    return Coordinates(q[0].copy(), q[1].copy(), q[2].copy(), 0.5 * (q[2] - q[0]))


def test_the_tips_radius_on_a_ray_is_linear_between_two_blades(stepper):
    tips, rng = stepper.model.tips, np.random.default_rng(1)
    displacement = rng.normal(size=(2, 8)) * 5e-3
    none = np.zeros(0)
    rays = Rays(
        np.zeros(1, int), np.zeros(1, int), none, none, none, np.array([[[0, 1]], [[5, 2]]]), np.array([[0.0], [0.3]])
    )
    place = tips.radius + (tips.static[0] + displacement[0, :6]) + 1j * (tips.static[1] + displacement[1, :6])
    assert tip_radius_on_ray(tips, rays, displacement, 0, 0) == pytest.approx(abs(place[0]), rel=1e-14)
    assert tip_radius_on_ray(tips, rays, displacement, 1, 0) == pytest.approx(
        0.7 * abs(place[5]) + 0.3 * abs(place[2]), rel=1e-14
    )


@pytest.mark.parametrize(("ovality", "error"), [(0.0, 2e-8), (4e-3, 4e-7)])
def test_a_ray_meets_a_casing_that_moves_as_a_whole_where_geometry_says(ovality, error):
    """X(psi) = r(psi) e_r + (a, b), r = R + e cos 2 psi: the psi at which X lies on the ray, by bisection.

    Right to |u|^3 / R^2 on a circle (the second order is 1e-6 here), else to r'' u^2 / R^2.
    """
    R, opening, moved = 0.2, 3e-4, 8e-4 * np.exp(2.2j)

    def radius(psi):
        return R + ovality * np.cos(2 * psi)

    for angle in np.linspace(0.1, 6.2, 13):

        def place(psi):
            return (radius(psi) + opening) * np.exp(1j * psi) + moved

        psi = brentq(
            lambda psi, angle=angle: np.angle(place(psi) * np.exp(-1j * angle)), angle - 0.1, angle + 0.1, xtol=1e-15
        )
        local = moved * np.exp(-1j * angle)  # radial and tangential displacement at the ray
        sums = np.array([9.0, local.real, local.imag, local.imag])  # u_r' = u_t for a field that is a translation
        slope = -2 * ovality * np.sin(2 * angle)
        rays = Rays(
            np.zeros(1, int), np.ones(1, int), np.array([angle]), np.array([radius(angle)]), np.array([slope]),
            np.zeros((1, 1, 2), int), np.zeros((1, 1)),
        )  # fmt: skip
        assert casing_radius_on_ray(rays, sums, opening, 0) == pytest.approx(abs(place(psi)), abs=error)


def test_the_shaft_is_read_in_the_inertial_frame(stepper):
    """x + i y of the turning frame stands at (x + i y) exp(i theta); its velocity is the derivative of that."""
    system, model, q = stepper.system, stepper.model, three_states(stepper, 2)
    state = stepper.state
    state.support.force[1] = 12.0, -7.0
    read_shaft(model, stepper.taps, coordinates_of(q), state.support, STEP)
    before, now, after = q[:, system.centre] + 1j * q[:, system.centre + 1]
    turn = np.exp(2j * np.pi * STEP / STEPS)
    place = now * turn
    velocity = ((after - before) / (2 * stepper.dt) + 1j * system.speed * now) * turn
    force = system.lateral_stiffness * place + system.lateral_damping * velocity - (12.0 - 7.0j) * turn
    signals = stepper.taps.signals
    for pair, expected in (((X, Y), place), ((SPEED_X, SPEED_Y), velocity), ((FORCE_X, FORCE_Y), force)):
        assert signals[pair[0]] + 1j * signals[pair[1]] == pytest.approx(expected, rel=1e-12)


def with_random_functionals(stepper, taps):
    """The stepper's taps with so many linear ones, whose functionals (taps, source) are random; and these."""
    rng, n_casing = np.random.default_rng(3), stepper.system.n_casing
    layout = TapLayout(stepper.system, stepper.model.surface, stepper.blocks, stepper.dt)
    sizes = dict(zip(SOURCES, (LANES, n_casing, n_casing, *[len(stepper.system.M)] * 2), strict=True))
    functionals = [{source: rng.normal(size=size) for source, size in sizes.items()} for _ in range(taps)]
    for number, rows in enumerate(functionals):
        in_z = {source: stepper.blocks.to_z(rows[source]) for source in ("position", "change")}
        layout.add(taps - 1 - number, **(rows | in_z))
    products = {source: layout.product(source) for source in SOURCES}
    linear = np.array(layout.linear, dtype=np.int64)
    return stepper.taps._replace(**products, linear=linear, sums=aligned(np.zeros(padded(taps)))), functionals


def test_linear_taps_are_the_sums_of_their_functionals(stepper):
    taps, functionals = with_random_functionals(stepper, 11)
    q, dt, start = three_states(stepper, 4), stepper.dt, stepper.system.casing_start
    taps.signals[:] = np.random.default_rng(5).normal(size=LANES)
    z, z_change = stepper.blocks.to_z(q[1]), stepper.blocks.to_z(0.5 * (q[2] - q[0]))
    sum_functionals(taps, coordinates_of(q), z, z_change, dt)
    acceleration = (q[2] - 2 * q[1] + q[0])[start:] / dt**2
    for number, rows in enumerate(functionals):
        parts = (
            rows["shaft"] @ taps.signals, rows["acceleration"] @ acceleration, rows["displacement"] @ q[1, start:],
            rows["position"] @ q[1], rows["change"] @ (q[2] - q[0]) / 2,
        )  # fmt: skip
        assert taps.sums[number] == pytest.approx(sum(parts), abs=1e-10 * max(np.abs(parts)))


def test_a_record_holds_force_torque_and_clearances_that_wear_and_opening_widen(stepper):
    taps, model, state = stepper.taps, stepper.model, stepper.state
    q = three_states(stepper, 6)
    now = motion_of(stepper, q[1])
    state.scratch.z_change[:] = 0.0

    def record(opening, worn):
        state.wear.depth[:] = worn
        out = np.full((len(DEFAULT_TAPS), STEPS), np.nan)
        record_taps(model, taps, coordinates_of(q), state, now, STEP, opening, 900.0, -40.0, out)
        assert np.isnan(np.delete(out, STEP, axis=1)).all()
        return out[:, STEP]

    usual, wide, worn = record(0.0, 0.0), record(1e-4, 0.0), record(0.0, 1e-4)
    assert np.isfinite(usual).all()
    assert taps.signals[CONTACT_FORCE] == 900.0
    assert taps.signals[CONTACT_TORQUE] == -40.0
    clearances = taps.rays.output
    assert len(clearances) == 2
    np.testing.assert_allclose((wide - usual)[clearances], 1e-4, rtol=1e-4)
    np.testing.assert_allclose(worn, wide, rtol=1e-12)
    others = np.setdiff1d(np.arange(len(usual)), clearances)
    np.testing.assert_array_equal(wide[others], usual[others])
    force = next(i for i, tap in enumerate(DEFAULT_TAPS) if tap.name == "contact_force")
    assert usual[force] == 900.0


def timing_at(angle, axial, chord_slope, blade):
    return Timing(
        np.array([angle]),
        np.array([axial]),
        chord_slope,
        0.3,
        np.array([[blade, blade + 1]] * 2)[:, None],
        np.zeros((3, 4)),
    )


def test_the_angle_beyond_a_probe_is_between_minus_and_plus_half_a_turn(stepper):
    timing, theta = timing_at(1.2, 0.0, 0.0, 0), np.linspace(-20, 20, 50)
    for step in range(50):
        for blade, place in enumerate(stepper.model.tips.angle):
            beyond = angle_beyond(stepper.model.tips, theta, timing, 0, blade, step, 0.07)
            assert abs(beyond) <= np.pi
            assert np.exp(1j * beyond) == pytest.approx(np.exp(1j * (theta[step] + place - 1.2 + 0.07)))


@pytest.mark.parametrize("chord_slope", [0.0, 0.4])
def test_a_blade_arrives_where_its_chord_stands_under_the_probe(stepper, chord_slope):
    """A blade that moves on a parabola: the root of its angle beyond the probe, by bisection, between two steps."""
    system, tips, blade, clock, axial = stepper.system, stepper.model.tips, 3, 1000, 5e-3
    theta = 0.4 + 2 * np.pi / STEPS * np.arange(3)
    rng, found = np.random.default_rng(7), 0
    for share in (0.05, 0.4, 0.77, 1.3, -0.2):
        q = np.zeros((3, len(system.M)))
        start, rate, bend = rng.normal(size=(3, 3)) * np.array([[3e-4], [2e-4], [1e-4]])
        q[:, 3 * blade : 3 * blade + 3] = [start - rate + bend, start, start + rate + bend]

        def chord(s, start=start, rate=rate, bend=bend):
            place = start + rate * s + bend * s * s + system.tip_static[blade]
            return place[1] - chord_slope * place[2], system.tip_radius + place[0]

        def stands_at(s, chord=chord):
            along, radial = chord(s)
            return (
                theta[0]
                + s * (theta[1] - theta[0])
                + tips.angle[blade]
                + np.arctan2(along + chord_slope * axial, radial)
            )

        probe = stands_at(share)
        timing = timing_at(np.mod(probe, 2 * np.pi), axial, chord_slope, blade)
        motions = tuple(motion_of(stepper, row) for row in q)
        assert is_near(tips, theta, timing, 0, blade, 0, motions[1].tips)
        count = record_arrivals(stepper.model.harmonics, tips, theta, timing, motions, 0, clock, 0)
        assert count == (0 <= share < 1)
        if count:
            number, seen, time, displacement = timing.arrivals[0]
            assert (number, seen) == (0, blade)
            assert time == pytest.approx(clock + share, abs=1e-4)
            assert displacement == pytest.approx(chord(share)[0], abs=1e-8)
            found += 1
    assert found == 3


def test_a_blade_far_from_the_probe_is_not_looked_at(stepper):
    tips, q = stepper.model.tips, np.zeros(len(stepper.system.M))
    for away in (-1.0, -0.31, 0.31, 1.0, 3.0):
        timing = timing_at(np.mod(tips.angle[2] - away, 2 * np.pi), 0.0, 0.0, 2)
        assert not is_near(tips, np.zeros(2), timing, 0, 2, 0, motion_of(stepper, q).tips)
