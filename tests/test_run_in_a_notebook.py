"""One run in a notebook: it shows itself short, saves, plots and replays itself."""

import dataclasses
import pickle
import subprocess
import sys

import matplotlib.figure
import numpy as np
import pytest

from rubgen import make_scenario
from rubgen.brief import brief
from rubgen.errors import UserError
from rubgen.io.mcap import read_mcap
from rubgen.io.parquet.read import read_table
from rubgen.scenario import load_recipe
from rubgen.solver import Status

LONGEST = 800


@pytest.fixture
def failed_run(rub_run):
    response = dataclasses.replace(rub_run.response, status=Status.DIVERGED, reason="blade <3> in turn 7")
    return dataclasses.replace(rub_run, response=response, recording=None, labels=None)


def parts(value, depth=0):
    """A value and all that its fields hold, three levels deep."""
    yield value
    if dataclasses.is_dataclass(value) and depth < 3:
        for field in dataclasses.fields(value):
            yield from parts(getattr(value, field.name), depth + 1)


@pytest.mark.parametrize("name", ["rub_run", "rig_run", "free_run", "failed_run"])
def test_no_part_of_a_run_floods_a_notebook(name, request):
    run = request.getfixturevalue(name)
    shown = [each for each in parts(run) if dataclasses.is_dataclass(each)]
    assert len(shown) > 8
    for each in shown:
        assert len(repr(each)) <= LONGEST, type(each)
    assert len(repr(run).splitlines()) <= 10
    assert run.scenario.run_id in run._repr_html_()


def test_a_run_says_what_one_looks_at_first(rub_run, failed_run):
    extent = rub_run.labels.amounts.extent.value
    assert repr(rub_run).splitlines()[:4] == [
        "run-000000: zeng2019, steady at 10,000 rev/min",
        f"  headline   {extent} rub, period-k",
        "  rub        True",
        "  motion     period-k, period 3",
    ]
    assert "12 channels of 7680 samples at 25600 Hz" in repr(rub_run)
    assert "diverged: blade <3> in turn 7" in repr(failed_run)
    assert "<td>diverged: blade &lt;3&gt; in turn 7</td>" in failed_run._repr_html_()
    assert repr(rub_run.labels).startswith("Labels(rub=True, contact_duty=0.125, blades_touched=36, ")


def test_scenarios_and_recipes_are_a_line():
    scenario = make_scenario(profile="run-up", speed_rpm=6650, end_speed_rpm=6850, duration_s=2, friction=0.02)
    assert repr(scenario) == (
        "Scenario(run-000000: zeng2019, run-up at 6,650 to 6,850 rev/min, friction 0.02, "
        "12 sensors 'default' at 25600 Hz for 1 s, seed 0)"
    )
    recipe = load_recipe()
    assert repr(recipe) == str(recipe)
    assert repr(recipe).startswith("Recipe('zeng2019-mini': 32 runs of zeng2019, seed ")
    assert len(repr(recipe)) < LONGEST


def test_brief_tells_sizes_and_leaves_defaults_out(rub_run):
    text = brief(rub_run.response)
    assert "status=ok" in text
    assert "section_q=array(120, 125)" in text
    assert "taps={" in text
    assert "worn" not in text


@pytest.mark.parametrize("ending", ["mcap", "parquet", "rrd"])
def test_a_run_saves_itself(rub_run, tmp_path, ending):
    path = tmp_path / f"run.{ending}"
    rub_run.save(str(path))
    values = rub_run.recording.channels["contact_force"].values
    if ending == "mcap":
        np.testing.assert_array_equal(read_mcap(path).signals["contact_force"], values)
    elif ending == "parquet":
        np.testing.assert_array_equal(read_table(path, ["contact_force"])["contact_force"][0].values, values)
    else:
        assert path.read_bytes()[:4] == b"RRF2"
    assert [each.name for each in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("name", ["rub_run", "rig_run", "free_run"])
def test_a_run_plots_itself(name, request):
    figure = request.getfixturevalue(name).plot()
    assert isinstance(figure, matplotlib.figure.Figure)
    assert len(figure.axes) >= 4
    assert figure._repr_png_()[1:4] == b"PNG"


def test_a_run_replays_itself(rub_run, monkeypatch):
    shown = []
    monkeypatch.setattr("rubgen.viz.viewer._open", lambda path, moment, web: shown.append((path.name, moment > 0, web)))
    monkeypatch.setenv("DISPLAY", ":0")
    rub_run.replay()
    rub_run.replay(web=True)
    assert shown == [("run-000000.rrd", True, False), ("run-000000.rrd", True, True)]


def test_what_cannot_be_done_is_one_line(rub_run, failed_run, tmp_path, monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    cases = [
        (lambda: rub_run.save(tmp_path / "run.csv"), "unknown kind of file; end the name in .mcap, .parquet or .rrd"),
        (lambda: rub_run.save(tmp_path / "none/run.mcap"), "there is no directory"),
        (
            lambda: failed_run.save(tmp_path / "run.mcap"),
            "(diverged: blade <3> in turn 7); there is nothing to save",
        ),
        (failed_run.plot, "there is nothing to plot"),
        (failed_run.replay, "there is nothing to replay"),
    ]
    if sys.platform.startswith("linux"):
        cases.append((rub_run.replay, 'use save("run.rrd") or web=True'))
    for act, message in cases:
        with pytest.raises(UserError) as caught:
            act()
        assert message in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_run_is_pickled_as_before(rub_run):
    again = pickle.loads(pickle.dumps(rub_run))  # noqa: S301 - our own
    assert again.scenario == rub_run.scenario
    assert type(again) is type(rub_run)


def test_a_scenario_needs_neither_kernels_nor_pandas():
    heavy = {"numba", "pandas", "rerun", "matplotlib", "pyarrow", "mcap"}
    code = f"import sys, rubgen; print(rubgen.make_scenario()); print(sorted({heavy!r} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[1:] == ["[]"]
