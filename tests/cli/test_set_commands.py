"""generate, info and verify on a set of made-up signals; real ones are generated in tests/dataset."""

import json
import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from rubgen.cli.commands.generating import _ways_to_look, _what_was_made
from rubgen.dataset.checking.inventory import Finding, Kind
from rubgen.dataset.checking.verify import advice
from rubgen.dataset.making.generate import Generated
from rubgen.dataset.making.outcome import Outcome
from rubgen.errors import UserError
from rubgen.progress import COMPILING
from rubgen.solver.response import Status


@pytest.fixture
def generate(run, make_synthetic_run, tmp_path, monkeypatch):
    """Runs `rubgen generate` for three runs without contact, the last of which diverges."""
    monkeypatch.setattr("rubgen.dataset.making.generate.warm_up", lambda *_: [])
    monkeypatch.setattr("rubgen.jit.kernels_are_compiled", lambda: True)
    template = make_synthetic_run(contact=False, seconds=0.1)

    def simulate(scenario):
        if scenario.index < 2:
            return replace(template, scenario=scenario)
        response = replace(template.response, status=Status.DIVERGED, reason="in turn 7")
        return replace(template, scenario=scenario, response=response, recording=None, labels=None)

    monkeypatch.setattr("rubgen.pipeline.simulate", simulate)
    recipe = tmp_path / "recipe.toml"
    recipe.write_text(
        'name = "free"\nruns = 3\nmachine = "zeng2019"\n[output]\nsignal_seconds = 0.1\nformats = ["mcap"]\n'
    )
    return lambda *more: run("generate", str(recipe), "--out", str(tmp_path / "set"), "--workers", "1", *more)


def test_generate_says_what_it_made(generate, tmp_path):
    code, output, errors = generate()
    made, motion, failed, *look = output.splitlines()
    assert (code, made) == (0, f"{tmp_path / 'set'}: 3 runs, 3 new: 2 ok, 1 diverged; 0 rub, 2 do not")
    assert motion == "  motion: 2 period-1"
    assert failed == "  1 diverged, such as run-000002: in turn 7"
    assert any(line.endswith(f"verify {tmp_path / 'set'}") for line in look)
    assert look[0] == f"  {tmp_path / 'set'}/runs.parquet: parameters, labels; for pandas, polars, datasets"  # of MCAP
    assert errors == "rubgen: simulate\n"  # no terminal: the step at once, then a line a minute


def test_commands_to_copy_have_a_folder_with_spaces_in_quotes(tmp_path):
    folder = tmp_path / "my set" / "rrd" / "0000"
    folder.mkdir(parents=True)
    (folder / "run-000000.rrd").touch()
    words = [shlex.split(line)[-1] for line in _ways_to_look(tmp_path / "my set")]
    assert words[1:4] == [str(folder / "run-000000.rrd"), *[str(tmp_path / "my set")] * 2]
    found = [Finding(text="x", kind=kind, path="x") for kind in (Kind.DATA, Kind.DERIVED)]
    assert advice(Path("my set"), found).count("rubgen repair 'my set'") == 2


def test_a_set_without_a_run_that_is_ok_ends_with_1(generate, tmp_path, monkeypatch):
    def refuse(scenario):
        raise UserError("too thick")

    monkeypatch.setattr("rubgen.pipeline.simulate", refuse)
    line = f"rubgen: {tmp_path / 'set'}: no run is ok; the reason of each: rubgen info {tmp_path / 'set'}\n"
    code, output, errors = generate("--shard", "1/1")
    assert (code, errors) == (0, "rubgen: simulate\n")  # of a set that is not complete nothing is known
    code, output, errors = generate("--finish", "--json")
    assert (code, errors, json.loads(output)["status"]) == (1, line, {"refused": 3})
    code, output, errors = generate()
    assert (code, errors) == (1, line)
    assert "nothing to do, all files are there: 3 refused" in output


def test_the_first_run_on_a_machine_says_that_it_compiles(generate, monkeypatch):
    monkeypatch.setattr("rubgen.jit.kernels_are_compiled", lambda: False)
    assert generate()[2] == f"rubgen: {COMPILING}\nrubgen: simulate\n"


def test_only_a_set_that_was_verified_is_called_so():
    outcome = Outcome(rub=2, no_rub=1, motion={"chaotic": 2, "period-1": 1}, failures=())
    made = Generated(directory=Path("set"), runs=3, made=0, status={"ok": 3}, outcome=outcome)
    assert next(_what_was_made(made)) == "set: 3 runs, 0 new: 3 ok; 2 rub, 1 do not"
    verified = replace(made, verified=True)
    assert next(_what_was_made(verified)) == "set: 3 runs, nothing to do, all files are there: 3 ok; 2 rub, 1 do not"


def test_generate_for_programs(generate, tmp_path):
    code, output, errors = generate("--json")
    assert (code, errors) == (0, "")
    assert json.loads(output) == {
        "directory": str(tmp_path / "set"),
        "runs": 3,
        "made": 3,
        "status": {"diverged": 1, "ok": 2},
        "outcome": {
            "rub": 0,
            "no_rub": 2,
            "motion": {"period-1": 2},
            "failures": [{"status": "diverged", "count": 1, "run_id": "run-000002", "reason": "in turn 7"}],
        },
        "verified": False,
        "part": "",
    }


def test_another_number_of_runs_is_refused(generate):
    generate()
    code, _, errors = generate("--runs", "2")
    assert code == 2
    assert "holds 3 runs of this recipe, asked for 2; it can only grow: ask for --runs 3 or more" in errors


def test_info_counts(generate, run, tmp_path):
    generate()
    code, output, errors = run("info", str(tmp_path / "set"), "--json")
    assert errors == ""
    values = json.loads(output)
    assert code == 0
    assert (values["runs"], values["status"], values["rub"]) == (3, {"diverged": 1, "ok": 2}, {"true": 0, "false": 2})
    assert values["motion"] == {
        "static": 0,
        "period-1": 2,
        "period-k": 0,
        "quasi-periodic": 0,
        "undecided": 0,
        "chaotic": 0,
    }
    code, output, _ = run("info", str(tmp_path / "set"))
    assert "run-000002  diverged: in turn 7" in output


def test_verify_ends_with_1_where_something_is_wrong(generate, run, tmp_path):
    generate()
    (tmp_path / "set/mcap/0000/run-000000.mcap").unlink()
    code, output, _ = run("verify", str(tmp_path / "set"), "--json")
    values = json.loads(output)
    assert (code, values["ok"]) == (1, False)
    assert "mcap/0000/run-000000.mcap: listed in the manifest, but not there" in values["problems"]
    code, output, _ = run("verify", str(tmp_path / "set"))
    assert code == 1
    assert "mcap/0000/run-000000.mcap: listed in the manifest, but not there" in output


def test_ctrl_c_says_how_to_go_on(generate, run, tmp_path, monkeypatch):
    from rubgen.dataset.making.keep import Keeper

    true = Keeper.begin

    def interrupted(keeper, index):
        if index == 1:
            raise KeyboardInterrupt
        true(keeper, index)

    with monkeypatch.context() as patch:
        patch.setattr(Keeper, "begin", interrupted)
        code, _, errors = generate()
    assert code == 130
    directory = str(tmp_path / "set")
    assert run("info", directory)[1].startswith(f"{directory}: unfinished, 1 of 3 runs of the recipe 'free' are kept\n")
    assert json.loads(run("info", directory, "--json")[1]) == {"name": "free", "runs": 3, "finished": False, "kept": 1}
    for command in ("verify", "label", "report"):
        told = run(command, directory)[2]
        assert told.endswith("it is unfinished; the `rubgen generate` command that began it makes the rest\n")
    assert f"interrupted; kept in {tmp_path / 'set'}: 1 finished run; the same command makes the rest" in errors
    assert ": 3 runs, 2 new: " in generate()[1].splitlines()[0]


@pytest.mark.parametrize("content", ["[]", "no json", '{"recipe": {"name": "free"}}'])
def test_info_of_a_damaged_unfinished_set_is_one_line(run, tmp_path, content):
    (tmp_path / ".staging").mkdir()
    (tmp_path / ".staging/identity.json").write_text(content)
    code, output, errors = run("info", str(tmp_path))
    assert (code, output, errors.count("\n")) == (2, "", 1)
    assert f"{tmp_path}/.staging/identity.json: cannot be read" in errors
