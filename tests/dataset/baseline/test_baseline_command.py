"""`rubgen baseline` on a small set: what it writes, its exit code, and what it refuses."""

import json

import pytest

from rubgen.baseline import baseline, evaluate
from rubgen.cli import main
from rubgen.cli.commands import scoring


def run(capsys, *words):
    with pytest.raises(SystemExit) as ended:
        main(["baseline", *map(str, words)])
    said = capsys.readouterr()
    return ended.value.code, said.out, said.err


def test_a_set_too_small_is_refused_in_one_line(small_set, capsys):
    code, _, errors = run(capsys, small_set.directory)
    assert (code, errors.count("\n")) == (2, 1)
    assert (
        "no task is possible: rub, faults: runs: 4 of them to learn from; at least 10 are needed, so make a larger set"
        in errors
    )
    code, _, errors = run(capsys, small_set.directory, "--task", "motion")
    assert code == 2
    assert "--task motion: runs that rub and have an answer: " in errors


def test_an_unknown_task_and_a_missing_package_are_named(small_set, capsys, monkeypatch):
    assert "did you mean severity?" in run(capsys, small_set.directory, "--task", "severty")[2]
    monkeypatch.setattr("importlib.util.find_spec", lambda _name: None)
    assert "pip install 'rubgen[baseline]'" in run(capsys, small_set.directory)[2]


def test_scores_are_written_and_a_marked_task_ends_with_one(small_set, capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(scoring, "usable_cores", lambda: 1)  # other processes would not know of the next lines
    monkeypatch.setattr(evaluate, "SEEDS", 1)
    monkeypatch.setattr(baseline, "SEEDS", 1)
    for module in (baseline, evaluate):
        monkeypatch.setattr(module, "FOLDS", 2)
    out = tmp_path / "baselines.json"
    code, output, _ = run(capsys, small_set.directory, "--task", "rub", "--out", out)
    (task,) = json.loads(out.read_text())["tasks"]
    assert (task["task"], task["groups"], task["windows"]) == ("rub", 4, 16)
    assert set(task["scores"]["boosting"]) == set(task["scores"]["rocket"]) == {"by group", "leaky"}
    assert task["scores"]["majority"]["by group"]["balanced accuracy"][0] == 0.5
    assert code == (1 if task["mark"] else 0)
    assert "| rub | balanced accuracy | majority | 0.50 ± 0.00 |" in output
    assert "- rub: learned from 16 windows of 4 groups" in output
