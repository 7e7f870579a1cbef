"""The recipe of run-ups at small size: generated, verified, and its labels over time read back."""

import tomllib

import rubgen
from rubgen.dataset.checking.relabel import relabel
from rubgen.io.parquet.read import read_table
from rubgen.scenario.load import RECIPES

RECIPE = RECIPES / "run-up.toml"


def test_the_run_up_recipe_makes_a_set_that_verifies(tmp_path):
    recipe = tomllib.loads(RECIPE.read_text(encoding="utf-8"))
    recipe["runs"] = 2
    recipe["operation"]["duration_s"] = recipe["output"]["signal_seconds"] = 0.2
    recipe["vary"] |= {"speed_rpm": 6500, "end_speed_rpm": {"choice": [7500, 6700]}, "clearance_m": 2.6e-4}
    recipe["simulation"] = {"settle_turns": 50}
    rubgen.generate(recipe, tmp_path / "set", workers=1)
    assert rubgen.verify(tmp_path / "set") == []
    assert relabel(tmp_path / "set").differences == ()
    rows = read_table(tmp_path / "set" / "runs.parquet").to_pylist()
    assert [row["status"] for row in rows] == ["ok", "ok"]
    for row in rows:
        assert row["change_times_s"][0] == 0
        assert len(row["change_rub"]) == len(row["change_times_s"])
        assert row["rub"] is (row["onset_speed_rpm"] is not None)
