"""Other sensors on the same motions: the recipe with another sensor set, and labels that do not depend on it."""

import hashlib

import pytest

import rubgen
from rubgen.dataset.making.resense import _warn_of_other_steps
from rubgen.errors import RubgenWarning, UserError
from rubgen.io.columns import label_columns
from rubgen.labels.registry import ENERGY_LABELS, LABELS
from rubgen.machine.load import PRESETS
from rubgen.scenario import parse_recipe
from rubgen.scenario.vary import KEYS

RECIPE = {
    "name": "resensed",
    "seed": 5,
    "runs": 2,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"choice": [9000.0, 10000.0]}, "clearance_m": {"uniform": [2e-4, 3e-3]}},
    "simulation": {"settle_turns": 60, "record_turns": 100},
    "output": {"formats": ["parquet"], "signal_seconds": 0.05},
}


@pytest.fixture(scope="module")
def sets(module_with_short_records, tmp_path_factory):
    """A set, the same with the sensors of the field, and what generate makes of the recipe with these."""
    folder = tmp_path_factory.mktemp("resense")
    rubgen.generate(RECIPE, folder / "before", workers=1)
    rubgen.resense(folder / "before", "field", folder / "after", workers=1)
    rubgen.generate({**RECIPE, "sensors": {"set": "field"}}, folder / "direct", workers=1)
    return folder


def test_labels_that_need_no_sensor_are_equal_to_the_bit(sets):
    before, after = (rubgen.open(sets / name).runs for name in ("before", "after"))
    labels = [column.name for column in label_columns(label for label in LABELS if not label.from_taps)]
    same = [*labels, *KEYS, *(label.name for label in ENERGY_LABELS), "steps_per_turn", "settle_turns", "record_turns"]
    assert before[same].equals(after[same])
    assert before["rub"].nunique() == 2  # one of them rubs


def test_the_channels_are_those_of_the_new_sensors(sets):
    before, after = (rubgen.open(sets / name) for name in ("before", "after"))
    assert any("housing" in name for name in after.channels)
    assert not any("housing" in name for name in before.channels)
    assert rubgen.verify(sets / "after") == []


def test_generate_makes_the_same_bytes_of_the_recipe_with_these_sensors(sets):
    def digests(name):
        files = (path for path in (sets / name).rglob("*") if path.is_file())
        return {str(path.relative_to(sets / name)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}

    assert digests("after") == digests("direct")


@pytest.mark.parametrize(
    ("sensors", "message"),
    [("default", "has these sensors already"), ("feild", "no such set"), ("missing.toml", "missing.toml")],
)
def test_a_mistaken_sensor_set_is_refused_in_one_line(sets, tmp_path, sensors, message):
    with pytest.raises(UserError, match=message) as error:
        rubgen.resense(sets / "before", sensors, tmp_path / "out", workers=1)
    assert "\n" not in str(error.value)
    assert not (tmp_path / "out").exists()


def test_a_frame_that_cannot_be_read_is_named(module_with_short_records, sets, tmp_path, monkeypatch):
    path = tmp_path / "mine.toml"
    path.write_text((PRESETS / "zeng2019.toml").read_text())
    recipe = {**RECIPE, "machine": str(path), "runs": 1}
    monkeypatch.setattr("rubgen.dataset.making.generate.warm_up", lambda *_: [])
    rubgen.generate(recipe, tmp_path / "set", workers=1)
    path.write_text(path.read_text().replace("unbalance_kg_m = ", "unbalance_kg_m = 1"))
    with pytest.raises(UserError, match="has changed"):
        rubgen.resense(tmp_path / "set", "field", tmp_path / "out", workers=1)
    path.unlink()
    with pytest.raises(UserError, match=r"machine's \[frame\].*mine.toml.*directory of the recipe"):
        rubgen.resense(tmp_path / "set", "field", tmp_path / "out", workers=1)
    assert not (tmp_path / "out").exists()


def test_a_warning_names_the_speed_at_which_the_steps_differ():
    slow = {**RECIPE, "vary": {"speed_rpm": {"uniform": [4000, 9000]}}, "simulation": {}}
    slow["output"] = {"formats": ["parquet"], "signal_seconds": 0.5}
    old, new = parse_recipe(slow), parse_recipe({**slow, "sensors": {"set": "field"}})
    with pytest.warns(RubgenWarning, match=r"2,048 steps a turn instead of 1,024 at 4000 rev/min"):
        _warn_of_other_steps(old, new, "field")
