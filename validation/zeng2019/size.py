"""How much is computed, all of it or little for a look, and of which machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from rubgen.scenario import Scenario

MACHINE, FITTED = MACHINES = "zeng2019", "zeng2019-fitted"
"""The preset, and what `python -m validation.zeng2019 --fit` made of it."""


@dataclass(frozen=True, kw_only=True)
class Size:
    """Turns of each run, every how many values of a full sweep are taken, and the preset that is run.

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

    def shortened(self, scenario: Scenario) -> Scenario:
        """The scenario with the turns of this size."""
        turns = replace(scenario.operation, settle_turns=self.settle_turns, record_turns=self.record_turns)
        return replace(scenario, operation=turns)

    @property
    def option(self) -> str:
        """What to add to a command so that it computes this size."""
        much = " --quick" if self.name == "quick" else f" --every {self.speed_thin}" if self.speed_thin > 1 else ""
        return much if self.machine == MACHINE else f"{much} --machine {self.machine}"

    @property
    def fitted(self) -> bool:
        """Whether the machine is one that was fitted to the classes of the regions II, III and V."""
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
