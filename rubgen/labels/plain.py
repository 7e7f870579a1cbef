"""Labels as a dictionary that JSON can hold: the names under which every file and command shows them."""

from __future__ import annotations

import math

from rubgen.arrays import FloatArray
from rubgen.labels.course import CourseLabels
from rubgen.labels.labels import Labels, Motion

CLASSES = list(Motion)
"""Classes of motion by their number in `change_motion_classes`."""


def labels_dict(labels: Labels) -> dict[str, object]:
    """The labels of one run by their public names, as JSON-ready Python values.

    Unit suffixes are part of the names: `contact_impulse_per_turn_n_s` in N s, `contact_zone_centres_rad` and
    `contact_zone_widths_rad` in rad; `lyapunov_*` in 1/turn but for `lyapunov_per_second`; `<tap>_orders` holds the
    amplitudes at k f_r in the unit of the tap. What is undefined (no period, a share of nothing) is None. The order of
    the keys is fixed.
    """
    plain: dict[str, object] = {
        "rub": bool(labels.rub),
        "contact_duty": _number(labels.contact_duty),
        "contact_impulse_per_turn_n_s": _number(labels.impulse_per_turn),
        "blades_touched": int(labels.blades_touched),
        "contact_zones": int(labels.contact_zones),
        "contact_zone_centres_rad": [_number(centre) for centre in labels.contact_zone_centres],
        "contact_zone_widths_rad": [_number(width) for width in labels.contact_zone_widths],
        "contact_zones_symmetric": labels.contact_zones_symmetric,
        "motion_blisk": labels.motion_blisk.value,
        "motion_casing": labels.motion_casing.value,
        "motion": labels.motion.value,
        "period_blisk": labels.period_blisk,
        "period_casing": labels.period_casing,
        "period": labels.period,
        **_motion_labels(labels),
        "has_2fr": bool(labels.has_2fr),
        "orders_present": [int(order) for order in labels.orders_present],
        **_lyapunov_labels(labels),
        **_course_labels(labels.course),
    }
    for tap in labels.orders:
        plain |= _order_labels(labels, tap)
    return plain


def _motion_labels(labels: Labels) -> dict[str, object]:
    return {
        "motion_confidence": _number(labels.motion_confidence),
        "motion_symmetric": labels.motion_symmetric,
        "motion_intermittent": bool(labels.segment_starts),
        "motion_segment_starts_s": [_number(start) for start in labels.segment_starts],
        "motion_segment_periods": [int(period) for period in labels.segment_periods],
        "tip_chatter": bool(labels.tip_chatter),
        "stray_blisk": _optional(labels.stray_blisk),
        "stray_casing": _optional(labels.stray_casing),
        "zero_one_k": _optional(labels.zero_one_k),
    }


def _optional(value: float | None) -> float | None:
    return None if value is None else _number(value)


def _lyapunov_labels(labels: Labels) -> dict[str, object]:
    exponent, per_second = labels.lyapunov, labels.lyapunov_per_second
    return {
        "lyapunov_per_turn": _number(exponent.per_turn) if exponent else None,
        "lyapunov_per_second": _optional(per_second),
        "lyapunov_error": _number(exponent.error) if exponent else None,
        "lyapunov_convergence": [_number(value) for value in exponent.convergence] if exponent else [],
    }


def _course_labels(course: CourseLabels | None) -> dict[str, object]:
    changes, windows = course.changes if course else (), course.windows if course else None
    return {
        "onset_speed_rpm": _rpm(course.onset_speed) if course else None,
        "end_of_rub_speed_rpm": _rpm(course.end_of_rub_speed) if course else None,
        "change_times_s": [_number(change.time) for change in changes],
        "change_speeds_rpm": [_rpm(change.speed) for change in changes],
        "change_rub": [int(change.rub) for change in changes],
        "change_impulse_per_turn_n_s": [_number(change.impulse) for change in changes],
        "change_motion_classes": [CLASSES.index(change.motion) for change in changes],
        "window_starts_s": windows.start.tolist() if windows else [],
        "window_speeds_rpm": [_rpm(speed) for speed in windows.speed.tolist()] if windows else [],
        "window_impulse_per_turn_n_s": windows.impulse.tolist() if windows else [],
    }


def _rpm(speed: float | None) -> float | None:
    return None if speed is None else _number(speed * 30 / math.pi)


def _order_labels(labels: Labels, tap: str) -> dict[str, object]:
    windows = labels.course.windows.orders[tap].ravel().tolist() if labels.course else []
    plain: dict[str, object] = {
        f"{tap}_orders": _numbers(labels.orders[tap]),
        f"{tap}_window_amplitudes": windows,
        f"{tap}_even_share": _number(labels.even_share[tap]),
        f"{tap}_odd_share": _number(labels.odd_share[tap]),
        f"{tap}_dominant_order": int(labels.dominant_order[tap]),
    }
    details = labels.order_details.get(tap)
    if details is not None:
        plain |= {
            f"{tap}_order_phases_rad": _numbers(details.phases),
            f"{tap}_order_floors": _numbers(details.floors),
            f"{tap}_fractional_amplitudes": _numbers(details.fractional),
            f"{tap}_blade_passing": _numbers(details.blade_passing),
        }
    return plain


def _numbers(values: FloatArray) -> list[float | None]:
    return [_number(value) for value in values]


def _number(value: float) -> float | None:
    """JSON has no NaN: what is undefined becomes None."""
    return float(value) if math.isfinite(value) else None
