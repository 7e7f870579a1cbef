"""Does half the step leave the labels as they are? At the 105 speeds of the paper's sweep."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from rubgen.labels import Motion
from rubgen.scenario import Scenario, make_scenario
from validation.sensitivity.cases import with_operation
from validation.sensitivity.outcome import Outcome

SPEEDS_RPM = tuple(range(2460, 14941, 120))
STEPS = 1024
IMPULSE_TOLERANCE = 0.02
EQUAL_LABELS = 0.9


@dataclass(frozen=True, kw_only=True)
class Pair:
    """The outcomes at one speed with the step and with half of it.

    `later` is the record that follows that of the whole step, where labels differ: they may do so without a new step.
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


def halve(
    outcome: Callable[[Scenario], Outcome], speeds_rpm: Sequence[float], shorter: Callable[[Scenario], Scenario]
) -> list[Pair]:
    """The pairs at these speeds; `outcome` runs a scenario, `shorter` may cut its turns."""
    return [_pair(outcome, speed, shorter) for speed in speeds_rpm]


def _pair(outcome: Callable[[Scenario], Outcome], speed: float, shorter: Callable[[Scenario], Scenario]) -> Pair:
    asked = shorter(scenario(speed, STEPS))
    pair = Pair(speed_rpm=speed, whole=outcome(asked), half=outcome(shorter(scenario(speed, 2 * STEPS))))
    if pair.equal:
        return pair
    turns = pair.whole.settle_turns + pair.whole.record_turns
    return replace(pair, later=outcome(with_operation(asked, settle_turns=turns)))


def equal_share(pairs: Sequence[Pair]) -> float:
    """Share of the speeds whose labels are equal."""
    return sum(pair.equal for pair in pairs) / len(pairs)
