"""Compute eigenvalues of the linear system, its stable step, and the turns in which its transients decay."""

import math

import numpy as np
import scipy.linalg as la

from rubgen.arrays import ComplexArray
from rubgen.errors import UserError
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import Operation
from rubgen.scenario.costs import STEPS_PER_SAMPLE
from rubgen.solver.linear.floquet import floquet_exponents, linearised, quadratic_eigenvalues
from rubgen.solver.linear.system_blocks import system_blocks
from rubgen.units import rev_per_min

STEP_SAFETY = 0.95
"""The step stays below this share of the stability limit 2 / omega_max."""
TRANSIENT_DECAY = 100.0
"""Transients have decayed when they are smaller by this factor."""
SETTLING_DECAYS = 3
"""So many times longer settles a run whose motion without rub is not known: first it leaves the motion of its start."""
MOST_STEPS_PER_TURN = 2**22
FLOQUET_STEPS = 1024
"""Least number of steps a turn for the transition over one period of a system with uneven supports."""


def eigenvalues(system: SpinningSystem) -> ComplexArray:
    """Return all 2 n eigenvalues s in 1/s of M q'' + C q' + K q = 0. Each block of the matrices is computed by itself.

    Laws of the support are linearised at the rub-free motion. The results are Floquet exponents (`floquet_exponents`)
    with uneven supports, which turn relative to the blisk, and with laws where gravity or loads of faults move O_d.
    Their imaginary parts are known up to a multiple of 2 Omega (Omega with laws). Laws with a motion that must settle
    are left out. For Floquet exponents UserError is raised as in `steps_per_turn`.
    """
    system = system.starting
    forces = system.turning
    if forces and (forces.uneven or (forces.laws and forces.is_periodic)):
        return floquet_exponents(system, steps_per_turn(system, FLOQUET_STEPS))
    constant = linearised(system) if forces and forces.laws else system
    blocks = system_blocks(constant)
    y = [blocks.transform.T @ matrix @ blocks.transform for matrix in (constant.M, constant.C, constant.K)]
    alike = [bundle[bundle[:, 0] >= 0] for bundle in blocks.lanes] + [block[None] for block in blocks.single]
    found = [quadratic_eigenvalues(*(X[part[:, :, None], part[:, None]] for X in y)) for part in alike]
    return np.concatenate([values.ravel() for values in found])


def slowest_decay(system: SpinningSystem) -> float:
    """Return the decay rate of the slowest transient of the linear system, in 1/s; negative where it grows.

    It is min(-Re s) over all `eigenvalues` s, which is 2 pi min(zeta f).
    """
    return float(-eigenvalues(system).real.max())


def stable_step(system: SpinningSystem) -> float:
    """Return the largest stable time step 2 / omega_max in s. omega_max belongs to (K, M) without gyroscopic terms.

    Uneven supports count with their stiffer direction on both axes, laws of the support with their largest stiffness.
    """
    start, largest = system.casing_start, 0.0
    stiffness = system.K
    if system.turning and system.turning.stiffening:
        stiffness = system.K.copy()
        for i in (system.centre, system.centre + 1):
            stiffness[i, i] += system.turning.stiffening
    for part in (slice(0, start), slice(start, None)):
        K, M = ((matrix[part, part] + matrix[part, part].T) / 2 for matrix in (stiffness, system.M))
        largest = max(largest, float(la.eigh(K, M, eigvals_only=True)[-1]))
    return 2 / math.sqrt(largest)


def steps_per_turn(system: SpinningSystem, least: int, sample_rate_hz: float = 0.0) -> int:
    """Double `least` until the step is stable and the step rate is at least 2.56 `sample_rate_hz`. Return the steps.

    A step counts as stable if dt is at most 0.95 * 2 / omega_max. A rate of 0 asks for nothing. A turn is a whole
    number of steps, so the Poincare section lies on steps exactly. Raises UserError for a system that would need more
    than 4,194,304 steps.
    """
    turn = 2 * math.pi / system.speed
    sampled = 1 / (STEPS_PER_SAMPLE * sample_rate_hz) if sample_rate_hz else turn
    longest = min(STEP_SAFETY * stable_step(system), sampled)
    steps = least
    while turn / steps > longest:
        steps *= 2
        if steps > MOST_STEPS_PER_TURN:
            raise UserError(
                f"speed_rpm = {rev_per_min(system.speed):.6g}: a stable step of {longest:.3g} s needs more than "
                f"{MOST_STEPS_PER_TURN} steps a turn; raise the speed"
            )
    return steps


def automatic_settle_turns(system: SpinningSystem, closing_turns: int, decay: float | None = None) -> int:
    """Return the number of turns until the clearance is closed and transients have decayed to a hundredth.

    It is closing_turns + ln(100) f_r / (2 pi min(zeta f)) with the eigenvalues at speed, rounded up. If the motion of a
    law must settle (`SupportLaw.SETTLES`), the second term is multiplied by three. `decay` is the slowest decay in 1/s;
    None computes it. Raises ValueError for an unstable system.
    """
    decay = slowest_decay(system) if decay is None else decay
    if decay <= 0:
        raise ValueError(f"the linear system grows by itself: largest real part {-decay:g} 1/s")
    times = 1 if system.starting is system else SETTLING_DECAYS
    return closing_turns + times * math.ceil(math.log(TRANSIENT_DECAY) * system.speed / (2 * math.pi) / decay)


def settle_turns(system: SpinningSystem, operation: Operation, decay: float | None = None) -> int:
    """Return the number of turns before the record: `operation.settle_turns`, or `automatic_settle_turns` for "auto".

    `decay` is the slowest decay in 1/s; None computes it. Raises ValueError for "auto" and an unstable system.
    """
    if operation.settle_turns == "auto":
        return automatic_settle_turns(system, operation.closing_turns, decay)
    return operation.settle_turns
