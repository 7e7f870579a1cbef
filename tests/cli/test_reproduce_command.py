import json

import pytest


def test_a_figure_is_reproduced(run, tmp_path):
    out = tmp_path / "out"
    code, text, _ = run("reproduce", "zeng2019", "--figure", "9", "--out", str(out), "--workers", "1", "--json")
    told = json.loads(text)
    assert (code, told["made"], sum(told["verdicts"].values())) == (0, 1, 2)
    assert told["page"] == str(out / "figure-9" / "zeng2019.md")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["zeng2020"], "zeng2020: unknown paper; choose from zeng2019"),
        (["zeng2019", "--figure", "22"], "--figure 22: there is no such figure; choose from 6"),
        (["zeng2019", "--fit", "--figure", "9"], "--fit --figure 9: the search is one whole; leave --figure out"),
        (
            ["zeng2019", "--fit", "--machine", "zeng2019-fitted"],
            "--fit --machine zeng2019-fitted: the search starts from the paper's own preset; leave --machine out",
        ),
        (["zeng2019", "--every", "0"], "--every 0: must be at least 1; 4 gives steps of 120 rev/min"),
        (
            ["zeng2019", "--machine", "zeng2020"],
            "--machine zeng2020: not a machine of this paper; choose from zeng2019, zeng2019-fitted",
        ),
        (["zeng2019", "--workers", "0"], "--workers 0: must be at least 1; give a number of processes"),
    ],
)
def test_mistakes_are_told_in_a_line(run, tmp_path, arguments, message):
    out = tmp_path / "out"
    code, text, error = run("reproduce", *arguments, "--out", str(out))
    assert (code, text) == (2, "")
    assert error.startswith(f"rubgen: {message}")
    assert error.count("\n") == 1
    assert not out.exists()


def test_an_interruption_says_how_to_go_on(run, tmp_path, monkeypatch):
    def stop(*_args, **_options):
        raise KeyboardInterrupt

    monkeypatch.setattr("rubgen.studies.zeng2019.reproducing.compute", stop)
    code, _, error = run("reproduce", "zeng2019", "--figure", "9", "--out", str(tmp_path / "out"))
    assert code == 130
    assert error.strip().endswith("the same command makes the rest")
