"""An oil film through its threshold: the rotor begins to whirl, as an integration in inertial axes does."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rubgen.labels.label import label
from rubgen.labels.labels import Motion
from rubgen.machine.support_laws.whirling_film import WhirlingFilm
from rubgen.reduction.model import TurningForces
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.units import rev_per_min
from validation.verification.rotors.rigid_rotor import rigid_rotor

MASS, REST, DAMPING, SWIRL, SCALE, UNBALANCE = 10.0, 100.0, 200.0, 0.47, 1e-3, 1e-4
STIFFNESS, SOFT = MASS * REST**2, 0.75 * MASS * REST**2
SLOW, FAST, SECONDS = 60.0, 200.0, 4.0  # the threshold is 50 / 0.47 = 106 rad/s


class Rotor:
    """The rotor at any speed, with the Euler force of a changing one."""

    def at_speed(self, speed, acceleration=0.0):
        film = WhirlingFilm(swirl_n_per_m=DAMPING * SWIRL * speed, soft_n_per_m=SOFT, scale_m=SCALE)
        forces = TurningForces(laws=(film,))
        system = rigid_rotor(speed, mass=MASS, stiffness=STIFFNESS, damping=DAMPING, unbalance=UNBALANCE, forces=forces)
        K, force = system.K.copy(), system.force.copy()
        K[3:5, 3:5] += acceleration * MASS * np.array([[0.0, -1.0], [1.0, 0.0]])
        force[4] -= acceleration * UNBALANCE
        return replace(system, K=K, force=force)


@pytest.fixture(scope="module")
def run_up():
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(SLOW), end_speed_rpm=rev_per_min(FAST), duration_s=SECONDS,
        settle_turns=60, steps_per_turn=256,
    )  # fmt: skip
    return integrate(Rotor(), operation, ContactLaw())


def slope(t, state, rotation):
    """Slopes of x, y, v_x, v_y in inertial axes."""
    z, v = complex(*state[:2]), complex(*state[2:])
    speed, acceleration = float(rotation.speed(np.array(t))), float(rotation.acceleration(np.array(t)))
    film = complex(SOFT, DAMPING * SWIRL * speed) / (1 + abs(z) ** 2 / SCALE**2)
    push = UNBALANCE * complex(speed**2, -acceleration) * np.exp(1j * float(rotation.angle(np.array(t))))
    a = (push - DAMPING * v - (STIFFNESS - film) * z) / MASS
    return [v.real, v.imag, a.real, a.imag]


def test_a_rotor_that_runs_up_begins_to_whirl(run_up):
    """Its distance from the axis over the last tenth of the record, and the motion before and after."""
    assert run_up.status is Status.OK
    rotation = run_up.changing_speed.rotation
    start = -1.5
    at_rest = UNBALANCE * SLOW**2 / complex(STIFFNESS - SOFT - MASS * SLOW**2, DAMPING * SLOW)
    z = at_rest * np.exp(1j * SLOW * start)
    v = 1j * SLOW * z
    steps = round(0.1 * SECONDS / run_up.dt)
    times = (run_up.record_steps - steps + np.arange(steps)) * run_up.dt
    found = solve_ivp(
        slope, (start, times[-1]), [z.real, z.imag, v.real, v.imag], args=(rotation,), method="DOP853", rtol=1e-8,
        atol=1e-11, t_eval=times,
    )  # fmt: skip
    expected = np.hypot(*found.y[:2])
    distance = np.hypot(run_up.taps["blisk_x"][-steps:], run_up.taps["blisk_y"][-steps:])
    assert np.sqrt(np.mean(expected**2)) > 20 * abs(at_rest)
    assert np.sqrt(np.mean(distance**2)) == pytest.approx(np.sqrt(np.mean(expected**2)), rel=5e-3)


def test_without_rub_its_motion_is_undecided_as_a_whole(run_up):
    assert run_up.free_penetration == math.inf
    labels = label(run_up)
    assert (labels.rub, labels.motion, labels.motion_blisk, labels.motion_casing) == (
        False, Motion.UNDECIDED, Motion.UNDECIDED, Motion.STATIC,
    )  # fmt: skip
