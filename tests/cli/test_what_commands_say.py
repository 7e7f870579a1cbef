"""What commands print of results that are made up here: counts, units of time, reasons. Their JSON on the sample."""

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from rubgen.cli.commands.planning import plan_lines
from rubgen.cli.commands.simulating import run_summary
from rubgen.dataset.checking.inventory import Finding, Kind
from rubgen.dataset.checking.repair import Repaired
from rubgen.dataset.remaking.regenerate import Regenerated
from rubgen.planning.drawn import Drawn
from rubgen.planning.plan import Plan, Reach
from rubgen.planning.tried import Tried
from rubgen.scenario import make_scenario
from rubgen.solver import Status

SAMPLE = Path(__file__).parents[2] / "datasets" / "sample"


def planned(**changes):
    """The plan of one run of which nothing is drawn."""
    values = {
        "name": "few", "runs": 1, "machine": "zeng2019", "machines": 1, "balanced": False, "splits": {"train": 1},
        "drawn": (), "reach": (Reach(depth_m=-1e-4),), "corners": 1, "refused_corners": (), "cpu_seconds": 30.0,
        "megabytes": {"parquet": 1.0, "mcap": 0.5}, "tried": None,
    }  # fmt: skip
    return "\n".join(plan_lines(Plan(**values | changes)))


def test_a_plan_of_one_run_speaks_of_one():
    text = planned()
    assert "few: 1 run of zeng2019\ndrawn     nothing: all runs are alike except for noise\n" in text
    assert "can rub   0 of 1 run looked at (0 %); free penetration -0.1 to -0.1 mm" in text
    assert "extremes  none of 1 scenario at the extremes is refused" in text
    assert text.endswith("disk      parquet 1 MB, mcap 0.5 MB; 1.5 MB in all")
    assert "balance" not in text
    assert "splits" not in text


@pytest.mark.parametrize(
    ("seconds", "said"), [(0.5, "0.5 s"), (89.0, "89 s"), (90.0, "1.5 min"), (5399.0, "90 min"), (5400.0, "1.5 h")]
)
def test_the_time_of_a_plan_has_a_fitting_unit(seconds, said, monkeypatch):
    monkeypatch.setattr("rubgen.cli.commands.planning.usable_cores", lambda: 1)
    known = "(estimated; --try 4 measures it here)"
    assert f"time      {said} on one core, {said} on 1 {known}" in planned(cpu_seconds=seconds)


def test_a_plan_tells_refused_unknown_and_measured_runs_apart():
    reach = (
        Reach(depth_m=2e-4),
        Reach(depth_m=math.inf),
        *(Reach(depth_m=math.nan, refused=f"reason {number}") for number in (1, 2, 2)),
    )
    tried = Tried(runs=1, classes={"rub, chaotic": 1}, seconds_a_run=2.0, megabytes_a_run={"mcap": 0.5})
    drawn = (
        Drawn(key="vary.friction", how="{ uniform = [0, 1] }", values=(0.75, 0.25, 0.5), runs=(0, 1, 2)),
        Drawn(key="vary.lobes", how="{ choice = [" + "1, " * 99, values=(), runs=()),
    )
    text = planned(
        runs=12_000, machines=4, machine="a, b", splits={"train": 8000, "test": 4000}, balanced=True,
        reach=reach, tried=tried, drawn=drawn, refused_corners=("too thick",), corners=9,
    )  # fmt: skip
    assert text.startswith("few: 12,000 runs of 4 machines from a, b\nsplits    train 8,000, test 4,000\nbalance   ")
    assert "can rub   2 of 2 runs looked at (100 %); free penetration 0.2 to 0.2 mm" in text
    assert "unknown   1 of 2 runs looked at: only the run itself shows whether it rubs" in text
    assert "refused   3 of 5 runs looked at\n  reason 1\n  reason 2\nextremes  1 of 9 scenarios" in text
    assert "classes   1 rub, chaotic" in text
    assert "(measured in 1 run)" in text
    rows = [line.split() for line in text.splitlines() if line.startswith("vary.")]
    assert rows[0][-3:] == ["0.25", "0.5", "0.75"]
    assert rows[1][-1].endswith("...")


def test_a_plan_of_refused_runs_alone_says_no_depth():
    text = planned(reach=(Reach(depth_m=math.nan, refused="too thick"),))
    assert "refused   1 of 1 run looked at\n  too thick" in text
    assert "can rub" not in text


def test_the_summary_of_a_failed_run_names_status_profile_and_fault(free_run):
    operation = replace(free_run.scenario.operation, profile="run-up", duration_s=2.0, end_speed_rpm=12000.0)
    machine = make_scenario(fault="lost-blade", lost_count=2).machine
    scenario = replace(free_run.scenario, operation=operation, machine=machine)
    response = replace(free_run.response, status=Status.DIVERGED, reason="in turn 7")
    told = dict(run_summary(replace(free_run, scenario=scenario, response=response, recording=None, labels=None)))
    assert told["run"].startswith(
        "zeng2019, run-up from 10,000 rev/min to 12,000 rev/min, 120 turns after 100 to settle"
    )
    assert told["failed"].endswith("; in turn 7")
    assert told["fault"].startswith("lost-blade: ")
    assert set(told) == {"run", "failed", "fault"}


@pytest.mark.parametrize(
    ("different", "moved", "versions", "code", "said"),
    [
        ({}, [], {}, 0, ["run-000001: equal to the bit"]),
        ({}, [], {"numpy": ("1", "2")}, 0, ["numpy: 1 made the set, 2 is installed", "run-000001: equal to the bit"]),
        (
            {"runs": list("abcdefgh")},
            [],
            {"numpy": ("1", "2")},
            0,
            ["other bits in a, b, c, d, e, f and 2 more", "within the"],
        ),
        ({"runs": ["rub"]}, [], {}, 1, ["run-000001: runs: other bits in rub", "same class of motion"]),
        ({"runs": ["rub"]}, ["rub"], {"numpy": ("1", "2")}, 1, ["labels differ by more than other versions"]),
    ],
)
def test_a_run_made_again_is_judged_by_bits_labels_and_versions(
    run, monkeypatch, different, moved, versions, code, said
):
    done = Regenerated(run=None, different=different, moved=moved, versions=versions)
    monkeypatch.setattr("rubgen.cli.commands.regenerating.regenerate", lambda *_: done)
    found, output, errors = run("regenerate", str(SAMPLE), "run-000001")
    assert (found, errors) == (code, "")
    assert all(each in output for each in said)
    found, output, _ = run("regenerate", str(SAMPLE), "run-000001", "--json")
    assert found == code
    values = json.loads(output)
    assert (values["same"], values["ok"]) == (not different, not code)


def test_what_only_the_old_version_can_mend_is_said(run, monkeypatch):
    left = (Finding(text="signals/a.parquet: damaged", kind=Kind.DATA, path="signals/a.parquet"),)
    done = Repaired(found=left, made=("README.md",), left=left, versions={"numpy": ("1.0", "2.0")})
    monkeypatch.setattr("rubgen.dataset.checking.repair.repair", lambda _: done)
    code, output, _ = run("repair", str(SAMPLE))
    assert code == 1
    made, version, problem, _advice = output.splitlines()
    assert made == "README.md: made again"
    assert version == "made with numpy 1.0, now it is 2.0: only the version that made the set makes its bytes again"
    assert problem == "signals/a.parquet: damaged"


def test_an_interrupted_push_says_that_the_same_command_goes_on(run, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("rubgen.cli.commands.generating.push", stop)
    said = "rubgen: interrupted; files so far are there: the same command copies the rest\n"
    assert run("push", str(SAMPLE), "memory://a/b") == (130, "", said)


def test_programs_read_what_export_features_and_push_made(run, tmp_path, monkeypatch):
    monkeypatch.setattr("rubgen.cli.commands.generating.push", lambda *_: 3)
    code, output, errors = run("push", str(SAMPLE), "memory://a/b", "--json")
    assert (code, errors) == (0, "")
    assert json.loads(output) == {"directory": str(SAMPLE), "url": "memory://a/b", "files": 3}
    words = ["--channels", "proximity_y, proximity_x", "--json"]
    code, output, errors = run("export", str(SAMPLE), "--format", "webdataset", "--out", str(tmp_path / "x"), *words)
    assert (code, errors) == (0, "")
    assert json.loads(output) == {
        "out": str(tmp_path / "x"), "runs": 4, "files": 1, "splits": ["train"],
        "channels": ["proximity_y", "proximity_x"],
    }  # fmt: skip
    out = tmp_path / "f.parquet"
    code, output, errors = run("features", str(SAMPLE), "--out", str(out), "--workers", "1", "--set", "time", *words)
    values = json.loads(output)
    assert (code, errors, values["runs"], values["windows"], values["sets"]) == (0, "", 4, 4, ["time"])
    assert values["channels"] == ["proximity_y", "proximity_x"]
    code, output, errors = run("features", str(SAMPLE), "--out", str(out), "--force", "--workers", "1", "--set", "time")
    assert (code, output.splitlines()[-1]) == (0, "  the metadata of each column has its unit and its definition")
    assert "docs/" not in output  # a package that is installed has no such folder
    code, output, errors = run("features", str(SAMPLE), "--out", str(tmp_path / "g.parquet"), "--workers", "0")
    assert (code, output, errors) == (2, "", "rubgen: --workers 0: must be at least 1\n")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--web", "--serve"], "--web and --serve: one opens a viewer and the other none; give one of them"),
        (["--serve", "--where", "speed_rpm < 0"], "--where 'speed_rpm < 0': no good run meets it; see `rubgen info"),
        (["--serve", "--where", "sped_rpm > 0"], "such as speed_rpm"),
        (["--serve", "--where", "run_id"], "--where 'run_id': "),
    ],
)
def test_a_browse_that_would_show_nothing_is_refused(run, options, said):
    code, output, errors = run("browse", str(SAMPLE), *options)
    assert (code, output, errors.count("\n")) == (2, "", 1)
    assert said in errors


@pytest.mark.parametrize("speed", ["-1", "60001", "nan"])
def test_modes_at_an_impossible_speed_are_refused(run, speed):
    code, output, errors = run("modes", "--speed-rpm", speed)
    assert (code, output, errors) == (2, "", f"rubgen: --speed-rpm {speed}: must be from 0 to 60,000\n")


def test_modes_at_a_speed_have_whirl_and_are_not_compared_with_the_paper(run):
    code, output, errors = run("modes", "--speed-rpm", "9000")
    assert (code, errors) == (0, "")
    (head,) = [line for line in output.splitlines() if line.startswith("blisk   ")]
    assert head.split()[1:] == ["turning", "Hz", "inertial", "Hz", "whirl", "family", "ND", "damping"]
    assert {word for line in output.splitlines() for word in line.split() if word in ("forward", "backward")} == {
        "forward", "backward",
    }  # fmt: skip
    assert "published" not in output
