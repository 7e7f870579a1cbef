"""A clearance that closes within the record."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Narrowing, Ramp, Severity
from rubgen.machine.quantities import STRICT, Duration, about, real

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine

Moment = Annotated[float, real(ge=0, le=1e5)]
Closing = Annotated[float, real(ge=0, le=0.1)]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class ClosingClearance(Fault):
    """The clearance becomes smaller by `closing_m` all around, linearly over `growth_s` from `start_s` of the record.

    Blades and casing warm up, or a hard landing closes the gap at once (a short `growth_s`). The speed may be constant.
    The rub then begins at a time, `rub_onset_s`, and not at a speed. `clearance_m` is the gap before. The casing's
    radius changes equally at all angles; its stiffness and the blades do not change.
    """

    SEVERITY: ClassVar = Severity(
        column="clearance_closing_m", unit="m", meaning="how far the clearance closes within the record"
    )
    kind: Annotated[Literal["closing-clearance"], about("Kind of this fault.")] = "closing-clearance"
    closing_m: Annotated[Closing, about("How far the clearance closes all around.")]
    start_s: Annotated[
        Moment, about("Time of the record at which the closing begins. Set it within the record to see a rub begin.")
    ] = 0.0
    growth_s: Annotated[
        Duration,
        about("Time in which the clearance closes. Seconds are a thermal closing, less than a turn a hard landing."),
    ] = 1.0

    @property
    def severity(self) -> float:
        """The closing in m."""
        return self.closing_m

    def narrowings(self, machine: Machine) -> tuple[Narrowing, ...]:
        """Return the closing by `closing_m` over its time."""
        return (Narrowing(amount_m=self.closing_m, ramp=Ramp(start_s=self.start_s, duration_s=self.growth_s)),)
