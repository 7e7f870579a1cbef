import json
import re
import warnings
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.stats import qmc

import rubgen
from rubgen.errors import RubgenWarning, UserError
from rubgen.scenario import Recipe, load_recipe, make_scenario, parse_recipe
from rubgen.scenario.load import RECIPES, check_recipe
from rubgen.scenario.vary import DIMENSIONS, KEYS, PARAMETERS, sobol_point, varied_values

MINIMAL = {"name": "small", "runs": 4, "machine": "zeng2019"}
ISSUE_KEYS = [
    "speed_rpm",
    "clearance_m",
    "ovality_m",
    "disk_support_stiffness_n_per_m",
    "casing_support_stiffness_n_per_m",
    "friction",
    "lobes",
    "unbalance_kg_m",
    "casing_thickness_m",
    "lateral_damping",
]


def test_keys_of_vary_begin_with_those_users_were_promised():
    """Each owns its dimension of the Sobol sequence for ever."""
    assert list(KEYS)[: len(ISSUE_KEYS)] == ISSUE_KEYS


def test_default_recipe_is_the_published_one():
    recipe = load_recipe()
    assert (recipe.name, recipe.runs, recipe.machine, recipe.license) == ("zeng2019-mini", 32, "zeng2019", "CC-BY-4.0")
    assert recipe.output.formats == ("parquet",)


def test_recipes_of_the_package_are_valid():
    names = [load_recipe(path).name for path in sorted(RECIPES.glob("*.toml"))]
    assert names == [path.stem for path in sorted(RECIPES.glob("*.toml"))]
    assert names


def test_a_recipe_of_the_package_is_loaded_by_its_name(tmp_path, monkeypatch):
    assert load_recipe("laboratory", runs=3).name == "laboratory"
    monkeypatch.chdir(tmp_path)
    (tmp_path / "laboratory").write_text('name = "own"\nruns = 1\nmachine = "zeng2019"\n')
    assert load_recipe("laboratory").name == "own"  # a file of the user comes first
    with pytest.raises(UserError, match=r"'laboratry': no such recipe; did you mean laboratory\? .*recipe .toml"):
        load_recipe("laboratry")


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"vary": {"fluctuation_rpm": 3}}, 'vary.fluctuation_rpm = 3: the profile "steady" has none'),
        ({"operation": {"duration_s": 2}}, 'operation.duration_s = 2: the profile "steady" has none'),
        (
            {
                "operation": {"profile": "run-up", "end_speed_rpm": 12000, "duration_s": 2},
                "simulation": {"record_turns": 600},
            },
            'simulation.record_turns = 600: the profile "run-up" has none',
        ),
    ],
)
def test_a_recipe_built_of_objects_is_checked_like_one_that_is_read(tmp_path, tables, message):
    built = Recipe(**MINIMAL, **tables)
    for refused in (lambda: parse_recipe(MINIMAL | tables), lambda: rubgen.generate(built, tmp_path / "set")):
        with pytest.raises(UserError, match=message):
            refused()
    assert list(tmp_path.iterdir()) == []


def test_a_recipe_built_of_objects_warns_once_and_takes_all_keys_of_a_manifest():
    built = Recipe(**MINIMAL, vary={"clearance_m": 0.05})
    with pytest.warns(RubgenWarning, match="clearance_m"):
        check_recipe(built)
    with warnings.catch_warnings(action="error"):
        check_recipe(built)
        check_recipe(Recipe(**Recipe(**MINIMAL).model_dump()))


@pytest.mark.parametrize("index", [-1, 1_000_000, 10**12, "0", 1.5, True, None])
def test_what_is_no_number_of_a_run_is_refused(index):
    with pytest.raises(UserError, match="give the number of a run, from 0 to below 1,000,000"):
        parse_recipe(MINIMAL).scenario(index)


@pytest.mark.parametrize("changes", [{"runs": 0}, {"seed": -3}, {"runs": "2"}, {"name": "a/b"}])
def test_a_copy_with_other_values_is_checked(tmp_path, changes):
    (key,) = changes
    with pytest.raises(UserError, match=f"recipe: {key} = "):
        rubgen.generate(parse_recipe(MINIMAL).model_copy(update=changes), tmp_path / "set")
    assert list(tmp_path.iterdir()) == []


def test_runs_override_changes_no_run():
    few, many = load_recipe(runs=2), load_recipe(runs=40)
    assert (few.runs, many.runs) == (2, 40)
    assert few.scenario(1) == many.scenario(1)


def test_runs_stay_within_the_ranges_and_differ():
    recipe = load_recipe()
    speeds = [recipe.scenario(i).operation.speed_rpm for i in range(32)]
    assert len(set(speeds)) == 32
    low, high = recipe.vary.speed_rpm.extremes()
    assert min(speeds) >= low
    assert max(speeds) <= high
    # Sobol: with 32 points each 32nd of the range is hit exactly once.
    assert np.unique(np.floor((np.array(speeds) - low) / (high - low) * 32)).size == 32


def test_points_are_the_sobol_sequence_of_scipy():
    engine = qmc.Sobol(DIMENSIONS, scramble=True, rng=np.random.default_rng(np.random.SeedSequence(7)))
    points = engine.random(8)[:, [*range(len(KEYS)), DIMENSIONS - 1]]  # the last is that of free_penetration_m
    alone = np.array([list(sobol_point(7, i).values()) for i in (5, 0, 3)])
    np.testing.assert_array_equal(alone, points[[5, 0, 3]])


def test_another_seed_draws_other_runs():
    one, two = (parse_recipe({**MINIMAL, "seed": s, "vary": {"speed_rpm": {"uniform": [7e3, 9e3]}}}) for s in (1, 2))
    assert one.scenario(0).operation.speed_rpm != two.scenario(0).operation.speed_rpm


def test_fixing_one_key_leaves_the_others():
    drawn = {"friction": {"uniform": [0.0, 0.2]}, "speed_rpm": {"uniform": [7e3, 9e3]}}
    both = parse_recipe({**MINIMAL, "vary": drawn}).scenario(3)
    one = parse_recipe({**MINIMAL, "vary": {**drawn, "friction": 0.1}}).scenario(3)
    assert one.operation == both.operation
    assert one.contact.friction == 0.1


def test_order_in_the_file_does_not_matter():
    drawn = {"friction": {"uniform": [0.0, 0.2]}, "speed_rpm": {"uniform": [7e3, 9e3]}}
    turned = dict(reversed(drawn.items()))
    assert parse_recipe({**MINIMAL, "vary": drawn}).scenario(2) == parse_recipe({**MINIMAL, "vary": turned}).scenario(2)


@pytest.mark.parametrize("entry", PARAMETERS, ids=lambda entry: entry.key)
def test_each_key_changes_its_own_value_alone(entry):
    base = make_scenario()
    value = 3 if entry.whole else entry.read(base) * 1.25 + (0.05 if entry.key == "friction" else 0)
    changed = entry.apply(base, value)
    # A steady run ends at its speed, and its turns last as long as that says.
    own = {entry.key} | ({"end_speed_rpm", "duration_s"} if entry.key == "speed_rpm" else set())
    others = {key: v for key, v in varied_values(base).items() if key not in own}
    assert entry.read(changed) == value
    assert {key: v for key, v in varied_values(changed).items() if key not in own} == others
    assert changed.machine_id == base.machine_id


def test_support_stiffness_of_the_casing_is_the_same_both_ways():
    casing = make_scenario(casing_support_stiffness_n_per_m=1.5e5).machine.casing
    assert casing.radial_support_stiffness_n_per_m == casing.circumferential_support_stiffness_n_per_m == 1.5e5


def test_machine_id_is_of_the_machine_before_vary():
    recipe = load_recipe()
    first, second = recipe.scenario(0), recipe.scenario(1)
    assert first.machine != second.machine
    assert first.machine_id == second.machine_id == make_scenario(path_gain=1.0).machine_id
    assert len(first.machine_id) == 12


def test_simulation_sensors_and_output_reach_the_scenario():
    recipe = parse_recipe(
        {
            **MINIMAL,
            "simulation": {"settle_turns": 150, "record_turns": 700, "steps_per_turn": 2048, "closing_turns": 30},
            "sensors": {"sample_rate_hz": 12800, "noise": 0, "adc_bits": 12, "keep_clean": True},
            "output": {"formats": ["mcap"], "signal_seconds": 0.25},
            "reduction": {"casing_modes": 13},
        }
    )
    scenario = recipe.scenario(2)
    assert asdict(scenario.operation) == {
        "speed_rpm": 10000.0,
        "settle_turns": 150,
        "record_turns": 700,
        "steps_per_turn": 2048,
        "closing_turns": 30,
        "profile": "steady",
        "end_speed_rpm": None,
        "duration_s": None,
        "fluctuation_rpm": 0.0,
        "fluctuation_period_s": 1.0,
        "forbidden_speed_rpm": (),
    }
    sensing = scenario.sensing
    assert (sensing.sample_rate_hz, sensing.noise, sensing.adc_bits, sensing.keep_clean) == (12800, 0, 12, True)
    assert sensing.set.name == "default"
    assert (scenario.signal_seconds, scenario.reduction.casing_modes) == (0.25, 13)
    assert (scenario.seed, scenario.index, scenario.run_id) == (0, 2, "run-000002")


def test_machine_path_starts_from_the_recipe(tmp_path):
    preset = Path(__file__).parents[2] / "rubgen/machine/presets/zeng2019.toml"
    mine = re.sub(r"unbalance_kg_m = .*", "unbalance_kg_m = 2.0e-2", preset.read_text())
    (tmp_path / "mine.toml").write_text(mine)
    (tmp_path / "recipe.toml").write_text('name = "a"\nruns = 1\nmachine = "mine.toml"\n')
    assert load_recipe(tmp_path / "recipe.toml").scenario(0).machine.unbalance_kg_m == 2.0e-2


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.dictionaries(st.sampled_from([*KEYS, "speed", "x"]), st.floats() | st.text(max_size=3) | st.none()))
def test_whatever_stands_in_vary_either_works_or_is_refused_in_one_line(table):
    data = {**MINIMAL, "output": {"signal_seconds": 1e-3}, "vary": table}
    message = ""
    with warnings.catch_warnings(record=True):  # of values that are allowed but surely not meant
        warnings.simplefilter("always", RubgenWarning)
        try:
            recipe = parse_recipe(data, source="r.toml")
        except UserError as error:
            message = str(error)
    if message:
        assert "\n" not in message
        assert message.startswith("r.toml: ")
    else:
        given = {k: v for k, v in table.items() if v is not None}
        assert {key: varied_values(recipe.scenario(0))[key] for key in given} == given


@pytest.mark.parametrize("operation", [{}, {"profile": "run-up", "end_speed_rpm": 12000, "duration_s": 2}])
@pytest.mark.parametrize("exclude_none", [True, False])
def test_the_recipe_of_a_manifest_is_a_recipe(operation, exclude_none):
    """It has the keys of every profile, without those that are None."""
    data = {"name": "a", "runs": 1, "machine": "zeng2019", "operation": operation}
    recorded = json.loads(json.dumps(parse_recipe(data).model_dump(mode="json", exclude_none=exclude_none)))
    assert parse_recipe(recorded).model_dump(mode="json", exclude_none=exclude_none) == recorded


def test_a_recipe_on_the_machine_for_comparison_is_told_that_it_is_not_for_data():
    with pytest.warns(RubgenWarning, match="machine = 'zeng2019-as-computed': for comparison .* never for data"):
        parse_recipe(MINIMAL | {"machine": "zeng2019-as-computed"})
    with warnings.catch_warnings(action="error"):
        parse_recipe(MINIMAL)
