"""Loads of faults at a changing speed, beside an integration in the inertial frame."""

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp
from test_changing_speed import MASS, STIFFNESS, UNBALANCE, At, jeffcott_at, record_taps

from rubgen.machine.faults.fault import HarmonicLoad, Ramp
from rubgen.reduction.fault_loads import turning_harmonics
from rubgen.reduction.model import GrowingLoad, TurningForces
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.integrate import integrate
from rubgen.solver.wants import Wants
from rubgen.units import rev_per_min

DAMPING, START, END = 0.05, 420.0, 560.0
RAMP = Ramp(start_s=0.1, duration_s=0.3)
REACTION = 40.0
"""Of a misaligned coupling at order 2 along 30 degrees, N: its order passes the critical speed of 1,000 rad/s."""
GROWING = 3e-4
"""An unbalance that grows, kg m; its force grows with the square of the speed too."""


def with_loads(speed, acceleration):
    system = jeffcott_at(DAMPING)(speed, acceleration)
    along = REACTION * np.exp(1j * np.pi / 6)
    steady = turning_harmonics([HarmonicLoad(order=2, x=along.real, y=along.imag)])
    growing = turning_harmonics([HarmonicLoad.rotating(GROWING * speed**2)])
    forces = TurningForces(loads=steady, growing=(GrowingLoad(ramp=RAMP, loads=growing, of_springs=False),))
    return replace(system, turning=forces)


def test_a_run_up_with_loads_is_that_of_the_inertial_frame():
    operation = Operation(
        profile="run-up", speed_rpm=rev_per_min(START), end_speed_rpm=rev_per_min(END), duration_s=0.5, settle_turns=60
    )
    response = integrate(At(with_loads), operation, ContactLaw(), Wants(tail_seconds=0.5))
    assert response.energy.residual < 1e-10
    rotation, orbit = response.changing_speed.rotation, record_taps(response)
    times = np.arange(orbit.size) * response.dt
    drag = 2 * DAMPING * np.sqrt(STIFFNESS * MASS)

    def rate(time, state):
        speed, push, angle = (float(part(time)) for part in (rotation.speed, rotation.acceleration, rotation.angle))
        turn, share = np.exp(1j * angle), float(RAMP.share(np.array(time)))
        force = UNBALANCE * (speed**2 - 1j * push) * turn + share * GROWING * speed**2 * turn
        force += REACTION * np.exp(1j * np.pi / 6) * np.cos(2 * angle)
        return [state[1], (force - drag * state[1] - STIFFNESS * state[0]) / MASS]

    def receptance(w):
        return 1 / (STIFFNESS - MASS * w**2 + 1j * drag * w)

    half = REACTION * np.exp(1j * np.pi / 6) / 2
    forward, backward = half * receptance(2 * START), half * np.conj(receptance(2 * START))
    whirl = UNBALANCE * START**2 * receptance(START)
    start = [whirl + forward + backward, 1j * START * (whirl + 2 * forward - 2 * backward)]
    exact = solve_ivp(rate, (0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-10, atol=1e-16).y[0]
    assert np.abs(exact).max() > 3 * np.abs(whirl)
    np.testing.assert_allclose(orbit, exact, atol=2e-3 * np.abs(exact).max())
