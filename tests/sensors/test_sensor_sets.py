"""Sensor sets from TOML files, and what is said of wrong ones."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from rubgen.errors import UserError
from rubgen.scenario import load_recipe
from rubgen.sensors import kinds
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.load import load_sensor_set, parse_sensor_set, sensor_set_names
from rubgen.sensors.registry import SENSOR_KINDS

RECIPE = """name = "a"
runs = 1
machine = "zeng2019"
[sensors]
set = "mine.toml"
"""
GOOD = """name = "mine"
[kinds.proximity]
unit = "um"
noise_rms = 0.5
[[sensors]]
name = "p"
kind = "proximity"
angle_deg = 30
[[sensors]]
name = "q"
kind = "proximity"
angle_deg = 120
noise_rms = 2.0
[[sensors]]
name = "t"
kind = "blade_tip_timing"
angle_deg = 0
"""


def written(tmp_path, text):
    (tmp_path / "mine.toml").write_text(text)
    (tmp_path / "recipe.toml").write_text(RECIPE)
    return tmp_path / "recipe.toml"


def test_every_file_of_a_kind_is_registered_under_its_name():
    files = {path.stem for path in Path(kinds.__file__).parent.glob("*.py")} - {"__init__"}
    assert len(files) >= 10
    assert set(SENSOR_KINDS) == files


def test_packaged_sets():
    assert sensor_set_names() == ["default", "field", "field-cheap", "rig"]
    for name in sensor_set_names():
        assert load_sensor_set(name).name == name


def test_a_set_reaches_the_scenario_with_the_values_of_its_kinds(tmp_path):
    sensors = load_recipe(written(tmp_path, GOOD)).scenario(0).sensing.set
    first, second, third = sensors.sensors
    assert isinstance(first, Proximity)
    assert (first.unit, first.noise_rms, first.angle_deg) == ("um", 0.5, 30)
    assert (second.unit, second.noise_rms) == ("um", 2.0)
    assert third.kind == "blade_tip_timing"
    assert [sensor.name for sensor in sensors.sampled] == ["p", "q"]


WRONG = [
    (
        'kind = "proximity"',
        'kind = "proximty"',
        "sensors.0.kind = proximty: unknown kind of sensor; did you mean proximi",
    ),
    ("[kinds.proximity]", "[kinds.proxy]", "kinds.proxy: unknown kind of sensor; did you mean proximity?"),
    ('unit = "um"', 'name = "x"', "kinds.proximity.name: each sensor has its own; give it in [[sensors]]"),
    ('unit = "um"', 'kind = "torque"', "kinds.proximity.kind: each sensor has its own; give it in [[sensors]]"),
    ('kind = "proximity"\n', "", "sensors.0.kind: this key is missing; add it, one of proximity, "),
    ('unit = "um"', 'unit = "micron"', "sensors.0: unit = 'micron' of p: unknown unit; allowed: m, mm, um, V"),
    ('unit = "um"', f'unit = "{"a" * 5000}"', f"unit = '{'a' * 59} of p: unknown unit; "),
    ('unit = "um"', 'unit = "umm"', "unit = 'umm' of p: unknown unit; did you mean um? allowed: m, mm, um, V"),
    (
        "angle_deg = 30",
        "angle_deg = 360",
        "sensors.0.angle_deg = 360: must be at least 0 and below 360; change the value",
    ),
    (
        "angle_deg = 30",
        "angle_deg = -1",
        "sensors.0.angle_deg = -1: must be at least 0 and below 360; change the value",
    ),
    ("angle_deg = 30", "", "sensors.0.angle_deg: this key is missing; add it"),
    ("angle_deg = 30", "angel_deg = 30", "sensors.0.angel_deg: unknown key; did you mean angle_deg?"),
    ('name = "q"', 'name = "p"', "name = 'p' of 2 sensors: must differ; rename all but one"),
    ('name = "q"', 'name = "q q"', "sensors.1.name = 'q q': "),
    ("noise_rms = 2.0", "range = [5, 5]", "range = [5.0, 5.0] of q: must ascend; give the lower limit first"),
    ("noise_rms = 2.0", "resonance_hz = 2e6", "resonance_hz = 2e+06 of q: at 10000 rev/min the step feeds at most"),
    (
        "noise_rms = 2.0",
        "noise_rms = -2.0",
        "sensors.1.noise_rms = -2: must be at least 0 and at most 1,000,000,000; change the value",
    ),
    (
        '"blade_tip_timing"\nangle_deg = 0',
        '"blade_strain"\nblade = 36',
        "blade = 36 of t: the machine has 36 blades; give 0",
    ),
    ("angle_deg = 0\n", "angle_deg = 0\naxial_m = 0.03\n", "axial_m = 0.03 of t: the tips reach 0.01927 m to either"),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG)
def test_a_wrong_set_is_refused_in_one_line(tmp_path, old, new, message):
    with pytest.raises(UserError) as caught:
        load_recipe(written(tmp_path, GOOD.replace(old, new, 1)))
    text = str(caught.value)
    assert message in text
    assert "\n" not in text
    assert str(tmp_path) in text


def test_unknown_and_missing_sets(tmp_path):
    with pytest.raises(
        UserError,
        match=r"sensors\.set = 'ring': no such set; did you mean rig\? allowed: default, field, field-cheap, rig, or ",
    ):
        load_sensor_set("ring")
    recipe = written(tmp_path, GOOD)
    recipe.write_text(RECIPE.replace("mine.toml", "rigg"))
    with pytest.raises(UserError, match=r"recipe\.toml: sensors\.set = 'rigg': no such set; did you mean rig"):
        load_recipe(recipe)
    recipe.write_text(RECIPE.replace("mine.toml", "nowhere.toml"))
    with pytest.raises(UserError, match=r"nowhere\.toml: there is no such file"):
        load_recipe(recipe)


def test_a_second_pulse_is_refused(tmp_path):
    path = tmp_path / "two.toml"
    pulse = '[[sensors]]\nname = "{}"\nkind = "once_per_rev"\n'
    path.write_text('name = "two"\n' + pulse.format("a") + pulse.format("b"))
    with pytest.raises(UserError, match="two sensors of kind once_per_rev: there is one pulse a turn; keep one"):
        parse_sensor_set(path)


@pytest.mark.parametrize(
    "sensor", ['kind = "once_per_rev"', 'kind = "blade_tip_timing"\nangle_deg = 10'], ids=["pulse", "timing"]
)
def test_a_set_that_records_no_signal_is_refused(tmp_path, sensor):
    recipe = written(tmp_path, f'name = "none"\n[[sensors]]\nname = "a"\n{sensor}\n')
    with pytest.raises(UserError, match=r"mine\.toml: sensors: none records a signal \(kinds .+ only\); add one"):
        load_recipe(recipe)


def test_the_command_line_ends_with_2_and_one_line(tmp_path):
    recipe = written(tmp_path, GOOD.replace("proximity", "proximty", 1).replace("kinds.proximty", "kinds.proxi"))
    command = [sys.executable, "-m", "rubgen.cli.run", "generate", str(recipe), "--out", str(tmp_path / "out")]
    code = "from rubgen.cli.run import main; import sys; main(sys.argv[1:])"
    command = [sys.executable, "-c", code, *command[3:]]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert re.fullmatch(r"rubgen: .*mine\.toml: kinds\.proxi: unknown kind of sensor; [^\n]*\n", done.stderr), (
        done.stderr
    )
    assert not (tmp_path / "out").exists()
