import numpy as np
import pytest

from rubgen.labels import Motion
from rubgen.labels.motion.decision import Indicators, MotionClass, combined, decide
from rubgen.solver.exponent import Exponent

STRONG, GROWING, NEUTRAL, DYING = (
    Exponent(per_turn=size, error=0.01, convergence=np.full(10, size), turns=500) for size in (1.5, 0.2, 0.001, -0.2)
)


def decided(period: int | None, stray: float, growth: float, exponent: Exponent | None) -> MotionClass:
    return decide(Indicators(period=period, stray=stray, growth=growth, exponent=exponent))


@pytest.mark.parametrize(
    ("period", "stray", "growth", "exponent", "motion"),
    [
        (1, 1e-8, 0.0, DYING, Motion.PERIOD_1),
        (3, 1e-8, 0.0, DYING, Motion.PERIOD_K),
        (1, 1e-3, 0.99, GROWING, Motion.PERIOD_1),  # chaos 60 dB below the motion
        (1, 8e-3, 0.99, GROWING, Motion.UNDECIDED),  # 2 dB below the bound, and both others see chaos
        (1, 8e-3, 0.99, NEUTRAL, Motion.PERIOD_1),
        (1, 8e-3, 0.2, GROWING, Motion.PERIOD_1),
        (None, 0.1, 0.99, GROWING, Motion.CHAOTIC),
        (None, 0.1, 0.02, NEUTRAL, Motion.QUASI_PERIODIC),
        (None, 0.1, 0.99, NEUTRAL, Motion.UNDECIDED),
        (None, 0.1, 0.99, DYING, Motion.UNDECIDED),
        (None, 0.1, 0.02, GROWING, Motion.UNDECIDED),
        (None, 0.1, 0.02, DYING, Motion.UNDECIDED),  # a period above 16, or not there yet
        (None, 0.1, 0.99, None, Motion.CHAOTIC),
        (None, 0.1, 0.02, None, Motion.QUASI_PERIODIC),
    ],
)
def test_a_class_needs_indicators_that_agree(period, stray, growth, exponent, motion) -> None:
    found = decided(period, stray, growth, exponent)
    assert found.motion is motion
    assert found.period == (period if motion in (Motion.PERIOD_1, Motion.PERIOD_K) else None)
    assert (found.confidence == 0) is (motion is Motion.UNDECIDED)
    assert 0 <= found.confidence <= 1


def test_confidence_falls_towards_the_bounds() -> None:
    far, near = (decided(1, stray, 0.0, DYING).confidence for stray in (1e-4, 9e-3))
    assert far > 0.95
    assert 0.5 < near < 0.6
    sure, *doubtful = (
        decided(None, stray, growth, exponent).confidence
        for stray, growth, exponent in (
            (0.3, 0.99, STRONG), (0.011, 0.99, STRONG), (0.3, 0.72, STRONG), (0.3, 0.99, GROWING), (0.3, 0.99, None),
        )
    )  # fmt: skip
    assert sure > 0.95
    assert max(doubtful) < 0.9
    assert decided(1, 4e-3, 0.99, GROWING).confidence < decided(1, 4e-3, 0.0, DYING).confidence
    assert decided(1, 1e-6, 0.0, NEUTRAL).confidence < 0.6  # half the step may be beyond a bifurcation


def test_few_steps_in_a_touch_leave_a_periodic_motion_doubtful() -> None:
    fine, coarse = (
        decide(Indicators(period=1, stray=1e-8, growth=0.0, exponent=DYING, resolved=resolved))
        for resolved in (True, False)
    )
    assert fine == coarse
    assert fine.confidence > 0.95
    assert coarse.confidence < 0.9


def test_what_few_runs_have_shown_is_never_sure() -> None:
    assert decided(4, 1e-9, 0.0, DYING).confidence < 0.9
    assert decided(None, 1.0, 0.0, NEUTRAL).confidence < 0.9


def test_chaos_of_one_part_is_that_of_the_whole_and_else_doubt_is() -> None:
    chaotic, doubt, regular = (
        decided(None, 0.3, 0.99, GROWING),
        decided(None, 0.3, 0.0, GROWING),
        decided(1, 1e-6, 0.0, DYING),
    )
    assert combined(doubt, chaotic) == chaotic
    assert combined(doubt, regular).motion is Motion.UNDECIDED
    assert combined(doubt, regular).confidence == 0
    assert combined(regular, chaotic).confidence == chaotic.confidence
