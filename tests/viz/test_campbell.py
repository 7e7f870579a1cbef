"""The Campbell diagram and the modes behind it, against closed forms of a rigid rotor and a symmetric blisk."""

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.reduction.modes import blisk_modes, casing_diameters
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s
from rubgen.viz.figures.machine import branches, campbell, crossings


@pytest.fixture(scope="module")
def model():
    return reduce(load_machine("zeng2019"), Reduction())


def test_frequencies_at_rest_are_those_of_the_symmetric_problem(model):
    modes = blisk_modes(model, 0.0)
    diameters = np.array([mode.nodal_diameters for mode in modes])
    undamped = np.array([abs(mode.turning_hz) / np.sqrt(1 - mode.damping_ratio**2) for mode in modes])
    assert undamped.size == len(model.blisk.M)
    expected = model.blisk_frequencies_hz()
    inner = diameters >= 2  # these move no support, so their damping is proportional and |lambda| is the frequency
    np.testing.assert_allclose(undamped[inner], expected[inner], rtol=1e-6)
    np.testing.assert_allclose(undamped[diameters == 0], expected[diameters == 0], rtol=1e-4)
    # the lateral dampers couple the modes of one diameter: ratios of 10 % move frequencies by the order of the square
    np.testing.assert_allclose(undamped[diameters == 1], expected[diameters == 1], rtol=1e-2)


def test_lateral_whirl_has_one_nodal_diameter_and_the_damping_of_the_support(model):
    machine = model.machine
    lateral = [mode for mode in blisk_modes(model, rad_per_s(6000)) if mode.family == "lateral"]
    assert [mode.nodal_diameters for mode in lateral] == [1, 1]
    assert {mode.whirl for mode in lateral} == {"forward", "backward"}
    for mode in lateral:  # a rigid body on the spring has the frequency and the ratio; blades and tilt give a little
        stiffness, ratio = machine.disk_support.lateral_stiffness_n_per_m, machine.damping.lateral
        rigid = np.sqrt(stiffness / model.blisk_mass) / (2 * np.pi)
        assert abs(mode.inertial_hz) == pytest.approx(rigid, rel=0.1)
        assert mode.damping_ratio == pytest.approx(ratio, rel=0.2)


def test_each_nodal_diameter_has_its_waves(model):
    half = model.machine.blades.count // 2
    counts = np.bincount([mode.nodal_diameters for mode in blisk_modes(model, rad_per_s(6000))], minlength=half + 1)
    assert counts[2:half].tolist() == [6] * (half - 2)  # three coordinates of a tip, two directions
    assert counts[half] == 3
    assert counts.sum() == len(model.blisk.M)


def test_waves_of_the_casing_come_in_pairs(model):
    assert sorted(casing_diameters(model)) == [1, 1, 2, 2, 2, 3, 3, 4, 4, 5, 5]


def test_forward_whirl_meets_the_speed_at_the_critical_speed(model):
    speeds = np.linspace(8000, 9500, 7)
    lines = branches([blisk_modes(model, rad_per_s(speed)) for speed in speeds], 1)
    met = np.concatenate([crossings(speeds, seen, 1.0) for seen in lines[..., 1].T])
    assert met == pytest.approx([model.critical_speed_rpm], rel=6e-3)  # damping of 10 % lowers it by half its square


def test_a_crossing_is_found_where_a_straight_line_meets_an_order():
    speeds = np.linspace(0, 6000, 13)
    assert crossings(speeds, 90 + speeds / 600, 2.0) == pytest.approx([90 / (2 / 60 - 1 / 600)])


def test_the_figure_says_machine_frames_and_directions(model):
    figure = campbell(model)
    assert figure.get_suptitle().startswith("zeng2019")
    assert ["inertial" in axes.get_title() for axes in figure.axes] == [True, False, True]
    assert {text.get_text() for text in figure.axes[0].get_legend().get_texts()} == {"forward", "backward"}
    points = next(line for line in figure.axes[2].lines if line.get_marker() == "o").get_xydata()
    np.testing.assert_allclose(points[:, 1] / (points[:, 0] / 60) % model.machine.casing.lobes, 0, atol=1e-9)
