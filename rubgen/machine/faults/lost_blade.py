"""Blades that are lost as a whole."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

from pydantic.dataclasses import dataclass

from rubgen.machine.faults.fault import Fault, Severity
from rubgen.machine.quantities import STRICT, BladeNumber, LostBladeCount, about

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine


@dataclass(frozen=True, kw_only=True, config=STRICT)
class LostBlade(Fault):
    """Blade number `blade` is gone from its root, and with `lost_count` above 1 the next blades too.

    The lost blades have no mass, no stiffness, no pull on the rim and no contact. So the disk has the unbalance of the
    missing blades opposite to them, its stress is uneven, and the frequencies of the other blades change. The disk
    itself and the dampers of its support do not change. The blades are gone from the beginning: their passage through
    the casing is not modelled. Each choice of blades needs a new reduction of the machine, which takes about two
    seconds.
    """

    SEVERITY: ClassVar = Severity(column="lost_blades", unit="1", meaning="number of blades that are lost as a whole")
    kind: Annotated[Literal["lost-blade"], about("Kind of this fault.")] = "lost-blade"
    lost_count: Annotated[
        LostBladeCount, about("Number of neighbouring blades that are lost. At most a quarter of all can be lost.")
    ] = 1
    blade: Annotated[BladeNumber, about("Number of the first lost blade.")] = 0

    @property
    def severity(self) -> float:
        """The number of lost blades."""
        return float(self.lost_count)

    def problem(self, machine: Machine) -> str | None:
        """Return a problem where the machine has no blade number `blade` or loses too many blades; else None.

        A quarter of the blades can be lost, rounded down, and always one, as long as two blades stay. After the last
        blade comes blade 0. An unbalance of the machine on a lost blade is a problem too.
        """
        count = machine.blades.count
        if self.blade >= count:
            return f"blade = {self.blade}: there is no such blade; give 0 to {count - 1}"
        if self.lost_count > max(count // 4, 1) or count - self.lost_count < 2:
            return (
                f"lost_count = {self.lost_count}: a quarter of {count} blades, and all but two, is the most; lower it"
            )
        lost = self.lost_blades(machine)
        heavy = [each.blade for each in machine.unbalances if each.blade is not None and each.blade in lost]
        if heavy:
            return f"blade = {self.blade}: an unbalance of the machine is on the lost blade {min(heavy)}; move one"
        return None

    def lost_blades(self, machine: Machine) -> tuple[int, ...]:
        """Return the numbers of the lost blades; after the last blade comes blade 0."""
        return tuple((self.blade + each) % machine.blades.count for each in range(self.lost_count))
