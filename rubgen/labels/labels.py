"""The labels of one run."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from rubgen.arrays import FloatArray
from rubgen.brief import number
from rubgen.labels.harmonics import TapOrders
from rubgen.labels.motion.lyapunov import Exponent

if TYPE_CHECKING:
    from rubgen.labels.contact.amounts import ContactAmounts
    from rubgen.labels.motion.whirl import Whirl
    from rubgen.labels.speed_history import CourseLabels
    from rubgen.labels.windows import Windows


class Motion(StrEnum):
    """Class of a steady motion, from the most regular to the least; undecided where its indicators contradict."""

    STATIC = "static"
    PERIOD_1 = "period-1"
    PERIOD_K = "period-k"
    QUASI_PERIODIC = "quasi-periodic"
    UNDECIDED = "undecided"
    CHAOTIC = "chaotic"


@dataclass(frozen=True, kw_only=True)
class Labels:
    """What the dynamics really did, from the true response over the whole record.

    Angles in rad, impulse in N s. `period*` is None unless the motion repeats after that many turns. The dictionaries
    are keyed by tap name: `orders` holds peak amplitudes at k f_r, k = 1..20, in the tap's unit; `even_share` and
    `odd_share` the shares of sum of squared amplitudes on even and odd k; `dominant_order` the k of the largest;
    `order_details` what else `labels.harmonics` finds.
    `orders_present` are the k that stand out of the casing acceleration at 0 degrees.
    `lyapunov` is the largest exponent of the whole system in 1/turn, None where it was switched off.
    `motion_symmetric` is None unless the motion is period-1 in contact. `zero_one_k` is K of the 0-1 test, `stray_*`
    how far the points of the section lie from where they should come back to, over the motion. Segments are empty
    unless the motion switches: starts in s from the record's, periods in turns, 0 where it is irregular. Where the
    speed changes, `course` tells how the labels go with time; the motion of the whole is undecided in contact, and
    `orders` are the root mean squares of those of windows. `windows` hold labels of every 16 turns, `amounts` how much
    blades touch, `whirl` which way the disk centre goes round; None where a response does not tell.
    """

    rub: bool
    contact_duty: float
    impulse_per_turn: float
    blades_touched: int
    contact_zones: int
    contact_zone_centres: tuple[float, ...]
    contact_zone_widths: tuple[float, ...]
    contact_zones_symmetric: bool | None
    motion_blisk: Motion
    motion_casing: Motion
    motion: Motion
    period_blisk: int | None
    period_casing: int | None
    period: int | None
    has_2fr: bool
    orders: dict[str, FloatArray]
    even_share: dict[str, float]
    odd_share: dict[str, float]
    dominant_order: dict[str, int]
    order_details: dict[str, TapOrders] = field(default_factory=dict)
    orders_present: tuple[int, ...] = ()
    lyapunov: Exponent | None = None
    motion_confidence: float = 1.0
    motion_symmetric: bool | None = None
    tip_chatter: bool = False
    zero_one_k: float | None = None
    stray_blisk: float | None = None
    stray_casing: float | None = None
    segment_starts: tuple[float, ...] = ()
    segment_periods: tuple[int, ...] = ()
    lyapunov_per_second: float | None = None
    course: CourseLabels | None = None
    windows: Windows | None = None
    amounts: ContactAmounts | None = None
    whirl: Whirl | None = None

    def __repr__(self) -> str:
        duty, zones = number(self.contact_duty), self.contact_zones
        contact = f"contact_duty={duty}, blades_touched={self.blades_touched}, contact_zones={zones}"
        impulse = f"impulse_per_turn={number(self.impulse_per_turn)}"
        motion = f"motion={self.motion.value!r}, period={self.period}, has_2fr={self.has_2fr}"
        return f"Labels(rub={self.rub}, {contact}, {impulse}, {motion}, orders of {len(self.orders)} signals)"
