"""The labels of one run."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from rubgen.brief import number
from rubgen.labels.harmonics import TapOrders
from rubgen.solver.exponent import Exponent

if TYPE_CHECKING:
    from rubgen.labels.contact.amounts import ContactAmounts
    from rubgen.labels.motion.whirl import Whirl
    from rubgen.labels.speed_history import Change, SpeedHistory
    from rubgen.labels.windows import Windows
    from rubgen.solver.response import Response


class Motion(StrEnum):
    """Class of a steady motion, from the most regular to the least. Undecided: its indicators contradict each other."""

    STATIC = "static"
    PERIOD_1 = "period-1"
    PERIOD_K = "period-k"
    QUASI_PERIODIC = "quasi-periodic"
    UNDECIDED = "undecided"
    CHAOTIC = "chaotic"


@dataclass(frozen=True, kw_only=True)
class Labels:
    """The labels of a run: its contact and motion, from the true response over the whole record.

    `rubgen.labels.registry` lists the public name of each value; docs/labels.md defines it.
    """

    rub: bool
    """A blade touched."""
    contact_duty: float
    """Share of the steps in which any blade touches."""
    impulse_per_turn: float
    """Mean normal impulse a turn of all blades, N s."""
    blades_touched: int
    """Number of blades that touched."""
    contact_zones: int
    """Number of separate zones on the casing."""
    contact_zone_centres: tuple[float, ...]
    """Polar angle of each zone, rad."""
    contact_zone_widths: tuple[float, ...]
    """Angular width of each zone, rad."""
    contact_zones_symmetric: bool | None
    """Zones are equal and evenly spread; None without contact."""
    motion_blisk: Motion
    """Class of the motion of the blisk; of the whole record undecided where the speed changes in contact."""
    motion_casing: Motion
    """Class of the motion of the casing."""
    motion: Motion
    """The less regular of the two."""
    period_blisk: int | None
    """Turns after which the blisk repeats; None where it does not."""
    period_casing: int | None
    """Turns after which the casing repeats; None where it does not."""
    period: int | None
    """Least common multiple of the two; None where there is none."""
    has_2fr: bool
    """Order 2 stands out of the casing acceleration at 0 degrees; False without a rub."""
    orders: dict[str, TapOrders]
    """By tap: amplitudes at multiples of the rotation frequency; root mean squares over windows at changing speed."""
    orders_present: tuple[int, ...] = ()
    """The k that stand out of the casing acceleration at 0 degrees; none without a rub."""
    lyapunov: Exponent | None = None
    """Largest exponent of the whole system; None where it was switched off, and where the speed changes or a fault
    grows."""
    lyapunov_per_second: float | None = None
    """The same in 1/s."""
    motion_confidence: float = 1.0
    """How sure the class is, 0 to 1."""
    motion_symmetric: bool | None = None
    """The motion has the symmetry of the lobes; None unless it is period-1 in contact."""
    tip_chatter: bool = False
    """The tips do not repeat; disk centre and casing do."""
    zero_one_k: float | None = None
    """K of the 0-1 test."""
    stray_blisk: float | None = None
    """Distance of the blisk's section points from where they should return to, over the motion."""
    stray_casing: float | None = None
    """The same of the casing; None where it rests."""
    motion_settling: bool = False
    """The motion still settles in the second half of the record."""
    segment_starts: tuple[float, ...] = ()
    """Starts of the stretches of an intermittent motion, s from the record's start; else empty."""
    segment_periods: tuple[int, ...] = ()
    """Period of each stretch in turns, 0 where it is irregular."""
    history: SpeedHistory | None = None
    """What happens when, where the speed changes; None at a steady speed."""
    windows: Windows
    """Labels of every 16 turns."""
    amounts: ContactAmounts
    """How much the blades touch."""
    whirl: Whirl | None = None
    """Which way the disk centre goes round; None where it rests."""
    response: Response = field(repr=False, compare=False)
    """What the labels come from: the response in the precision of the compact record, without taps."""

    @property
    def changes(self) -> tuple[Change, ...]:
        """Changes of rub and motion over time; empty for a steady speed."""
        return self.history.changes if self.history else ()

    def __repr__(self) -> str:
        duty, zones = number(self.contact_duty), self.contact_zones
        contact = f"contact_duty={duty}, blades_touched={self.blades_touched}, contact_zones={zones}"
        impulse = f"impulse_per_turn={number(self.impulse_per_turn)}"
        motion = f"motion={self.motion.value!r}, period={self.period}, has_2fr={self.has_2fr}"
        return f"Labels(rub={self.rub}, {contact}, {impulse}, {motion}, orders of {len(self.orders)} signals)"
