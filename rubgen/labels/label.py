"""Make all labels of one run."""

from dataclasses import replace

from rubgen.labels.compact_record import in_record_precision
from rubgen.labels.contact.amounts import contact_amounts
from rubgen.labels.contact.zones import contact_zones
from rubgen.labels.harmonics import MARKED_TAP, harmonics
from rubgen.labels.labels import Labels
from rubgen.labels.motion.classify import motion
from rubgen.labels.motion.whirl import whirl
from rubgen.labels.speed_history import by_angle, changing_motion, changing_orders, speed_history
from rubgen.labels.stretches import window_motions
from rubgen.labels.windows import windows
from rubgen.solver.exponent import lyapunov
from rubgen.solver.response import Response


def label(response: Response) -> Labels:
    """Compute the labels of a run that ended with status OK. Every label is defined in docs/labels.md.

    Labels describe the true response, before any sensor. Contact and motion are computed from the whole record, orders
    from its last 100 turns. Only the number of windows with amplitudes depends on the length of the taps. The class of
    motion is reliable for a record of 500 turns or more. Raises UserError below 32 turns, but not where the speed
    changes or a fault grows. For a changing speed see `speed_history`. A response made from a compact record has no
    taps: its labels are the same, without orders.
    """
    response = in_record_precision(response)
    contact_steps = int(response.contact_steps_per_turn.sum())
    rub = contact_steps > 0
    zones = contact_zones(by_angle(response), steps_per_turn=response.steps_per_turn)
    exponent = lyapunov(response.companion_growth)
    history = speed_history(response) if response.changing_speed else None
    parts = changing_motion(response, rub) if history or response.grows else motion(response, exponent)
    cut = windows(response)
    cut = replace(cut, motion=window_motions(response, parts, history))
    orders = changing_orders(cut) if history else harmonics(response)
    present = orders[MARKED_TAP].present if rub and orders else ()
    turn = response.turn_seconds
    return Labels(
        rub=rub,
        contact_duty=contact_steps / response.record_steps,
        impulse_per_turn=float(response.impulse_per_turn.mean()),
        blades_touched=len(set(response.events.blade.tolist())),
        contact_zones=len(zones.centres),
        contact_zone_centres=zones.centres,
        contact_zone_widths=zones.widths,
        contact_zones_symmetric=zones.symmetric,
        motion_blisk=parts.blisk.motion,
        motion_casing=parts.casing.motion,
        motion=parts.system.motion,
        period_blisk=parts.blisk.period,
        period_casing=parts.casing.period,
        period=parts.system.period,
        has_2fr=2 in present,
        orders=orders,
        orders_present=present,
        lyapunov=exponent,
        lyapunov_per_second=exponent.per_turn / turn if exponent else None,
        motion_confidence=parts.system.confidence,
        motion_symmetric=parts.symmetric,
        tip_chatter=parts.tip_chatter,
        zero_one_k=parts.indicators[0].growth if parts.indicators else None,
        stray_blisk=parts.indicators[0].stray if parts.indicators else None,
        stray_casing=parts.indicators[1].stray if len(parts.indicators) > 1 else None,
        motion_settling=parts.settling,
        segment_starts=tuple(segment.start * turn for segment in parts.segments),
        segment_periods=tuple(segment.period for segment in parts.segments),
        history=history,
        windows=cut,
        amounts=contact_amounts(response, zones, record_steps=response.record_steps),
        whirl=whirl(response.orbit),
        response=replace(response, taps={}),
    )
