from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg as la

from rubgen import make_scenario
from rubgen.machine import Mistuning
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.floquet import quadratic_eigenvalues
from rubgen.solver.linear.rub_free import steady_state
from rubgen.solver.linear.stability import automatic_settle_turns, eigenvalues, stable_step, steps_per_turn
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper, start_opening


def exact_flow(system, seconds):
    """exp of the first-order form of M q'' + C q' + K q = 0."""
    n = system.M.shape[0]
    first_order = np.block(
        [[np.zeros((n, n)), np.eye(n)], [-la.solve(system.M, system.K), -la.solve(system.M, system.C)]]
    )
    return la.expm(first_order * seconds)


def free_vibration_error(system, steps):
    stepper = rub_free_stepper(system, ContactLaw(), steps)
    n = system.M.shape[0]
    rng = np.random.default_rng(3)
    deviation = np.concatenate([rng.normal(size=n) * 1e-5, rng.normal(size=n) * 1e-3])
    rest = steady_state(system)
    before = exact_flow(system, -stepper.dt) @ deviation
    stepper.set_coordinates(rest + before[:n], rest + deviation[:n])
    stepper.run_turn(np.full(steps + 2, 1e-2))
    exact = rest + (exact_flow(system, stepper.dt * steps) @ deviation)[:n]
    return np.abs(stepper.coordinates.now - exact).max() / np.abs(exact - rest).max()


def test_free_vibration_follows_the_matrix_exponential_with_second_order(small_system):
    errors = [free_vibration_error(small_system(), steps) for steps in (2048, 4096, 8192)]
    assert errors[-1] < 2e-3
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx([2, 2], abs=0.1)


def test_without_rub_the_blisk_turns_rigidly_and_the_casing_rests(small_system, operation):
    system = small_system(clearance=2e-3)
    response = integrate(system, operation(system, record_turns=120), ContactLaw(friction=0.1))
    assert response.status is Status.OK
    start = system.casing_start
    expected = la.solve(system.K[:start, :start], system.force[:start])
    assert np.hypot(*expected[system.centre : system.centre + 2]) > 1e-4
    np.testing.assert_allclose(response.section_q[:, :start] - expected, 0, atol=1e-11 * np.abs(expected).max())
    assert not response.section_q[:, start:].any()
    assert not response.section_v[:, start:].any()
    assert not response.impulse_per_turn.any()
    assert not response.contact_steps_per_turn.any()
    assert len(response.events.blade) == 0
    assert not response.taps["contact_force"].any()
    assert not response.taps["casing_acc_90"].any()
    assert response.energy.residual < 1e-12


def test_taps_of_a_run_without_rub_are_those_of_a_circular_whirl(small_system, operation):
    system = small_system(clearance=2e-3)
    response = integrate(system, operation(system, record_turns=100), ContactLaw())
    q = steady_state(system)
    centre = q[system.centre] + 1j * q[system.centre + 1]
    theta = 2 * np.pi * np.arange(100 * 256) / 256
    whirl = centre * np.exp(1j * theta)
    np.testing.assert_allclose(response.taps["blisk_x"] + 1j * response.taps["blisk_y"], whirl, atol=1e-13)
    support = (system.lateral_stiffness + 1j * system.speed * system.lateral_damping) * whirl
    measured = response.taps["support_force_x"] + 1j * response.taps["support_force_y"]
    np.testing.assert_allclose(measured, support, atol=1e-8 * np.abs(support).max())
    # At theta = 0 blade 0 stands on the ray at 0 degrees.
    radial = system.tip_radius + system.tip_static[0, 0] + q[0]
    gap = system.surface.mean_radius - 1e-3 - np.hypot(radial, q[1])
    assert response.taps["tip_clearance_0"][0] == pytest.approx(gap, abs=1e-12)


def test_the_clearance_on_a_ray_is_that_of_the_blade_which_passes_it(small_system):
    """In an unbalanced whirl every blade is another distance away; 384 steps put each of the six on both rays."""
    system = small_system(clearance=2e-3, ovality=2e-3)
    stepper = rub_free_stepper(system, ContactLaw(), 384)
    q = steady_state(system)[: 3 * system.n_blades].reshape(-1, 3) + system.tip_static
    radius = np.hypot(system.tip_radius + q[:, 0], q[:, 1])
    assert np.ptp(radius) > 1e-4
    stepper.run_turn()
    for tap, ray, undeformed in ((9, 0.0, -1e-3), (10, np.pi / 2, 1e-3)):
        passing = np.rint(np.mod(ray - system.blade_angles, 2 * np.pi) * 384 / (2 * np.pi)).astype(int) % 384
        expected = system.surface.mean_radius + undeformed - radius
        np.testing.assert_allclose(stepper.result.taps[tap, passing], expected, atol=1e-12)


@pytest.mark.parametrize("direction", [0.4, 2.5])
def test_the_clearance_of_a_shifted_round_casing_is_that_of_the_shifted_circle(small_system, direction):
    system = small_system(ovality=0.0, clearance=8e-3, unbalance=0.0)
    stepper, start = rub_free_stepper(system, ContactLaw(), 256), system.casing_start
    shift = 4e-3 * np.array([np.cos(direction), np.sin(direction)])
    q = steady_state(system)
    q[start : start + 2] = shift / system.casing_modes[0, 0, 0]  # cos t and sin t move the ring along X and Y
    stepper.set_coordinates(q, q)
    stepper.run_turn(np.full(258, 3e-4))
    tip = system.tip_radius + system.tip_static[0, 0]
    for ray, (along, across) in ((9, shift), (10, shift[::-1])):
        exact = along + np.sqrt((system.surface.mean_radius + 3e-4) ** 2 - across**2) - tip
        # Third order, 4 mm (4 / 208)^2 / 2, and the interpolation between 36 nodes; the second order is up to 38 um.
        assert stepper.result.taps[ray, 0] == pytest.approx(exact, abs=1e-6)


def test_the_clearance_of_a_bent_casing_is_to_where_the_ray_meets_the_curve(small_system):
    """The casing turned by 50 degrees, shifted and ovalised: the point of the exact curve that lies on the ray."""
    system = small_system(ovality=6e-3, clearance=8e-3, unbalance=0.0, turned_nodes=5)
    stepper, start = rub_free_stepper(system, ContactLaw(), 256), system.casing_start
    q = steady_state(system)
    q[start : start + 4] = np.array([1.5e-3, -1e-3, 1e-3, 1.5e-3]) / np.hypot(*system.casing_modes[0, :, 0])
    stepper.set_coordinates(q, q)
    stepper.run_turn()
    nodes = 2 * np.pi * np.arange(36) / 36
    undeformed = system.surface.mean_radius - 3e-3 * np.cos(2 * (nodes - 5 * np.pi / 18))
    at_nodes = undeformed * np.exp(1j * nodes) + system.casing_modes @ q[start:] @ [1, 1j]
    orders, weights = np.fft.fftfreq(36, 1 / 36), np.fft.fft(at_nodes) / 36
    t = np.linspace(0, 2 * np.pi, 20001)
    curve = np.exp(1j * np.multiply.outer(t, orders)) @ weights
    tip = system.tip_radius + system.tip_static[0, 0]
    for tap, ray in ((9, 0.0), (10, np.pi / 2)):
        off = np.angle(curve * np.exp(-1j * ray))
        near = np.argsort(np.abs(off))[:8]
        exact = np.polyval(np.polyfit(off[near], np.abs(curve[near]), 2), 0.0) - tip
        # Left out are u_t^2 (r'' + u_r'') / (2 r^2) and the interpolation; u_r' u_t / r is up to 40 um.
        assert stepper.result.taps[tap, 0] == pytest.approx(exact, abs=2e-6)


def test_settle_turns_follow_from_the_slowest_decay(small_system):
    system = small_system()
    flow = exact_flow(system, 1.0)
    slowest = -np.log(np.abs(la.eigvals(flow)).max())
    expected = 40 + np.log(100) * system.speed / (2 * np.pi) / slowest
    assert automatic_settle_turns(system, 40) == int(np.ceil(expected))


def test_eigenvalues_solve_the_quadratic_pencil(small_system):
    system = small_system()
    for s in eigenvalues(system)[::7]:
        pencil = s**2 * system.M + s * system.C + system.K
        singular = la.svdvals(pencil)
        assert singular[-1] < 1e-9 * singular[0]


@pytest.mark.parametrize("mistuning", [None, Mistuning(relative_std=0.01, seed=3)])
def test_eigenvalues_by_blocks_are_those_of_the_whole_matrices(mistuning):
    """Equal blades leave many small blocks, mistuned ones a large one."""
    machine = make_scenario("zeng2019").machine
    machine = replace(machine, blades=replace(machine.blades, mistuning=mistuning))
    system = reduce(machine, Reduction()).at_speed(1000.0)
    whole = quadratic_eigenvalues(system.M, system.C, system.K)
    found = eigenvalues(system)
    assert found.size == whole.size
    away = np.abs(whole[:, None] - found)
    assert (away.min(axis=0) / np.abs(found)).max() < 1e-9
    assert (away.min(axis=1) / np.abs(whole)).max() < 1e-9


def test_the_step_is_halved_for_stability_and_for_the_sample_rate(small_system):
    system = small_system()
    symmetric = (system.K + system.K.T) / 2
    highest = np.sqrt(la.eigvals(la.solve(system.M, symmetric)).real.max())
    assert stable_step(system) == pytest.approx(2 / highest, rel=1e-9)
    turn = 2 * np.pi / system.speed
    assert 64 * 0.95 * 2 / highest < turn <= 128 * 0.95 * 2 / highest
    assert steps_per_turn(system, 8) == 128
    assert steps_per_turn(system, 384) == 384
    rate = 1000 / turn / 2.56
    assert steps_per_turn(system, 500, rate) == 1000
    assert steps_per_turn(system, 500, rate * 1.001) == 2000


def test_the_stable_step_is_the_casings_where_that_is_the_stiffer(small_system):
    system = small_system()
    start = system.casing_start
    system.K[start:, start:] *= 1e6
    assert stable_step(system) == pytest.approx(2 / (1e3 * 2 * np.pi * 390.0), rel=1e-9)


def test_an_unstable_linear_system_is_refused_with_its_growth(small_system, operation):
    system = small_system(lateral_damping=-0.01)
    largest = eigenvalues(system).real.max()
    assert largest > 0
    response = integrate(system, operation(system), ContactLaw())
    assert response.status is Status.UNSTABLE
    assert f"{largest:.4g} 1/s" in response.reason
    with pytest.raises(ValueError, match="grows by itself"):
        automatic_settle_turns(system, 40)


def test_the_clearance_closes_smoothly_from_where_nothing_touches(small_system):
    system = small_system(clearance=-5e-5)
    x = np.linspace(0, 1, 2001)
    ramp = closing_ramp(x)
    assert ramp[0] == 1
    assert ramp[-1] == 0
    assert np.all(np.diff(ramp) <= 0)
    bend = np.gradient(np.gradient(ramp, x), x)
    assert abs(bend[2]) < 0.2
    assert abs(bend[-3]) < 0.2
    q = steady_state(system)[: 3 * system.n_blades].reshape(-1, 3) + system.tip_static
    radius = np.hypot(system.tip_radius + q[:, 0], q[:, 1]).max()
    narrowest = system.surface.mean_radius - 1e-3
    assert narrowest + start_opening(system) - radius == pytest.approx(2.5e-4 * system.tip_radius)
