"""One run of a study and what is kept of it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from rubgen.arrays import FloatArray
from rubgen.labels import Labels, label
from rubgen.labels.motion.classify import blisk_points, casing_points, chaos_indicator, cluster_distances
from rubgen.reduction import reduce
from rubgen.reduction.reduced import ReducedModel
from rubgen.scenario import Scenario
from rubgen.solver import Response, Status
from rubgen.solver.integrate import integrate
from rubgen.solver.observers.companion import LEAST_TURNS
from rubgen.solver.wants import Wants
from validation.piece import Arrays, Piece

BLOCKS = 10
"""Parts of the record whose mean impulses give the error of the mean: longer than what a chaotic rub remembers."""
COMPARED_FREQUENCIES = 42
"""The lowest frequencies at rest: all that four modes of the blisk are asked to carry, as in the paper."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What is kept of one run; `motion` is empty and the numbers below it are NaN or empty where the run failed.

    `impulse` is the mean normal impulse a turn, `impulse_error` its standard error from ten parts of the record, in
    N s. `force_orders` (N) and `blisk_orders` (m) are peak amplitudes at k f_r, k = 1 .. 20, of the contact force and
    of blisk_x. `indicator_*` is K of the 0-1 test, `stray_*` the rms distance of the section's points (second half of
    the record) from their mean, over the size of the motion: period-1 up to 0.01. `exponent` is the Lyapunov exponent
    with its standard error, in 1/turn, NaN without contact, where no label needs it. `growth` is the largest outward
    displacement of a tip at speed without contact, in m. Frequencies at rest, in Hz.
    """

    status: str
    reason: str
    steps_per_turn: int
    settle_turns: int
    record_turns: int
    motion: str
    motion_blisk: str
    motion_casing: str
    period: int | None
    rub: bool
    zones: int
    symmetric: bool | None
    impulse: float
    impulse_error: float
    contact_duty: float
    force_orders: list[float]
    blisk_orders: list[float]
    indicator_blisk: float
    indicator_casing: float
    stray_blisk: float
    stray_casing: float
    exponent: float
    exponent_error: float
    growth: float
    critical_speed_rpm: float
    blisk_frequencies_hz: list[float]
    highest_casing_hz: float
    dof: int

    @property
    def label(self) -> str:
        """Motion, and the period where it is longer than a turn."""
        name = self.motion or self.status
        return f"period-{self.period}" if self.motion == "period-k" else name

    def as_dict(self) -> dict[str, object]:
        """The values by name, numbers, texts and lists of numbers."""
        return asdict(self)


def run_piece(scenario: Scenario) -> Piece:
    """The piece that runs the scenario."""
    return Piece(run_arrays, (scenario,))


def run_arrays(scenario: Scenario) -> Arrays:
    """The outcome of `scenario` as arrays; a value that is None has none."""
    values = run(scenario).as_dict()
    return {name: np.asarray(value) for name, value in values.items() if value is not None}


def outcome_of(found: Arrays) -> Outcome:
    """The outcome from the arrays of its piece."""
    absent: dict[str, Any] = {"period": None, "symmetric": None}
    return Outcome(**(absent | {name: value.tolist() for name, value in found.items()}))


def run(scenario: Scenario) -> Outcome:
    """The outcome of `scenario`, labelled as data are, with the exponent where the record is long enough for one.

    There are no sensors, so that nothing but stability raises its steps a turn.

    Raises UserError for mode numbers or meshes that do not fit.
    """
    operation = scenario.operation
    with threadpool_limits(1, user_api="blas"):
        model = reduce(scenario.machine, scenario.reduction)
        system, companion = model.at_speed(operation.speed_rad_per_s), operation.record_turns >= LEAST_TURNS
        response = integrate(system, operation, scenario.contact, Wants(companion=companion))
        return outcome(model, response)


def outcome(model: ReducedModel, response: Response) -> Outcome:
    """What is kept of a response of `model`."""
    labels = label(response) if response.status is Status.OK else None
    return Outcome(
        status=response.status.code,
        reason=response.reason,
        steps_per_turn=response.steps_per_turn,
        settle_turns=response.settle_turns,
        record_turns=response.record_turns,
        **_dynamics(labels, response),  # type: ignore[arg-type]
        growth=_growth(model, response.speed),
        critical_speed_rpm=model.critical_speed_rpm,
        blisk_frequencies_hz=[float(hz) for hz in model.blisk_frequencies_hz()[:COMPARED_FREQUENCIES]],
        highest_casing_hz=float(model.casing_frequencies_hz[-1]),
        dof=model.reduced_dof,
    )


def _dynamics(labels: Labels | None, response: Response) -> dict[str, object]:
    return {
        "motion": labels.motion.value if labels else "",
        "motion_blisk": labels.motion_blisk.value if labels else "",
        "motion_casing": labels.motion_casing.value if labels else "",
        "period": labels.period if labels else None,
        "rub": labels.rub if labels else False,
        "zones": labels.contact_zones if labels else 0,
        "symmetric": labels.contact_zones_symmetric if labels else None,
        "impulse": labels.impulse_per_turn if labels else float("nan"),
        "impulse_error": _error_of_mean(response.impulse_per_turn) if labels else float("nan"),
        "contact_duty": labels.contact_duty if labels else float("nan"),
        "force_orders": labels.orders["contact_force"].amplitudes.tolist() if labels else [],
        "blisk_orders": labels.orders["blisk_x"].amplitudes.tolist() if labels else [],
    } | (_indicators(response, labels) if labels and labels.rub else _no_indicators(0.0 if labels else float("nan")))


def _no_indicators(value: float) -> dict[str, float]:
    """Those of a run without contact, all but the exponent `value`."""
    names = ("indicator_blisk", "indicator_casing", "stray_blisk", "stray_casing")
    return dict.fromkeys(names, value) | dict.fromkeys(("exponent", "exponent_error"), float("nan"))


def _indicators(response: Response, labels: Labels) -> dict[str, float]:
    parts = {"blisk": blisk_points(response), "casing": casing_points(response)}
    late = {name: points[points.shape[0] // 2 :] for name, points in parts.items()}
    stray = {name: cluster_distances(points, 1) for name, points in late.items()}
    exponent = labels.lyapunov
    return {
        **{f"indicator_{name}": chaos_indicator(points) for name, points in parts.items()},
        **{f"stray_{name}": float(np.sqrt(np.mean(distance**2))) for name, distance in stray.items()},
        "exponent": exponent.per_turn if exponent else float("nan"),
        "exponent_error": exponent.error if exponent else float("nan"),
    }


def _error_of_mean(impulse: FloatArray) -> float:
    """Standard error of the mean from BLOCKS equal parts, the rest at the start left out; 0 for too few turns."""
    length = impulse.size // BLOCKS
    if length == 0:
        return 0.0
    means = impulse[impulse.size - BLOCKS * length :].reshape(BLOCKS, length).mean(axis=1)
    return float(means.std(ddof=1) / np.sqrt(BLOCKS))


def _growth(model: ReducedModel, speed: float) -> float:
    system = model.at_speed(speed)
    q = np.linalg.solve(system.K, system.force)
    u = system.tip_static + q[: system.centre].reshape(-1, 3)
    return float(np.hypot(system.tip_radius + u[:, 0], u[:, 1]).max()) - system.tip_radius
