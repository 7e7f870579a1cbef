"""Turn the loads of faults on the disk centre from the inertial frame into the turning one."""

from collections.abc import Iterable

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.machine import Machine
from rubgen.machine.faults.fault import HarmonicLoad
from rubgen.reduction.model import GrowingLoad


def steady_loads(machine: Machine, speed: float) -> ComplexArray:
    """Return the sum of the machine's fault loads that do not grow, at `speed` in rad/s: p (orders, 2) in N.

    The orders are counted in the turning frame, as in `turning_harmonics`.
    """
    return turning_harmonics(load for load in _loads(machine, speed) if load.ramp is None)


def growing_loads(machine: Machine, speed: float) -> tuple[GrowingLoad, ...]:
    """Return the machine's fault loads that grow within the record, each with its growth, at `speed` in rad/s."""
    return tuple(
        GrowingLoad(ramp=load.ramp, loads=turning_harmonics([load]), of_springs=load.of_springs)
        for load in _loads(machine, speed)
        if load.ramp is not None
    )


def spring_load(machine: Machine, speed: float) -> FloatArray:
    """Return the part (2,) of the steady loads that the lateral springs apply, in N, constant in the turning frame.

    `speed` is in rad/s. A bow causes it: the bow moves the position in which the springs are at rest.
    """
    loads = [load for load in _loads(machine, speed) if load.of_springs and load.ramp is None]
    return np.asarray(turning_harmonics(loads)[0].real)


def turning_harmonics(loads: Iterable[HarmonicLoad]) -> ComplexArray:
    """Sum inertial loads in the turning frame: p (orders, 2) in N, with f = Re sum_m p_m e^(i m theta).

    Row m of p is order m of x and y in the turning frame, from 0 to the largest order of a load + 1. f_x = cos theta
    F_X + sin theta F_Y and f_y = -sin theta F_X + cos theta F_Y. An inertial load of order k has the orders k - 1 and k
    + 1 in the turning frame, a load of order 0 only the order 1. Loads that grow count with their full size. Without
    loads p is one row of zeros.
    """
    loads = tuple(loads)
    total = np.zeros((max((load.order + 2 for load in loads), default=1), 2), dtype=np.complex128)
    for load in loads:
        above = 0.5 * np.array([load.x - 1j * load.y, 1j * load.x + load.y])
        below = 0.5 * np.array([load.x + 1j * load.y, -1j * load.x + load.y])
        total[load.order + 1] += above
        if load.order:
            total[load.order - 1] += below
        else:
            total[1] += below.conj()
    return total


def _loads(machine: Machine, speed: float) -> tuple[HarmonicLoad, ...]:
    return tuple(load for fault in machine.faults for load in fault.loads(machine, speed))
