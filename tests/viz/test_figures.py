import dataclasses
import itertools
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from matplotlib.colors import to_hex

from rubgen.viz.colors import MOTION_COLORS
from rubgen.viz.figures import dataset_overview, overview, save_png
from rubgen.viz.figures.data_set import varied_keys


@pytest.fixture(scope="module")
def figure(rub_run):
    return overview(rub_run)


@pytest.fixture(scope="module")
def runs():
    generator = np.random.default_rng(3)
    count = 40
    return pd.DataFrame(
        {
            "status": ["ok"] * (count - 2) + ["diverged"] * 2,
            "speed_rpm": generator.uniform(6500, 12500, count),
            "clearance_m": generator.uniform(2e-4, 3.5e-4, count),
            "casing_support_stiffness_n_per_m": np.exp(generator.uniform(np.log(5e4), np.log(6e5), count)),
            "motion": generator.choice(["period-1", "period-k", "quasi-periodic", "chaotic"], count),
            "rub": generator.uniform(size=count) > 0.3,
            "contact_impulse_per_turn_n_s": generator.uniform(0, 3, count),
        }
    )


def test_the_map_holds_the_whole_impulse(figure, rub_run):
    polar = figure.axes[2]
    heights = np.array([bar.get_height() for bar in polar.patches])
    assert heights.sum() == pytest.approx(1e3 * rub_run.response.events.impulse.sum() / rub_run.response.record_turns)
    angles = np.array([bar.get_x() + bar.get_width() / 2 for bar in polar.patches])
    strong = angles[heights > heights.max() / 2]
    assert np.all(np.abs(np.sin(strong)) < np.sin(np.radians(20)))  # the synthetic zones stand at 0 and 180 degrees


def test_the_spectrum_shows_the_amplitudes_of_the_force(figure, rub_run):
    force = rub_run.response.taps["contact_force"]
    turn = rub_run.response.steps_per_turn
    angle = 2 * np.pi * np.arange(force.size) / turn
    last = slice(-100 * turn, None)
    expected = [2 * abs(np.mean(force[last] * np.exp(-1j * k * angle[last]))) for k in (2, 4, 6)]
    even = next(line for line in figure.axes[3].lines if line.get_label() == "even orders")
    assert list(even.get_xdata()[:3]) == [2, 4, 6]
    np.testing.assert_allclose(even.get_ydata()[:3], expected, rtol=1e-9)


def test_orbit_and_section_are_in_micrometres(figure, rub_run):
    path, section = figure.axes[0].lines[:2]
    assert path.get_xdata()[-1] == pytest.approx(1e6 * rub_run.response.taps["blisk_x"][-1])
    assert section.get_ydata()[7] == pytest.approx(1e6 * rub_run.response.section_q[7, 3 * 36 + 1])
    assert figure.axes[0].get_aspect() == 1.0


def test_the_waveform_ends_with_the_recording(figure, rub_run):
    line = figure.axes[1].lines[0]
    assert line.get_ydata()[-1] == rub_run.recording.channels["casing_acc_0"].values[-1]
    assert line.get_xdata()[-1] == pytest.approx(5 * 6.0, abs=0.05)  # five turns at 10,000 rev/min in ms


def test_every_axis_has_a_unit_and_no_panel_covers_another(figure):
    figure.canvas.draw()
    labels = [(axes.get_xlabel(), axes.get_ylabel()) for axes in figure.axes[:4]]
    units = ["µm", "µm", "ms", "m/s²", "mN s", "", "order", "N"]
    assert all(unit.lower() in label.lower() for unit, label in zip(units, itertools.chain(*labels), strict=True))
    boxes = [axes.get_tightbbox() for axes in figure.axes[:4]]
    assert not any(first.overlaps(second) for first, second in itertools.combinations(boxes, 2))
    assert all(figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1 for box in boxes)


def test_a_set_of_sensors_without_the_usual_channel_shows_its_first(rig_run):
    channels = dict(rig_run.recording.channels)
    del channels["casing_acc_0"]
    wave = overview(dataclasses.replace(rig_run, recording=dataclasses.replace(rig_run.recording, channels=channels)))
    assert wave.axes[1].lines[0].get_ydata()[-1] == channels["proximity_45"].values[-1]
    assert wave.axes[1].get_ylabel().endswith(f"disk centre, {channels['proximity_45'].unit}")


def test_without_contact_the_panels_say_so(free_run):
    figure = overview(free_run)
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert texts.count("no contact") == 2


def test_the_same_run_gives_the_same_small_picture(rub_run, tmp_path):
    for name in ("one", "two"):
        save_png(overview(rub_run), tmp_path / f"{name}.png")
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()
    assert (tmp_path / "one.png").stat().st_size < 300_000


def test_a_failed_run_has_no_picture(rub_run):
    with pytest.raises(ValueError, match="nothing to show"):
        overview(dataclasses.replace(rub_run, recording=None))


def test_what_follows_from_a_steady_speed_is_no_parameter(runs):
    steady = runs.assign(end_speed_rpm=runs["speed_rpm"], duration_s=500 * 60 / runs["speed_rpm"], fluctuation_rpm=0.0)
    expected = ["speed_rpm", "clearance_m", "casing_support_stiffness_n_per_m"]
    assert varied_keys(steady) == expected
    assert varied_keys(steady.assign(end_speed_rpm=9000.0)) == [*expected, "duration_s"]


def test_long_labels_stay_inside(runs):
    figure = dataset_overview(runs)
    figure.canvas.draw()
    for axes in figure.axes:
        label = axes.yaxis.label.get_window_extent()
        assert figure.bbox.y0 <= label.y0
        assert label.y1 <= figure.bbox.y1


def test_every_good_run_is_one_point_in_the_colour_of_its_motion(runs):
    figure = dataset_overview(runs)
    good = runs[runs["status"] == "ok"]
    for axes, column, scale in zip(
        figure.axes,
        ["clearance_m", "casing_support_stiffness_n_per_m", "contact_impulse_per_turn_n_s"],
        [1e3, 1.0, 1.0],
        strict=True,
    ):
        drawn = sorted(
            (float(x), float(y), to_hex(line.get_color()), line.get_markerfacecolor() != "none")
            for line in axes.lines
            for x, y in zip(line.get_xdata(), line.get_ydata(), strict=True)
        )
        expected = sorted(
            (row.speed_rpm, scale * getattr(row, column), MOTION_COLORS[row.motion], bool(row.rub))
            for row in good.itertuples()
        )
        assert drawn == expected


def test_pictures_need_no_global_state():
    code = "import sys, rubgen.viz.figures; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
