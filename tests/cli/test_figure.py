"""`rubgen figure`: every name draws, and mistakes are named."""

from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from rubgen import make_scenario
from rubgen.errors import UserError
from rubgen.io.mcap import write_mcap
from rubgen.report.figures import FIGURES, Choice, make_figure
from rubgen.viz.colors import MOTION_COLORS


class MadeSet:
    """A sweep of three runs with made signals: 30 turns of 1/100 s."""

    runs = pd.DataFrame(
        {
            "run_id": ["run-000000", "run-000001", "run-000002"],
            "status": "ok",
            "speed_rpm": [6000.0, 6100.0, 6200.0],
            "sample_rate_hz": 10000.0,
            "motion": ["period-1", "chaotic", "period-1"],
            "rub": [True, True, False],
            "contact_impulse_per_turn_n_s": [1.0, 2.0, 0.0],
            "lyapunov_per_turn": [-0.1, 0.3, None],
            "lyapunov_error": [0.01, 0.02, None],
        }
    ).set_index("run_id")
    manifest: ClassVar = SimpleNamespace(
        name="made",
        identity=SimpleNamespace(
            machines=[{"name": "zeng2019"}], recorded=lambda: SimpleNamespace(sensing=make_scenario().sensing)
        ),
    )
    units: ClassVar[dict[str, str]] = {"proximity_x": "m", "proximity_x_clean": "m", "casing_acc_0": "m/s2"}

    def __init__(self, _directory=None):
        pass

    @property
    def ok(self):
        return self.runs[self.runs["status"] == "ok"]

    def row(self, run_id):
        return self.runs.loc[run_id].to_dict()

    def each_channel(self, _name):
        time, pulses = np.arange(3000) / 1e4, np.arange(30) / 100
        for number, run_id in enumerate(self.runs.index):
            wave = np.cos(2 * np.pi * (100 if number != 1 else 137.5) * time)
            yield run_id, (1e-4 * wave).astype(np.float32), pulses


@pytest.fixture
def made_set(monkeypatch):
    monkeypatch.setattr("rubgen.report.figures.DataSet", MadeSet)


@pytest.fixture(scope="module")
def mcap_file(rub_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("figure") / "run.mcap"
    write_mcap(rub_run, path)
    return path


def no_text_overlaps_or_leaves(figure):
    """Titles, labels and ticks stay inside, and no label stands on another axes' panel."""
    figure.canvas.draw()
    for axes in figure.axes:
        box = axes.get_tightbbox()
        assert figure.bbox.x0 - 1 <= box.x0
        assert box.x1 <= figure.bbox.x1 + 1
        assert figure.bbox.y0 - 1 <= box.y0
        assert box.y1 <= figure.bbox.y1 + 1
    boxes = [text.get_window_extent() for axes in figure.axes for text in [axes.title] if text.get_text()]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


@pytest.mark.parametrize("name", ["campbell", "critical", "unbalance", "modes"])
def test_figures_of_a_machine(name):
    no_text_overlaps_or_leaves(make_figure(name, None, Choice()))


@pytest.mark.parametrize("name", ["orbit", "contact", "waveform"])
def test_figures_of_a_run(name, mcap_file):
    no_text_overlaps_or_leaves(make_figure(name, mcap_file, Choice()))


@pytest.mark.parametrize("name", ["bifurcation", "cascade", "exponent", "overview"])
def test_figures_of_a_set(name, made_set, tmp_path):
    no_text_overlaps_or_leaves(make_figure(name, tmp_path, Choice()))


def test_the_bifurcation_shows_the_section_in_the_colour_of_its_class(made_set, tmp_path):
    lines = make_figure("bifurcation", tmp_path, Choice()).axes[0].lines
    assert [line.get_color() for line in lines] == [MOTION_COLORS[motion] for motion in MadeSet.runs["motion"]]
    assert np.ptp(lines[0].get_ydata()) < 1e-3  # um: it repeats every turn
    assert np.ptp(lines[1].get_ydata()) > 100
    assert set(lines[1].get_xdata()) == {6100.0}


def test_the_bifurcation_takes_the_clean_channel_and_names_its_unit(made_set, monkeypatch, tmp_path):
    asked = []
    each = MadeSet.each_channel
    monkeypatch.setattr(MadeSet, "each_channel", lambda data, name: asked.append(name) or each(data, name))
    assert make_figure("bifurcation", tmp_path, Choice()).axes[0].get_ylabel().endswith("about its mean, µm")
    monkeypatch.setattr(MadeSet, "units", {"proximity_45": "V"})
    figure = make_figure("bifurcation", tmp_path, Choice(channel="proximity_45"))
    assert figure.axes[0].get_ylabel() == "proximity_45 once a turn about its mean, V"
    assert asked == ["proximity_x_clean", "proximity_45"]


def test_noise_is_shown_as_a_band_and_only_where_there_is_some(made_set, tmp_path):
    (probe,) = (each for each in make_scenario().sensing.set.sampled if each.name == "proximity_x")
    assert probe.noise_rms > 0
    noisy = make_figure("bifurcation", tmp_path, Choice(channel="proximity_x"))
    (band,) = noisy.axes[0].patches
    assert band.get_y() == pytest.approx(-3e6 * probe.noise_rms)
    assert band.get_height() == pytest.approx(6e6 * probe.noise_rms)
    assert "noise of the sensor, ±3 rms" in [text.get_text() for text in noisy.legends[0].get_texts()]
    assert not make_figure("bifurcation", tmp_path, Choice()).axes[0].patches


@pytest.mark.parametrize("name", ["bifurcation", "cascade", "exponent", "overview"])
def test_the_title_names_set_runs_and_machine(name, made_set, tmp_path):
    assert make_figure(name, tmp_path, Choice()).get_suptitle().startswith("made: 3 runs of zeng2019")


@pytest.mark.parametrize("name", ["bifurcation", "cascade", "exponent"])
def test_a_set_in_which_more_varies_is_marked(name, made_set, monkeypatch, tmp_path):
    drawn = MadeSet.runs.assign(friction=[0.0, 0.1, 0.2], clearance_m=[1e-4, 2e-4, 3e-4])
    monkeypatch.setattr(MadeSet, "runs", drawn)
    warning = make_figure(name, tmp_path, Choice()).axes[0].get_title(loc="left")
    assert warning == "No sweep: clearance_m, friction vary too"


@pytest.mark.parametrize(("name", "expected"), [("bifurcation", "acc_17 once a turn"), ("cascade", "g")])
def test_a_set_without_the_usual_channel_shows_its_first(name, expected, made_set, monkeypatch, tmp_path):
    asked = []
    each = MadeSet.each_channel
    monkeypatch.setattr(MadeSet, "each_channel", lambda data, name: asked.append(name) or each(data, name))
    monkeypatch.setattr(MadeSet, "units", {"acc_17": "g", "acc_18": "g"})
    figure = make_figure(name, tmp_path, Choice())
    assert asked == ["acc_17"]
    assert any(expected in axes.get_ylabel() for axes in figure.axes)


def test_the_exponent_leaves_out_runs_without_one(made_set, tmp_path):
    axes = make_figure("exponent", tmp_path, Choice()).axes[0]
    drawn = [(float(c[0].get_xdata()[0]), float(c[0].get_ydata()[0])) for c in axes.containers]
    assert drawn == [(6000.0, -0.1), (6100.0, 0.3)]


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_the_command_writes_vectors_and_pixels(run, mcap_file, tmp_path, ending):
    path = tmp_path / f"orbit.{ending}"
    assert run("figure", "orbit", str(mcap_file), "--out", str(path))[:2] == (0, f"{path}\n")
    start = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[ending]
    assert path.read_bytes().startswith(start)
    if ending == "png":
        with Image.open(path) as image:
            assert image.width > 1000


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("orbits", "{mcap}", "--out", "{tmp}/a.png"), "did you mean orbit? allowed: campbell, critical"),
        (("orbit", "--out", "{tmp}/a.png"), "this figure needs a source"),
        (("orbit", "{mcap}", "--out", "{tmp}/a.jpg"), "end the name in .png, .svg or .pdf"),
        (("orbit", "{mcap}", "--out", "{tmp}/there.png"), "exists already"),
        (("waveform", "{mcap}", "--channel", "speech", "--out", "{tmp}/a.png"), "no channel 'speech'; allowed: "),
        (("waveform", "{mcap}", "--channel", "casing_ac", "--out", "{tmp}/a.png"), "did you mean casing_acc_0?"),
        (("campbell", "--speeds-rpm", "9:2", "--out", "{tmp}/a.png"), "--speeds-rpm 9:2: give LOW:HIGH with 0 <= LOW"),
        (("unbalance", "--speeds-rpm", "fast", "--out", "{tmp}/a.png"), "--speeds-rpm fast: give LOW:HIGH"),
        (("campbell", "--frequencies-hz", "-5:9", "--out", "{tmp}/a.png"), "--frequencies-hz -5:9: give LOW:HIGH"),
        (("modes", "--modes", "blade 9", "--out", "{tmp}/a.png"), "--modes 'blade 9': no such mode"),
        (("campbell", "nowhere", "--out", "{tmp}/a.png"), "nowhere"),
        (("overview", "{tmp}", "--out", "{tmp}/a.png"), "no finished data set of rubgen"),
    ],
)
def test_mistakes_are_named_in_one_line(run, mcap_file, tmp_path, arguments, message):
    (tmp_path / "there.png").write_bytes(b"")
    code, out, err = run("figure", *(each.format(mcap=mcap_file, tmp=tmp_path) for each in arguments))
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert message in err
    assert [path.name for path in tmp_path.iterdir()] == ["there.png"]


def test_a_parameter_that_does_not_vary_is_refused(made_set, tmp_path):
    with pytest.raises(UserError, match="--over friction: does not vary in this set; give one of speed_rpm"):
        make_figure("bifurcation", tmp_path, Choice(parameter="friction"))


def test_every_figure_has_a_test():
    assert set(FIGURES) == {
        "campbell", "critical", "unbalance", "modes", "orbit", "contact", "waveform", "bifurcation", "cascade",
        "exponent", "overview", "waterfall", "bode",
    }  # fmt: skip


@pytest.mark.parametrize("name", ["overview", "bifurcation", "cascade", "exponent"])
def test_a_set_without_a_good_run_has_no_figure(run, monkeypatch, tmp_path, name):
    monkeypatch.setattr("rubgen.report.figures.DataSet", MadeSet)
    monkeypatch.setattr(MadeSet, "runs", MadeSet.runs.assign(status="diverged"))
    code, text, error = run("figure", name, "made", "--out", str(tmp_path / "f.png"))
    assert (code, text) == (2, "")
    assert error == "rubgen: made: no run is good; see `rubgen info made`\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("speed", "--over speed: unknown parameter; did you mean speed_rpm? allowed: speed_rpm"),
        ("clearance_m", "--over clearance_m: does not vary in this set; give one of speed_rpm"),
    ],
)
def test_a_parameter_to_draw_over_is_named(made_set, tmp_path, name, message):
    with pytest.raises(UserError, match=message.replace("?", r"\?")):
        make_figure("exponent", tmp_path, Choice(parameter=name))


@pytest.mark.parametrize(
    ("name", "choice", "option"),
    [
        ("overview", Choice(parameter="clearance"), "--over clearance"),
        ("overview", Choice(run_id="run-000000"), "run run-000000"),
        ("exponent", Choice(channel="proximity_x"), "--channel proximity_x"),
        ("cascade", Choice(where="rub"), "--where rub"),
        ("orbit", Choice(parameter="speed_rpm"), "--over speed_rpm"),
        ("campbell", Choice(channel="proximity_x"), "--channel proximity_x"),
        ("critical", Choice(frequencies_hz="0:100"), "--frequencies-hz 0:100"),
        ("orbit", Choice(speeds_rpm="0:100"), "--speeds-rpm 0:100"),
        ("unbalance", Choice(modes="7"), "--modes 7"),
    ],
)
def test_an_option_that_a_figure_would_ignore_is_refused(name, choice, option, tmp_path):
    with pytest.raises(UserError, match=f"^{option}: this figure has no such option; leave it out"):
        make_figure(name, tmp_path, choice)


def test_a_bug_in_a_figure_is_not_called_a_mistake_of_the_user(monkeypatch):
    def draw(_source, _choice):
        raise ValueError("x and y must have the same first dimension")

    monkeypatch.setitem(FIGURES, "modes", draw)
    with pytest.raises(ValueError, match="same first dimension") as caught:
        make_figure("modes", None, Choice())
    assert not isinstance(caught.value, UserError)
