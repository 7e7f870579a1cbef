"""Refuse runs that cannot be integrated: find the reason before the run, and make a response with this reason.

O_d is the disk centre.
"""

import math
from collections.abc import Sequence

import numpy as np

from rubgen.errors import UserError
from rubgen.reduction import reduce
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import Operation, Scenario
from rubgen.solver.linear.admissible import check_system
from rubgen.solver.linear.reach import with_clearance
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import slowest_decay, steps_per_turn
from rubgen.solver.observers.touches import contact_events
from rubgen.solver.response import EnergyBalance, Response, Status
from rubgen.taps import DEFAULT_TAPS

UNDYING_SHARE = 1e-6
"""A slowest decay below this share of the spin speed counts as none: a transient would need 700,000 turns to decay."""
MOTION_TOLERANCE = 1e-8
"""Largest share of force on O_d that may be unbalanced in the motion from which a run starts."""
Refusal = tuple[Status, str]
"""Status and reason."""
NO_ENERGY = EnergyBalance(**dict.fromkeys(EnergyBalance.__dataclass_fields__, 0.0))


def no_response(
    status: Status,
    reason: str,
    *,
    speed: float,
    dt: float,
    steps_per_turn: int,
    record_turns: int,
    n_blades: int = 0,
    n_casing: int = 0,
    size: int = 0,
) -> Response:
    """Make a response of a run that was not integrated, with a status and its reason. All its arrays are empty.

    - speed, dt, steps_per_turn, record_turns, n_blades, n_casing: the fields of `Response`; speed in rad/s, dt in s.
    - size: number of coordinates.
    """
    nothing = np.zeros((0, size))
    return Response(
        status=status,
        reason=reason,
        speed=speed,
        dt=dt,
        steps_per_turn=steps_per_turn,
        settle_turns=0,
        record_turns=record_turns,
        taps={tap.name: np.zeros(0) for tap in DEFAULT_TAPS},
        section_q=nothing,
        section_v=nothing,
        impulse_per_turn=np.zeros(0),
        contact_steps_per_turn=np.zeros(0, dtype=np.int64),
        events=contact_events([]),
        energy=NO_ENERGY,
        n_blades=n_blades,
        n_casing=n_casing,
    )


def refused_response(system: SpinningSystem, operation: Operation, steps: int, refusal: Refusal) -> Response:
    """Make the response of a system that is not integrated.

    - system, operation: of the run.
    - steps: number of steps in a turn.
    - refusal: status and reason.
    """
    return no_response(
        *refusal,
        speed=float(system.speed),
        dt=2 * math.pi / system.speed / steps,
        steps_per_turn=steps,
        record_turns=operation.recorded_turns,
        n_blades=system.n_blades,
        n_casing=system.n_casing,
        size=len(system.M),
    )


def film_refusal(system: SpinningSystem, steps: int) -> Refusal | None:
    """Return status FILM_CLOSED and a reason if no rub-free motion fits the laws of the support; else None.

    A motion fits if at most 1e-8 of the force on O_d is not balanced. Laws whose motion must settle are left out.
    `steps` is the number of steps in a turn.
    """
    forces = system.starting.turning
    if forces is None or not forces.laws:
        return None
    missing = rub_free_motion(system, steps).residual
    if missing <= MOTION_TOLERANCE:
        return None
    return (
        Status.FILM_CLOSED,
        f"no rub-free motion inside it: {missing:.3g} of the force on the disk centre is not borne",
    )


def stability(system: SpinningSystem) -> tuple[Refusal | None, float]:
    """Return a refusal, and the `slowest_decay` of the system in 1/s. The refusal is None for a stable system.

    A refusal is status UNSTABLE and a reason. It is returned if the decay is negative (a motion grows without a force)
    or at most 1e-6 of the speed in rad/s. With supports that make the system periodic it is the decay of the Floquet
    exponents.
    """
    decay = slowest_decay(system)
    if decay > UNDYING_SHARE * system.speed:
        return None, decay
    largest = f"largest real part of the eigenvalues {-decay:.4g} 1/s at {system.speed:.6g} rad/s"
    undying = "; some motion never dies, at a critical speed it grows without limit: add damping"
    return (Status.UNSTABLE, largest + (undying if abs(decay) <= UNDYING_SHARE * system.speed else "")), decay


def no_run_warning(scenarios: Sequence[Scenario]) -> str | None:
    """Return a warning of one line if none of these runs can be integrated, with the first reason; None if one can.

    `scenarios` are the runs, at least one. None is integrated here. A changing speed is checked at its first, its
    slowest and its fastest speed.
    """
    reasons = []
    for scenario in scenarios:
        reason = _refusal(scenario)
        if reason is None:
            return None
        reasons.append(reason)
    which = "the run cannot" if len(reasons) == 1 else f"none of the {len(reasons)} runs looked at can"
    return f"{which} be integrated: {reasons[0]}"


def _refusal(scenario: Scenario) -> str | None:
    """Return why `integrate` would refuse the run, from its first, slowest and fastest speed."""
    operation = scenario.operation
    speeds = (operation.rotation.start, operation.rotation.slowest, operation.rotation.fastest)
    try:
        scenario = with_clearance(scenario)
        model = reduce(scenario.machine, scenario.reduction)
        systems = [model.at_speed(speed) for speed in dict.fromkeys(speeds)]
        for system in systems:
            check_system(system)
            unstable = stability(system)[0]
            if unstable:
                return f"{unstable[0].code}: {unstable[1]}"
        steps = steps_per_turn(systems[0], operation.steps_per_turn, scenario.sensing.fastest_hz)
        closed = film_refusal(systems[0], steps)
    except (UserError, np.linalg.LinAlgError) as error:
        return str(error)
    return f"{closed[0].code}: {closed[1]}" if closed else None
