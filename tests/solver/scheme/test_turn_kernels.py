"""What a turn sums, records and leaves, against the same of single steps."""

import numpy as np
import pytest

from rubgen.scenario import ContactLaw
from rubgen.solver.scheme.state_kernels import OK, Snapshots
from rubgen.solver.scheme.turn_kernels import (
    BLADE,
    COSINE,
    FRICTION_LOSS,
    IMPULSE,
    NORMAL_LOSS,
    SINE,
    START,
    STEPS,
    Touches,
    add_orbit,
    add_touch,
    close_touches,
    record_frame,
    record_section,
    run_turn,
)
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.taps import DEFAULT_TAPS

TURN = 96
SPEED = 500.0


def no_touches(blades):
    return Touches(np.zeros((blades, 8)), np.zeros(blades, dtype=np.int64), np.zeros((400, 8)))


def test_a_touch_is_a_run_of_steps_with_force_on_one_blade():
    rng = np.random.default_rng(1)
    blades, steps, first = 4, 60, 500
    presses = rng.random((steps, blades)) < 0.6
    psi, impulse, friction, normal = rng.normal(size=(4, steps, blades))
    touches, ended = no_touches(blades), 0
    for step, blade in np.argwhere(presses).tolist():
        at = step, blade
        ended = add_touch(touches, blade, first + step, psi[at], impulse[at], friction[at], normal[at], ended)
    under_way = np.flatnonzero(presses[-1])
    ended = close_touches(touches, first + steps - 1, ended)
    assert set(np.flatnonzero(touches.open[:, STEPS])) == set(under_way)
    ended = close_touches(touches, first + steps, ended)
    assert not touches.open[:, STEPS].any()
    expected = []
    for blade in range(blades):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], presses[:, blade].astype(int), [0]])))
        for start, end in edges.reshape(-1, 2):
            part = slice(start, end), blade
            row = np.zeros(8)
            row[[BLADE, START, STEPS]] = blade, first + start, end - start
            row[COSINE], row[SINE] = (impulse[part] * [np.cos(psi[part]), np.sin(psi[part])]).sum(axis=1)
            row[IMPULSE], row[FRICTION_LOSS], row[NORMAL_LOSS] = (x[part].sum() for x in (impulse, friction, normal))
            expected.append(row)
    assert ended == len(expected) > 30
    found = touches.ended[:ended]
    np.testing.assert_allclose(found[np.lexsort((found[:, START], found[:, BLADE]))], expected, atol=1e-12)


def test_orbit_sums_of_a_circle():
    """r = (x0 + a cos wt, y0 + a sin wt): mean square radius and velocity, and the areal velocity a^2 w."""
    count, a, w, x0, y0 = 50, 3e-4, -200.0, 2e-5, -4e-5
    out = np.zeros(5)
    for angle in 2 * np.pi * np.arange(count) / count:
        x, y, vx, vy = x0 + a * np.cos(angle), y0 + a * np.sin(angle), -a * w * np.sin(angle), a * w * np.cos(angle)
        add_orbit(np.array([x, y, 0.0, 0.0, 0.0, 0.0, vx, vy]), out)
    expected = [x0, y0, x0**2 + y0**2 + a**2, (a * w) ** 2, a**2 * w]
    np.testing.assert_allclose(out / count, expected, rtol=1e-12)


@pytest.mark.parametrize(("frames", "steps"), [(1, 7), (5, 7), (7, 7), (32, 100), (3, 128)])
def test_frames_are_the_first_steps_at_or_after_equal_shares_of_a_turn(frames, steps):
    out, done = np.full((frames, 4), np.nan), 0
    for step in range(steps):
        done = record_frame(out, done, step, steps, np.full(4, float(step)))
    assert done == frames
    np.testing.assert_array_equal(out[:, 0], np.ceil(np.arange(frames) * steps / frames))


@pytest.mark.parametrize("tau", [0.0, 0.37, -0.5])
def test_the_section_of_a_parabola_is_exact(small_system, tau):
    stepper, rng = rub_free_stepper(small_system(), ContactLaw(), TURN), np.random.default_rng(2)
    start, rate, bend = rng.normal(size=(3, len(stepper.system.M))) * 1e-4
    motions, scratch = stepper.state.motions, stepper.state.scratch
    for step, motion in zip((-1, 0, 1), motions, strict=True):
        motion.z[:] = stepper.blocks.to_z(start + rate * step + bend * step**2)
    scratch.z_change[:] = 0.5 * (motions[2].z - motions[0].z)
    out = np.zeros((2, len(start)))
    record_section(stepper.model.harmonics, tau, stepper.dt, *motions, scratch, out)
    expected = start + rate * tau + bend * tau**2, (rate + 2 * bend * tau) / stepper.dt
    np.testing.assert_allclose(out[0], expected[0], atol=1e-16)
    np.testing.assert_allclose(out[1], expected[1], atol=1e-14 / stepper.dt)


@pytest.mark.parametrize("recording", [False, True])
def test_a_turn_is_its_steps(small_system, recording):
    """A turn in contact: impulse, touches, frames, section, snapshots, orbit and force are those of its steps."""
    system, clock, opening = small_system(speed=SPEED, clearance=-2e-4), 700, np.linspace(4e-4, 0, TURN + 2)
    steppers = [rub_free_stepper(system, ContactLaw(friction=0.2), TURN) for _ in range(2)]
    whole, single = steppers
    states, forces, presses = [whole.coordinates.before, whole.coordinates.now], [], []
    for step in range(TURN):
        code, count = single.step(step, opening)
        assert code == OK
        states.append(single.coordinates.now)
        lam = np.zeros(system.n_blades)
        lam[single.state.contact.blade[:count]] = single.state.contact.lam[:count]
        forces.append(lam.sum())
        presses.append(lam * single.dt)
    snapshots = Snapshots(
        np.array([10, 50, TURN]), np.zeros((3, 2, whole.state.motions[0].z.size)), np.zeros((3, 2, system.n_blades))
    )
    result = whole.result
    result.taps[:], result.orbit[:] = np.nan, np.nan
    code, end, ended = run_turn(
        whole.model, opening, clock, recording, whole.state, whole.taps, whole.touches, snapshots, result
    )
    assert (code, end) == (OK, TURN)
    q, impulses = np.array(states), np.array(presses)
    assert (impulses.sum(axis=1) > 0).sum() > 10
    assert result.summary[0] == pytest.approx(impulses.sum(), rel=1e-12)
    assert result.summary[1] == (impulses.sum(axis=1) > 0).sum()
    bounds = np.abs(q[2:, system.casing_start :]) @ whole.model.surface.mode_displacement
    assert np.argmax(bounds) < TURN - 1  # not the last step's
    assert result.summary[2] == pytest.approx(bounds.max(), rel=1e-12)
    open_now = whole.touches.open[whole.touches.open[:, STEPS] > 0]
    by_touch = np.concatenate([whole.touches.ended[:ended], open_now])
    per_blade = np.bincount(by_touch[:, BLADE].astype(int), by_touch[:, IMPULSE], minlength=system.n_blades)
    np.testing.assert_allclose(per_blade, impulses.sum(axis=0), rtol=1e-10)
    assert by_touch[:, START].min() == clock + np.argmax(impulses.any(axis=1))
    steps = np.ceil(np.arange(len(result.frames)) * TURN / len(result.frames)).astype(int)
    frames = np.array([whole.blocks.to_q(z) for z in result.frames])
    np.testing.assert_allclose(frames, q[1 + steps], atol=1e-15)
    np.testing.assert_allclose(result.section, [q[1], (q[2] - q[0]) / (2 * whole.dt)], rtol=1e-9, atol=1e-9)
    for number, step in enumerate(snapshots.steps):
        kept = [whole.blocks.to_q(z) for z in snapshots.z[number]]
        np.testing.assert_allclose(kept, q[[step, step + 1]], atol=1e-15)
    x, y = q[1:-1, system.centre], q[1:-1, system.centre + 1]
    if recording:
        assert result.orbit[2] == pytest.approx((x**2 + y**2).sum(), rel=1e-12)
        assert np.isfinite(result.taps).all()
        force = [tap.name for tap in DEFAULT_TAPS].index("contact_force")
        np.testing.assert_allclose(result.taps[force], forces, rtol=1e-10, atol=1e-9)
    else:
        assert not result.orbit.any()
        assert np.isnan(result.taps).all()
