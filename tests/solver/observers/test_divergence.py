"""Rates of growth in the reason of a run that diverges."""

import re
from pathlib import Path

import numpy as np
import pytest

from rubgen.scenario import ContactLaw
from rubgen.solver.observers.divergence import ADVICE, Growth, trend, what_diverged
from rubgen.solver.speed.start import rub_free_stepper


@pytest.fixture
def stepper(small_system):
    return rub_free_stepper(small_system(), ContactLaw(), 256)


def add(growth, casing, tip, steps=256):
    """A turn in whose tenth frame blade 3 is displaced by `tip`."""
    stepper = growth.stepper
    q = np.zeros(len(stepper.system.M))
    q[3 * 3 + 1] = -tip
    stepper.result = stepper.result._replace(frames=np.zeros_like(stepper.result.frames))
    stepper.result.frames[10] = stepper.blocks.to_z(q)
    stepper.result.summary[2] = casing
    growth.add(steps)


def test_rates_are_those_of_exponentials_over_the_last_ten_turns(stepper):
    growth = Growth(stepper)
    for turn in range(25):
        add(growth, 2e-5 * np.exp(0.1 * max(turn - 14, 0)), 1e-6 * np.exp(0.3 * turn))
    text = growth.sentence()
    assert text.startswith("growing: rate over the last 10 turns blades +0.3 a turn (+")
    middle = 1e3 * 1e-6 * np.exp(0.3 * 19)
    assert f"({0.3 / (2 * np.pi / 400.0):+.3g} 1/s) about {middle:.3g} mm, casing +0.1 a turn" in text


def test_a_motion_that_goes_up_and_down_is_no_growth(stepper):
    growth = Growth(stepper)
    for turn in range(15):
        add(growth, 1e-3, 4e-3 * (1 + 0.2 * (-1) ** turn))
    assert growth.sentence().startswith(
        "no steady growth, an excursion of an irregular motion: rate over the last 10 turns"
    )


def test_the_last_turn_counts_as_far_as_it_went(stepper):
    growth = Growth(stepper)
    for tip in (1e-3, 2e-3):
        add(growth, 0.0, tip)
    add(growth, 0.0, 9e-3, steps=20)  # the frame of 9 mm stands later in the turn
    assert f"blades +{np.log(2):.3g} a turn" in growth.sentence()


def test_the_rate_of_a_run_that_diverges_at_once_is_not_made_up(stepper):
    growth = Growth(stepper)
    assert growth.sentence() == "too soon to tell a rate of growth"
    add(growth, 1e-3, 1e-3)
    assert growth.sentence() == "too soon to tell a rate of growth"


def test_amplitudes_that_are_no_numbers_are_left_out():
    found = trend(np.array([0.0, 1.0, np.nan, np.exp(-1.0)]))
    assert found.rate == pytest.approx(-0.5)
    assert found.turns == 2
    assert found.size == pytest.approx(np.exp(-0.5))
    assert trend(np.array([1.0, np.nan])) is None


@pytest.mark.parametrize("tip", [0.03, -0.03, np.nan])
def test_a_tip_beyond_its_limit_or_no_number_is_the_blade_s_and_else_it_is_the_casing(stepper, tip):
    limit, q = stepper.model.laws.tip_limit, np.zeros(len(stepper.system.M))
    q[3 * 4 + 1] = tip
    stepper.state.motions[2].z[:] = stepper.blocks.to_z(q)
    assert limit < 0.03
    branch, text = what_diverged(stepper)
    assert branch == "blade"
    assert text.endswith(f"bent beyond {1e3 * limit:.3g} mm")
    assert text.startswith("blade 4") or np.isnan(tip)  # in blocks NaN spreads over all blades
    stepper.state.motions[2].z[:] = stepper.blocks.to_z(np.minimum(np.nan_to_num(np.abs(q)), 0.9 * limit))
    assert what_diverged(stepper)[0] == "casing"


def test_the_advice_counts_what_the_page_of_the_model_counts():
    page = (Path(__file__).parents[3] / "docs/status.md").read_text()
    rows = dict(re.findall(r"^\| (friction 0.02|[^|]+?) \| (.+) \|$", page, re.MULTILINE))
    expected = {
        "blade": ["friction 0.02", "casing support stiffness / 4", "damping of the blades x 4"],
        "casing": ["casing support stiffness x 4", "unbalance / 2", "damping of the casing x 4"],
    }
    for column, (branch, changes) in enumerate(expected.items()):
        counts = [rows[change].split(" | ")[column] for change in changes]
        assert re.findall(r"(\d+)(?: stayed| with)", ADVICE[branch]) == counts
        assert counts == sorted(counts, key=int, reverse=True)
