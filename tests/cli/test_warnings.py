"""What is not meant is told in one line, and the command goes on."""

import warnings

import pytest

from rubgen.cli import run
from rubgen.errors import RubgenWarning, UserError, warn


@pytest.mark.parametrize("runs", [1, 2])
def test_a_warning_is_one_line_without_a_place_in_our_code(capsys, monkeypatch, runs):
    def warned(directory, *, as_json):
        for _ in range(runs):
            warn("clearance_m = 0.22: no blade can reach\n the casing")

    monkeypatch.setattr("rubgen.cli.commands.inspecting.info_command", warned)
    with warnings.catch_warnings(), pytest.raises(SystemExit) as ended:
        run.main(["info", "anywhere"])
    assert ended.value.code == 0
    line = "rubgen: warning: clearance_m = 0.22: no blade can reach the casing\n"
    assert capsys.readouterr().err == line * runs


def test_in_python_a_warning_is_a_warning():
    with pytest.warns(RubgenWarning, match="nothing will rub"):
        warn("nothing will rub")


def test_one_run_with_a_clearance_in_millimetres_warns_before_it_is_made(run, monkeypatch):
    def stop(_scenario):
        raise UserError("made")

    monkeypatch.setattr("rubgen.cli.commands.simulating.simulate", stop)
    with warnings.catch_warnings():
        code, out, err = run("simulate", "--clearance-m", "0.22")
    assert (code, out) == (2, "")
    warning, end = err.splitlines()
    assert warning.startswith(
        "rubgen: warning: clearance_m = 0.22: 55 % of the radius of the blade tips; were mm meant"
    )
    assert end == "rubgen: made"
    with warnings.catch_warnings():
        _, _, err = run("simulate", "--speed-rpm", "900", "--signal-seconds", "0.1")
    assert "rubgen: warning: no blade can reach the casing in this run: the largest free penetration is" in err
    assert "were rad/s meant? A blade would: 900 rad/s are 8594.37 rev/min\n" in err
