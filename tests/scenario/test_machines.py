"""Virtual machines and splits of a recipe, against closed forms and against machines made by hand."""

import json
from collections import Counter
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from pydantic import TypeAdapter

import rubgen
from rubgen.dataset.making.warm_up import warm_up
from rubgen.dataset.manifest import Identity, identity_of
from rubgen.errors import UserError
from rubgen.machine import Machine, load_machine
from rubgen.machine.faults.closing_clearance import ClosingClearance
from rubgen.machine.load import PRESETS
from rubgen.pipeline import simulate
from rubgen.reduction import reduce
from rubgen.scenario import load_recipe, make_scenario, parse_recipe
from rubgen.scenario.machines.keys import MACHINE_KEYS, with_values
from rubgen.scenario.scenario import Reduction, scenario_dict
from rubgen.scenario.tables.machines import MachineTable
from rubgen.solver.candidate import candidate_problem
from rubgen.solver.linear.reach import with_clearance
from rubgen.units import rad_per_s

PRESET = load_machine("zeng2019")
ONE_VALUE = {"blade_count": 24, "lobes": 3, "clearance_m": 4e-4, "casing_radius_m": 0.41}
FLEET = {
    "name": "fleet",
    "seed": 11,
    "machine": ["zeng2019", "zeng2019-fitted"],
    "machines": {
        "count": 40,
        "runs_per_machine": 3,
        "vary": {
            "blade_length_m": {"uniform": [0.13, 0.16]},
            "blade_count": {"choice": [24, 36]},
            "mistuning": {"uniform": [0.0, 0.02]},
        },
    },
    "splits": {
        "train": 0.6,
        "test": 0.2,
        "unseen": {"share": 0.2, "machines": {"blade_count": 18}, "vary": {"speed_rpm": 7000}},
    },
    "vary": {"speed_rpm": {"uniform": [9000, 11000]}},
}


@pytest.fixture
def all_sane(monkeypatch):
    """Nothing is reduced: every candidate that can be meshed is taken."""
    monkeypatch.setattr("rubgen.solver.candidate.candidate_problem", lambda *_: None)


def fleet(**changes):
    return parse_recipe({**FLEET, **changes})


@pytest.mark.parametrize("entry", MACHINE_KEYS, ids=lambda entry: entry.key)
def test_a_value_is_read_where_it_is_written(entry):
    before = entry.read(PRESET)
    value = ONE_VALUE.get(entry.key, 0.05 if before == 0 else 1.05 * before)
    made = with_values(PRESET, {entry.key: value})
    if entry.key == "mistuning":  # 36 draws of that standard deviation
        assert made.blades.mistuning.relative_std == value
        assert entry.read(made) == pytest.approx(value, rel=0.5)
    else:
        assert entry.read(made) == pytest.approx(value, rel=1e-12)


def test_chord_thickness_twist_stagger_frame_and_radius_by_hand():
    blades, casing = PRESET.blades, PRESET.casing
    made = with_values(
        PRESET,
        {
            "blade_chord_m": 2 * blades.root_chord_m,
            "blade_thickness_m": 3 * blades.root_thickness_m,
            "blade_twist_deg": 10.0,
            "blade_stagger_deg": 60.0,
            "frame_frequency_hz": 2 * PRESET.frame.modes[0].frequency_hz,
            "casing_radius_m": 0.405,
        },
    )
    assert made.blades.tip_chord_m == pytest.approx(2 * blades.tip_chord_m)
    assert made.blades.tip_thickness_m == pytest.approx(3 * blades.tip_thickness_m)
    assert (made.blades.root_angle_deg, made.blades.tip_angle_deg) == pytest.approx((55, 65))
    doubled = [2 * mode.frequency_hz for mode in PRESET.frame.modes]
    assert [mode.frequency_hz for mode in made.frame.modes] == pytest.approx(doubled)
    assert made.casing.clearance_m == pytest.approx(0.405 - 0.4 - casing.ovality_m / 2)


@pytest.mark.parametrize("count", [17, 18, 36, 72, 90])
def test_every_blade_has_a_node_at_the_rim(count):
    made = with_values(PRESET, {"blade_count": count})
    assert made.disk.circumferential_elements % count == 0
    assert abs(made.disk.circumferential_elements - 72) <= count / 2 or count >= 72


def test_runs_of_a_machine_follow_each_other_and_depend_on_nothing_else(all_sane):
    recipe = fleet()
    assert (recipe.runs, recipe.machine_count) == (120, 40)
    backwards = {index: recipe.scenario(index) for index in reversed(range(120))}
    fewer = fleet(machines={**FLEET["machines"], "count": 30})
    assert all(fewer.scenario(index) == backwards[index] for index in (0, 1, 44, 89))
    numbers = [backwards[index].virtual.number for index in range(120)]
    assert numbers == [index // 3 for index in range(120)]
    ids = [backwards[3 * number].machine_id for number in range(40)]
    assert len(set(ids)) == 40
    assert all(backwards[index].machine_id == ids[index // 3] for index in range(120))
    lengths = [backwards[3 * number].machine.blades.length_m for number in range(40)]
    assert 0.13 <= min(lengths) < 0.135
    assert 0.155 < max(lengths) <= 0.16
    patterns = {backwards[3 * number].machine.blades.mistuning.seed for number in range(40)}
    assert len(patterns) == 40


def test_splits_are_of_whole_machines_with_their_shares_and_ranges(all_sane):
    recipe = fleet(machines={**FLEET["machines"], "count": 2000})
    split = [recipe.split_of(3 * number) for number in range(2000)]
    assert all(recipe.split_of(index) == split[index // 3] for index in range(6000))
    share = {name: count / 2000 for name, count in Counter(split).items()}
    assert share == pytest.approx({"train": 0.6, "test": 0.2, "unseen": 0.2}, abs=0.003)
    for file in (0, 1):  # of each machine file too
        assert Counter(split[file::2])["test"] / 1000 == pytest.approx(0.2, abs=0.005)
    for index in range(0, 90, 3):
        scenario = recipe.scenario(index)
        unseen = recipe.split_of(index) == "unseen"
        assert (scenario.machine.blades.count == 18) is unseen
        assert (scenario.operation.speed_rpm == 7000) is unseen


def test_more_machines_change_no_split(all_sane):
    small, large = fleet(), fleet(machines={**FLEET["machines"], "count": 4000})
    assert [small.split_of(index) for index in range(120)] == [large.split_of(index) for index in range(120)]


def test_another_seed_permutes_the_splits():
    orders = {tuple(fleet(seed=seed).split_of(3 * number) for number in range(40)) for seed in range(5)}
    assert len(orders) == 5


def test_refused_candidates_are_replaced_in_a_fixed_order(monkeypatch):
    """A bound on the blades' length as the check: the candidate is the first below it, in every order of asking."""

    def too_long(scenario, *_):
        length = scenario.machine.blades.length_m
        return f"blade_length_m = {length:g}: too long" if length > 0.14 else None

    monkeypatch.setattr("rubgen.solver.candidate.candidate_problem", too_long)
    recipe, again = fleet(), fleet()
    chosen = [recipe.scenario(3 * number) for number in range(40)]
    assert chosen == [again.scenario(3 * number) for number in reversed(range(40))][::-1]
    assert all(each.machine.blades.length_m <= 0.14 for each in chosen)
    refused = [each.virtual.candidate for each in chosen]
    assert np.mean(refused) == pytest.approx(2, abs=1)  # geometric: a third is accepted
    assert min(refused) == 0
    known = fleet()
    known.remember(7, chosen[7].virtual.candidate)
    monkeypatch.setattr("rubgen.solver.candidate.candidate_problem", lambda *_: pytest.fail("was checked again"))
    assert known.scenario(21) == chosen[7]


def test_without_a_sane_candidate_the_run_is_refused_with_the_reasons(monkeypatch):
    monkeypatch.setattr("rubgen.solver.candidate.candidate_problem", lambda *_: "onset_clearance_m = 1: outside")
    recipe = fleet(machines={**FLEET["machines"], "tries": 3})
    with pytest.raises(UserError, match=r"machine 2: none of 3 candidates is sane \(onset_clearance_m 3 times\)"):
        simulate(recipe.scenario(6))
    with pytest.raises(UserError, match=r"machine 0: none of 3 candidates"):
        warm_up(recipe.scenario(0), (), ())


def test_a_recorded_recipe_draws_the_same_machines_without_its_files(tmp_path, all_sane):
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text((PRESETS / "zeng2019.toml").read_text().replace("36", "24"))
    quiet = (rubgen.sensors.load.SETS / "default.toml").read_text().replace("noise_rms", "noise_rms")
    (tmp_path / "quiet.toml").write_text(quiet.replace('"default"', '"quiet"'))
    splits = {"train": 0.6, "test": {"share": 0.4, "sensors": str(tmp_path / "quiet.toml")}}
    recipe = fleet(machine=[str(tmp_path / "a.toml"), str(tmp_path / "b.toml")], splits=splits)
    identity = json.loads(identity_of(recipe).model_dump_json())
    for path in tmp_path.glob("*.toml"):
        path.unlink()
    recorded = Identity.model_validate(identity).recorded()
    for index in range(0, 60, 3):
        assert recorded.scenario(index) == recipe.scenario(index)
        assert recorded.split_of(index) == recipe.split_of(index)
    names = {recipe.split_of(index): recipe.scenario(index).sensing.set.name for index in range(0, 60, 3)}
    assert names == {"train": "default", "test": "quiet"}


def test_other_recipes_have_no_new_keys():
    recipe = load_recipe()
    identity = json.loads(identity_of(recipe).model_dump_json())
    assert not {"machines", "splits"} & set(identity["recipe"])
    assert "split_sensors" not in identity
    assert isinstance(identity["machine"], dict)
    assert "virtual" not in scenario_dict(recipe.scenario(0))
    assert (recipe.split_names, recipe.split_of(5), recipe.machine_number(31)) == (("train",), "train", 0)


def test_bounds_of_a_sane_machine():
    """The critical speed from the model; the onset from the clearance that a free penetration of 0 asks for."""
    scenario = make_scenario(speed_rpm=10_000)
    slow = fast = rad_per_s(10_000)
    critical = reduce(PRESET, Reduction()).critical_speed_rpm
    onset = with_clearance(make_scenario(speed_rpm=10_000, free_penetration_m=0.0)).machine.casing.clearance_m
    for key, value in (("critical_speed_rpm", critical), ("onset_clearance_m", onset)):
        inside = MachineTable(**{key: (0.999 * value, 1.001 * value)})
        assert candidate_problem(scenario, inside, slow, fast) is None
        above = MachineTable(**{key: (1.001 * value, 2 * value)})
        problem = candidate_problem(scenario, above, slow, fast)
        assert problem.startswith(f"{key} = ")
        assert float(problem.split()[2].rstrip(":")) == pytest.approx(value, rel=1e-5)


def test_the_onset_of_a_closing_clearance_is_that_of_the_first_instant():
    """The blades stand clear at first, and the casing closes on them later: the clearance of the onset is the same."""
    wide = replace(PRESET, casing=replace(PRESET.casing, clearance_m=3e-3))
    scenario = replace(make_scenario(speed_rpm=10_000), machine=wide)
    closing = replace(scenario, machine=replace(wide, faults=(ClosingClearance(closing_m=2.9e-3),)))
    speed = rad_per_s(10_000)
    above = MachineTable(onset_clearance_m=(1.0, 2.0))
    problem = candidate_problem(scenario, above, speed, speed)
    assert problem.startswith("onset_clearance_m = 0.00")
    assert candidate_problem(closing, above, speed, speed) == problem


def test_an_unstable_machine_is_not_sane():
    """Internal damping of the blades alone: above the critical speed the whirl grows."""
    damping = replace(PRESET.damping, lateral=0.0, tilt=0.0)
    scenario = replace(make_scenario(speed_rpm=12_000), machine=replace(PRESET, damping=damping))
    fast = rad_per_s(12_000)
    assert candidate_problem(scenario, MachineTable(), fast, fast).startswith("unstable")


V = {"blade_length_m": {"uniform": [0.13, 0.16]}}
BAD = {
    "no count": ({"machines": {}}, "runs: this key is missing; add it"),
    "two counts": ({"runs": 5, "machines": {"count": 12}}, "runs = 5: machines.count = 12 with 1 runs each make 12"),
    "equal machines": ({"machines": {"count": 9}}, "machines: 9 machines, of which only 1 can differ"),
    "a choice alone": (
        {"machines": {"count": 9, "vary": {"blade_count": {"choice": [18, 36]}}}},
        "machines: 9 machines, of which only 1 can differ",
    ),
    "mistuning or none": (
        {"machines": {"count": 9, "vary": {"mistuning": {"choice": [0, 0.02]}}}},
        "machines: 9 machines, of which only 1 can differ",
    ),
    "several files": ({"machine": ["zeng2019", "zeng2019-fitted"], "runs": 4}, "several machines need [machines] with"),
    "a file twice": ({"machine": ["zeng2019"] * 2, "machines": {"count": 2}}, "name each machine once"),
    "part of a blade": (
        {"machines": {"count": 9, "vary": {**V, "blade_count": {"uniform": [18, 36]}}}},
        "machines.vary.blade_count: takes whole numbers only",
    ),
    "beyond its bounds": (
        {"machines": {"count": 9, "vary": {"blade_length_m": {"uniform": [-1, 1]}}}},
        "machines.vary.blade_length_m = -1: must be at least 1e-07",
    ),
    "in two tables": (
        {"machines": {"count": 9, "vary": {**V, "lobes": 2}}, "vary": {"lobes": 3}},
        "vary.lobes: stands in machines.vary too; keep one of the two",
    ),
    "two clearances": (
        {"machines": {"count": 9, "vary": {**V, "clearance_m": 3e-4, "casing_radius_m": 0.41}}},
        "each decides the clearance; keep one of them",
    ),
    "no frame": (
        {"machines": {"count": 9, "vary": {**V, "frame_frequency_hz": 500}}},
        "machines.vary.frame_frequency_hz: no sensor feels a frame",
    ),
    "swapped": (
        {"machines": {"count": 9, "vary": V, "critical_speed_rpm": [9000, 5000]}},
        "critical_speed_rpm = [9000, 5000]: the lower end comes first",
    ),
    "shares": (
        {"machines": {"count": 9, "vary": V}, "splits": {"train": 0.7, "test": 0.2}},
        "the shares add up to 0.9, 0.7 + 0.2; change them so that they add up to 1",
    ),
    "percent": (
        {"splits": {"train": 70, "test": 30}},
        "splits.train = 70: must be above 0 and at most 1; 70 % is written 0.7",
    ),
    "name": ({"splits": {"train-1": 1}}, "splits.train-1 = 'train-1': must begin with a small letter"),
    "reserved": ({"splits": {"all": 1}}, "all: readers call every split together so"),
    "one machine": (
        {"runs": 9, "splits": {"train": 0.5, "test": 0.5}},
        "splits: go by machine, and the recipe has one",
    ),
    "no machine in it": (
        {"machines": {"count": 3, "vary": V}, "splits": {"train": 0.6, "validation": 0.05, "test": 0.35}},
        "splits.validation: none of the 3 machines falls into it; take at least",
    ),
    "never a machine in it": (
        {"machines": {"count": 3, "vary": V}, "splits": {"train": 1 - 1e-9, "test": 1e-9}},
        "splits.test: none of the 3 machines falls into it; take a larger share",
    ),
    "unknown key": (
        {"machines": {"count": 9, "vary": V}, "splits": {"train": {"share": 1, "machine": {}}}},
        "splits.train.machine: unknown key; did you mean machine? allowed: machines, operation,",
    ),
    "other channels": (
        {"machines": {"count": 9, "vary": V}, "splits": {"train": 0.5, "test": {"share": 0.5, "sensors": "rig"}}},
        "splits.test.sensors = 'rig': other sensors than sensors.set = 'default'",
    ),
    "other columns": (
        {"machines": {"count": 9, "vary": V}, "splits": {"train": 0.5, "t": {"share": 0.5, "surroundings": {}}}},
        "splits.t.surroundings: the recipe has no [surroundings]",
    ),
    "another profile": (
        {
            "machines": {"count": 9, "vary": V},
            "splits": {"train": 0.5, "t": {"share": 0.5, "operation": {"profile": "run-up"}}},
        },
        'splits.t: operation.end_speed_rpm: the profile "run-up" needs it; add it',
    ),
}


@pytest.mark.parametrize(("tables", "message"), BAD.values(), ids=list(BAD))
def test_a_bad_table_is_refused_in_one_line(tables, message):
    with pytest.raises(UserError) as raised:
        parse_recipe({"name": "a", "machine": "zeng2019", **tables}, source="r.toml")
    assert str(raised.value).startswith("r.toml: ")
    assert message in str(raised.value)
    assert "\n" not in str(raised.value)


def test_machines_of_the_recipe_in_the_repository_differ_in_their_columns(all_sane):
    recipe = load_recipe(rubgen.scenario.load.RECIPES / "machines.toml")
    columns = [entry.key for entry in recipe.machine_keys]
    assert "blade_count" in columns
    assert not [key for key in columns if key.startswith("frame_")]  # no sensor feels it
    numbers = [recipe.machine_number(index) for index in range(recipe.runs)]
    assert all(after - before in (0, 1) for before, after in pairwise(numbers))
    written = TypeAdapter(Machine).dump_json(recipe.scenario(0).machine)
    assert TypeAdapter(Machine).validate_json(written) == recipe.scenario(0).machine
