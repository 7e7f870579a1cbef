"""One case for each rule: the message names the file, the key, the value, what is allowed and how to mend it."""

import warnings

import pytest

import rubgen
from rubgen.errors import RubgenWarning, UserError
from rubgen.machine.load import PRESETS
from rubgen.scenario import load_recipe, make_scenario, parse_recipe
from rubgen.scenario.vary import KEYS

GOOD = 'name = "a"\nruns = 2\nmachine = "zeng2019"\n'
VARY = GOOD + "[vary]\n"
RUN_UP = GOOD + '[operation]\nprofile = "run-up"\n'
CASES = {
    "run-up without an end": (
        RUN_UP + "duration_s = 2",
        'operation.end_speed_rpm: the profile "run-up" needs it; add it',
    ),
    "run-up downward": (
        RUN_UP + "duration_s = 2\nend_speed_rpm = 12000\n[vary]\nend_speed_rpm = { uniform = [9000, 11000] }",
        "operation.end_speed_rpm = 9000: a run-up ends above its start, speed_rpm = 10000; raise it",
    ),
    "unknown profile": (
        GOOD + '[operation]\nprofile = "runup"',
        "operation.profile = 'runup': unknown value; did you mean run-up? allowed: steady, run-up,",
    ),
    "key of another profile": (
        VARY + "fluctuation_rpm = 3",
        'vary.fluctuation_rpm = 3: the profile "steady" has none; leave it out or give the profile "fluctuating"',
    ),
    "period of another profile": (
        GOOD + "[operation]\nfluctuation_period_s = 0.5",
        'operation.fluctuation_period_s = 0.5: the profile "steady" has none; leave it out or give the profile "fluc',
    ),
    "period of another profile, drawn": (
        RUN_UP + "duration_s = 2\nend_speed_rpm = 12000\n[vary]\nfluctuation_period_s = { uniform = [1, 2] }",
        'vary.fluctuation_period_s = { uniform = [1, 2] }: the profile "run-up" has none; leave it out or give the pr',
    ),
    "turns of a steady record": (
        RUN_UP + "duration_s = 2\nend_speed_rpm = 12000\n[simulation]\nrecord_turns = 600",
        'simulation.record_turns = 600: the profile "run-up" has none; leave it out or give the profile "steady"',
    ),
    "exponent of a run-up": (
        RUN_UP + "duration_s = 2\nend_speed_rpm = 12000\n[labels]\nlyapunov = true",
        'labels.lyapunov = true: the profile "run-up" has none; leave it out or give the profile "steady"',
    ),
    "run-up through a forbidden band": (
        RUN_UP + "duration_s = 2\nend_speed_rpm = 12000\nforbidden_speed_rpm = [[10500, 10600]]",
        "operation.forbidden_speed_rpm = [10500, 10600]: the speed goes from 10000 to 12000 rev/min; stay out of the",
    ),
    "steady in a forbidden band": (
        GOOD + "[operation]\nforbidden_speed_rpm = [[1, 2], [9000, 10000]]",
        "operation.forbidden_speed_rpm = [9000, 10000]: the speed is 10000 rev/min; stay out of the band",
    ),
    "fluctuation within a step": (
        GOOD + '[operation]\nprofile = "fluctuating"\nduration_s = 2\nfluctuation_rpm = 9\nfluctuation_period_s = 1e-4',
        "operation.fluctuation_period_s = 0.0001: must be at least a tenth of a turn, 0.0006 s; raise it",
    ),
    "band upside down": (
        GOOD + "[operation]\nforbidden_speed_rpm = [[3000, 2000]]",
        "operation.forbidden_speed_rpm = [3000, 2000]: the lower end comes first; swap the two",
    ),
    "signal beyond the run-up": (
        RUN_UP + "duration_s = 0.9\nend_speed_rpm = 12000",
        "output.signal_seconds = 1: the record lasts 0.9 s, operation.duration_s; lower it or raise that",
    ),
    "unknown key": (GOOD + "sede = 3", "sede: unknown key; did you mean seed?"),
    "unknown key of a table": (
        GOOD + "[output]\nformat = ['mcap']",
        "output.format: unknown key; did you mean formats?",
    ),
    "unknown key of vary": (VARY + "speed = 9000", "vary.speed: unknown key; did you mean speed_rpm?"),
    "unknown distribution": (
        VARY + "speed_rpm = { unifrom = [1, 2] }",
        "vary.speed_rpm = { unifrom = [1, 2] }: no such",
    ),
    "two distributions": (
        VARY + "friction = { uniform = [0.1, 0.2], choice = [0.1] }",
        "no such distribution; give a number or a table of one key: uniform, log_uniform, normal, choice",
    ),
    "missing key": ('name = "a"\nmachine = "zeng2019"', "runs: this key is missing; add it"),
    "text for a number": (VARY + 'speed_rpm = "fast"', "vary.speed_rpm = 'fast': no such distribution; give a number"),
    "negative clearance": (
        VARY + "clearance_m = -1e-4",
        "vary.clearance_m = -0.0001: must be at least 1e-07 and at most 100",
    ),
    "clearance reaches 0": (
        VARY + "clearance_m = { uniform = [0, 1e-3] }",
        "vary.clearance_m = 0: must be at least 1e-07 and",
    ),
    "speed 0": (VARY + "speed_rpm = 0", "vary.speed_rpm = 0: must be at least 0.001"),
    "nan": (VARY + "speed_rpm = nan", "vary.speed_rpm = nan: must be a finite number; change the value"),
    "inf": (VARY + "speed_rpm = { uniform = [1000, inf] }", "vary.speed_rpm.uniform.1 = inf: must be a finite number"),
    "min above max": (
        VARY + "speed_rpm = { uniform = [9000, 8000] }",
        "vary.speed_rpm = { uniform = [9000, 8000] }: the lower end 9000 is above the upper end 8000; swap them",
    ),
    "log of 0": (VARY + "friction = { log_uniform = [0, 0.1] }", "both ends must be above 0"),
    "normal without width": (
        VARY + "friction = { normal = { mean = 0.1, std = 0, min = 0, max = 0.2 } }",
        "vary.friction.normal.std = 0: must be above 0; change the value",
    ),
    "normal turned round": (
        VARY + "friction = { normal = { mean = 0.1, std = 0.1, min = 0.2, max = 0 } }",
        "the lower end 0.2 is above the upper end 0; swap them",
    ),
    "range by other words": (
        VARY + "friction = { low = 0, high = 0.2 }",
        "a range is written { uniform = [0, 0.2] }",
    ),
    "date for a number": (GOOD + "seed = 2020-01-31", "seed = 2020-01-31: must be a whole number"),
    "empty choice": (VARY + "lobes = { choice = [] }", "vary.lobes.choice = []: "),
    "friction too high": (VARY + "friction = 0.4", "vary.friction = 0.4: must be at least 0 and at most 0.3; change"),
    "unknown key of contact": (GOOD + "[contact]\nmu = 0.1", "contact.mu: unknown key; "),
    "restitution above 1": (
        GOOD + "[contact]\nrestitution = 1.2",
        "contact.restitution = 1.2: must be at least 0 and at most 1; 1.2 % is written 0.012",
    ),
    "half a lobe": (VARY + "lobes = 2.5", "vary.lobes = 2.5: must be a whole number; change the value"),
    "lobes from a range": (VARY + "lobes = { uniform = [2, 4] }", "vary.lobes: takes whole numbers only"),
    "lobes beyond the modes": (
        VARY + "lobes = { choice = [2, 6] }",
        "casing.lobes = 6: 11 casing modes carry the orders 0 to 5; take another number of lobes, or raise reduction.c",
    ),
    "nodes not divisible": (
        VARY + "lobes = 7\n[reduction]\ncasing_modes = 15",
        "casing.nodes = 180: must be divisible by 4 and by casing.lobes = 7; take 168",
    ),
    "modes of a blade": (
        GOOD + "[reduction]\nblade_modes = 115",
        "reduction.blade_modes = 115: this mesh has 114; lower it, or take more elements",
    ),
    "springs that leave the order of the lobes to high modes": (
        VARY + "casing_support_stiffness_n_per_m = 1e4\nlobes = 90",
        "casing.lobes = 90: 11 casing modes carry the orders 0 to 5; take another number of lobes, or raise reduction",
    ),
    "signal beyond the record": (
        VARY + "speed_rpm = { uniform = [6000, 12000] }\n[output]\nsignal_seconds = 2.6",
        "output.signal_seconds = 2.6: the record lasts 2.5 s (500 turns at 12000 rev/min)",
    ),
    "no sample": (
        GOOD + "[output]\nsignal_seconds = 1e-9",
        "output.signal_seconds = 1e-09: holds no sample at sensors.sample_rate_hz = 25600, one takes 3.91e-05 s; ra",
    ),
    "no sample at a low rate": (
        GOOD + "[sensors]\nsample_rate_hz = 1e-3",
        "output.signal_seconds = 1: holds no sample at sensors.sample_rate_hz = 0.001, one takes 1e+03 s; raise one",
    ),
    "one step a turn": (
        GOOD + "[simulation]\nsteps_per_turn = 1",
        "simulation.steps_per_turn = 1: must be at least 32 and at most 16,384; change the value",
    ),
    "few turns": (GOOD + "[simulation]\nrecord_turns = 499", "simulation.record_turns = 499: labels need at least 500"),
    "sample rate": (
        VARY
        + "speed_rpm = { uniform = [120, 9000] }\n[simulation]\nrecord_turns = 500\n[sensors]\nsample_rate_hz = 25600",
        "sensors.sample_rate_hz = 25600: at 120 rev/min the step feeds at most 12800 Hz",
    ),
    "steps": (
        GOOD + "[simulation]\nsteps_per_turn = 20000",
        "simulation.steps_per_turn = 20000: must be at least 32 and at most 16,384; change the value",
    ),
    "settle": (GOOD + "[simulation]\nsettle_turns = 0", "simulation.settle_turns"),
    "no runs": (
        'name = "a"\nruns = 0\nmachine = "zeng2019"',
        "runs = 0: must be at least 1 and at most 1,000,000; change the value",
    ),
    "unknown preset": (
        'name = "a"\nruns = 1\nmachine = "zeng2018"',
        "machine = 'zeng2018': no such preset; did you mean",
    ),
    "unknown format": (
        GOOD + "[output]\nformats = ['csv']",
        "output.formats.0 = 'csv': unknown value; allowed: parquet, mcap, rrd",
    ),
    "no format": (GOOD + "[output]\nformats = []", "output.formats = []: "),
    "format twice": (GOOD + "[output]\nformats = ['mcap', 'mcap']", "output.formats = ['mcap', 'mcap']: name each"),
    "name with a slash": ('name = "a/b"\nruns = 1\nmachine = "zeng2019"', "name = 'a/b': "),
    "not TOML": ("name = ", "not TOML"),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_refused_in_one_line(case, tmp_path):
    text, message = case
    path = tmp_path / "recipe.toml"
    path.write_text(text)
    with pytest.raises(UserError) as caught:
        load_recipe(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "count = 36",
            "count = 35",
            "circumferential_elements = 72: must be a multiple of blades.count = 35, .*; try 70",
        ),
        ("count = 36", "count = 1", "own.toml: blades.count = 1: must be at least 2 and at most 1,000; change"),
        ("nodes = 180", "nodes = 182", "casing.nodes = 182: must be divisible by 4 and by casing.lobes = 2; take 184"),
    ],
)
def test_a_machine_that_cannot_be_meshed_is_refused_with_its_recipe(tmp_path, old, new, message):
    text = (PRESETS / "zeng2019.toml").read_text()
    assert old in text
    (tmp_path / "own.toml").write_text(text.replace(old, new))
    with pytest.raises(UserError, match=message):
        parse_recipe({"name": "a", "runs": 1, "machine": "own.toml"}, folder=tmp_path)


def test_missing_file(tmp_path):
    with pytest.raises(UserError, match=r"none.toml: there is no such file; check the path"):
        load_recipe(tmp_path / "none.toml")


def test_directory_for_a_file(tmp_path):
    with pytest.raises(UserError, match="cannot be read"):
        load_recipe(tmp_path)


def test_not_text(tmp_path):
    (tmp_path / "a.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UserError, match=r"a text file in UTF-16; save it in UTF-8"):
        load_recipe(tmp_path / "a.toml")


def test_machine_file_of_the_recipe_is_named(tmp_path):
    with pytest.raises(UserError, match=r"gone.toml: there is no such file"):
        parse_recipe({"name": "a", "runs": 1, "machine": "gone.toml"}, folder=tmp_path)


@pytest.mark.parametrize("runs", [0, -1, 1_000_001, 2**70, True, 2.0])
def test_runs_option(tmp_path, runs):
    for refused in (
        lambda: load_recipe(runs=runs),
        lambda: rubgen.generate(load_recipe(), tmp_path / "set", runs=runs),
        lambda: rubgen.generate({"name": "a", "runs": 1, "machine": "zeng2019"}, tmp_path / "set", runs=runs),
    ):
        with pytest.raises(UserError, match=rf"--runs {runs}: must be at least 1 and at most 1,000,000; give a whole"):
            refused()
    assert list(tmp_path.iterdir()) == []


def test_scenario_keys():
    with pytest.raises(UserError, match="speed_rmp: unknown key; did you mean speed_rpm"):
        make_scenario(speed_rmp=9000)
    with pytest.raises(UserError, match="clearance_m = -1: must be at least 1e-07"):
        make_scenario(clearance_m=-1.0)
    with pytest.raises(UserError, match="'nothing': no such preset"):
        make_scenario("nothing")


@pytest.mark.parametrize("value", [5e-324, 1e-8, 1e3, 1e300])
@pytest.mark.parametrize("key", KEYS)
def test_a_value_beyond_all_machines_is_refused_before_a_run(key, value):
    text = ""
    with warnings.catch_warnings(action="ignore", category=RubgenWarning):
        try:
            parse_recipe({"name": "a", "runs": 1, "machine": "zeng2019", "vary": {key: value}})
        except UserError as error:
            text = str(error)
    assert "\n" not in text
    assert "Input should" not in text
