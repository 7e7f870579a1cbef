"""`[surroundings]` of a recipe: what is drawn, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import RubgenWarning, UserError
from rubgen.machine import load_machine
from rubgen.machine.frame import Frame
from rubgen.machine.load import PRESETS, machine_id
from rubgen.scenario import make_scenario, parse_recipe
from rubgen.scenario.costs import bytes_a_second, run_problem
from rubgen.scenario.scenario import scenario_dict
from rubgen.scenario.surroundings import Surroundings, Tone

BASE = {"name": "around", "runs": 4, "machine": "zeng2019"}
DRAWN = {
    "background_m_per_s2": {"log_uniform": [1, 300]},
    "runout_m": {"uniform": [1e-6, 9e-6]},
    "tones": [{"order": {"uniform": [2, 4]}, "level_m_per_s2": {"uniform": [1, 9]}}],
}


def recipe(**surroundings):
    return parse_recipe({**BASE, "surroundings": surroundings}, source="r.toml")


def drawn(**surroundings) -> list[Surroundings]:
    made = recipe(**surroundings)
    return [made.scenario(index).surroundings for index in range(40)]


def test_values_fill_their_ranges():
    values = np.log([each.background_m_per_s2 for each in drawn(**DRAWN)])
    assert 0 <= values.min() < 0.2 * np.log(300)
    assert 0.8 * np.log(300) < values.max() <= np.log(300)
    orders = [each.tones[0].order for each in drawn(**DRAWN)]
    assert 2 <= min(orders) < 2.4
    assert 3.6 < max(orders) <= 4


def test_a_key_changes_no_other_and_no_drawn_value_of_vary():
    alone = drawn(runout_m=DRAWN["runout_m"])
    assert [each.runout_m for each in alone] == [each.runout_m for each in drawn(**DRAWN)]
    vary = {"clearance_m": {"uniform": [2e-4, 3e-4]}}
    silent = parse_recipe({**BASE, "vary": vary}).scenario(3)
    around = parse_recipe({**BASE, "vary": vary, "surroundings": DRAWN}).scenario(3)
    assert around.machine == silent.machine
    assert len({each.runout_m for each in alone}) == len(alone)


def test_a_silent_recipe_says_nothing_of_surroundings():
    silent = parse_recipe(BASE)
    assert "surroundings" not in silent.model_dump(mode="json", exclude_none=True)
    assert "surroundings" not in scenario_dict(silent.scenario(0))
    assert scenario_dict(recipe(runout_m=1e-6).scenario(0))["surroundings"]["runout_m"] == 1e-6


def test_a_single_run_takes_the_same_keys():
    scenario = make_scenario(background_m_per_s2=50, runout_m=2e-6)
    assert scenario.surroundings == Surroundings(background_m_per_s2=50, runout_m=2e-6)
    assert make_scenario().surroundings is None
    with pytest.raises(UserError, match=r"^background_m_per_s2 = "):
        make_scenario(background_m_per_s2={"uniform": [1, 2]})


def test_a_tone_above_half_the_sample_rate_is_warned_of():
    with pytest.warns(RubgenWarning, match=r"tones\.0\.order = 100: at 16666\.7 Hz; channels show at most 12800 Hz"):
        recipe(tones=[{"order": 100, "level_m_per_s2": 1}])


@pytest.mark.parametrize(
    ("surroundings", "words"),
    [
        ({"background_m_per_s2": {"uniform": [-1, 5]}}, "surroundings.background_m_per_s2 = -1"),
        ({"background_m_per_s2": {"uniform": [1, 1e12]}}, "surroundings.background_m_per_s2 = 1e+12"),
        ({"runout_m": [1e-6, 2e-6]}, "a range is written"),
        ({"backgrund_m_per_s2": 3}, "did you mean background_m_per_s2?"),
        ({"tones": [{"level_m_per_s2": 3}]}, "either an order or a frequency_hz"),
        ({"tones": [{"order": 2, "frequency_hz": 50, "level_m_per_s2": 3}]}, "either an order or a frequency_hz"),
        ({"tones": [{"order": 2}]}, "level_m_per_s2"),
        ({"tones": [{"order": 0, "level_m_per_s2": 3}]}, "surroundings.tones.0.order = 0"),
        ({"tones": [{"order": 2, "level_m_per_s2": 3}] * 17}, "surroundings.tones"),
        ({"background_slope": 9}, "surroundings.background_slope = 9"),
    ],
)
def test_mistakes_are_one_line_with_the_key(surroundings, words):
    with pytest.raises(UserError) as error:
        recipe(**surroundings)
    assert str(error.value).startswith("r.toml: surroundings")
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_a_level_in_another_unit_is_asked_about():
    with pytest.warns(RubgenWarning, match="background_m_per_s2 = 300000: .* were mm/s2 meant, 300 m/s2"):
        recipe(background_m_per_s2={"uniform": [1, 300000]})


def test_a_tone_at_a_fixed_frequency_has_an_order_of_the_run():
    assert Tone(frequency_hz=50, level_m_per_s2=1).order_at(200) == 0.25


def test_a_frame_that_no_sensor_feels_is_no_part_of_the_run():
    idle, plain = parse_recipe(BASE).scenario(0), load_machine("zeng2019")
    assert plain.frame is not None
    assert idle.machine.frame is None
    assert idle.machine_id == machine_id(replace(plain, frame=None))
    assert "frame" not in scenario_dict(idle)["machine"]
    assert recipe(runout_m=1e-6).scenario(0).machine.frame is None
    for felt in (recipe(path_gain={"uniform": [0, 2]}), parse_recipe({**BASE, "sensors": {"set": "field"}})):
        assert felt.scenario(0).machine.frame == plain.frame
        assert felt.scenario(0).machine_id == machine_id(plain)
    assert make_scenario(path_gain=0.5).frame == plain.frame
    assert make_scenario(runout_m=1e-6).frame is None


def test_a_machine_without_a_frame_says_what_needs_one(tmp_path):
    machine = tmp_path / "m.toml"
    text = (PRESETS / "zeng2019.toml").read_text(encoding="utf-8")
    machine.write_text(text[: text.index("# A plausible frame")], encoding="utf-8")
    with pytest.raises(UserError, match=r"^surroundings\.path_gain = 0\.5: the machine has no \[frame\]; give it one"):
        make_scenario(machine, path_gain=0.5)
    with pytest.raises(UserError, match=r"housing_accelerometer' of housing_acc_x: the machine has no \[frame\]"):
        make_scenario(machine, sensors="field")
    assert make_scenario(machine, background_m_per_s2=3).machine.frame is None


@pytest.mark.parametrize(
    ("surroundings", "words"),
    [
        ({"background_slope": 2}, "background_slope = 2: changes no channel: without background_m_per_s2"),
        ({"speed_exponent": 2, "runout_m": 1e-6}, "without background_m_per_s2 or blade_passing_m_per_s2"),
        ({"frame_spread": 0.1}, "frame_spread = 0.1: changes no channel: without path_gain or an accelerometer"),
    ],
)
def test_a_key_that_changes_no_channel_is_warned_of(surroundings, words):
    with pytest.warns(RubgenWarning) as caught:
        recipe(**surroundings)
    assert len(caught) == 1
    assert words in str(caught[0].message)
    assert str(caught[0].message).startswith("r.toml: surroundings.")


def test_a_level_drawn_from_0_on_that_no_sensor_feels_is_warned_of(tmp_path):
    sensors = tmp_path / "s.toml"
    sensors.write_text('name = "one"\n[[sensors]]\nname = "f"\nkind = "contact_force"\n')
    drawn = {"name": "r", "runs": 2, "machine": "zeng2019", "surroundings": {"runout_m": {"uniform": [0, 1e-6]}}}
    with pytest.warns(RubgenWarning, match="runout_m = 1e-06: .* the sensor set one has no proximity probe"):
        parse_recipe(drawn | {"sensors": {"set": str(sensors)}})


def test_a_slope_of_a_level_drawn_from_0_on_is_not_warned_of(recwarn):
    recipe(background_m_per_s2={"uniform": [0, 10]}, background_slope={"uniform": [0, 1]})  # its least is without one
    assert not [each for each in recwarn if issubclass(each.category, RubgenWarning)]


def test_a_level_that_no_sensor_feels_is_warned_of(tmp_path):
    sensors = tmp_path / "s.toml"
    sensors.write_text('name = "one"\n[[sensors]]\nname = "f"\nkind = "contact_force"\n')
    with pytest.warns(RubgenWarning, match="runout_m = 1e-06: .* the sensor set one has no proximity probe"):
        make_scenario(runout_m=1e-6, sensors=sensors)


def test_tones_that_no_sensor_feels_are_warned_of(tmp_path):
    sensors = tmp_path / "s.toml"
    sensors.write_text('name = "one"\n[[sensors]]\nname = "f"\nkind = "contact_force"\n')
    tones = {"surroundings": {"tones": [{"order": 2.5, "level_m_per_s2": 0.3}]}, "name": "r", "runs": 2}
    with pytest.warns(RubgenWarning) as caught:
        parse_recipe(tones | {"machine": "zeng2019", "sensors": {"set": str(sensors)}})
    words = [str(each.message) for each in caught]
    assert words == ["recipe: surroundings.tones: changes no channel: the sensor set one has no accelerometer"]


@pytest.mark.filterwarnings("error")
def test_a_key_that_some_run_needs_is_not_warned_of():
    recipe(background_slope=2, background_m_per_s2={"uniform": [0, 10]})
    recipe(frame_spread=0.1, path_gain={"uniform": [0, 1]})


def test_the_memory_of_surroundings_and_frame_counts():
    silent, around = make_scenario(), make_scenario(background_m_per_s2=3)
    path = make_scenario(path_gain=1)
    assert bytes_a_second(silent) < bytes_a_second(around) < bytes_a_second(path)
    modes = (replace(path.machine.frame.modes[0], frequency_hz=10.0, damping=1e-3),)
    slow = replace(path, machine=replace(path.machine, frame=Frame(modes=modes)))
    assert "the slowest needs 147 s of the record" in run_problem(slow)
    assert run_problem(path) is None
