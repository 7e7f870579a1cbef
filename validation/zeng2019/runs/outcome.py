"""One run, and the little that is kept of it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels import Labels, Motion, label
from rubgen.labels.harmonics import HIGHEST_ORDER, order_spectrum
from rubgen.labels.motion.classify import indicators
from rubgen.labels.motion.decision import decide
from rubgen.labels.motion.section import blisk_points, casing_points, casing_rests
from rubgen.reduction import reduce
from rubgen.scenario import Scenario
from rubgen.solver import Response, Status
from rubgen.solver.integrate import integrate
from validation.piece import Arrays, Piece
from validation.zeng2019.runs.contact_pattern import ContactPattern, contact_pattern

POINTS = 49
"""The paper's diagrams show the last 49 turns, one point each."""
SPECTRUM_LINES = 1001
"""Orders 0 to 10 by a hundredth."""
REGULAR = (Motion.STATIC.value, Motion.PERIOD_1.value)


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What is kept of one run; of a failed one only `status` and `reason`, its arrays being empty.

    `motion_centre` is the class of the disk centre alone, `motion_blisk` that of the worst of disk centre and tips.
    `points_*` (49,) are O_d x (m) and casing acceleration at 0 deg (m/s2) once a turn, `spectrum_*` (1001,) their peak
    amplitudes over orders 0 to 10 by a hundredth. `even_field` and `odd_field` (10,) are orders 1 to 10 of half the
    sum and half the difference of the accelerations at 0 and 180 deg, which hold the even and the odd circumferential
    orders, `force_orders` (10,) those of the contact force in N. `*_rms` is without the mean, `symmetric` is -1 without
    contact. `on_casing` (120,) and `on_blades` hold the impulse of the last 49 turns in N s by sectors of 3 deg and by
    blade, `area_deg` the touched arc, `at_once` the most blades that touch in one step, `neighbours` the share of the
    steps in contact in which two neighbours touch.
    """

    status: str
    reason: str
    motion: str = ""
    motion_centre: str = ""
    motion_blisk: str = ""
    motion_casing: str = ""
    period: int = 0
    rub: bool = False
    zones: int = 0
    symmetric: int = -1
    centres_deg: FloatArray
    impulse: float = 0.0
    blades_touched: int = 0
    blisk_rms: float = 0.0
    casing_rms: float = 0.0
    points_blisk: FloatArray
    points_casing: FloatArray
    spectrum_blisk: FloatArray
    spectrum_casing: FloatArray
    even_field: FloatArray
    odd_field: FloatArray
    force_orders: FloatArray
    on_casing: FloatArray
    on_blades: FloatArray
    area_deg: float = 0.0
    at_once: int = 0
    neighbours: float = 0.0

    @property
    def ok(self) -> bool:
        """Whether the run can be judged."""
        return self.status == Status.OK.code

    @property
    def regular(self) -> bool:
        """Whether the whole moves in period-1."""
        return self.ok and self.motion in REGULAR

    @property
    def label(self) -> str:
        """Motion, with its period where that is longer than a turn; the status of a failed run."""
        if not self.ok:
            return self.status
        return f"period-{self.period}" if self.motion == Motion.PERIOD_K.value else self.motion


def outcome_of(found: Arrays) -> Outcome:
    """The outcome from the arrays of its piece."""
    values: dict[str, Any] = {field.name: found[field.name] for field in fields(Outcome)}
    return Outcome(**{name: value.item() if value.ndim == 0 else value for name, value in values.items()})


def run_piece(scenario: Scenario) -> Piece:
    """The piece that runs the scenario."""
    return Piece(run, (scenario,))


def run(scenario: Scenario) -> Arrays:
    """The outcome of a scenario without sensors, as arrays."""
    model = reduce(scenario.machine, scenario.reduction)
    system = model.at_speed(scenario.operation.speed_rad_per_s)
    found = outcome(integrate(system, scenario.operation, scenario.contact))
    return {field.name: np.asarray(getattr(found, field.name)) for field in fields(found)}


def outcome(response: Response) -> Outcome:
    """What is kept of a response."""
    if response.status is not Status.OK:
        nothing: dict[str, Any] = {field.name: np.zeros(0) for field in fields(Outcome) if field.type == "FloatArray"}
        return Outcome(status=response.status.code, reason=response.reason, **nothing)
    labels = label(response)
    return Outcome(
        status=response.status.code,
        reason="",
        motion_centre=_motion_of_the_centre(response, labels),
        **_labels(labels),
        **_signals(response),
        **_contact(contact_pattern(response, POINTS)),
    )


def _motion_of_the_centre(response: Response, labels: Labels) -> str:
    """Class of the disk centre by the rules of `docs/labels/motion.md`, as if the blisk had no tips.

    K of the 0-1 test is the larger of the disk centre and the casing.
    """
    if not labels.rub:
        return labels.motion_blisk.value
    centre = blisk_points(response)[:, :1]
    parts = [centre] if casing_rests(response) else [centre, casing_points(response)]
    return decide(indicators(parts, None)[0]).motion.value


def _labels(labels: Labels) -> dict[str, Any]:
    symmetric = labels.contact_zones_symmetric
    return {
        "motion": labels.motion.value,
        "motion_blisk": labels.motion_blisk.value,
        "motion_casing": labels.motion_casing.value,
        "period": labels.period or 0,
        "rub": labels.rub,
        "zones": labels.contact_zones,
        "symmetric": -1 if symmetric is None else int(symmetric),
        "centres_deg": np.degrees(labels.contact_zone_centres),
        "impulse": labels.impulse_per_turn,
        "blades_touched": labels.blades_touched,
        "force_orders": labels.orders["contact_force"].amplitudes,
    }


def _signals(response: Response) -> dict[str, Any]:
    taps, steps = response.taps, response.steps_per_turn
    once = {name: taps[name][: -POINTS * steps - 1 : -steps][::-1] for name in ("blisk_x", "casing_acc_0")}
    spectra = {name: order_spectrum(taps[name], response)[:SPECTRUM_LINES] for name in once}
    east, west = taps["casing_acc_0"], taps["casing_acc_180"]
    return {
        "points_blisk": once["blisk_x"].copy(),
        "points_casing": once["casing_acc_0"].copy(),
        "spectrum_blisk": spectra["blisk_x"].astype(np.float32),
        "spectrum_casing": spectra["casing_acc_0"].astype(np.float32),
        "even_field": _orders((east + west) / 2, response),
        "odd_field": _orders((east - west) / 2, response),
        "blisk_rms": float(taps["blisk_x"][-POINTS * steps :].std()),
        "casing_rms": float(east[-POINTS * steps :].std()),
    }


def _orders(tap: FloatArray, response: Response) -> FloatArray:
    """Peak amplitudes at orders 1 to 10; outward accelerations at opposite places add up in even orders."""
    lines = order_spectrum(tap, response)
    turns = min(100, response.record_turns)
    return np.asarray(lines[turns : HIGHEST_ORDER * turns + 1 : turns], dtype=np.float64)


def _contact(pattern: ContactPattern) -> dict[str, Any]:
    return {
        "on_casing": pattern.on_casing.astype(np.float32),
        "on_blades": pattern.on_blades.astype(np.float32),
        "area_deg": pattern.area_deg,
        "at_once": pattern.at_once,
        "neighbours": pattern.neighbours,
    }
