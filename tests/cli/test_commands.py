import json
import subprocess
import sys
from inspect import signature

import numpy as np
import pytest

import rubgen
from rubgen.cli.app import app, simulate
from rubgen.io.mcap import read_mcap
from rubgen.scenario.vary import KEYS

HEAVY = {"numba", "pandas", "rerun", "pyarrow", "scipy", "numpy", "pydantic", "mcap", "matplotlib"}


@pytest.fixture
def short(monkeypatch):
    """Options of a run of 110 turns; the least number of turns is lowered for them."""
    monkeypatch.setattr("rubgen.scenario.feasible.MIN_RECORD_TURNS", 100)
    return ["--record-turns", "110", "--settle-turns", "90", "--signal-seconds", "0.3"]


def test_help_is_quick_because_it_imports_little():
    code = f"""
import sys, time
start = time.perf_counter()
try:
    from rubgen.cli import main
    main(["--help"])
except SystemExit as ended:
    print("code", ended.code, file=sys.stderr)
print("heavy", sorted({HEAVY!r} & set(sys.modules)), file=sys.stderr)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr.splitlines() == ["code 0", "heavy []"]
    for command in ("generate", "simulate", "modes", "reproduce", "info", "verify"):
        assert command in done.stdout


def test_importing_rubgen_imports_little():
    code = f"import sys, rubgen; print(sorted({HEAVY!r} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_public_names():
    assert rubgen.__all__ == [
        "RubgenError",
        "UserError",
        "__version__",
        "generate",
        "load_recipe",
        "make_scenario",
        "open",
        "simulate",
        "verify",
    ]
    assert all(getattr(rubgen, name) is not None for name in rubgen.__all__)


def test_every_key_of_vary_is_an_option_of_simulate():
    assert set(KEYS) <= set(signature(simulate).parameters)


def test_simulate_takes_the_keys_of_make_scenario_with_the_same_defaults():
    own = {"out", "replay", "json"}
    options = {name: option.default for name, option in signature(simulate).parameters.items() if name not in own}
    assert options == {name: key.default for name, key in signature(rubgen.make_scenario).parameters.items()}


def test_commands_are_there():
    assert set(app) >= {"generate", "simulate", "modes", "info", "verify"}


def test_version(run):
    assert run("--version")[1].strip() == rubgen.__version__


def test_modes_match_the_paper(run):
    code, output, errors = run("modes", "zeng2019", "--json")
    values = json.loads(output)
    assert (code, errors) == (0, "")
    assert (values["full_dof"], values["reduced_dof"]) == (15018, 125)
    assert np.array(values["blisk_hz"])[[0, 2, 4, 38, 40, 41]] == pytest.approx(
        [68.55, 143.65, 155.37, 164.43, 210.60, 417.32], rel=5e-3
    )
    published = [180.98, 181.04, 181.05, 181.22, 181.54, 181.99, 181.99, 183.35, 183.36, 186.54, 186.54]
    assert values["casing_hz"] == pytest.approx(published, rel=1e-3)
    assert 8100 < values["critical_speed_rpm"] < 8910
    assert values["blisk_deviation"]["1"] == pytest.approx(values["blisk_hz"][0] / 68.55 - 1)


def test_modes_for_people(run):
    code, output, _ = run("modes")
    assert code == 0
    assert "full_dof            15018" in output
    assert "published" in output


def test_simulate_without_contact(run, short):
    code, output, errors = run("simulate", "--speed-rpm", "6000", *short, "--json")
    values = json.loads(output)
    assert (code, errors, values["status"]) == (0, "", "ok")
    promised = ["rub", "contact_duty", "contact_zones", "motion_blisk", "motion_casing", "motion", "period", "has_2fr"]
    assert [values[name] for name in promised] == [False, 0, 0, "period-1", "static", "period-1", 1, False]
    assert values["contact_force_orders"] == [0] * 20
    blisk = np.array(values["blisk_x_orders"])
    assert blisk.size == 20
    assert blisk[0] > 1e-5
    assert blisk[1:].max() < 1e-9 * blisk[0]
    assert values["lyapunov_per_turn"] < 0
    assert len(values["lyapunov_convergence"]) == 10


def test_the_exponent_can_be_switched_off(run, short):
    code, output, _ = run("simulate", "--speed-rpm", "6000", *short, "--no-lyapunov", "--json")
    values = json.loads(output)
    assert (code, values["lyapunov_per_turn"], values["lyapunov_error"]) == (0, None, None)
    assert values["lyapunov_convergence"] == []


def test_simulate_with_contact_writes_a_file(run, short, tmp_path):
    path = tmp_path / "run.mcap"
    code, output, _ = run("simulate", "--friction", "0.05", *short, "--out", str(path), "--json")
    values = json.loads(output)
    assert (code, values["rub"], values["friction"]) == (0, True, 0.05)
    written = read_mcap(path)
    assert written.labels["motion"] == values["motion"]
    assert written.signals["contact_force"].size == round(0.3 * 25600)
    assert written.signals["contact_force"].max() > 50
    assert [file.name for file in tmp_path.iterdir()] == ["run.mcap"]


def test_simulate_for_people(run, short):
    code, output, _ = run("simulate", "--speed-rpm", "6000", *short)
    assert code == 0
    assert "motion_casing                     static" in output


def test_a_failed_run_ends_with_1(run, short, monkeypatch, rub_run):
    from dataclasses import replace

    from rubgen.solver import Status

    response = replace(rub_run.response, status=Status.DIVERGED, reason="in turn 3")
    failed = replace(rub_run, response=response, recording=None, labels=None)
    monkeypatch.setattr("rubgen.cli.simulating.simulate", lambda _: failed)
    code, output, _ = run("simulate", *short, "--json")
    values = json.loads(output)
    assert (code, values["status"], values["reason"]) == (1, "diverged", "in turn 3")
    assert (values["rub"], values["motion"], values["contact_force_orders"]) == (None, None, None)


BAD = {
    "unknown command": (["simulat"], "simulat"),
    "unknown option": (["simulate", "--sped-rpm", "3"], "--sped-rpm"),
    "no number": (["simulate", "--speed-rpm", "fast"], "fast"),
    "missing option": (["generate"], "--out"),
    "speed 0": (["simulate", "--speed-rpm", "0"], "speed_rpm = 0: must be above 0"),
    "nan": (["simulate", "--friction", "nan"], "friction = nan: must be at least 0 and at most 0.3"),
    "inf": (["simulate", "--speed-rpm", "inf"], "speed_rpm = inf: must be above 0"),
    "negative clearance": (["simulate", "--clearance-m", "-1e-4"], "clearance_m = -0.0001: must be above 0"),
    "lobes": (["simulate", "--lobes", "6"], "lobes = 6: 11 casing modes carry at most 5 lobes"),
    "few turns": (
        ["simulate", "--record-turns", "60"],
        "record_turns = 60: labels need at least 500 turns, the Lyapunov exponent too; raise it",
    ),
    "no turns": (["simulate", "--settle-turns", "-1"], "settle_turns = -1: "),
    "zero turns": (["simulate", "--settle-turns", "0"], "settle_turns = 0: "),
    "rate": (["simulate", "--sample-rate-hz", "-5"], "sample_rate_hz = -5.0: must be above 0; change the value"),
    "rate too high": (["simulate", "--sample-rate-hz", "2e6"], "sample_rate_hz = 2e+06: at 10000 rev/min the step"),
    "signal": (["simulate", "--signal-seconds", "9"], "signal_seconds = 9: the record lasts 3 s"),
    "kind of file": (["simulate", "--out", "x.csv"], "--out x.csv: unknown kind of file"),
    "folder of file": (["simulate", "--out", "none/x.mcap"], "there is no directory none; make it first"),
    "preset": (["modes", "zeng"], "'zeng': no such preset; did you mean zeng2019?"),
    "machine file": (["modes", "none.toml"], "none.toml: there is no such file"),
    "recipe": (["generate", "none.toml", "--out", "x"], "none.toml: there is no such file; check the path"),
    "runs": (["generate", "--out", "x", "--runs", "0"], "--runs 0: must be at least 1"),
    "workers": (["generate", "--out", "x", "--workers", "-2"], "--workers -2: must be at least 1"),
    "info": (["info", "none"], "none: no finished data set of rubgen"),
    "label": (["label", "none"], "none: no finished data set of rubgen"),
    "verify": (["verify", "none"], "none: no finished data set of rubgen"),
}


@pytest.mark.parametrize("case", BAD.values(), ids=BAD.keys())
def test_mistakes_are_one_line_and_end_with_2(case, run, tmp_path, monkeypatch):
    arguments, message = case
    monkeypatch.chdir(tmp_path)
    code, output, errors = run(*arguments)
    assert (code, output) == (2, "")
    assert errors.startswith("rubgen: ")
    assert message in errors
    assert errors.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_ctrl_c_ends_with_130(run, monkeypatch, short):
    def interrupt(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("rubgen.cli.simulating.simulate", interrupt)
    assert run("simulate", *short) == (130, "", "rubgen: interrupted\n")
