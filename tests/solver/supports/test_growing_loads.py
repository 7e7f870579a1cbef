"""Loads that grow within the record, beside a plain integration."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rubgen.machine.faults.fault import HarmonicLoad, Ramp
from rubgen.reduction.fault_loads import turning_harmonics
from rubgen.reduction.model import GrowingLoad, TurningForces
from rubgen.scenario import ContactLaw
from rubgen.solver.integrate import integrate

GROWTHS = {"ramp": Ramp(start_s=0.05, duration_s=0.2), "step": Ramp(start_s=0.05, duration_s=0.0)}


@pytest.mark.parametrize("growth", GROWTHS)
def test_a_growing_load_moves_the_disk_as_an_integration_does(small_system, operation, growth):
    """A constant force of the turning frame and one of order 2 that grow, beside solve_ivp of the whole blisk."""
    system = small_system(clearance=5e-3)
    loads = turning_harmonics([HarmonicLoad.rotating(300 - 100j), HarmonicLoad(order=2, x=400, y=200j)])
    ramp = GROWTHS[growth]
    forces = TurningForces(growing=(GrowingLoad(ramp=ramp, loads=loads, of_springs=False),))
    system = replace(system, turning=forces)
    response = integrate(system, operation(system, record_turns=40, settle_turns=5, steps_per_turn=512), ContactLaw())
    assert response.energy.residual < 1e-10
    found = np.array([response.taps["blisk_x"], response.taps["blisk_y"]])[:, -40 * 512 :]
    times = np.arange(found.shape[1]) * response.dt
    expected = integrated(system, ramp, loads, times, turn=512 * response.dt)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-3 * np.abs(expected).max())


def integrated(system, ramp, loads, times, turn):
    """The disk centre's inertial X and Y, from the rub-free motion at t = 0."""
    n, c = system.casing_start, system.centre
    M, C, K = (matrix[:n, :n] for matrix in (system.M, system.C, system.K))
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    inverse = np.linalg.inv(M)
    rest = np.linalg.solve(K, system.force[:n])

    def rate(time, state):
        theta = system.speed * time
        # A step is spread over the steps of its turn.
        first = np.floor(time / turn) * turn
        share = np.interp(time, [first, first + turn], ramp.share(np.array([first, first + turn])))
        force = system.force[:n].copy()
        force[c : c + 2] += share * (np.exp(1j * theta * np.arange(len(loads))) @ loads).real
        return A @ state + np.concatenate([np.zeros(n), inverse @ force])

    start = np.concatenate([rest, np.zeros(n)])
    q = solve_ivp(rate, (0, times[-1]), start, t_eval=times, method="LSODA", rtol=1e-7, atol=1e-11, max_step=turn / 8).y
    place = (q[c] + 1j * q[c + 1]) * np.exp(1j * system.speed * times)
    return np.array([place.real, place.imag])
