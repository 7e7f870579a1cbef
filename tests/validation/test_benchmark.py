"""The page of the benchmark: its counts of a set, and the recipes whose scores it compares."""

import tomllib
from pathlib import Path

import pytest

import rubgen
from rubgen.scenario import parse_recipe
from rubgen.scenario.load import RECIPES
from validation.benchmark import RECIPE, WAYS, counts, results

SAMPLE = Path(__file__).parents[2] / "datasets" / "sample"


def changed(way):
    recipe = tomllib.loads((RECIPES / f"{RECIPE}.toml").read_text(encoding="utf-8"))
    WAYS[way](recipe)
    return recipe


@pytest.mark.parametrize("way", WAYS)
def test_each_way_is_a_recipe_that_keeps_all_that_moves_the_machine(way):
    recipe, as_it_is = changed(way), changed("as it is")
    parse_recipe(recipe)
    for key in ("seed", "machine", "machines", "vary", "twins", "faults", "output"):
        assert recipe[key] == as_it_is[key]
    parts = [recipe, *(each for each in recipe["splits"].values() if isinstance(each, dict))]
    assert any("surroundings" in part for part in parts) == (way != "without surroundings")
    assert (recipe["sensors"].get("noise") == 0) == (way == "without noise of the sensors")


def test_the_page_counts_the_runs_of_each_split():
    data = rubgen.open(SAMPLE)
    table = counts(data)
    assert table.splitlines()[-1].split("|")[3].strip() == str(len(data.runs))
    assert results(data, [], len(data.runs)).startswith(f"Of all {len(data.runs)} runs")
    assert results(data, [], 8000).startswith(f"Of {len(data.runs)} runs of 8,000")
