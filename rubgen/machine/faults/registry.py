"""Every kind of fault; a new one is a file and a line here."""

from typing import Annotated, Any

from pydantic import Field

from rubgen.machine.faults.bearing_defect import BearingDefect
from rubgen.machine.faults.bow import Bow
from rubgen.machine.faults.casing_off_centre import CasingOffCentre
from rubgen.machine.faults.closing_clearance import ClosingClearance
from rubgen.machine.faults.crack import Crack
from rubgen.machine.faults.cracked_blade import CrackedBlade
from rubgen.machine.faults.fault import Fault
from rubgen.machine.faults.growing_unbalance import GrowingUnbalance
from rubgen.machine.faults.loose_support import LooseSupport
from rubgen.machine.faults.lost_blade import LostBlade
from rubgen.machine.faults.lost_tip import LostTip
from rubgen.machine.faults.misalignment import Misalignment
from rubgen.machine.faults.oil_whirl import OilWhirl

AnyFault = Annotated[
    Misalignment  #
    | Bow
    | CasingOffCentre
    | GrowingUnbalance
    | ClosingClearance
    | BearingDefect
    | LooseSupport
    | OilWhirl
    | Crack
    | CrackedBlade
    | LostTip
    | LostBlade,
    Field(discriminator="kind"),
]
_KINDS: Any = AnyFault
FAULTS: dict[str, type[Fault]] = {kind.kind: kind for kind in _KINDS.__origin__.__args__}
"""Each kind by its name; columns stand in this order, so a new one is at the end."""
