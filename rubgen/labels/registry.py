"""Every label by its public name: kind, unit, meaning, role, and how its value is read.

The columns of Parquet files, the JSON form (MCAP, Rerun, `--json`), the schema of a run, the card, Croissant, the units
of a DataFrame and the tables of docs/labels.md come from here. A new label is one entry, where its column is to stand.
Meanings stand in the files: another wording changes their bytes.
"""

import math

import numpy as np

from rubgen.labels.classes import MOTION_CLASSES
from rubgen.labels.contact.amounts import RubExtent
from rubgen.labels.entries import EnergyLabel, Label, TapLabel, WindowLabel, count, counts, flag, number, numbers, text
from rubgen.labels.harmonics import FRACTIONS
from rubgen.labels.labels import Motion
from rubgen.labels.motion.whirl import WhirlDirection
from rubgen.units import rev_per_min


def _rpm(speed: float | None) -> float | None:
    return None if speed is None else rev_per_min(speed)


_NUMBERED = ", ".join(f"{place} {word}" for word, place in MOTION_CLASSES.items())

CONTACT = (
    flag("rub", "a blade touched the casing within the record", lambda x: x.rub, role="target"),
    number(
        "contact_duty", "1", "share of the time in which any blade touches", lambda x: x.contact_duty, role="target"
    ),
    number(
        "contact_impulse_per_turn_n_s",
        "N s",
        "mean normal impulse a turn, all blades",
        lambda x: x.impulse_per_turn,
        role="target",
    ),
    count("blades_touched", "number of blades that touched", lambda x: x.blades_touched, role="target"),
    count("contact_zones", "number of separate contact zones on the casing", lambda x: x.contact_zones, role="target"),
    numbers(
        "contact_zone_centres_rad", "rad", "polar angle of each zone", lambda x: x.contact_zone_centres, role="target"
    ),
    numbers(
        "contact_zone_widths_rad", "rad", "angular width of each zone", lambda x: x.contact_zone_widths, role="target"
    ),
    flag(
        "contact_zones_symmetric",
        "zones equal and evenly spread; null without contact",
        lambda x: x.contact_zones_symmetric,
    ),
    count("contact_touches", "uninterrupted touches of single blades within the record", lambda x: x.amounts.touches),
    number(
        "contact_friction_work_per_turn_j",
        "J",
        "mean work of friction a turn, all blades, <= 0",
        lambda x: x.amounts.friction_work,
    ),
    number(
        "contact_severity",
        "1",
        "mean normal force over the blisk's weight",
        lambda x: x.amounts.severity,
        role="target",
    ),
    number(
        "free_penetration_m",
        "m",
        "how deep tips would be without contact; null at changing speeds and where a support is loose or oil whirls",
        lambda x: x.amounts.free_penetration,
    ),
    text("rub_extent", "none, partial or full-annular", RubExtent, lambda x: x.amounts.extent, role="target"),
    counts("blade_touches", "touches of each blade within the record", lambda x: x.amounts.blade_touches),
    numbers(
        "blade_impulses_per_turn_n_s",
        "N s",
        "mean normal impulse a turn of each blade",
        lambda x: x.amounts.blade_impulses,
    ),
    text(
        "whirl",
        "direction of the disk centre's orbit: forward, backward or mixed",
        WhirlDirection,
        lambda x: x.whirl and x.whirl.direction,
    ),
    number(
        "whirl_index", "1", "1 a circle forward, 0 a line, -1 a circle backward", lambda x: x.whirl and x.whirl.index
    ),
)
MOTION = (
    text(
        "motion_blisk",
        "static, period-1, period-k, quasi-periodic, undecided or chaotic",
        Motion,
        lambda x: x.motion_blisk,
    ),
    text("motion_casing", "the same of the casing", Motion, lambda x: x.motion_casing),
    text("motion", "the less regular of the two", Motion, lambda x: x.motion, role="target"),
    count(
        "period_blisk",
        "turns after which the blisk repeats; null where it does not",
        lambda x: x.period_blisk,
        unit="turns",
    ),
    count("period_casing", "the same of the casing", lambda x: x.period_casing, unit="turns"),
    count(
        "period",
        "least common multiple of the two; null where there is none",
        lambda x: x.period,
        unit="turns",
        role="target",
    ),
    number(
        "motion_confidence",
        "1",
        "chance that half the time step keeps the class, 0 to 1; 0 where undecided",
        lambda x: x.motion_confidence,
        role="diagnostic",
    ),
    flag(
        "motion_symmetric",
        "q(t + T/N) = q(t) for N lobes; null unless period-1 in contact",
        lambda x: x.motion_symmetric,
    ),
    flag(
        "motion_settling",
        "the motion still settles in the second half of the record",
        lambda x: x.motion_settling,
        role="diagnostic",
    ),
    flag("motion_intermittent", "the motion switches between regular and irregular", lambda x: bool(x.segment_starts)),
    numbers(
        "motion_segment_starts_s", "s", "starts of its stretches, from the record's start", lambda x: x.segment_starts
    ),
    counts(
        "motion_segment_periods", "period of each stretch, 0 where irregular", lambda x: x.segment_periods, unit="turns"
    ),
    flag("tip_chatter", "tips do not repeat, disk centre and casing do", lambda x: x.tip_chatter),
    number(
        "stray_blisk",
        "1",
        "how far the blisk's section strays from repeating, over its motion",
        lambda x: x.stray_blisk,
        role="diagnostic",
    ),
    number(
        "stray_casing", "1", "the same of the casing; null where it rests", lambda x: x.stray_casing, role="diagnostic"
    ),
    number(
        "zero_one_k",
        "1",
        "K of the 0-1 test: near 1 for chaos, near 0 for regular motion",
        lambda x: x.zero_one_k,
        role="diagnostic",
    ),
)
ORDERS = (
    flag("has_2fr", "order 2 stands out of the casing acceleration at 0 degrees", lambda x: x.has_2fr, from_taps=True),
    counts(
        "orders_present",
        "the k up to 20 that stand out of that acceleration, as for has_2fr",
        lambda x: x.orders_present,
        from_taps=True,
    ),
)
EXPONENT = (
    number(
        "lyapunov_per_turn",
        "1/turn",
        "largest Lyapunov exponent; null where switched off",
        lambda x: x.lyapunov and x.lyapunov.per_turn,
    ),
    number("lyapunov_per_second", "1/s", "the same by the second", lambda x: x.lyapunov_per_second),
    number(
        "lyapunov_error", "1/turn", "its standard error", lambda x: x.lyapunov and x.lyapunov.error, role="diagnostic"
    ),
    numbers(
        "lyapunov_convergence",
        "1/turn",
        "it from 1/10, 2/10, ... of the turns that count",
        lambda x: x.lyapunov.convergence if x.lyapunov else (),
        role="diagnostic",
    ),
    count(
        "lyapunov_turns",
        "turns of the record after which the exponent was settled",
        lambda x: x.lyapunov and x.lyapunov.turns,
        role="diagnostic",
    ),
)
HISTORY = (
    number(
        "onset_speed_rpm",
        "rev/min",
        "speed at the first touch; null without or at a steady speed",
        lambda x: _rpm(x.history.onset_speed) if x.history else None,
        role="target",
    ),
    number(
        "end_of_rub_speed_rpm",
        "rev/min",
        "speed at the end of the last touch",
        lambda x: _rpm(x.history.end_of_rub_speed) if x.history else None,
    ),
    numbers(
        "change_times_s",
        "s",
        "times from the record's start at which labels change; first 0",
        lambda x: [change.time for change in x.changes],
    ),
    numbers("change_speeds_rpm", "rev/min", "speed at each", lambda x: [_rpm(change.speed) for change in x.changes]),
    counts("change_rub", "1 where a rub goes on from there, else 0", lambda x: [change.rub for change in x.changes]),
    numbers(
        "change_impulse_per_turn_n_s",
        "N s",
        "mean normal impulse a turn until the next",
        lambda x: [change.impulse for change in x.changes],
    ),
    Label(
        "change_motion_classes",
        "integers",
        "",
        f"class of motion from there on: {_NUMBERED}",
        lambda x: [MOTION_CLASSES[change.motion] for change in x.changes],
        words=Motion,
    ),
)
WINDOWS = (
    numbers("window_starts_s", "s", "starts of windows of 16 turns", lambda x: x.windows.start),
    numbers("window_speeds_rpm", "rev/min", "mean speed of each", lambda x: [_rpm(speed) for speed in x.windows.speed]),
    counts("window_rub", "1 where a blade touches within the window, else 0", lambda x: x.windows.duty > 0),
    numbers(
        "window_contact_duty", "1", "share of the time in which any blade touches, of each", lambda x: x.windows.duty
    ),
    numbers("window_impulse_per_turn_n_s", "N s", "mean normal impulse a turn of each", lambda x: x.windows.impulse),
    Label(
        "window_motion_classes",
        "integers",
        "",
        f"class of motion of each: {_NUMBERED} or changing",
        lambda x: [MOTION_CLASSES[motion] for motion, _ in x.windows.motion],
        words=Motion,
    ),
    numbers(
        "window_motion_confidence",
        "1",
        "chance that half the time step keeps that class; null where it was not measured",
        lambda x: [math.nan if sure is None else sure for _, sure in x.windows.motion],
    ),
)

LABELS = (*CONTACT, *MOTION, *ORDERS, *EXPONENT, *HISTORY, *WINDOWS)
"""In the order of the columns."""
_FRACTIONS = ", ".join(str(fraction) for fraction in FRACTIONS)
TAP_LABELS = (
    TapLabel("orders", "numbers", None, "peak amplitudes of {tap} at k f_r, k = 1..20", lambda tap: tap.amplitudes),
    TapLabel("even_share", "number", "1", "share of the squares on even k", lambda tap: tap.even_share),
    TapLabel("odd_share", "number", "1", "share of the squares on odd k", lambda tap: tap.odd_share),
    TapLabel("dominant_order", "integer", "", "k of the largest amplitude", lambda tap: tap.dominant),
    TapLabel("order_phases_rad", "numbers", "rad", "phases: A cos(k theta + phase), k = 1..20", lambda tap: tap.phases),
    TapLabel("order_floors", "numbers", None, "median amplitude around each k", lambda tap: tap.floors),
    TapLabel(
        "fractional_amplitudes", "numbers", None, f"the same at f_r times {_FRACTIONS}", lambda tap: tap.fractional
    ),
    TapLabel(
        "blade_passing",
        "numbers",
        None,
        "at blade passing and two orders on either side, b-2..b+2",
        lambda tap: tap.blade_passing,
    ),
)
TAP_ENDINGS = tuple(f"_{label.ending}" for label in TAP_LABELS)
"""Ends of the names of the labels that each true signal has."""
WINDOW_LABELS = (
    WindowLabel(
        "window_amplitudes",
        "amplitudes at k f_r, twenty a window, the last ones",
        lambda windows: windows.astype(np.float32).ravel().tolist(),  # in single precision they compress
    ),
)
ENERGY_LABELS = (
    EnergyLabel(
        "energy_residual",
        "1",
        "error of the energy identity, share of all absolute works",
        lambda x: x.residual,
        role="diagnostic",
    ),
    EnergyLabel("normal_loss_j", "J", "energy lost in normal impacts, <= 0", lambda x: x.normal_loss),
    EnergyLabel("friction_loss_j", "J", "energy lost in friction, <= 0", lambda x: x.friction_loss),
)
