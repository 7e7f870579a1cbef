"""`[balance]`: the class of a run and its candidates follow from its number alone, and mistakes are one line."""

from collections import Counter

import pytest

from rubgen.errors import UserError
from rubgen.scenario import parse_recipe
from rubgen.scenario.vary import varied_values

RECIPE = {
    "name": "balanced",
    "seed": 4,
    "runs": 8,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [8000, 12000]}, "clearance_m": {"uniform": [2e-4, 3e-4]}},
    "faults": [{"kind": "bow", "share": 0.5, "bow_m": {"uniform": [1e-6, 3e-5]}}],
}
BALANCE = {"rub": 0.6, "motion": {"period-1": 0.5, "chaotic": 0.3}, "severity_bounds": [0.1], "speed_bands": 3}


def test_every_class_has_its_share_of_any_stretch_of_runs():
    balance = parse_recipe({**RECIPE, "balance": BALANCE}).balance
    shares = {cell.name: cell.share for cell in balance.cells}
    assert sum(shares.values()) == pytest.approx(1)
    assert shares["rub, chaotic, severity from 0.1"] == pytest.approx(0.6 * 0.3 / 2)
    for start in (0, 12_345):
        places = [balance.place(4, index) for index in range(start, start + 3000)]
        counts = Counter((cell.name, band) for cell, band in places)
        for name, share in shares.items():
            for band in range(3):
                assert counts[name, band] / 3000 == pytest.approx(share / 3, abs=0.004)


def test_a_label_is_in_exactly_one_class():
    balance = parse_recipe({**RECIPE, "balance": BALANCE}).balance
    names = [cell.name for cell in balance.cells]
    assert names[balance.cell_of(rub=False)] == "no rub"
    assert names[balance.cell_of(rub=True, motion="chaotic", severity=0.1)] == "rub, chaotic, severity from 0.1"
    assert names[balance.cell_of(rub=True, motion="undecided", severity=0.05)].startswith("rub, other motion")
    assert len(set(names)) == len(names) == 1 + 3 * 2


def test_the_first_candidate_is_the_run_without_balance_and_others_are_independent():
    plain = parse_recipe(RECIPE)
    balanced = parse_recipe({**RECIPE, "balance": {"rub": 0.5}})
    for index in range(4):
        run, first = plain.scenario(index), balanced.candidate(index)
        assert (varied_values(first), first.machine) == (varied_values(run), run.machine)
    others = [balanced.candidate(index, attempt) for index in range(3) for attempt in range(1, 4)]
    assert len({each.operation.speed_rpm for each in others}) == 9
    assert {bool(each.machine.faults) for each in others} == {True, False}  # faults are drawn again as well
    assert others == [balanced.candidate(index, attempt) for index in range(3) for attempt in range(1, 4)]
    assert balanced.candidate(2) == balanced.scenario(2, screened=False)


def test_bands_of_the_speed_hold_for_every_candidate():
    recipe = parse_recipe({**RECIPE, "balance": BALANCE})
    for index in range(9):
        band = recipe.balance.place(4, index)[1]
        low, high = (8000 + 4000 * end / 3 for end in (band, band + 1))
        assert all(low <= recipe.candidate(index, each).operation.speed_rpm <= high for each in range(5))


@pytest.mark.parametrize(
    ("balance", "message"),
    [
        ({}, "balance.rub: this key is missing"),
        ({"rub": 50}, "balance.rub = 50: must be at least 0 and at most 1; 50 % is written 0.5"),
        ({"rub": 0.5, "motion": {"period-1": 0.8, "chaotic": 0.4}}, "shares of motion add up to 1.2; lower them"),
        ({"rub": 0.5, "motion": {"static": 0.4}}, "balance.motion.static"),
        ({"rub": 0.5, "motion": {"chaos": 0.4}}, "did you mean chaotic"),
        ({"rub": 0, "motion": {"chaotic": 0.5}}, "rub = 0: no run rubs"),
        ({"rub": 0.5, "severity_bounds": [1, 0.1]}, "must ascend; sort them"),
        ({"rub": 0.5, "severity_bands": [1]}, "did you mean severity_bounds"),
        ({"rub": 0.5, "speed_bands": 0}, "balance.speed_bands = 0: must be at least 1"),
        ({"rub": 0.5, "tries": 2.5}, "balance.tries = 2.5: must be a whole number"),
    ],
)
def test_mistakes_are_refused_in_one_line(balance, message):
    with pytest.raises(UserError, match=message) as error:
        parse_recipe({**RECIPE, "balance": balance}, source="r.toml")
    assert "\n" not in str(error.value)


def test_classes_that_cannot_occur_are_refused():
    run_up = {"profile": "run-up", "end_speed_rpm": 12_500, "duration_s": 2}
    with pytest.raises(UserError, match=r'balance.motion: with the profile "run-up" a rub has no class'):
        parse_recipe({**RECIPE, "operation": run_up, "balance": {"rub": 0.5, "motion": {"chaotic": 0.5}}})
    with pytest.raises(UserError, match=r"balance.speed_bands = 4: \[vary\] draws no speed_rpm"):
        parse_recipe({**RECIPE, "vary": {}, "balance": {"rub": 0.5, "speed_bands": 4}})
