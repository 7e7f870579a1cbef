"""The response to the unbalance against the Jeffcott rotor, and critical speeds against those of a rigid one."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.reduction.modes import blisk_modes, critical_speeds_rpm, synchronous_speeds
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s, rev_per_min
from rubgen.viz.figures import critical_map, unbalance_response
from rubgen.viz.figures.response import whirl_of_unbalance


@pytest.fixture(scope="module")
def machine():
    return load_machine("zeng2019")


def test_a_rigid_blisk_is_a_jeffcott_rotor(rigid):
    speeds = np.linspace(500, 16_000, 32)
    omega, mass, unbalance = rad_per_s(speeds), rigid.blisk_mass, rigid.machine.unbalance_kg_m
    stiffness, damping = rigid.springs[0], rigid.dampers[0]
    expected = unbalance * omega**2 / (stiffness - mass * omega**2 + 1j * damping * omega)
    found = whirl_of_unbalance(rigid, speeds)
    np.testing.assert_allclose(found[:, 0], expected, rtol=2e-5)
    assert np.all(found[:, 1] == 0)


def test_uneven_springs_whirl_backward_as_two_rotors_of_one_direction_do(rigid):
    uneven = replace(rigid.machine, disk_support=replace(rigid.machine.disk_support, lateral_stiffness_anisotropy=0.2))
    speeds = np.linspace(2000, 14_000, 9)
    omega, mass = rad_per_s(speeds), rigid.blisk_mass
    x, y = (
        rigid.machine.unbalance_kg_m * omega**2 / (k - mass * omega**2 + 1j * rigid.dampers[0] * omega)
        for k in (1.2 * rigid.springs[0], 0.8 * rigid.springs[0])
    )
    found = whirl_of_unbalance(reduce(uneven, Reduction()), speeds)
    np.testing.assert_allclose(found[:, 0], (x + y) / 2, rtol=5e-5)
    np.testing.assert_allclose(found[:, 1], np.conj(x - y) / 2, rtol=5e-4)


def test_uneven_springs_have_the_critical_speeds_at_which_the_orbit_is_largest(machine):
    springs = replace(machine.disk_support, lateral_stiffness_anisotropy=0.1)
    model = reduce(replace(machine, disk_support=springs), Reduction())
    light = replace(model, dampers=1e-2 * model.dampers, beta=1e-2 * model.beta)
    critical = critical_speeds_rpm(model)
    assert len(critical) == 2
    assert critical[1] < model.critical_speed_rpm < critical[0]  # along X, along Y
    for each in critical:
        speeds = each * np.linspace(0.99, 1.01, 81)
        size = np.abs(whirl_of_unbalance(light, speeds)).sum(axis=1)
        assert speeds[np.argmax(size)] == pytest.approx(each, rel=1e-3)


def test_figures_of_uneven_springs_mark_both_critical_speeds(machine):
    springs = replace(machine.disk_support, lateral_stiffness_anisotropy=0.1)
    model = reduce(replace(machine, disk_support=springs), Reduction())
    low, high = sorted(critical_speeds_rpm(model))
    label = unbalance_response(model, (low - 10, high + 10)).axes[1].get_xlabel()
    assert f"critical speeds, {low:,.0f} and {high:,.0f} rev/min" in label
    drawn = [text.get_text() for text in critical_map(model).axes[0].texts]
    assert f"{low:,.0f} rev/min" in drawn
    assert f"{high:,.0f} rev/min" in drawn


def test_a_rigid_blisk_is_critical_at_its_natural_frequency(rigid):
    stiffness = np.array([1e6, 1e8, 1e9])
    found = synchronous_speeds(rigid, stiffness)
    expected = rev_per_min(np.sqrt(stiffness / rigid.blisk_mass))
    # what is left: elasticity at the stiff end, rounding of the very stiff blisk at the soft end
    np.testing.assert_allclose(found[:, 0], expected, rtol=5e-5)
    np.testing.assert_allclose(found[:, 1], expected, rtol=5e-5)  # both directions of an even support


def test_the_map_is_that_of_the_machine_reduced_with_each_stiffness(machine):
    softer = replace(machine, disk_support=replace(machine.disk_support, lateral_stiffness_n_per_m=3e7))
    alone = reduce(softer, Reduction())
    (found,) = synchronous_speeds(reduce(machine, Reduction()), np.array([3e7]))
    assert found[0] == pytest.approx(alone.critical_speed_rpm, rel=1e-6)
    # independent of the singular stiffness: at that speed a damped forward mode of the inertial frame is near 1X
    modes = [mode for mode in blisk_modes(alone, rad_per_s(float(found[0]))) if mode.whirl == "forward"]
    nearest = min(modes, key=lambda mode: abs(60 * mode.inertial_hz - found[0]))
    assert nearest.family == "lateral"
    assert 60 * nearest.inertial_hz == pytest.approx(found[0], rel=6e-3)  # damping of 10 % lowers it by half its square


def test_figures_show_what_was_computed(machine, monkeypatch):
    monkeypatch.setattr("rubgen.viz.figures.response.STIFFNESSES", 5)
    model = reduce(machine, Reduction())
    figure = unbalance_response(model, (4000, 12_000))
    assert figure.get_suptitle().startswith("zeng2019: response to the unbalance of 14.5 g m")
    speeds, amplitude = figure.axes[0].lines[0].get_xydata().T
    forward = whirl_of_unbalance(model, speeds[::50])[:, 0]
    np.testing.assert_allclose(amplitude[::50], 1e6 * np.abs(forward))
    np.testing.assert_allclose(figure.axes[1].lines[0].get_ydata()[::50], np.degrees(np.angle(forward)))
    assert figure.axes[0].get_xlim() == (4000, 12_000)
    drawn = critical_map(model, (1000, 20_000)).axes[0]
    assert (drawn.get_xscale(), drawn.get_yscale(), drawn.get_ylim()) == ("log", "log", (1000, 20_000))
    marks = [line.get_xydata()[0] for line in drawn.lines if line.get_marker() == "o"]
    np.testing.assert_allclose(marks, [[model.springs[0], model.critical_speed_rpm]])
