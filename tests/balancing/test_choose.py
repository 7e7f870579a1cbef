"""The choice of candidates: statics against the run itself, shares and weights against probabilities that are known."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rubgen.balancing.choose import choose
from rubgen.balancing.screen import SCREEN_TURNS, Verdict, reaches, short_run
from rubgen.dataset.reading.balance import balance_table, balance_weights
from rubgen.errors import UserError
from rubgen.pipeline import simulate
from rubgen.scenario import parse_recipe
from rubgen.scenario.merged import merged_recipe
from rubgen.scenario.run_id import run_id_of
from rubgen.solver.response import Status

RECIPE = {
    "name": "balanced",
    "seed": 4,
    "runs": 6,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [9000, 10000]}, "clearance_m": {"uniform": [2e-4, 4e-4]}, "friction": 0.0},
    "simulation": {"settle_turns": 60, "record_turns": 500},
    "output": {"formats": ["parquet"], "signal_seconds": 0.05},
    "labels": {"lyapunov": False},
}


def test_statics_tell_rub_as_the_run_does():
    vary = {**RECIPE["vary"], "clearance_m": {"uniform": [2e-4, 2e-3]}}
    recipe = parse_recipe({**RECIPE, "vary": vary, "balance": {"rub": 0.5}})
    runs = [recipe.scenario(index) for index in range(4)]
    assert len({run.balance.cell for run in runs}) == 2
    for run in runs:
        assert reaches(run) is run.balance.cell.startswith("rub")
        assert simulate(run).labels.rub is reaches(run)


def test_the_short_run_is_the_beginning_of_the_run():
    run = parse_recipe({**RECIPE, "vary": {**RECIPE["vary"], "clearance_m": 2e-4}}).scenario(0)
    verdict, labels = short_run(run), simulate(run).labels
    assert (verdict.rub, verdict.motion) == (labels.rub, labels.motion.value)
    assert verdict.severity == pytest.approx(labels.amounts.severity, rel=0.1)


def test_a_clearance_that_closes_within_the_record_is_left_to_the_run():
    fault = {"kind": "closing-clearance", "closing_m": 1e-4, "start_s": 0.5, "growth_s": 0.5}
    clear = {**RECIPE, "vary": {**RECIPE["vary"], "clearance_m": 2e-3}}
    assert reaches(parse_recipe(clear).scenario(0)) is False
    assert reaches(parse_recipe({**clear, "faults": [fault]}).scenario(0)) is None


def test_the_short_run_is_short(monkeypatch):
    asked = []

    def integrate(_model, operation, _contact, wants):
        asked.append((operation, wants))
        return SimpleNamespace(status=Status.UNSTABLE)

    monkeypatch.setattr("rubgen.balancing.screen.integrate", integrate)
    assert short_run(parse_recipe(RECIPE).scenario(0)) is None
    assert [operation.record_turns for operation, _ in asked] == [SCREEN_TURNS]
    assert asked[0][1].sample_rate_hz == 0  # sensors decide nothing, so others get the same motions


def test_a_class_that_is_not_found_refuses_the_run_with_what_was_found():
    recipe = parse_recipe({**RECIPE, "vary": {"clearance_m": 2e-3}, "balance": {"rub": 1.0, "tries": 3}})
    with pytest.raises(UserError, match="none of 3 candidates is in the class 'rub'; found: 3 no rub") as error:
        simulate(recipe.scenario(1))
    assert "\n" not in str(error.value)


def test_a_twin_is_that_of_the_chosen_candidate_and_is_not_screened_again(monkeypatch):
    seen = []

    def screen(candidate, *, motion):
        seen.append(candidate)
        return _verdict(candidate, motion=motion)

    monkeypatch.setattr("rubgen.balancing.choose.screen", screen)
    recipe = parse_recipe({**RECIPE, "balance": {"rub": 0.5}, "twins": {"friction": 0.1}})
    number = next(index for index in (0, 1) if recipe.twin_of(index) is not None)
    run, screened = recipe.scenario(1 - number), len(seen)
    twin = recipe.scenario(number)
    assert (twin.machine, twin.operation, twin.balance, twin.partner) == (
        run.machine, run.operation, run.balance, run.run_id,
    )  # fmt: skip
    assert len(seen) == screened
    assert parse_recipe({**RECIPE, "balance": {"rub": 0.5}, "twins": {"friction": 0.1}}).scenario(number) == twin


def _verdict(scenario, *, motion):
    """A quarter of the candidates rubs, and three tenths of these are chaotic."""
    rub = scenario.machine.casing.clearance_m < 2.5e-4
    words = "chaotic" if scenario.machine.casing.clearance_m < 2.15e-4 else "period-1"
    return Verdict(rub=rub, motion=words if rub and motion else "")


@pytest.mark.parametrize("bands", [1, 2])
def test_natural_shares_and_weights_are_those_of_the_drawing(monkeypatch, bands):
    monkeypatch.setattr("rubgen.balancing.choose.screen", _verdict)
    monkeypatch.setattr("rubgen.scenario.vary.sobol_point", _point)
    table = {"rub": 0.5, "motion": {"period-1": 0.4, "chaotic": 0.6}, "speed_bands": bands, "tries": 500}
    recipe = parse_recipe({**RECIPE, "balance": table})
    runs = _rows_of(recipe, 300)
    found = balance_table(runs, recipe).groupby(lambda row: row // len(recipe.balance.cells))["natural"]
    natural = sum(group.to_numpy() for _, group in found)
    np.testing.assert_allclose(natural, [0.75, 0.25 * 0.7, 0.25 * 0.3, 0], atol=0.03)
    weights = balance_weights(runs, balance_table(runs, recipe))
    rub = runs["balance_cell"].str.startswith("rub").to_numpy()
    good = (runs["status"] == "ok").to_numpy()
    assert np.average(rub[good], weights=weights[good]) == pytest.approx(0.25, abs=0.03)
    assert weights[good].mean() == pytest.approx(1)
    assert weights[~good].isna().all()


def _rows_of(recipe, number):
    """The columns of runs that a balance needs. The last run is refused."""
    chosen = [choose(recipe, recipe.balance, index) for index in range(number)]
    return pd.DataFrame(
        {
            "split": "train",
            "status": ["ok"] * (number - 1) + ["refused"],
            "balance_cell": [each.balance.cell for each in chosen],
            "balance_tries": [each.balance.tries for each in chosen],
            "balance_seen": [np.array(each.balance.seen) for each in chosen],
        },
        index=[each.run_id for each in chosen],
    )


def test_each_source_of_a_merged_set_has_its_own_shares_and_weights(monkeypatch):
    monkeypatch.setattr("rubgen.balancing.choose.screen", _verdict)
    recipes = [
        parse_recipe({**RECIPE, "runs": 20, "seed": seed, "balance": {"rub": rub, "speed_bands": 2}})
        for seed, rub in [(1, 0.5), (2, 0.8)]
    ]
    whole = merged_recipe(recipes[0].model_copy(update={"runs": 40}), recipes, ["aa", "bb"])
    parts = [_rows_of(recipe, 20) for recipe in recipes]
    runs = pd.concat(parts)
    runs.index = [run_id_of(number) for number in range(40)]
    runs["merged_from"] = ["aa/"] * 20 + ["bb/"] * 20
    table = balance_table(runs, whole)
    for source, part, recipe in zip(["aa", "bb"], parts, recipes, strict=True):
        own = table[table["source"] == source].drop(columns="source").reset_index(drop=True)
        pd.testing.assert_frame_equal(own, balance_table(part, recipe))
    alone = [balance_weights(part, balance_table(part, recipe)) for part, recipe in zip(parts, recipes, strict=True)]
    np.testing.assert_array_equal(balance_weights(runs, table), np.concatenate(alone))


def _point(seed, index):
    """An independent point for candidate 0: the sequence itself takes its time."""
    generator = np.random.default_rng([seed, index])
    keys = ("speed_rpm", "clearance_m", "friction")
    return dict(zip(keys, generator.random(3).tolist(), strict=True))


def test_a_set_without_balance_has_no_weights():
    with pytest.raises(UserError, match=r"no \[balance\]"):
        balance_table(pd.DataFrame(), parse_recipe(RECIPE))
