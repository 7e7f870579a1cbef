"""A set with surroundings beside the same set in silence: files, columns, labels, checks."""

import json

import numpy as np
import pytest

import rubgen
from rubgen.dataset.checking.verify import verify
from rubgen.scenario import parse_recipe

RECIPE = {
    "name": "plant",
    "runs": 1,
    "machine": "zeng2019",
    "vary": {"speed_rpm": 10000},
    "labels": {"lyapunov": False},
    "sensors": {"keep_clean": True},
    "output": {"signal_seconds": 1.0, "formats": ["parquet", "mcap"]},
}
SURROUNDINGS = {
    "background_m_per_s2": 80,
    "runout_m": 5e-6,
    "tones": [{"frequency_hz": 100, "level_m_per_s2": 4}],
}


@pytest.fixture(scope="module")
def sets(tmp_path_factory):
    folder = tmp_path_factory.mktemp("surroundings")
    for name, more in (("silent", {}), ("plant", {"surroundings": SURROUNDINGS})):
        rubgen.generate(parse_recipe({**RECIPE, **more}), folder / name, workers=1)
    return rubgen.open(folder / "silent"), rubgen.open(folder / "plant")


def test_motion_and_labels_are_those_of_silence_and_levels_are_columns(sets):
    silent, plant = (data.row("run-000000") for data in sets)
    assert {name: plant[name] for name in silent} == silent
    added = {name: plant[name] for name in plant if name not in silent}
    assert added["background_m_per_s2"] == 80
    assert (added["tones_order"], added["tones_frequency_hz"]) == ([0], [100])
    assert added["tones_m_per_s2"] == [4]
    assert sets[1].runs.attrs["units"]["runout_m"] == "m"


def test_channels_differ_and_clean_ones_do_not(sets):
    silent, plant = (data.signals("run-000000") for data in sets)
    changed = {name for name in silent if not np.array_equal(silent[name], plant[name])}
    assert changed == {name for name in silent if name.startswith(("casing_acc", "proximity")) and "clean" not in name}


def test_nothing_is_wrong_with_it_and_its_files_say_what_was_added(sets):
    _, plant = sets
    assert verify(plant.layout.root) == []
    card = plant.layout.card.read_text()
    assert "`background_m_per_s2`" in card
    assert "also feel surroundings" in card
    assert "surroundings" not in sets[0].layout.card.read_text()
    records = json.loads(plant.layout.croissant.read_text())["recordSet"]
    assert "runs/runout_m" in [field["@id"] for record_set in records for field in record_set["field"]]
