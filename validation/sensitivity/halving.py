"""Does half the step leave the labels as they are? At the 105 speeds of the paper's sweep."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from rubgen.labels import Motion
from rubgen.scenario import Scenario, make_scenario
from validation.sensitivity.cases import with_operation
from validation.sensitivity.outcome import Outcome
from validation.sensitivity.results import Shorten

SPEEDS_RPM = tuple(range(2460, 14941, 120))
STEPS = 1024
IMPULSE_TOLERANCE = 0.02
EQUAL_LABELS = 0.9


@dataclass(frozen=True, kw_only=True)
class Pair:
    """The outcomes at one speed with the step and with half of it.

    `later` is the outcome of the record that follows the whole step's, where labels differ: they may do so without a
    new step.
    """

    speed_rpm: float
    whole: Outcome
    half: Outcome
    later: Outcome | None = None

    @property
    def equal(self) -> bool:
        """Whether status, rub and motion with its period are equal."""
        return _label(self.whole) == _label(self.half)

    @property
    def equal_zones(self) -> bool:
        """Whether the number of contact zones and their symmetry are equal as well."""
        return (self.whole.zones, self.whole.symmetric) == (self.half.zones, self.half.symmetric)

    @property
    def changes_by_itself(self) -> bool:
        """Whether the label changes from one record to the next with the same step."""
        return self.later is not None and _label(self.whole) != _label(self.later)

    @property
    def impulse_change(self) -> float | None:
        """Impulse of the whole step over that of half the step, less 1; None unless both are period-1 in contact."""
        both = (self.whole, self.half)
        if not all(run.rub and run.motion == Motion.PERIOD_1.value for run in both):
            return None
        return self.whole.impulse / self.half.impulse - 1


def _label(outcome: Outcome) -> tuple[str, bool, str, int | None]:
    return outcome.status, outcome.rub, outcome.motion, outcome.period


def scenario(speed_rpm: float, steps_per_turn: int) -> Scenario:
    """The preset at that speed, all else by default."""
    return with_operation(make_scenario("zeng2019", speed_rpm=speed_rpm), steps_per_turn=steps_per_turn)


def halve(outcome: Callable[[Scenario], Outcome | None], speeds_rpm: Sequence[float], shorten: Shorten) -> list[Pair]:
    """The pairs at those of the speeds where both runs are finished; `outcome` returns None for a run that is not."""
    pairs = []
    for speed in speeds_rpm:
        whole, half = (outcome(shorten(scenario(speed, steps))) for steps in (STEPS, 2 * STEPS))
        if whole and half:
            pair = Pair(speed_rpm=speed, whole=whole, half=half)
            pairs.append(pair if pair.equal else replace(pair, later=outcome(next_record(pair, shorten))))
    return pairs


def next_record(pair: Pair, shorten: Shorten) -> Scenario:
    """The scenario of the whole step, with the record that follows the one that it has."""
    turns = pair.whole.settle_turns + pair.whole.record_turns
    return with_operation(shorten(scenario(pair.speed_rpm, STEPS)), settle_turns=turns)


def equal_share(pairs: Sequence[Pair]) -> float:
    """Share of the speeds whose labels are equal."""
    return sum(pair.equal for pair in pairs) / len(pairs)
