"""Labels as a dictionary that JSON can hold: the names under which every file and command shows them."""

from __future__ import annotations

import math

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.labels.compact_record import Kept, response_of
from rubgen.labels.contact.amounts import ContactAmounts
from rubgen.labels.label import label
from rubgen.labels.labels import Labels, Motion
from rubgen.labels.speed_history import CourseLabels
from rubgen.labels.windows import Windows
from rubgen.units import rev_per_min

CLASSES = list(Motion)
"""Classes of motion by their number in `change_motion_classes`."""
ORDER_LABELS = ("has_2fr", "orders_present")
"""Labels of orders that do not bear a tap's name: they need the taps."""


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
        **_amount_labels(labels.amounts),
        "whirl": labels.whirl.direction.value if labels.whirl else None,
        "whirl_index": _number(labels.whirl.index) if labels.whirl else None,
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
        **_window_labels(labels.windows),
    }
    for tap in labels.orders:
        plain |= _order_labels(labels, tap)
    return plain


def remade_labels(kept: Kept) -> dict[str, object]:
    """The labels that what is kept of a run gives again, by the same names: all but those of orders."""
    plain = labels_dict(label(response_of(kept)))
    return {name: value for name, value in plain.items() if name not in ORDER_LABELS}


def window_amplitudes(labels: Labels) -> dict[str, list[float]]:
    """`<tap>_window_amplitudes`: twenty amplitudes of each window after those of the one before.

    They are rounded to single precision, which a Parquet file then compresses.
    """
    orders = labels.windows.orders if labels.windows else {}
    return {f"{tap}_window_amplitudes": values.astype(np.float32).ravel().tolist() for tap, values in orders.items()}


def _amount_labels(amounts: ContactAmounts | None) -> dict[str, object]:
    return {
        "contact_touches": amounts.touches if amounts else None,
        "contact_friction_work_per_turn_j": _number(amounts.friction_work) if amounts else None,
        "contact_severity": _optional(amounts.severity) if amounts else None,
        "free_penetration_m": _optional(amounts.free_penetration) if amounts else None,
        "rub_extent": amounts.extent.value if amounts else None,
        "blade_touches": amounts.blade_touches.tolist() if amounts else [],
        "blade_impulses_per_turn_n_s": amounts.blade_impulses.tolist() if amounts else [],
    }


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
    changes = course.changes if course else ()
    return {
        "onset_speed_rpm": _rpm(course.onset_speed) if course else None,
        "end_of_rub_speed_rpm": _rpm(course.end_of_rub_speed) if course else None,
        "change_times_s": [_number(change.time) for change in changes],
        "change_speeds_rpm": [_rpm(change.speed) for change in changes],
        "change_rub": [int(change.rub) for change in changes],
        "change_impulse_per_turn_n_s": [_number(change.impulse) for change in changes],
        "change_motion_classes": [CLASSES.index(change.motion) for change in changes],
    }


def _window_labels(windows: Windows | None) -> dict[str, object]:
    return {
        "window_starts_s": windows.start.tolist() if windows else [],
        "window_speeds_rpm": [_rpm(speed) for speed in windows.speed.tolist()] if windows else [],
        "window_rub": [int(duty > 0) for duty in windows.duty.tolist()] if windows else [],
        "window_contact_duty": windows.duty.tolist() if windows else [],
        "window_impulse_per_turn_n_s": windows.impulse.tolist() if windows else [],
    }


def _rpm(speed: float | None) -> float | None:
    return None if speed is None else _number(rev_per_min(speed))


def _order_labels(labels: Labels, tap: str) -> dict[str, object]:
    plain: dict[str, object] = {
        f"{tap}_orders": _numbers(labels.orders[tap]),
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
