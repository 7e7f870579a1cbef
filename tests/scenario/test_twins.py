"""`[twins]`: a run and its partner differ in one thing, and the numbers of the partners follow from a formula."""

from dataclasses import fields, is_dataclass

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.scenario import load_recipe, parse_recipe
from rubgen.scenario.load import RECIPES
from rubgen.scenario.tables.twins import partner_of
from rubgen.scenario.vary import varied_values

RECIPE = {
    "name": "twins",
    "seed": 11,
    "runs": 8,
    "machine": "zeng2019",
    "vary": {"clearance_m": {"uniform": [2e-4, 3e-4]}, "friction": {"uniform": [0.0, 0.02]}},
    "surroundings": {"background_m_per_s2": {"log_uniform": [1, 300]}, "runout_m": 2e-6},
    "faults": [{"kind": "bow", "share": 0.5, "bow_m": {"uniform": [1e-6, 3e-5]}}],
}
OWN = {"index", "pairing"}


def differences(one, other, place=""):
    """Yield the places at which two dataclasses differ, without the number of the run."""
    if is_dataclass(one) and type(one) is type(other):
        for field in fields(one):
            if place or field.name not in OWN:
                where = f"{place}.{field.name}".lstrip(".")
                yield from differences(getattr(one, field.name), getattr(other, field.name), where)
    elif one != other:
        yield place


def pair(recipe, slot):
    """Return run and twin of a slot that is a pair."""
    twin = next(index for index in (2 * slot, 2 * slot + 1) if recipe.twin_of(index) is not None)
    return recipe.scenario(twin ^ 1), recipe.scenario(twin)


@pytest.mark.parametrize(
    ("change", "place"),
    [
        ({"clearance_m": 1e-3}, "machine.casing.clearance_m"),
        ({"friction": 0.1}, "contact.friction"),
        ({"unbalance_kg_m": 1e-2}, "machine.unbalance_kg_m"),
        ({"speed_rpm": 9000}, "operation.speed_rpm"),
        ({"background_m_per_s2": 500}, "surroundings.background_m_per_s2"),
        ({"fault": {"kind": "bow", "bow_m": 1e-4}}, "machine.faults"),
        ({"fault": {"kind": "oil-whirl"}}, "machine.faults"),
    ],
)
def test_a_pair_differs_in_one_place(change, place):
    recipe = parse_recipe({**RECIPE, "twins": change})
    for slot in range(3):
        run, twin = pair(recipe, slot)
        assert list(differences(run, twin)) == [place]
        assert twin.partner == run.run_id
    plain = parse_recipe(RECIPE)
    allowed = {"fault_kinds"}  # those of every run of the recipe: the twins may have one more
    run = pair(recipe, 1)[0]
    assert set(differences(plain.scenario(run.index), run)) <= allowed


def test_a_twin_in_place_of_a_drawn_penetration_changes_the_clearance_alone():
    vary = {"free_penetration_m": {"uniform": [-1e-4, 5e-5]}}
    given = pair(parse_recipe({**RECIPE, "vary": vary, "twins": {"clearance_m": 4e-4}}), 0)[1]
    assert (given.free_penetration_m, given.machine.casing.clearance_m) == (None, 4e-4)


def test_a_fault_keeps_the_clearance_that_followed_from_a_penetration():
    from rubgen.solver.linear.reach import with_clearance

    vary = {"free_penetration_m": {"uniform": [-1e-4, 5e-5]}}
    recipe = parse_recipe({**RECIPE, "vary": vary, "twins": {"fault": {"kind": "lost-tip", "lost_kg": 1e-3}}})
    run, twin = map(with_clearance, pair(recipe, 0))
    assert varied_values(run) == varied_values(twin)
    assert list(differences(run, twin)) == ["machine.faults"]


@pytest.mark.parametrize("share", [0.1, 0.37, 0.5, 1.0])
@pytest.mark.parametrize("count", [2, 3, 4, 7, 1000])
def test_the_share_of_runs_with_a_twin_is_met_within_every_machine_block(share, count):
    runs = count * (20_000 // count)
    partners = [partner_of(index, share, 3, index // count * count, count) for index in range(runs)]
    twins = sum(each is not None for each in partners)
    possible = (count // 2) / (count - count // 2)
    assert twins / (runs - twins) == pytest.approx(min(share, possible), abs=0.02)  # four standard errors
    assert all(each is None or each == index ^ 1 or count % 2 for index, each in enumerate(partners))
    assert all(each is None or abs(each - index) == 1 for index, each in enumerate(partners))
    assert all(each is None or partners[each] is None for each in partners)
    assert all(each is None or each // count == index // count for index, each in enumerate(partners))


def test_no_place_in_the_set_tells_of_a_twin():
    twins = np.array([partner_of(index, 0.5, 3, index // 8 * 8, 8) is not None for index in range(16_000)])
    for period in (2, 3, 5, 8, 12, 24):  # four standard errors
        shares = [twins[first::period].mean() for first in range(period)]
        assert np.ptp(shares) < 8 * np.sqrt(0.22 * period / twins.size)


def test_partners_do_not_depend_on_the_number_of_runs():
    data = {**RECIPE, "twins": {"share": 0.4, "friction": 0.1}}
    few, many = (parse_recipe(data, runs=runs) for runs in (3, 1000))
    assert [few.twin_of(index) for index in range(50)] == [many.twin_of(index) for index in range(50)]
    assert load_recipe().twin_of(1) is None


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({}, "nothing differs.* give one key beside share"),
        ({"friction": 0.1, "clearance_m": 1e-3}, "friction differ: a twin differs .* in one thing"),
        ({"clearence_m": 1e-3}, "twins.clearence_m: unknown key; did you mean clearance_m"),
        ({"sensors": "field"}, "one sensor set; .* rubgen resense"),
        ({"clearance_m": -1.0}, "twins.clearance_m = -1: must be at least"),
        ({"ovality_m": 8.0511e-3}, "twins.ovality_m = 0.0080511: every run has it already"),
        ({"runout_m": 2e-6}, "twins.runout_m = 2e-06: every run has it already"),
        ({"end_speed_rpm": 9000}, 'twins.end_speed_rpm = 9000: the profile "steady" has none'),
        ({"share": 0, "friction": 0.1}, "twins.share = 0: must be above 0"),
        ({"fault": {"kind": "bowl"}}, "did you mean bow"),
        ({"fault": {"kind": "cracked-blade", "stiffness_loss": 0.2, "blade": 99}}, "no such blade"),
    ],
)
def test_mistakes_are_refused_in_one_line(change, message):
    with pytest.raises(UserError, match=message) as error:
        parse_recipe({**RECIPE, "twins": change}, source="r.toml")
    assert "\n" not in str(error.value)
    assert str(error.value).startswith("r.toml: ")


def test_a_level_without_the_table_of_surroundings_is_refused():
    data = {key: value for key, value in RECIPE.items() if key != "surroundings"}
    with pytest.raises(UserError, match=r"twins.runout_m: the recipe has no \[surroundings\]"):
        parse_recipe({**data, "twins": {"runout_m": 1e-6}}, source="r.toml")


def test_the_example_has_pairs_of_which_the_twin_stays_clear():
    recipe = load_recipe(RECIPES / "twins.toml")
    clear = [recipe.scenario(index).machine.casing.clearance_m == 1e-3 for index in range(16)]
    assert all(sum(pair) == 1 for pair in zip(clear[::2], clear[1::2], strict=True))
    assert len(set(clear[::2])) == 2  # either may be the twin


def test_twins_stay_with_their_machine_and_its_split():
    machines = {"count": 6, "runs_per_machine": 3, "vary": {"mistuning": 0.01}}
    data = {key: value for key, value in RECIPE.items() if key != "runs"}
    data |= {"machines": machines, "splits": {"train": 0.5, "test": 0.5}, "twins": {"friction": 0.1}}
    recipe = parse_recipe(data)
    twins = [index for index in range(18) if recipe.twin_of(index) is not None]
    assert [index // 3 for index in twins] == list(range(6))
    assert all(index % 3 < 2 for index in twins)
    assert all(recipe.split_of(index) == recipe.split_of(recipe.twin_of(index)) for index in twins)
    with pytest.raises(UserError, match="runs_per_machine = 1: a twin is another run"):
        parse_recipe({**data, "machines": {**machines, "runs_per_machine": 1}})
