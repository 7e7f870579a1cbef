"""What is drawn is where it is, its deviations from the tip circle multiplied by one factor."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.machine.faults.casing_off_centre import CasingOffCentre
from rubgen.machine.faults.closing_clearance import ClosingClearance
from rubgen.reduction.casing import reduce_casing
from rubgen.viz.entities.machine_shape import (
    DRAWN_SHARE,
    STATIONS,
    blade_leanings,
    blade_mesh,
    blade_placements,
    casing_angles,
    casing_curve,
    casing_radius,
    disk_mesh,
    drawing_factor,
    drawn_tips,
    plate_mesh,
    plate_shapes,
    spring,
    undeformed_curve,
)
from rubgen.viz.replay import replay_of

FACTOR = 10.0


@pytest.fixture(scope="module")
def machine():
    return load_machine("zeng2019")


@pytest.fixture(scope="module")
def frames(rub_run):
    return replay_of(rub_run).frames


def volume(mesh):
    """By the divergence theorem, with the triangles turned as their normals say."""
    a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    outward = np.sign(np.sum(across * mesh.normals[mesh.triangles].mean(axis=1), axis=1))
    return float(np.sum(outward * np.sum(a * across, axis=1)) / 6)


def test_the_drawn_disk_has_the_disks_volume(machine):
    disk = machine.disk
    r1, r2, h1, h2 = disk.bore_radius_m, disk.rim_radius_m, disk.bore_thickness_m, disk.rim_thickness_m
    slope = (h2 - h1) / (r2 - r1)
    exact = 2 * np.pi * ((h1 - slope * r1) * (r2**2 - r1**2) / 2 + slope * (r2**3 - r1**3) / 3)
    polygon = np.sin(2 * np.pi / 72) / (2 * np.pi / 72)
    assert volume(disk_mesh(disk)) == pytest.approx(exact * polygon, rel=1e-12)


def test_a_drawn_blade_has_nearly_the_blades_volume_and_its_length(machine):
    blades, mesh = machine.blades, blade_mesh(machine.blades)
    area = np.array([blades.root_chord_m * blades.root_thickness_m, blades.tip_chord_m * blades.tip_thickness_m])
    middle = (blades.root_chord_m + blades.tip_chord_m) * (blades.root_thickness_m + blades.tip_thickness_m) / 4
    exact = blades.length_m * (area[0] + 4 * middle + area[1]) / 6
    # The root's own face is left out: it lies on x = 0 and adds nothing. Flat triangles on a twisted face stand out.
    assert exact < volume(mesh) < 1.06 * exact
    assert mesh.vertices[:, 0].max() == blades.length_m
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1)


def test_a_plate_is_a_unit_box_and_plates_close_the_casing(machine):
    assert volume(plate_mesh()) == pytest.approx(1.0)
    shapes = plate_shapes(machine, FACTOR)
    assert np.all(np.linalg.det(shapes) > 0)
    length = np.linalg.norm(shapes[:, :2, 1], axis=1)
    assert length.sum() == pytest.approx(2 * np.pi * machine.tip_radius_m * 1.12, rel=0.03)


def test_leaning_blades_end_at_the_drawn_tips(machine, frames):
    leanings, tips = blade_leanings(machine, frames, FACTOR), drawn_tips(machine, frames, FACTOR)
    ends = np.einsum("fkab,b->fka", leanings, [machine.blades.length_m, 0.0, 0.0]) + blade_placements(machine)
    ends[..., :2] += FACTOR * frames.centre[:, None, :]
    turn = frames.angle[:, None]
    x = np.cos(turn) * ends[..., 0] - np.sin(turn) * ends[..., 1]
    y = np.sin(turn) * ends[..., 0] + np.cos(turn) * ends[..., 1]
    np.testing.assert_allclose(np.stack([x, y], axis=-1), tips, rtol=0, atol=1e-12)


def test_the_drawn_clearance_is_the_true_one_times_the_factor(machine, frames):
    """At a factor of one the drawing is the machine itself, and differences grow by the factor."""
    angle = casing_angles()
    assert angle.size == STATIONS
    open_ = np.zeros(frames.time.size)
    true, drawn = (np.hypot(*np.moveaxis(casing_curve(machine, frames, angle, f, open_), -1, 0)) for f in (1.0, FACTOR))
    grown = machine.tip_radius_m + FACTOR * (true - machine.tip_radius_m)
    np.testing.assert_allclose(drawn, grown, rtol=0, atol=2e-3 * machine.tip_radius_m)
    nodes = len(frames.casing_modes)
    at_zero = np.hypot(
        *(np.array([machine.tip_radius_m + machine.casing.clearance_m, 0]) + frames.casing_modes[0] @ frames.casing[0])
    )
    assert true[0, 0] == pytest.approx(at_zero, rel=1e-12)
    assert nodes == 60


def test_the_factor_is_one_two_or_five_times_a_power_of_ten(machine, frames):
    factor = drawing_factor(machine, frames)
    assert factor == 10.0
    assert drawing_factor(machine, None) == 10.0


def test_the_drawn_surface_is_that_of_the_contact_also_off_centre(machine):
    """Tips that touch on one side touch there in the picture too."""
    moved = replace(machine, faults=(CasingOffCentre(offset_m=4e-4, direction_deg=70.0),))
    angle = np.linspace(0, 2 * np.pi, 100)
    for each in (machine, moved):
        surface = reduce_casing(each, 11).surface
        waves = np.cos(surface.order * (angle[:, None] - surface.phase))
        expected = surface.mean_radius + waves @ surface.amplitude
        np.testing.assert_allclose(casing_radius(each, angle), expected, rtol=1e-14)
        place = undeformed_curve(each, angle, 1.0)
        np.testing.assert_allclose(np.hypot(*place.T), expected, rtol=1e-14)


def test_a_far_casing_is_enlarged_less(machine):
    far = replace(machine, faults=(CasingOffCentre(offset_m=1e-2),))
    assert drawing_factor(far, None) == 2.0 < drawing_factor(machine, None)
    assert 2.0 * 1e-2 < DRAWN_SHARE * machine.tip_radius_m < 5.0 * 1e-2


def test_the_drawn_casing_closes_with_the_clearance(rub_run):
    """The true gap between tip and casing at each frame, from the fault's own ramp over the record."""
    fault = ClosingClearance(closing_m=2e-4, start_s=0.05, growth_s=0.4)
    whole = replay_of(rub_run)
    closing = replace(whole.scenario, machine=replace(whole.scenario.machine, faults=(fault,)))
    replay, angle = replace(whole, scenario=closing), casing_angles()
    time = whole.frames.time + whole.recording.start_seconds
    expected = 2e-4 * np.clip((time - 0.05) / 0.4, 0, 1)
    assert np.ptp(expected) > 1e-5
    before, after = (
        casing_curve(each.scenario.machine, each.frames, angle, FACTOR, each.closed) for each in (whole, replay)
    )
    inward = np.sum((before - after) * np.column_stack([np.cos(angle), np.sin(angle)]), axis=-1)
    np.testing.assert_allclose(inward, FACTOR * np.broadcast_to(expected[:, None], inward.shape), rtol=1e-9)
    assert not whole.closed.any()
    assert replace(replay, frames=None).closed.size == 0


def test_a_spring_goes_from_end_to_end():
    line = spring(np.array([1.0, 0.0, 0.0]), np.array([2.0, 0.0, 0.0]))
    assert line[0].tolist() == [1, 0, 0]
    assert line[-1].tolist() == [2, 0, 0]
