import json
import math
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import pytest

from rubgen.cli import main
from rubgen.cli.commands.planning import plan_lines
from rubgen.pipeline import simulate
from rubgen.planning import plan as planning
from rubgen.planning.drawn import Drawn
from rubgen.planning.picture import TICKS, plan_figure
from rubgen.planning.plan import plan
from rubgen.scenario import Recipe, load_recipe, parse_recipe
from rubgen.scenario.costs import SECONDS_A_CANDIDATE
from rubgen.scenario.load import RECIPES

RECIPE = {
    "name": "few",
    "runs": 6,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [7000, 11000]}, "free_penetration_m": {"uniform": [-2e-4, 1e-4]}},
    "labels": {"lyapunov": False},
    "output": {"signal_seconds": 0.2, "formats": ["parquet", "mcap"]},
}
TOML = """
name = "few"
runs = 6
machine = "zeng2019"
[vary]
speed_rpm = { uniform = [7000, 11000] }
free_penetration_m = { uniform = [-2e-4, DEEPEST] }
[output]
signal_seconds = 0.2
formats = ["parquet"]
"""


def changed(**tables):
    return parse_recipe({**RECIPE, **tables})


def test_the_free_penetration_of_a_run_is_the_one_that_its_recipe_draws():
    recipe = changed()
    made = plan(recipe)
    drawn = [recipe.scenario(index).free_penetration_m for index in range(6)]
    assert [each.depth_m for each in made.reach] == pytest.approx(drawn, abs=1e-9)
    assert made.share_that_can_rub == sum(depth >= 0 for depth in drawn) / 6
    assert 0 < made.share_that_can_rub < 1


def test_runs_that_cannot_rub_do_not_rub():
    recipe = changed(runs=3)
    made, runs = plan(recipe), [simulate(recipe.scenario(index)) for index in range(3)]
    assert [run.labels.rub for run in runs] == [each.can_rub for each in made.reach]
    assert len({each.can_rub for each in made.reach}) == 2


def test_trying_runs_gives_classes_time_and_sizes_near_the_estimates():
    recipe = changed(runs=8)
    estimated, tried = plan(recipe), plan(recipe, tries=2)
    assert estimated.tried is None
    assert sum(tried.tried.classes.values()) == 2
    assert set(tried.megabytes) == {"parquet", "mcap"}
    for name, size in tried.megabytes.items():
        assert 0.4 < estimated.megabytes[name] / size < 2.5
    assert tried.cpu_seconds == 8 * tried.tried.seconds_a_run > 0


def test_what_is_refused_is_counted_with_its_reason():
    made = plan(changed(vary={"free_penetration_m": {"choice": [0.0, 5e-3]}}))
    refused = [each for each in made.reach if each.refused]
    assert 0 < len(refused) < 6
    assert all("free_penetration_m = 0.005" in each.refused for each in refused)
    assert len(made.refused_corners) == 1
    assert made.share_that_can_rub == 1  # of those that are not refused


def test_a_large_set_is_looked_at_in_few_runs_from_its_beginning_to_its_end(monkeypatch):
    seen = []
    monkeypatch.setattr(planning, "deepest", lambda scenario: (seen.append(scenario.index) or 0.0, 1.0))
    made = plan(changed(runs=1_000_000))
    first = seen[: planning.LOOKED_AT]
    assert (first[0], first[-1]) == (0, 999_999)
    assert max(b - a for a, b in pairwise(first)) < 16_000
    assert len(made.reach) == planning.LOOKED_AT
    assert made.splits == {"train": 1_000_000}


def test_values_of_every_table_that_draws_are_in_the_plan():
    recipe = load_recipe(runs=8)
    drawn = {each.key: each for each in plan(recipe).drawn}
    speed = drawn["vary.speed_rpm"]
    assert speed.how == "{ uniform = [6500, 12000] }"
    assert list(speed.values) == [recipe.scenario(index).operation.speed_rpm for index in range(8)]
    width = drawn["faults.bearing-defect.width_m"]
    having = [
        index
        for index in range(8)
        if any(each.kind == "bearing-defect" for each in recipe.scenario(index).machine.faults)
    ]
    assert list(width.runs) == having
    assert "surroundings.path_gain" in drawn


def test_a_balanced_set_is_planned_by_its_first_candidates_without_screening(monkeypatch):
    monkeypatch.setattr(Recipe, "_chosen", lambda *_: pytest.fail("a candidate was screened"))
    recipe = load_recipe(RECIPES / "balanced.toml", runs=2)
    made = plan(recipe)
    assert made.balanced
    assert len(made.reach) == 2
    assert "quotas" in "\n".join(plan_lines(made))


def test_each_candidate_of_a_machine_costs_its_reduction(monkeypatch):
    machines = {"count": 50, "runs_per_machine": 4, "vary": {"blade_length_m": {"uniform": [0.14, 0.16]}}}
    recipe = parse_recipe({**{key: each for key, each in RECIPE.items() if key != "runs"}, "machines": machines})
    drawn = [SimpleNamespace(virtual=SimpleNamespace(candidate=number)) for number in (0, 0, 3)]
    assert planning._machine_seconds(recipe, drawn) == pytest.approx(50 * 2 * SECONDS_A_CANDIDATE)
    assert planning._machine_seconds(changed(), [SimpleNamespace(virtual=None)]) == 0


def test_the_picture_has_a_panel_for_each_key_that_varies_and_one_for_the_penetration():
    made = plan(changed(runs=3))
    shown = [axes for axes in plan_figure(made).axes if axes.get_visible()]
    assert [axes.get_xlabel() for axes in shown] == [
        "free penetration, mm",
        "vary.speed_rpm",
        "vary.free_penetration_m",
    ]
    counted = [sum(bar.get_height() for group in axes.containers for bar in group) for axes in shown]
    assert counted == [3, 3, 3]
    unknown = replace(made, reach=tuple(replace(each, depth_m=math.inf) for each in made.reach))
    assert "not known" in plan_figure(unknown).axes[0].texts[0].get_text()


@pytest.mark.parametrize(("least", "largest"), [(5.2e4, 5.8e5), (0.35, 2.7), (2.8e-4, 3.1e-3), (1e-9, 3), (4.1, 4.3)])
def test_the_axis_of_a_key_drawn_by_its_logarithm_has_few_values(least, largest):
    made = plan(changed(runs=3))
    drawn = Drawn(key="vary.k", how="{ log_uniform = [1, 2] }", values=(least, largest), runs=(0, 1))
    axes = plan_figure(replace(made, drawn=(drawn,))).axes[1]
    assert 1 <= sum(least <= place <= largest for place in axes.get_xticks()) <= TICKS
    assert axes.get_xticks(minor=True).size == 0


def run(capsys, *words):
    with pytest.raises(SystemExit) as end:
        main(list(words))
    captured = capsys.readouterr()
    return end.value.code, captured.out, captured.err


def recipe_file(folder, deepest="1e-4"):
    path = folder / "few.toml"
    path.write_text(TOML.replace("DEEPEST", deepest), encoding="utf-8")
    return str(path)


def test_a_dry_run_prints_the_plan_and_makes_nothing(tmp_path, capsys):
    file, out = recipe_file(tmp_path), tmp_path / "set"
    code, text, _ = run(capsys, "plan", file, "--runs", "4")
    assert code == 0
    assert "few: 4 runs of zeng2019" in text
    assert "of 4 runs looked at" in text
    assert run(capsys, "generate", file, "--runs", "4", "--out", str(out), "--dry-run")[:2] == (0, text)
    assert not out.exists()


def test_a_program_reads_the_plan_and_a_picture_is_written(tmp_path, capsys):
    file, picture = recipe_file(tmp_path), tmp_path / "plan.png"
    code, out, _ = run(capsys, "plan", file, "--runs", "2", "--json", "--out", str(picture))
    found = json.loads(out)
    assert (code, found["runs"], len(found["reach"])) == (0, 2, 2)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_refused_run_is_named_and_the_exit_code_is_1(tmp_path, capsys):
    code, out, _ = run(capsys, "plan", recipe_file(tmp_path, "5e-3"))
    assert code == 1
    assert "refused" in out
    assert "needs a clearance of" in out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--try", "-1"], "--try -1: must be at least 0"),
        (["--try", "1.5"], "1.5"),
        (["--runs", "0"], "must be at least 1"),
        (["--out", "plan.txt"], "end the name in"),
        (["--out", "no/plan.png"], "there is no directory no"),
        (["--workers", "2"], "--workers"),
    ],
)
def test_a_mistake_is_one_line(words, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(capsys, "plan", recipe_file(tmp_path), *words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert said in err
    assert [path.name for path in tmp_path.iterdir()] == ["few.toml"]
