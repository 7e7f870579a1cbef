"""The confusion study at small size: verdicts and causes of made cases, and the whole command on short runs."""

import re
from dataclasses import replace

import numpy as np
import pytest

from rubgen.labels.labels import Motion
from rubgen.scenario import make_scenario
from rubgen.solver.exponent import Exponent
from validation.confusion.__main__ import main
from validation.confusion.runs import SERIES, SPEEDS_RPM, run_name, scenarios
from validation.confusion.verdicts import AGREE, Case, Cause, Clusters, Sign, ZeroOne, line_share


def case(clusters, test, sign, **changes):
    values = {
        "motion": Motion.UNDECIDED,
        "confidence": 0.0,
        "stray": 1e-3,
        "group": "tips",
        "growth": 0.9 if test is ZeroOne.CHAOS else 0.1,
        "exponent": Exponent(per_turn=0.0, error=0.1, convergence=np.zeros(10), turns=500),
        "settling": 1.0,
        "intermittent": False,
        "long_period": None,
        "line_share": 0.0,
    }
    return Case(name="preset, 9060 rev/min", verdict=(clusters, test, sign), **(values | changes))


def test_three_verdicts_agree_and_have_no_cause():
    assert len(AGREE) == 3
    for verdict in AGREE:
        assert case(*verdict).agree
        assert case(*verdict).cause is None


@pytest.mark.parametrize(
    ("verdict", "changes", "cause"),
    [
        ((Clusters.REPEATS, ZeroOne.CHAOS, Sign.POSITIVE), {"motion": Motion.PERIOD_1}, Cause.SMALL_CHAOS),
        ((Clusters.REPEATS, ZeroOne.CHAOS, Sign.POSITIVE), {}, Cause.NEAR_BOUND),
        ((Clusters.REPEATS, ZeroOne.REGULAR, Sign.POSITIVE), {}, Cause.HIDDEN_CHAOS),
        ((Clusters.REPEATS, ZeroOne.REGULAR, Sign.POSITIVE), {"line_share": 0.9}, Cause.SLOW_PHASE),
        ((Clusters.REPEATS, ZeroOne.REGULAR, Sign.ZERO), {"settling": 13.0}, Cause.SETTLING),
        ((Clusters.REPEATS, ZeroOne.CHAOS, Sign.ZERO), {}, Cause.SMALL_NOISE),
        ((Clusters.REPEATS, ZeroOne.REGULAR, Sign.ZERO), {}, Cause.SMALL_TORUS),
        ((Clusters.REPEATS, ZeroOne.REGULAR, Sign.ZERO), {"stray": 1e-8}, Cause.NEUTRAL),
        ((Clusters.STRAYS, ZeroOne.REGULAR, Sign.NEGATIVE), {"settling": 5.0}, Cause.SETTLING),
        ((Clusters.STRAYS, ZeroOne.REGULAR, Sign.NEGATIVE), {"long_period": 24}, Cause.LONG_PERIOD),
        ((Clusters.STRAYS, ZeroOne.CHAOS, Sign.ZERO), {"intermittent": True}, Cause.SWITCHING),
        ((Clusters.STRAYS, ZeroOne.REGULAR, Sign.POSITIVE), {"line_share": 0.95}, Cause.SLOW_PHASE),
        ((Clusters.STRAYS, ZeroOne.REGULAR, Sign.POSITIVE), {"long_period": 24}, Cause.UNEXPLAINED),
    ],
)
def test_causes(verdict, changes, cause):
    assert case(*verdict, **changes).cause is cause


def test_one_line_is_told_from_many():
    turn, rng = np.arange(250), np.random.default_rng(0)
    wave = np.stack([np.cos(0.3 * turn), np.sin(0.3 * turn)], axis=1)[:, None]
    assert line_share(wave) > 0.99
    assert line_share(rng.standard_normal((250, 1, 2))) < 0.3
    assert line_share(np.zeros((250, 1, 2))) == 0.0


def test_there_are_at_least_200_runs_within_the_sweep():
    assert len(scenarios()) == len(SERIES) * len(SPEEDS_RPM) > 200
    assert len(scenarios(every=20)) == 4 * 4


def test_the_command_makes_judges_and_goes_on(tmp_path, monkeypatch, capsys):
    speeds = (9060.0, 12060.0, 6540.0)
    short = {"settle_turns": 90, "record_turns": 64}
    asked = {run_name("preset", speed): make_scenario("zeng2019", speed_rpm=speed) for speed in speeds}
    asked = {name: replace(each, operation=replace(each.operation, **short)) for name, each in asked.items()}
    monkeypatch.setattr("validation.confusion.__main__.scenarios", lambda **_: asked)
    assert main(["--every", "9", "--workers", "1"], tmp_path) == 0
    made = {path: path.stat().st_mtime_ns for path in (tmp_path / "out/confusion/pieces").glob("*.npz")}
    assert len(made) == 3
    assert not list((tmp_path / "out/confusion/pieces").glob("*.part*"))
    assert "2 runs that rub" in capsys.readouterr().out  # at 6,540 rev/min nothing touches
    page = (tmp_path / "out/confusion/confusion.md").read_text(encoding="utf-8")
    table = page.split("## The table")[1].split("##")[0]
    assert sum(int(number) for number in re.findall(r"\| \**(\d+)", table)) == 2
    assert (tmp_path / "out/confusion/confusion.png").stat().st_size > 10_000
    assert main(["--every", "9", "--workers", "1"], tmp_path) == 0
    assert made == {path: path.stat().st_mtime_ns for path in made}
