"""Uneven supports, squeeze film and gravity: the start keeps, works are booked, wrong machines are refused."""

import numpy as np
import pytest
import scipy.linalg as la
from scipy.integrate import quad

from rubgen.machine import SqueezeFilm
from rubgen.reduction.model import TurningForces
from rubgen.scenario import ContactLaw
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.floquet import quadratic_eigenvalues
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import eigenvalues, slowest_decay, stable_step
from rubgen.solver.speed.start import rub_free_stepper, start_opening
from rubgen.solver.supports.turning_forces import turning_force

CASES = ("gravity", "springs", "dampers", "film", "crack", "loads", "all")
SETTLING = ("loose", "whirl")


@pytest.fixture(scope="module", params=(*CASES, *SETTLING))
def rub(request, small_system, turning, operation):
    """A run in contact with each kind of force, and with all on blades that differ."""
    system = small_system(speed=500.0, uneven_blade=0.05 if request.param == "all" else 0.0)
    system = turning(system, request.param)
    run = integrate(system, operation(system, record_turns=20, settle_turns=60), ContactLaw(friction=0.1))
    return request.param, run


def test_the_rub_happens_and_every_work_is_booked(rub):
    case, run = rub
    assert run.status is Status.OK
    assert run.impulse_per_turn.min() > 0.1
    balance = run.energy
    works = balance.unbalance + balance.damping + balance.circulatory + balance.contact
    works += balance.anisotropy + balance.support_laws + balance.gravity + balance.faults
    assert balance.residual < 1e-11
    assert abs(balance.end - balance.start - works) <= 1e-11 * balance.absolute_work
    share = 1e-7 * balance.absolute_work
    assert (abs(balance.gravity) > share) is (case in ("gravity", "crack", "all"))
    assert (abs(balance.faults) > share) is (case in ("loads", "all"))
    assert (abs(balance.anisotropy) > share) is (case in ("springs", "dampers", "all"))
    assert (abs(balance.support_laws) > share) is (case in ("film", "loose", "crack", "whirl", "all"))
    if case in ("film", "all"):
        assert balance.support_laws_loss < -share
    elif case == "whirl":  # the journal drives the oil
        assert balance.support_laws_loss > share
    elif case != "crack":  # a spring at rest gives back what it takes, but for the energy that it holds at the end
        assert abs(balance.support_laws_loss) <= 0.5 * 4e6 * 3e-4**2 * (case == "loose")


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("uneven", [0.0, 0.05])
def test_a_run_keeps_the_rub_free_motion_from_which_it_starts(small_system, turning, case, uneven):
    system = turning(small_system(clearance=5e-3, uneven_blade=uneven), case)
    stepper = rub_free_stepper(system, ContactLaw(), 256, start_angle=0.3)
    motion = rub_free_motion(system, 256)
    assert motion.residual < 1e-11
    for _ in range(5):
        assert stepper.run_turn()[0] == 0
    q = motion.at(0.3)
    np.testing.assert_allclose(stepper.coordinates.now, q, rtol=0, atol=1e-11 * np.abs(q).max())
    assert stepper.result.summary[0] == 0


def test_the_schemes_motion_tends_to_the_exact_one_with_second_order(small_system, turning):
    system = turning(small_system(), "all")
    exact = rub_free_motion(system).at(1.0)
    errors = [np.abs(rub_free_motion(system, steps).at(1.0) - exact).max() for steps in (256, 512, 1024)]
    assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx([2, 2], abs=0.02)


def test_no_forces_is_what_forces_of_zero_are(small_system, turning):
    system = small_system(speed=500.0)
    ends = []
    for each in (system, turning(system, "springs", stiffness=0.0)):
        stepper = rub_free_stepper(each, ContactLaw(friction=0.1), 256)
        for turn in range(5):
            stepper.run_turn(np.full(258, 4e-4 * (1 - turn / 5)))
        assert stepper.result.summary[0] > 0
        assert stepper.model.support.active is (each.turning is not None)
        ends.append(stepper.coordinates.now)
    np.testing.assert_allclose(ends[1], ends[0], rtol=0, atol=1e-11 * np.abs(ends[0]).max())


def test_the_opening_of_the_start_regards_the_whole_turn(small_system, turning):
    system = turning(small_system(clearance=0.0, unbalance=0.0), "gravity", gravity=2000.0)
    sag = -rub_free_motion(system).at(0.0)[system.centre + 1]
    assert sag > 1e-3
    assert start_opening(system) > sag


def test_the_support_force_taps_hold_all_that_the_support_bears(small_system, turning):
    """Without rub and drag of blades, what the support bears is the weight and the unbalance's inertia."""
    system = turning(small_system(clearance=5e-3), "all", loads=0.0)
    stepper = rub_free_stepper(system, ContactLaw(), 512)
    stepper.run_turn()
    fx, fy = stepper.result.taps[6:8]
    mass = 8.0 + 6 * 0.05
    assert fx.mean() == pytest.approx(0.0, abs=1e-9 * mass * 9.81)
    # The scheme's second difference of a once-per-turn motion is (2 pi / 512)^2 / 12 = 1.3e-5 less than the derivative.
    assert fy.mean() == pytest.approx(-mass * 9.81, rel=1.3e-5)


@pytest.mark.parametrize("share", [0.0, 0.3, 0.8])
def test_film_coefficients_are_the_integrals_of_the_short_bearings_pressure(share):
    """Integral over the film's length of p = 6 mu (z^2 - L^2 / 4) h' / h^3 is -mu L^3 h' / h^3, h = c - e cos phi."""
    film = SqueezeFilm(radius_m=0.05, length_m=0.02, clearance_m=2e-4, viscosity_pa_s=0.02)
    e = share * film.clearance_m

    def coefficient(shape):
        integral = quad(lambda phi: shape(phi) ** 2 / (film.clearance_m - e * np.cos(phi)) ** 3, 0, 2 * np.pi)[0]
        return film.viscosity_pa_s * film.radius_m * film.length_m**3 * integral

    direction = np.array([np.cos(1.1), np.sin(1.1)])
    across = np.array([-direction[1], direction[0]])
    velocity = 0.03 * direction - 0.02 * across
    found = turning_force(TurningForces(laws=(film,)), 0.0, np.zeros(()), e * direction, velocity)
    expected = -0.03 * coefficient(np.cos) * direction + 0.02 * coefficient(np.sin) * across
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_floquet_exponents_are_the_inertial_eigenvalues_where_there_are_any(small_system, turning):
    """With equal blades the blisk has constant matrices in the inertial frame.

    Decay rates are compared: the turn of the frame shifts imaginary parts alone.
    """
    system = turning(small_system(), "springs")
    forces = system.turning
    turned = np.sort(eigenvalues(system).real)
    start = system.casing_start
    assert len(turned) == 2 * len(system.M)
    inertial = inertial_eigenvalues(system, forces)
    casing = quadratic_eigenvalues(*(X[start:, start:] for X in (system.M, system.C, system.K))).real
    expected = np.sort(np.concatenate([inertial.real, casing]))
    slow = expected > -120  # the scheme's own decay of faster motions differs by (omega dt)^2 / 12
    np.testing.assert_allclose(turned[slow], expected[slow], rtol=2e-3)


def inertial_eigenvalues(system, forces):
    """Eigenvalues of the blisk by blade motions as fields that stand still in the inertial frame.

    q = R(theta) p with R' = Omega J R, where M, C, K commute with J: equal blades.
    """
    blades, start = system.n_blades, system.casing_start
    M, C, K = (X[:start, :start].copy() for X in (system.M, system.C, system.K))
    J = np.zeros((start, start))
    k = np.arange(blades)
    F = np.exp(2j * np.pi * np.outer(k, np.fft.fftfreq(blades, 1 / blades)) / blades) / np.sqrt(blades)
    order = np.fft.fftfreq(blades, 1 / blades)
    order[blades // 2] = 0  # the alternating pattern stays with the blades
    turn = (F @ np.diag(1j * order) @ F.conj().T).real
    for a in range(3):
        J[a : 3 * blades : 3, a : 3 * blades : 3] = turn
    J[-2:, -2:] = [[0, 1], [-1, 0]]  # coordinates of the turning frame of a vector at rest in the inertial one
    omega = system.speed
    E = np.eye(start)[:, -2:]
    uneven = np.diag([forces.stiffness, -forces.stiffness])
    C_in, K_in = 2 * omega * M @ J + C, omega**2 * M @ J @ J + omega * C @ J + K + E @ uneven @ E.T
    for X in (M, C, K):
        np.testing.assert_allclose(X @ J, J @ X, atol=1e-9 * np.abs(X).max())
    A = np.block([[np.zeros_like(M), np.eye(start)], [-la.solve(M, K_in), -la.solve(M, C_in)]])
    return la.eigvals(A)


def test_uneven_dampers_that_push_are_refused_with_the_growth(small_system, turning, operation):
    system = turning(small_system(lateral_damping=0.002), "dampers", damping=900.0)
    assert system.lateral_damping < 900.0
    growth = -slowest_decay(system)
    assert growth > 0
    run = integrate(system, operation(system), ContactLaw())
    assert run.status is Status.UNSTABLE
    assert f"{growth:.4g} 1/s" in run.reason


def test_the_stiffer_direction_limits_the_step(small_system, turning):
    system = small_system()
    expected = [stable_step(turning(system, "springs", stiffness=k)) for k in (0.0, 2e6, -2e6)]
    assert expected[0] >= expected[1] == expected[2]


def test_a_weight_that_the_film_cannot_hold_is_refused(small_system, turning, operation):
    narrow = SqueezeFilm(radius_m=0.05, length_m=0.01, clearance_m=1e-5, viscosity_pa_s=0.05)
    system = turning(small_system(unbalance=0.0), "all", film=narrow)
    run = integrate(system, operation(system), ContactLaw())
    assert run.status is Status.FILM_CLOSED
    assert "no rub-free motion inside it" in run.reason


def test_a_disk_that_is_thrown_through_the_film_ends_the_run(small_system, turning, operation):
    """A film of 1 nm more than the free orbit, of hardly any oil: the first hard contact goes through it."""
    system = small_system(speed=500.0)
    orbit = np.hypot(*rub_free_motion(system).at(0.0)[system.centre : system.centre + 2])
    thin = SqueezeFilm(radius_m=0.05, length_m=0.001, clearance_m=1.01 * orbit, viscosity_pa_s=1e-9)
    system = turning(system, "film", film=thin)
    run = integrate(system, operation(system, record_turns=20), ContactLaw(friction=0.1))
    assert run.status is Status.FILM_CLOSED
    assert "in turn" in run.reason
