"""The recipe of a test rig's sensors, at small size: made, and nothing wrong with it."""

import numpy as np

import rubgen
from rubgen.scenario import load_recipe
from rubgen.scenario.load import RECIPES
from tests.whole_table import whole_table

RECIPE = RECIPES / "rig.toml"


def test_runs_of_the_rig_recipe(tmp_path):
    """The first of the two is a heavy rub that diverges; the second is recorded."""
    rubgen.generate(RECIPE, tmp_path / "rig", runs=2, workers=1)
    assert rubgen.verify(tmp_path / "rig") == []
    rows = whole_table(tmp_path / "rig").to_pylist()
    assert rows  # or nothing was verified
    sensors = load_recipe(RECIPE).sensing.set.sensors
    for row in rows:
        turns = 0.5 * row["speed_rpm"] / 60
        for sensor in sensors:
            if sensor.kind == "blade_tip_timing":
                assert len(row[f"{sensor.name}_s"]) == len(row[f"{sensor.name}_blade"])
                assert abs(len(row[f"{sensor.name}_s"]) - 36 * turns) < 36
            elif sensor.kind != "once_per_rev":
                assert np.ptp(row[sensor.name]) > 0
                assert row[sensor.name] != row[f"{sensor.name}_clean"]
