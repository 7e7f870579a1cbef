"""How much is computed, all of it or little for a look, and of which machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from rubgen.scenario import ContactLaw, Scenario, make_scenario
from validation.onset import chord_inset

MACHINE, AS_COMPUTED, TWIN = MACHINES = "zeng2019", "zeng2019-as-computed", "zeng2019-as-computed, smooth"
"""The preset; the machine as the paper discretised it, on chords; and the same machine and air on the smooth curve."""
CHORDS = ContactLaw(surface="chords")


@dataclass(frozen=True, kw_only=True)
class Size:
    """Turns of each run, every how many values of a full sweep are taken, and which of MACHINES is run.

    `thin` thins sweeps, keeping their ends, `speed_thin` that of the speed; `campbell_step` is that of the reduced
    models, `full_speeds` are the speeds of the full one, in rev/min; `samples` is the number of Sobol base points, a
    power of two.
    """

    name: str
    settle_turns: int
    record_turns: int
    thin: int
    speed_thin: int
    campbell_step: int
    full_speeds: tuple[float, ...]
    samples: int
    machine: str = MACHINE

    def scenario(self) -> Scenario:
        """The machine on its contact surface, without friction, with the turns of this size."""
        made = make_scenario(MACHINE if self.machine == MACHINE else AS_COMPUTED)
        turns = replace(made.operation, settle_turns=self.settle_turns, record_turns=self.record_turns)
        made = replace(made, operation=turns)
        if self.machine == AS_COMPUTED:
            return replace(made, contact=CHORDS)
        if self.machine == MACHINE:
            return made
        casing = made.machine.casing
        smooth = replace(casing, clearance_m=casing.clearance_m - chord_inset(made.machine))
        return replace(made, machine=replace(made.machine, casing=smooth))

    @property
    def option(self) -> str:
        """What to add to a command so that it computes this size."""
        return " --quick" if self.name == "quick" else f" --every {self.speed_thin}" if self.speed_thin > 1 else ""

    @property
    def fitted(self) -> bool:
        """Whether the machine was fitted to the classes of the regions II, III and V."""
        return self.machine != MACHINE

    def speeds_of(self, values: Sequence[float]) -> tuple[float, ...]:
        """The values of a sweep of the speed at this size, with its first and its last."""
        return replace(self, thin=self.speed_thin).of(values)

    def of(self, values: Sequence[float]) -> tuple[float, ...]:
        """The values of another sweep at this size, with its first and its last."""
        kept = list(values[:: self.thin])
        return tuple(kept if kept[-1] == values[-1] else [*kept, values[-1]])


FULL = Size(
    name="full",
    settle_turns=150,
    record_turns=500,
    thin=1,
    speed_thin=1,
    campbell_step=250,
    full_speeds=(0.0, 5000.0, 10000.0, 15000.0),
    samples=64,
)
QUICK = Size(
    name="quick",
    settle_turns=60,
    record_turns=128,
    thin=12,
    speed_thin=12,
    campbell_step=2500,
    full_speeds=(0.0, 15000.0),
    samples=4,
)


def sizes(size: Size) -> dict[str, Size]:
    """The size of each machine: the twin takes every fourth speed and every second support of it."""
    twin = replace(size, machine=TWIN, thin=2 * size.thin, speed_thin=4 * size.speed_thin)
    return {MACHINE: replace(size, machine=MACHINE), AS_COMPUTED: replace(size, machine=AS_COMPUTED), TWIN: twin}
