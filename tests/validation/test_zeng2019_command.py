import json

import pytest

from validation.zeng2019.__main__ import main


@pytest.fixture
def run(capsys):
    """Runs the command: exit code, stdout, stderr."""

    def call(*arguments):
        code = main(arguments)
        told = capsys.readouterr()
        return code, told.out, told.err

    return call


def test_a_figure_is_reproduced(run, tmp_path):
    out = tmp_path / "out"
    code, text, _ = run("--figure", "9", "--out", str(out), "--workers", "1", "--json")
    told = json.loads(text)
    assert (code, told["made"], sum(told["verdicts"].values())) == (0, 1, 2)
    assert told["page"] == str(out / "figure-9" / "zeng2019.md")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--figure", "22"], "--figure 22: there is no such figure; choose from 6"),
        (["--fit", "--figure", "9"], "--fit --figure 9: the search is one whole; leave --figure out"),
        (["--every", "0"], "--every 0: must be at least 1; 4 gives steps of 120 rev/min"),
        (["--workers", "0"], "--workers 0: must be at least 1; give a number of processes"),
    ],
)
def test_mistakes_are_told_in_a_line(run, tmp_path, arguments, message):
    out = tmp_path / "out"
    code, text, error = run(*arguments, "--out", str(out))
    assert (code, text) == (2, "")
    assert error.startswith(f"validation.zeng2019: {message}")
    assert error.count("\n") == 1
    assert not out.exists()


def test_an_interruption_says_how_to_go_on(run, tmp_path, monkeypatch):
    def stop(*_args, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr("validation.store.Store.compute", stop)
    code, _, error = run("--figure", "9", "--out", str(tmp_path / "out"))
    assert code == 130
    assert error.strip().endswith("the same command makes the rest")
