"""The Campbell diagram and the modes behind it, against closed forms of a rigid rotor and a symmetric blisk."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.machine.faults.lost_blade import LostBlade
from rubgen.machine.machine import Mistuning
from rubgen.reduction import reduce
from rubgen.reduction.modes import blisk_modes, casing_diameters
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s
from rubgen.viz.figures.campbell_diagram import branches, campbell, crossings


@pytest.fixture(scope="module")
def model():
    return reduce(load_machine("zeng2019"), Reduction())


@pytest.fixture(scope="module")
def mistuned(model):
    blades = replace(model.machine.blades, mistuning=Mistuning(relative_std=0.03, seed=5))
    return reduce(replace(model.machine, blades=blades), Reduction())


def test_frequencies_at_rest_are_those_of_the_symmetric_problem(model):
    light = replace(model, dampers=1e-6 * model.dampers, beta=1e-6 * model.beta)  # damping couples modes
    found = np.sort([abs(mode.turning_hz) for mode in blisk_modes(light, 0.0)])
    np.testing.assert_allclose(found, model.blisk_frequencies_hz(), rtol=1e-6)


def test_a_rigid_blisk_whirls_with_the_frequency_and_the_damping_of_the_support(rigid):
    ratio = rigid.machine.damping.lateral
    expected = np.sqrt(rigid.springs[0] / rigid.blisk_mass * (1 - ratio**2)) / (2 * np.pi)
    lateral = [mode for mode in blisk_modes(rigid, rad_per_s(6000)) if mode.family == "lateral"]
    assert {mode.whirl for mode in lateral} == {"forward", "backward"}
    for mode in lateral:
        assert mode.nodal_diameters == 1
        assert abs(mode.inertial_hz) == pytest.approx(expected, rel=1e-4)
        assert mode.damping_ratio == pytest.approx(ratio, rel=1e-4)


def test_an_elastic_blisk_has_a_pair_of_lateral_modes(model):
    lateral = [mode for mode in blisk_modes(model, rad_per_s(6000)) if mode.family == "lateral"]
    assert [(mode.nodal_diameters, mode.whirl) for mode in lateral] == [(1, "forward"), (1, "backward")]


def test_two_blades_whirl_with_the_disk_in_both_directions(model):
    two = reduce(replace(model.machine, blades=replace(model.machine.blades, count=2)), Reduction())
    forward, backward = (mode for mode in blisk_modes(two, rad_per_s(6000)) if mode.family == "lateral")
    assert (forward.whirl, backward.whirl) == ("forward", "backward")
    assert -backward.inertial_hz == pytest.approx(forward.inertial_hz, rel=0.02)
    assert backward.damping_ratio == pytest.approx(forward.damping_ratio, rel=0.02)


def test_each_nodal_diameter_has_its_waves(model):
    half = model.machine.blades.count // 2
    counts = np.bincount([mode.nodal_diameters for mode in blisk_modes(model, rad_per_s(6000))], minlength=half + 1)
    assert counts[2:half].tolist() == [6] * (half - 2)  # three coordinates of a tip, two directions
    assert counts[half] == 3
    assert counts.sum() == len(model.blisk.M)


@pytest.mark.parametrize("speed", [0.0, 60.0, 400.0, 6000.0])
def test_each_mode_of_uneven_blades_is_named_after_its_own_mode_of_the_even_blisk(model, mistuned, speed):
    even, found = ({}, {})
    for of, names in ((model, even), (mistuned, found)):
        for mode in blisk_modes(of, rad_per_s(speed)):
            names.setdefault((mode.family, mode.nodal_diameters, mode.whirl), []).append(abs(mode.turning_hz))
    assert {name: len(values) for name, values in found.items()} == {name: len(even[name]) for name in even}
    for name, values in found.items():
        np.testing.assert_allclose(sorted(values), sorted(even[name]), rtol=0.04)  # deviations reach 7 %: 3.5 % in Hz


def test_branches_of_uneven_blades_follow_those_of_even_ones(model, mistuned):
    speeds = np.linspace(60, 12_000, 7)
    for waves in (0, 1, 2, 9, 18):
        even, found = (branches([blisk_modes(of, rad_per_s(x)) for x in speeds], waves) for of in (model, mistuned))
        np.testing.assert_allclose(found[..., 0], even[..., 0], rtol=0.04, atol=2)


def test_a_blisk_without_a_blade_lacks_modes_of_blades_alone(model):
    lost = reduce(replace(model.machine, faults=(LostBlade(blade=3),)), Reduction())
    of_lost, of_all = (Counter(mode.family for mode in blisk_modes(x, rad_per_s(6000))) for x in (lost, model))
    assert set(of_all) == set(of_lost)
    missing = of_all - of_lost
    assert missing.total() == 3
    assert set(missing) <= {family for family in of_all if family.startswith("blade")}


def test_waves_of_the_casing_come_in_pairs_and_it_turns_as_a_whole_without_waves(model):
    found = casing_diameters(model)
    assert sorted(found) == [0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5]
    whole, casing = model.casing_frequencies_hz[found.index(0)], model.machine.casing
    mass = (
        casing.material.density_kg_per_m3
        * casing.thickness_m
        * casing.width_m
        * 2
        * np.pi
        * model.machine.casing_mean_radius_m
    )
    springs = casing.nodes * casing.circumferential_support_stiffness_n_per_m
    assert whole == pytest.approx(np.sqrt(springs / mass) / (2 * np.pi), rel=1e-3)


def test_forward_whirl_meets_the_speed_at_the_critical_speed(model):
    speeds = np.linspace(8000, 9500, 7)
    lines = branches([blisk_modes(model, rad_per_s(speed)) for speed in speeds], 1)
    met = np.concatenate([crossings(speeds, seen, 1.0) for seen in lines[..., 1].T])
    assert met == pytest.approx([model.critical_speed_rpm], rel=6e-3)  # damping of 10 % lowers it by half its square


def test_a_crossing_is_found_where_a_straight_line_meets_an_order():
    speeds = np.linspace(0, 6000, 13)
    assert crossings(speeds, 90 + speeds / 600, 2.0) == pytest.approx([90 / (2 / 60 - 1 / 600)])


def test_ranges_are_those_of_all_panels(model, monkeypatch):
    monkeypatch.setattr("rubgen.viz.figures.campbell_diagram.SPEEDS", 9)
    figure = campbell(model, (7000, 11_000), (50, 400))
    for axes in figure.axes:
        assert (axes.get_xlim(), axes.get_ylim()) == ((7000, 11_000), (50, 400))
        for line in axes.lines:
            if line.get_linewidth() == 0.6:  # orders of rotation
                assert np.all((line.get_ydata() >= 50 - 1e-9) & (line.get_ydata() <= 400 + 1e-9))
    assert any(" rev/min, 10.0 %" in text.get_text() for text in figure.axes[0].texts)


def test_the_figure_says_machine_frames_and_directions(model):
    figure = campbell(model)
    assert figure.get_suptitle().startswith("zeng2019")
    assert ["inertial" in axes.get_title() for axes in figure.axes] == [True, False, True]
    assert {text.get_text() for text in figure.axes[0].get_legend().get_texts()} == {"forward", "backward"}
    points = next(line for line in figure.axes[2].lines if line.get_marker() == "o").get_xydata()
    orders = points[:, 1] / (points[:, 0] / 60) / model.machine.casing.lobes
    np.testing.assert_allclose(orders, np.rint(orders), atol=1e-9)


def test_legends_cover_no_panel(model, monkeypatch):
    monkeypatch.setattr("rubgen.viz.figures.campbell_diagram.SPEEDS", 9)
    figure = campbell(model)
    figure.draw_without_rendering()
    panels = [axes.get_window_extent() for axes in figure.axes]
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    assert len(legends) == 2
    assert not any(legend.get_window_extent().overlaps(panel) for legend in legends for panel in panels)
