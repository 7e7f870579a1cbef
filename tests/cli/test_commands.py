import json
import os
import shutil
import subprocess
import sys
from inspect import signature

import numpy as np
import pytest

import rubgen
from rubgen.cli.app import app
from rubgen.cli.declarations.single_run import simulate
from rubgen.cli.printing import check_new_file, write_file
from rubgen.errors import UserError
from rubgen.io.mcap import read_mcap
from rubgen.scenario.vary import KEYS

HEAVY = {"numba", "pandas", "rerun", "pyarrow", "scipy", "numpy", "pydantic", "mcap", "matplotlib"}


@pytest.fixture
def short(monkeypatch):
    """Options of a run of 110 turns; the least number of turns is lowered for them."""
    monkeypatch.setattr("rubgen.scenario.checks.feasible.MIN_RECORD_TURNS", 100)
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
    for command in ("generate", "simulate", "modes", "info", "verify"):
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
        "merge",
        "open",
        "push",
        "resense",
        "simulate",
        "stream",
        "verify",
    ]
    assert all(getattr(rubgen, name) is not None for name in rubgen.__all__)


def test_every_key_of_vary_is_an_option_of_simulate():
    assert set(KEYS) <= set(signature(simulate).parameters)


def test_simulate_takes_the_keys_of_make_scenario_with_the_same_defaults():
    own = {"out", "force", "replay", "json"}
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
    lines = dict(line.split("  ", 1) for line in output.splitlines())
    assert len(output.splitlines()) <= 25
    assert lines["rub"].strip() == "no"
    assert "rev/min, 110 turns after 90 to settle" in lines["run"]
    assert lines["motion"].strip() == "period-1, confidence 1.00 (blisk period-1, casing static)"
    assert lines["smallest gap"].endswith("µm without contact")


def test_a_failed_run_ends_with_1(run, short, monkeypatch, rub_run, tmp_path):
    from dataclasses import replace

    from rubgen.solver import Status

    response = replace(rub_run.response, status=Status.DIVERGED, reason="in turn 3")
    failed = replace(rub_run, response=response, recording=None, labels=None)
    monkeypatch.setattr("rubgen.cli.commands.simulating.simulate", lambda _: failed)
    code, output, _ = run("simulate", *short, "--json")
    values = json.loads(output)
    assert (code, values["status"], values["reason"]) == (1, "diverged", "in turn 3")
    assert (values["rub"], values["motion"], values["contact_force_orders"]) == (None, None, None)
    code, output, _ = run("simulate", *short, "--out", str(tmp_path / "a.mcap"))
    assert (code, list(tmp_path.iterdir())) == (1, [])
    assert output.endswith(f"not written    {tmp_path / 'a.mcap'}: a run that failed has no signals\n")


BAD = {
    "unknown command": (["simulat"], "simulat: unknown command; did you mean simulate? commands: baseline, "),
    "unlike any command": (["zzz"], "zzz: unknown command; commands: baseline, browse, "),
    "last command": (["infoo"], "simulate, verify\n"),
    "unknown option": (
        ["simulate", "--sped-rpm", "3"],
        "--sped-rpm: unknown option of rubgen simulate; did you mean --speed-rpm? see rubgen simulate --help",
    ),
    "unlike any option": (["info", "x", "--qqq"], "--qqq: unknown option of rubgen info; see rubgen info --help"),
    "no number": (["simulate", "--speed-rpm", "fast"], "--speed-rpm fast: must be a number; see"),
    "no whole number": (["simulate", "--settle-turns", "2.5"], "--settle-turns 2.5: must be a whole number; see"),
    "no whole runs": (["generate", "--out", "x", "--runs", "1e1"], "--runs 1e1: must be a whole number; see"),
    "no flag": (["info", "x", "--json=foo"], "--json foo: must be true or false; see"),
    "missing option": (["generate"], "--out: rubgen generate needs it; see rubgen generate --help"),
    "missing value": (["generate", "--out"], "--out: a value must follow; see rubgen generate --help"),
    "missing argument": (["info"], "DIRECTORY: rubgen info needs it; see rubgen info --help"),
    "too many": (["info", "a", "b"], "b: one argument too many for rubgen info; see"),
    "twice": (["modes", "--json", "--json"], "--json: given more than once; give it once"),
    "shell": (["completion", "zhs"], "SHELL zhs: must be one of bash, zsh, fish, powershell; did you mean zsh?"),
    "report of a file": (["report", __file__], "test_commands.py: no finished data set of rubgen: it is a file; give"),
    "no report": (["report", "none"], "none: no finished data set of rubgen: there is no such directory; give"),
    "speed 0": (["simulate", "--speed-rpm", "0"], "speed_rpm = 0: must be at least 0.001"),
    "nan": (["simulate", "--friction", "nan"], "friction = nan: must be a finite number; change the value"),
    "inf": (["simulate", "--speed-rpm", "inf"], "speed_rpm = inf: must be a finite number"),
    "negative clearance": (["simulate", "--clearance-m", "-1e-4"], "clearance_m = -0.0001: must be at least 1e-07"),
    "lobes": (["simulate", "--lobes", "6"], "lobes = 6: 11 casing modes carry the orders 0 to 5"),
    "key of another fault": (
        ["simulate", "--fault", "crack", "--depth", "3"],
        "--depth: unknown option of rubgen simulate; did you mean --width-m? the fault crack has --crack-loss, --angle",
    ),
    "few turns": (
        ["simulate", "--record-turns", "60"],
        "record_turns = 60: labels need at least 500 turns, the Lyapunov exponent too; raise it",
    ),
    "no turns": (["simulate", "--settle-turns", "-1"], "settle_turns = -1: "),
    "zero turns": (["simulate", "--settle-turns", "0"], "settle_turns = 0: "),
    "rate": (["simulate", "--sample-rate-hz", "-5"], "sample_rate_hz = -5: must be above 0 and at most "),
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

    monkeypatch.setattr("rubgen.cli.commands.simulating.simulate", interrupt)
    assert run("simulate", *short) == (130, "", "rubgen: interrupted\n")


def test_a_file_that_is_there_is_kept_unless_forced(run, short, tmp_path):
    path = tmp_path / "run.mcap"
    path.write_bytes(b"mine")
    code, _, errors = run("simulate", *short, "--no-lyapunov", "--out", str(path))
    assert (code, path.read_bytes()) == (2, b"mine")
    assert errors == f"rubgen: --out {path}: exists already; choose another name, or replace it with --force\n"
    code, output, _ = run("simulate", *short, "--no-lyapunov", "--out", str(path), "--force")
    assert code == 0
    assert output.splitlines()[-1].startswith(f"written        {path}: ")
    assert read_mcap(path).labels["rub"]
    assert [file.name for file in tmp_path.iterdir()] == ["run.mcap"]


def test_a_file_stays_whole_where_its_replacement_cannot_be_written(tmp_path):
    path = tmp_path / "run.mcap"
    path.write_bytes(b"mine")

    def fail(part):
        part.write_bytes(b"half")
        raise OSError(28, "No space left on device")

    with pytest.raises(UserError, match=r"^--out .+run.mcap: the disk is full; make room and give the same command"):
        write_file("--out", path, fail)
    assert path.read_bytes() == b"mine"
    assert [file.name for file in tmp_path.iterdir()] == ["run.mcap"]


def test_no_file_is_written_into_a_data_set(tmp_path):
    for name in ("manifest.json", "manifest.json.sha256"):
        (tmp_path / name).write_bytes(b"")
    folder = tmp_path / "data"
    folder.mkdir()
    said = rf"^--out {folder}/run.mcap: lies in the data set {tmp_path}; choose a place outside of it$"
    with pytest.raises(UserError, match=said):
        check_new_file("--out", folder / "run.mcap", (".mcap",), force=True)
    check_new_file("--out", tmp_path / "report.html", (".html",))
    (tmp_path / "manifest.json.sha256").unlink()  # the manifest of something else
    check_new_file("--out", folder / "run.mcap", (".mcap",))


def test_a_folder_is_never_replaced(run, tmp_path):
    folder = tmp_path / "run.mcap"
    folder.mkdir()
    code, _, errors = run("simulate", "--out", str(folder), "--force")
    assert code == 2
    assert f"--out {folder}: exists already and is no file; choose another name" in errors


@pytest.mark.parametrize("name", ["Ελλάδα", "Größe-日本"])
def test_a_name_that_stdout_cannot_encode_costs_nothing(name, tmp_path):
    code = "import sys, rubgen.cli.printing as p; from rubgen.cli import app, main; "
    code += f"app.app.command(lambda: p.say({name!r}), name='x'); main(['x'])"
    environment = os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "0"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == name.encode("ascii", "backslashreplace").decode() + "\n"


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (OSError(13, "Permission denied", "/a/b"), "rubgen: /a/b: Permission denied\n"),
        (OSError("no room"), "rubgen: no room\n"),
        (UnicodeEncodeError("utf-8", "x\udcff", 1, 2, "surrogates not allowed"), "cannot be encoded as utf-8"),
    ],
)
def test_what_nobody_foresaw_is_one_line_without_a_cause(run, monkeypatch, error, line):
    def fail(*_args, **_options):
        raise error

    monkeypatch.setattr("rubgen.cli.commands.inspecting.info_command", fail)
    code, output, errors = run("info", "x")
    assert (code, output, errors.count("\n")) == (2, "", 1)
    assert line in errors


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish", "powershell"])
def test_completion_is_printed_for_each_shell(run, shell):
    code, output, errors = run("completion", shell)
    assert (code, errors) == (0, "")
    assert "rubgen" in output
    assert "simulate" in output


def test_bash_takes_the_completion(run, tmp_path):
    script = tmp_path / "completion.bash"
    script.write_text(run("completion", "bash")[1])
    done = subprocess.run(
        ["bash", "-c", f". {script} && complete -p rubgen"], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip().endswith("rubgen")


_TAB = """zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "{setup}; PS1=; LISTMAX=0; unsetopt zle_bracketed_paste; print rea''dy"
zpty -r shell seen "*ready*"
zpty -w -n shell "rubgen verif\t"
zpty -r shell seen "*verify*" && print -r -- completed
zpty -d shell
"""


@pytest.mark.skipif(shutil.which("zsh") is None, reason="zsh is not installed")
@pytest.mark.parametrize("way", ["read", "fpath"])
def test_zsh_completes_from_its_start_file_and_from_its_path(run, tmp_path, way):
    script = tmp_path / "_rubgen"
    script.write_text(run("completion", "zsh")[1])
    setup = {
        "read": f". {script}",
        "fpath": f"fpath=({tmp_path} \\$fpath); autoload -Uz compinit; compinit -u -d {tmp_path}/dump",
    }[way]
    done = subprocess.run(
        ["zsh", "-f", "-c", _TAB.format(setup=setup)], capture_output=True, text=True, timeout=60, check=False
    )
    assert "completed" in done.stdout, done


@pytest.mark.skipif(shutil.which("fish") is None, reason="fish is not installed")
def test_fish_takes_the_completion(run, tmp_path):
    script = tmp_path / "rubgen.fish"
    script.write_text(run("completion", "fish")[1])
    done = subprocess.run(
        ["fish", "--no-config", "-c", f"source {script}; complete -C 'rubgen verif'"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout.startswith("verify\t")
