"""A changing speed, against integrations in the inertial frame, closed forms, and the steady runs."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.special import fresnel

from rubgen.errors import UserError
from rubgen.measurement.channel import Channel, Recording
from rubgen.measurement.motion import motion_frames
from rubgen.reduction.model import CasingSurface, SpinningSystem
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.solver.speed import driver
from rubgen.solver.wants import Wants
from rubgen.units import rev_per_min

MASS, STIFFNESS, UNBALANCE = 10.0, 1e7, 2e-4
CRITICAL = np.sqrt(STIFFNESS / MASS)


class At:
    """A model of systems that a function makes."""

    def __init__(self, build):
        self.build = build

    def at_speed(self, speed, acceleration=0.0):
        return self.build(speed, acceleration)


def jeffcott_at(damping):
    """A Jeffcott rotor at any speed and acceleration, with one massless idle "tip" far from a ring."""
    whirl = np.array([[0.0, -1.0], [1.0, 0.0]])
    drag = 2 * damping * np.sqrt(STIFFNESS * MASS)

    def build(speed, acceleration):
        M, C, K = np.eye(7), 100 * np.eye(7), 1e6 * np.eye(7)
        o = slice(3, 5)
        M[o, o] = MASS * np.eye(2)
        C[o, o] = 2 * speed * MASS * whirl + drag * np.eye(2)
        K[o, o] = (STIFFNESS - speed**2 * MASS) * np.eye(2) + (speed * drag + acceleration * MASS) * whirl
        force = np.zeros(7)
        force[o] = UNBALANCE * speed**2, -UNBALANCE * acceleration
        modes = np.zeros((12, 2, 2))
        modes[:] = np.eye(2)
        return SpinningSystem(
            speed=speed,
            M=M,
            C=C,
            K=K,
            force=force,
            n_blades=1,
            n_casing=2,
            tip_radius=0.5,
            blade_angles=np.zeros(1),
            tip_static=np.zeros((1, 3)),
            surface=CasingSurface(mean_radius=0.6, amplitude=np.zeros(1), order=np.full(1, 2.0), phase=np.zeros(1)),
            casing_modes=modes,
            lateral_stiffness=STIFFNESS,
            lateral_damping=drag,
        )

    return build


def run_jeffcott(operation, damping):
    build = jeffcott_at(damping)
    response = integrate(At(build), operation, ContactLaw(), Wants(tail_seconds=operation.duration_s))
    assert response.status is Status.OK
    return response


def inertial_orbit(rotation, damping, times):
    """Complex displacement and velocity of the rotor at `times` from 0 on, started from its steady whirl."""
    drag = 2 * damping * np.sqrt(STIFFNESS * MASS)

    def rate(time, state):
        speed, push = float(rotation.speed(time)), float(rotation.acceleration(time))
        force = UNBALANCE * (speed**2 - 1j * push) * np.exp(1j * float(rotation.angle(time)))
        return [state[1], (force - drag * state[1] - STIFFNESS * state[0]) / MASS]

    speed = rotation.start
    whirl = UNBALANCE * speed**2 / (STIFFNESS - MASS * speed**2 + 1j * drag * speed)
    solution = solve_ivp(
        rate, (0, times[-1]), [whirl + 0j, 1j * speed * whirl], method="DOP853", t_eval=times, rtol=1e-10, atol=1e-16
    )
    return solution.y


def record_taps(response):
    steps = response.changing_speed.turn_steps[-1]
    return response.taps["blisk_x"][-steps:] + 1j * response.taps["blisk_y"][-steps:]


@pytest.mark.parametrize(("start", "end"), [(700.0, 1300.0), (1300.0, 700.0)])
def test_a_rotor_passes_its_critical_speed_as_in_the_inertial_frame(start, end):
    profile = "run-up" if end > start else "coast-down"
    operation = Operation(
        profile=profile, speed_rpm=rev_per_min(start), end_speed_rpm=rev_per_min(end), duration_s=0.6, settle_turns=3
    )
    response = run_jeffcott(operation, 0.02)
    rotation, dt = response.changing_speed.rotation, response.dt
    orbit = record_taps(response)
    times = np.arange(orbit.size) * dt
    exact = inertial_orbit(rotation, 0.02, times)[0]
    # Second order in dt: a phase error of (omega dt)^2 / 24 rad per rad, 1e-6 over 600 rad, and the parts' steps.
    np.testing.assert_allclose(orbit, exact, atol=2e-3 * np.abs(exact).max())
    peak, exact_peak = np.abs(orbit).argmax(), np.abs(exact).argmax()
    assert np.abs(orbit).max() == pytest.approx(np.abs(exact).max(), rel=1e-4)
    assert rotation.speed(times[peak]) == pytest.approx(rotation.speed(times[exact_peak]), rel=1e-3)
    assert (rotation.speed(times[peak]) - CRITICAL) * (end - start) > 0
    assert response.energy.residual < 1e-10


def test_the_track_holds_the_true_motion_of_whole_turns():
    """Without contact the first eight turns of the signals; each part of a turn gives its share of frames."""
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(700), end_speed_rpm=rev_per_min(1300), duration_s=0.3, settle_turns=3
    )
    build = jeffcott_at(0.02)
    response = integrate(At(build), operation, ContactLaw(), Wants(tail_seconds=0.1))
    track, changing, orbit = response.track, response.changing_speed, record_taps(response)
    turn = np.searchsorted(changing.turn_steps, track.step, side="right") - 1
    begin = changing.turn_steps[-1] - 0.1 / response.dt
    assert np.unique(turn).tolist() == list(range(turn[0], turn[0] + 8))
    assert np.unique(turn, return_counts=True)[1].min() >= 32
    assert changing.turn_steps[turn[0] - 1] < begin <= changing.turn_steps[turn[0]] == track.step[0]
    theta = changing.rotation.angle(track.step * response.dt)
    place = np.exp(1j * theta) * (track.q[:, 3] + 1j * track.q[:, 4])
    np.testing.assert_allclose(place, orbit[track.step], rtol=0, atol=1e-12 * np.abs(orbit).max())
    assert track.tip_growth.shape == (response.record_turns, 1, 3)

    start = (changing.turn_steps[-1] - 1) * response.dt - 0.1  # as of sensors that record the last 0.1 s
    silent = Channel(
        name="", unit="", quantity="", axis="", location="", range_min=0.0, range_max=0.0, resolution=0.0,
        noise_rms=0.0,
        values=np.zeros(100, np.float32),
    )  # fmt: skip
    recording = Recording(
        sample_rate_hz=1e3, rotation_angle=0.0, channels={"": silent}, once_per_rev=np.zeros(0), start_seconds=start
    )
    frames = motion_frames(response, recording)
    assert frames.dense.sum() == track.step.size
    assert 3 < (frames.dense == 0).sum() <= 48
    assert frames.angle[frames.dense == 0] == pytest.approx(0)
    step = (frames.time + start) / response.dt
    place = np.exp(1j * frames.angle) * (frames.centre[:, 0] + 1j * frames.centre[:, 1])
    seen = np.interp(step, np.arange(orbit.size), orbit)
    # Sections lie at theta = 0, up to half a step from the step that dates them.
    turned = 0.6 * changing.rotation.fastest * response.dt * np.abs(orbit).max()
    np.testing.assert_allclose(place, seen, rtol=0, atol=turned)

    growth = np.arange(1.0, response.record_turns + 1)[:, None, None] * [1.0, 0.0, 0.0]  # of each turn its number
    grown = motion_frames(replace(response, track=replace(track, tip_growth=growth)), recording)
    number = np.searchsorted(changing.turn_steps, np.rint(step), side="right")
    np.testing.assert_allclose((grown.tips - frames.tips)[:, 0, 0], number, rtol=0, atol=1e-9)
    assert len(set(number.tolist())) > 10


def test_the_growth_of_the_tips_in_the_track_follows_the_speed():
    """Made to be 1 nm (rad/s)^-2 Omega^2; a part of a turn stands for speeds within 0.02 %."""
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(700), end_speed_rpm=rev_per_min(1300), duration_s=0.6, settle_turns=3
    )
    build = jeffcott_at(0.02)

    def growing(speed, acceleration):
        return replace(build(speed, acceleration), tip_static=np.array([[1e-9 * speed**2, 0.0, 0.0]]))

    response = integrate(At(growing), operation, ContactLaw(), Wants(tail_seconds=0.05))
    speed = response.changing_speed.rotation.speed(response.changing_speed.turn_steps[:-1] * response.dt)
    np.testing.assert_allclose(response.track.tip_growth[:, 0, 0], 1e-9 * speed**2, rtol=3e-4)
    assert speed[-1] > 1.5 * speed[0]


def test_without_damping_the_peak_lags_by_what_the_fresnel_integral_says():
    """A' = e Omega^2 / (2 i omega) exp(i alpha t^2 / 2): the peak is at w = 1.2172, alpha t^2 = pi w^2."""
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(800), end_speed_rpm=rev_per_min(1200), duration_s=1.0, settle_turns=3
    )
    response = run_jeffcott(operation, 1e-5)
    rotation, orbit = response.changing_speed.rotation, record_taps(response)
    w = np.linspace(1.0, 1.5, 5001)
    cornu = np.abs((0.5 + 0.5j) + np.array([c + 1j * s for s, c in zip(*fresnel(w), strict=True)]))
    lag = np.sqrt(np.pi * rotation.rate) * w[cornu.argmax()]
    amplitude = UNBALANCE / MASS * CRITICAL / 2 * np.sqrt(np.pi / rotation.rate) * cornu.max()
    peak = float(rotation.speed(np.abs(orbit).argmax() * response.dt))
    # The closed form is of first order in sqrt(alpha) / omega, here 2 %; the orbit's beat shifts its largest value.
    assert peak - CRITICAL == pytest.approx(lag, rel=0.1)
    assert np.abs(orbit).max() == pytest.approx(amplitude, rel=0.06)


def test_the_section_is_taken_where_theta_is_0_between_the_steps():
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(700), end_speed_rpm=rev_per_min(1300), duration_s=0.3, settle_turns=3
    )
    response = run_jeffcott(operation, 0.02)
    rotation = response.changing_speed.rotation
    arrivals = np.array([rotation.time_of(2 * np.pi * turn) for turn in range(response.record_turns)])
    off = arrivals / response.dt - response.changing_speed.turn_steps[:-1]
    assert np.abs(off).max() > 0.4
    u, v = inertial_orbit(rotation, 0.02, arrivals)
    v = v - 1j * rotation.speed(arrivals) * u  # seen from the turning frame
    q = response.section_q[:, 3] + 1j * response.section_q[:, 4]
    w = response.section_v[:, 3] + 1j * response.section_v[:, 4]
    np.testing.assert_allclose(q, u, atol=2e-3 * np.abs(u).max())
    np.testing.assert_allclose(w, v, atol=2e-3 * np.abs(v).max() + 2e-5 * CRITICAL * np.abs(u).max())


def test_the_error_of_parts_falls_with_the_square_of_their_length(monkeypatch):
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(700), end_speed_rpm=rev_per_min(1000), duration_s=0.8, settle_turns=3
    )
    ends = []
    for share in (2e-4, 4e-4, 8e-4):
        monkeypatch.setattr(driver, "SPEED_SHARE", share)
        ends.append(record_taps(run_jeffcott(operation, 0.05))[-8000:-2000])
    fine, coarse = (np.abs(ends[i + 1] - ends[i]).max() for i in (0, 1))
    assert fine < 1e-4 * np.abs(ends[0]).max()
    assert coarse / fine > 3.5


def small_at(small_system, **options):
    """The small system at any speed and acceleration: its Coriolis matrix is the skew part of C over 2 Omega."""

    def build(speed, acceleration):
        system = small_system(speed=speed, **options)
        mass, start = 0.05, system.casing_start
        G = (system.C - system.C.T) / (4 * speed)
        system.K[:start, :start] += acceleration * G[:start, :start]
        system.force[1 : 3 * system.n_blades : 3] -= acceleration * mass * system.tip_radius
        system.force[system.centre + 1] -= acceleration * system.force[system.centre] / speed**2
        return system

    return build


def test_the_slower_the_ramp_the_nearer_to_the_steady_run(small_system):
    build = small_at(small_system, clearance=5e-5, casing_damping=0.4)
    law = ContactLaw(friction=0.1)
    steady = Operation(speed_rpm=rev_per_min(400), record_turns=40, steps_per_turn=256)
    expected = integrate(build(400.0, 0.0), steady, law)
    assert expected.contact_steps_per_turn.min() > 0
    errors = []
    for rise in (1e-7, 1e-6):
        ramp = Operation(
            profile="run-up",
            speed_rpm=rev_per_min(400),
            end_speed_rpm=rev_per_min(400 * (1 + rise)),
            duration_s=2 * np.pi * 39.5 / 400,
            steps_per_turn=256,
        )
        found = integrate(At(build), ramp, law)
        assert found.record_turns == 40
        np.testing.assert_allclose(found.impulse_per_turn, expected.impulse_per_turn, rtol=1e-5)
        errors.append(np.abs(found.section_q - expected.section_q).max() / np.abs(expected.section_q).max())
    assert errors[0] < 1e-5
    assert errors[1] / errors[0] == pytest.approx(10, rel=0.03)


@pytest.mark.parametrize(
    "keys",
    [
        {"profile": "run-up", "end_speed_rpm": rev_per_min(480)},
        {"profile": "coast-down", "end_speed_rpm": rev_per_min(330)},
        {"profile": "fluctuating", "fluctuation_rpm": rev_per_min(20), "fluctuation_period_s": 0.2},
    ],
)
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_the_energy_identity_holds_while_the_speed_changes_and_blades_rub(small_system, keys, restitution):
    build = small_at(small_system, clearance=5e-5)
    operation = Operation(speed_rpm=rev_per_min(400), duration_s=0.6, steps_per_turn=256, settle_turns=50, **keys)
    law = ContactLaw(friction=0.1, restitution=restitution)
    response = integrate(At(build), operation, law)
    assert response.status is Status.OK
    assert response.contact_steps_per_turn.sum() > 50
    assert response.energy.residual < 1e-12
    assert abs(response.energy.speed_change) > 100 * response.energy.residual * response.energy.absolute_work
    assert response.energy.friction_loss < 0
    impulse = response.events.impulse.sum()
    assert impulse == pytest.approx(response.impulse_per_turn.sum(), rel=1e-9)
    last = response.events.start_step + response.events.steps
    assert response.events.start_step.min() >= 0
    assert last.max() <= response.changing_speed.turn_steps[-1]


def test_an_angular_acceleration_bends_the_blades_back(small_system):
    """Damped out, the blades follow K(Omega, Omega') q = force(Omega, Omega'): f_t / k behind the unloaded place."""
    build = small_at(small_system, clearance=3e-3, unbalance=0.0)
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(400), end_speed_rpm=rev_per_min(500), duration_s=1.0, steps_per_turn=256
    )
    response = integrate(At(build), operation, ContactLaw())
    tangential = response.section_q[:, 1:18:3]
    speed = float(response.changing_speed.rotation.speed(response.changing_speed.turn_steps[-2] * response.dt))
    behind = -100.0 * 0.05 * 0.2 / (1.5e6 - 0.05 * speed**2)
    np.testing.assert_allclose(tangential[-1], behind, rtol=1e-3)


def test_a_speed_at_which_the_system_grows_by_itself_is_refused(small_system):
    def build(speed, _):
        return small_system(speed=speed, lateral_damping=0.1 if speed < 450 else -0.01)

    operation = Operation(profile="run-up", speed_rpm=rev_per_min(400), end_speed_rpm=rev_per_min(500), duration_s=0.2)
    response = integrate(At(build), operation, ContactLaw())
    assert response.status is Status.UNSTABLE
    assert "1/s at 4" in response.reason or "1/s at 5" in response.reason


def test_what_is_missing_for_a_changing_speed_is_said(small_system):
    system = small_system()
    operation = Operation(profile="run-up", speed_rpm=rev_per_min(400), end_speed_rpm=rev_per_min(500), duration_s=0.2)
    with pytest.raises(TypeError, match="needs a model with at_speed"):
        integrate(system, operation, ContactLaw())
    bad = Operation(profile="run-up", speed_rpm=rev_per_min(400), duration_s=0.2)
    with pytest.raises(UserError, match=r"operation\.end_speed_rpm: .* add it"):
        integrate(system, bad, ContactLaw())
