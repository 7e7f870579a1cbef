"""The reliability of `motion_confidence`: what is counted as kept, in which bin, and what the page says of it."""

import numpy as np
import pytest

from rubgen.labels.motion.classify import Motions
from rubgen.labels.motion.decision import AT_REST, Indicators, combined, decide
from rubgen.solver.exponent import Exponent
from validation.sensitivity.confidence import bins, interval, spreads, sure
from validation.sensitivity.confidence_figure import reliability_figure
from validation.sensitivity.confidence_page import confidence_page
from validation.sensitivity.recipes import RECIPES, SEEDS, Halved, all_runs

RUN = all_runs(1, lambda scenario: scenario)[0]


def motions(period: int | None, stray: float, growth: float, exponent: float) -> Motions:
    known = Exponent(per_turn=exponent, error=0.01, convergence=np.full(10, exponent), turns=500)
    seen = Indicators(period=period, stray=stray, growth=growth, exponent=known)
    blisk = decide(seen)
    return Motions(blisk=blisk, casing=AT_REST, system=combined(blisk, AT_REST), indicators=(seen,))


REGULAR, CHAOTIC, DOUBT = motions(1, 1e-4, 0.0, -0.2), motions(None, 0.3, 0.99, 1.0), motions(None, 0.3, 0.0, 1.0)
DOUBLED = motions(2, 1e-4, 0.0, -0.2)


def pair(whole: Motions, half: Motions) -> Halved:
    return Halved(run=RUN, whole=whole, half=half)


def test_a_class_is_kept_with_its_period():
    assert pair(REGULAR, motions(1, 5e-4, 0.1, -0.1)).kept
    assert not pair(REGULAR, CHAOTIC).kept
    assert not pair(DOUBLED, motions(4, 1e-4, 0.0, -0.2)).kept


def test_bins_count_decided_runs_by_confidence():
    pairs = [pair(REGULAR, REGULAR), pair(REGULAR, CHAOTIC), pair(CHAOTIC, CHAOTIC), pair(DOUBT, CHAOTIC)]
    assert sum(each.runs for each in bins(pairs)) == 3
    assert sum(each.kept for each in bins(pairs)) == 2
    assert sure(pairs) == (3, 2)
    low, high = bins(pairs)[-1].interval
    assert low < 2 / 3 < high


def test_interval_is_where_the_share_is_compatible_with_the_runs():
    """Wilson's bounds solve (share - p)^2 = z^2 p (1 - p) / n."""
    low, high = interval(57, 61)
    for p in (low, high):
        assert (57 / 61 - p) ** 2 == pytest.approx(1.96**2 * p * (1 - p) / 61)
    assert low < 57 / 61 < high
    assert interval(61, 61)[1] == pytest.approx(1.0)


def test_spreads_are_changes_in_decades():
    changed = motions(1, 1e-3, 0.0, -0.2)
    assert spreads([pair(REGULAR, changed)])["stray, the rest regular"].rms == pytest.approx(1.0)
    grown = spreads([pair(CHAOTIC, motions(None, 0.3, 0.79, 10.0))])
    assert grown["K"].rms == pytest.approx(0.2)
    assert grown["exponent, positive"].rms == pytest.approx(1.0)


def test_runs_come_from_every_recipe_and_both_seeds():
    runs = all_runs(2, lambda scenario: scenario)
    assert {(run.recipe, run.use) for run in runs[: len(RECIPES) * len(SEEDS)]} == {
        (recipe, use) for recipe in RECIPES for use in SEEDS
    }
    pieces = [run.piece(steps).key for run in runs for steps in (1024, 2048)]
    assert len(set(pieces)) == len(pieces)


def test_the_page_names_every_class_that_moves():
    pairs = {"fit": [pair(REGULAR, REGULAR)], "check": [pair(CHAOTIC, REGULAR), pair(DOUBT, REGULAR)]}
    text = confidence_page(pairs)
    moved = [line for line in text.splitlines() if RUN.name in line]
    assert ["chaotic / period-1" in line or "undecided / period-1" in line for line in moved] == [True, True]
    assert "| check | **0.9 to 1** |  | 1 | 0 | **0.0** | 0.0 to 79.3 |" in text
    assert "| check, run 16 on | **0.9 to 1** |  | 0 | 0 | **-** | - |" in text
    figure = reliability_figure(pairs)
    assert [list(container.lines[0].get_ydata()) for container in figure.axes[0].containers] == [[1.0], [0.0]]
