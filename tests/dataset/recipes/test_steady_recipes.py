"""The recipes of steady runs at small size: made, nothing wrong with them, and their labels made again."""

import tomllib

import numpy as np
import pytest

import rubgen
from rubgen.dataset.checking.relabel import relabel
from rubgen.scenario.load import RECIPES
from tests.whole_table import whole_table


@pytest.mark.parametrize("name", ["speed-sweep", "three-lobes"])
def test_a_steady_recipe_makes_a_set_that_verifies(name, short_records, tmp_path):
    recipe = tomllib.loads((RECIPES / f"{name}.toml").read_text(encoding="utf-8"))
    recipe |= {"runs": 2, "simulation": {"settle_turns": 90, "record_turns": 110}}
    recipe["vary"] |= {"speed_rpm": 10000.0}
    recipe["output"] = {"formats": ["parquet"], "signal_seconds": 0.5}
    rubgen.generate(recipe, tmp_path / "set", workers=1)
    assert rubgen.verify(tmp_path / "set") == []
    assert relabel(tmp_path / "set").differences == ()
    rows = whole_table(tmp_path / "set").to_pylist()
    assert any(row["rub"] for row in rows)
    for row in rows:
        assert len(row["window_starts_s"]) == 7
        amplitudes = np.reshape(row["contact_force_window_amplitudes"], (6, 20))  # the first began before the tail
        assert (amplitudes.max(axis=1) > 0).tolist() == [bool(rub) for rub in row["window_rub"][1:]]
        touches = row["blade_touches"]
        assert (len(touches), sum(touches)) == (36, row["contact_touches"])
        assert len(row["touch_start_s"]) <= row["contact_touches"]
        assert row["rub"] is (row["free_penetration_m"] > 0)
        assert 0 < row["signal_start_s"] < row["window_starts_s"][-1]
