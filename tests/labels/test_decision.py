import numpy as np
import pytest

from rubgen.labels import Motion
from rubgen.labels.motion.decision import Indicators, MotionClass, combined, decide
from rubgen.solver.exponent import Exponent

GROWING, NEUTRAL, DYING = (
    Exponent(per_turn=size, error=0.01, convergence=np.full(10, size), turns=500) for size in (0.2, 0.001, -0.2)
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
    far, near = (decided(1, stray, 0.0, NEUTRAL).confidence for stray in (1e-4, 9e-3))
    assert far > 0.99
    assert 0.5 < near < 0.9
    sure, doubtful = (decided(None, 0.3, growth, GROWING).confidence for growth in (0.99, 0.72))
    assert sure > 0.95
    assert doubtful < sure
    assert decided(1, 4e-3, 0.99, GROWING).confidence < decided(1, 4e-3, 0.0, DYING).confidence
    assert decided(None, 0.3, 0.99, None).confidence < sure


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
