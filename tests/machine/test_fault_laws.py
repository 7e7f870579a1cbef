"""What each kind of fault gives the solver, by the formulas of its own description and nothing else."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.machine import load_machine
from rubgen.machine.faults.bow import Bow
from rubgen.machine.faults.casing_off_centre import CasingOffCentre
from rubgen.machine.faults.closing_clearance import ClosingClearance
from rubgen.machine.faults.cracked_blade import CrackedBlade
from rubgen.machine.faults.fault import HarmonicLoad, Ramp
from rubgen.machine.faults.growing_unbalance import GrowingUnbalance
from rubgen.machine.faults.lost_blade import LostBlade
from rubgen.machine.faults.lost_tip import LostTip
from rubgen.machine.faults.misalignment import Misalignment
from rubgen.machine.faults.oil_whirl import OilWhirl
from rubgen.machine.faults.registry import FAULTS
from rubgen.machine.mass import blade_mass, blisk_mass
from rubgen.machine.mesh import disk_nodes, node_problem, pitch_problem
from rubgen.machine.published import BLISK_HZ, CASING_HZ, blisk_deviation, casing_deviation
from rubgen.scenario import make_scenario

SPEED, THETA = 900.0, np.linspace(0, 2 * np.pi, 50)


@pytest.fixture(scope="module")
def machine():
    return load_machine("zeng2019")


def force_at(loads, theta):
    """F_X + i F_Y (angles,) of loads in the inertial frame."""
    turns = [np.exp(1j * load.order * theta) for load in loads]
    x = sum((load.x * turn).real for load, turn in zip(loads, turns, strict=True))
    return x + 1j * sum((load.y * turn).real for load, turn in zip(loads, turns, strict=True))


def test_a_rotating_load_has_one_size_and_turns_with_the_shaft():
    load = HarmonicLoad.rotating(3 - 4j)
    np.testing.assert_allclose(force_at((load,), THETA), (3 - 4j) * np.exp(1j * THETA), atol=1e-12)


@pytest.mark.parametrize("angle", [0.0, 90.0, 217.0])
def test_an_unbalance_that_grows_pulls_outward_with_the_square_of_the_speed(machine, angle):
    fault = GrowingUnbalance(kg_m=2e-3, angle_deg=angle, start_s=0.5, growth_s=2.0)
    (load,) = fault.loads(machine, SPEED)
    expected = 2e-3 * SPEED**2 * np.exp(1j * (THETA + np.deg2rad(angle)))
    np.testing.assert_allclose(force_at((load,), THETA), expected, atol=1e-9)
    (fast,) = fault.loads(machine, 2 * SPEED)
    assert abs(fast.x) == pytest.approx(4 * abs(load.x), rel=1e-12)
    assert (load.ramp, load.of_springs) == (Ramp(start_s=0.5, duration_s=2.0), False)


def test_a_bow_is_the_force_of_the_springs_at_any_speed(machine):
    stiffness = machine.disk_support.lateral_stiffness_n_per_m
    for speed in (10.0, SPEED):
        (load,) = Bow(bow_m=3e-5, angle_deg=60.0).loads(machine, speed)
        expected = stiffness * 3e-5 * np.exp(1j * (THETA + np.pi / 3))
        np.testing.assert_allclose(force_at((load,), THETA), expected, rtol=1e-12)
        assert (load.ramp, load.of_springs) == (None, True)
    (thermal,) = Bow(bow_m=3e-5, start_s=1.0, growth_s=4.0).loads(machine, SPEED)
    assert thermal.ramp == Ramp(start_s=1.0, duration_s=4.0)


def test_a_coupling_pushes_along_the_misalignment_with_its_shares(machine):
    fault = Misalignment(
        parallel_m=1e-4, angular_deg=0.2, direction_deg=130.0, coupling_stiffness_n_per_m=3e7, coupling_length_m=0.2,
        share_1x=0.1, share_2x=0.4, share_3x=0.05,
    )  # fmt: skip
    reaction = 3e7 * (1e-4 + np.deg2rad(0.2) * 0.2 / 2)
    size = reaction * (1 + 0.1 * np.cos(THETA) + 0.4 * np.cos(2 * THETA) + 0.05 * np.cos(3 * THETA))
    found = force_at(fault.loads(machine, SPEED), THETA)
    np.testing.assert_allclose(found, size * np.exp(1j * np.deg2rad(130.0)), rtol=1e-12)
    assert fault.severity == pytest.approx(reaction / 3e7)
    np.testing.assert_allclose(force_at(fault.loads(machine, 2 * SPEED), THETA), found, rtol=1e-14)


def test_a_ramp_is_linear_between_its_ends_and_sudden_without_a_length():
    time = np.array([-1.0, 0.4999, 0.5, 1.0, 2.5, 9.0])
    np.testing.assert_allclose(Ramp(start_s=0.5, duration_s=2.0).share(time), [0, 0, 0, 0.25, 1, 1], atol=1e-12)
    np.testing.assert_array_equal(Ramp(start_s=0.5, duration_s=0.0).share(time), [0, 0, 1, 1, 1, 1])


def test_faults_of_the_casing_change_its_radius_and_nothing_else(machine):
    (wave,) = CasingOffCentre(offset_m=2e-4, direction_deg=200.0).surface_harmonics(machine)
    assert (wave.order, wave.amplitude_m, wave.phase_rad) == (1, 2e-4, pytest.approx(np.deg2rad(200.0)))
    (closing,) = ClosingClearance(closing_m=3e-4, start_s=0.2, growth_s=0.7).narrowings(machine)
    assert (closing.amount_m, closing.ramp) == (3e-4, Ramp(start_s=0.2, duration_s=0.7))


NEEDED = {
    "misalignment": {"parallel_m": 1e-4}, "bow": {"bow_m": 1e-5}, "casing-off-centre": {"offset_m": 1e-4},
    "growing-unbalance": {"kg_m": 1e-3}, "closing-clearance": {"closing_m": 1e-4}, "bearing-defect": {"width_m": 1e-3},
    "loose-support": {"lost_stiffness": 0.3}, "oil-whirl": {}, "crack": {"crack_loss": 0.2},
    "cracked-blade": {"stiffness_loss": 0.1}, "lost-tip": {"lost_kg": 1e-3}, "lost-blade": {},
}  # fmt: skip
WAYS = {
    "misalignment": {"loads"}, "bow": {"loads"}, "growing-unbalance": {"loads"}, "oil-whirl": {"support_laws"},
    "crack": {"support_laws"}, "loose-support": {"support_laws"}, "casing-off-centre": {"surface_harmonics"},
    "closing-clearance": {"narrowings"}, "lost-tip": {"lost_masses"}, "lost-blade": {"lost_blades"},
    "cracked-blade": {"altered"}, "bearing-defect": {"strikes"},
}  # fmt: skip
"""The one way in which each kind of fault acts."""


@pytest.mark.parametrize("kind", FAULTS)
def test_a_fault_acts_in_its_own_way_alone(machine, kind):
    """A fault that is not there has the severity 0, so every fault that is there has another."""
    fault = FAULTS[kind](**NEEDED[kind])
    rng = np.random.default_rng(0)
    found = {
        "loads": fault.loads(machine, SPEED),
        "support_laws": fault.support_laws(machine, SPEED),
        "surface_harmonics": fault.surface_harmonics(machine),
        "narrowings": fault.narrowings(machine),
        "lost_masses": fault.lost_masses(machine),
        "lost_blades": fault.lost_blades(machine),
        "altered": fault.altered(machine) != machine,
        "strikes": fault.strikes(np.linspace(0, 50, 900), np.full(900, SPEED), rng) is not None,
    }
    assert {way for way, given in found.items() if given} == WAYS[kind]
    assert fault.severity > 0


def test_oil_whirl_begins_where_the_swirl_drives_as_much_as_the_damper_takes(machine):
    """Muszynska: at Omega = sqrt(k_f / m) / ratio the cross-coupled stiffness is c times the whirl's frequency."""
    fault = OilWhirl(swirl_ratio=0.45, film_stiffness=0.2)
    mass, stiffness = blisk_mass(machine), machine.disk_support.lateral_stiffness_n_per_m
    whirl = math.sqrt(0.2 * stiffness / mass)
    (law,) = fault.support_laws(machine, whirl / 0.45)
    damper = 2 * machine.damping.lateral * math.sqrt(stiffness * mass)
    assert law.swirl_n_per_m == pytest.approx(damper * whirl, rel=1e-12)
    assert stiffness - law.soft_n_per_m == pytest.approx(mass * whirl**2, rel=1e-12)


def test_a_cracked_blade_keeps_its_share_of_what_mistuning_left_it(machine):
    tuned = replace(machine, blades=replace(machine.blades, mistuning=None))
    once = CrackedBlade(stiffness_loss=0.2, blade=4).altered(tuned)
    twice = CrackedBlade(stiffness_loss=0.5, blade=4).altered(once)
    assert once.blades.stiffness_deviations[4] == pytest.approx(-0.2)
    assert twice.blades.stiffness_deviations[4] == pytest.approx(0.8 * 0.5 - 1)
    assert not any(twice.blades.stiffness_deviations[k] for k in range(36) if k != 4)


def test_lost_blades_follow_each_other_over_the_last_one(machine):
    assert LostBlade(lost_count=3, blade=34).lost_blades(machine) == (34, 35, 0)
    assert LostBlade(lost_count=9).problem(machine) is None
    assert "a quarter of 36 blades" in LostBlade(lost_count=10).problem(machine)
    assert "there is no such blade; give 0 to 35" in LostBlade(blade=36).problem(machine)


def test_no_more_than_an_eighth_of_a_blade_is_lost_at_its_tip(machine):
    most = blade_mass(machine.blades) / 8
    assert LostTip(lost_kg=0.999 * most).problem(machine) is None
    assert "an eighth of a blade" in LostTip(lost_kg=1.001 * most).problem(machine)
    assert "there is no such blade" in LostTip(lost_kg=1e-4, blade=36).problem(machine)
    (lost,) = LostTip(lost_kg=1e-4, blade=7).lost_masses(machine)
    assert (lost.blade, lost.kg) == (7, 1e-4)
    gone = replace(machine, faults=(LostBlade(blade=7),))
    assert "the fault lost-blade has taken this blade" in LostTip(lost_kg=1e-4, blade=7).problem(gone)


def test_a_fault_without_its_size_is_refused():
    with pytest.raises(UserError, match="must have parallel_m or angular_deg; give one or both"):
        make_scenario(fault="misalignment", direction_deg=10.0)


@pytest.mark.parametrize(("blades", "elements"), [(36, 70), (36, 20), (7, 72), (25, 3), (2, 3)])
def test_the_mesh_that_a_message_proposes_is_none_that_it_refuses(machine, blades, elements):
    disk, row = replace(machine.disk, circumferential_elements=elements), replace(machine.blades, count=blades)
    problem = pitch_problem(disk, row)
    assert problem.startswith(f"disk.circumferential_elements = {elements}: must be a multiple")
    proposed = int(problem.rsplit(" ", 1)[1])
    assert abs(proposed - elements) <= blades
    assert pitch_problem(replace(disk, circumferential_elements=proposed), row) is None


@pytest.mark.parametrize(("lobes", "nodes"), [(2, 181), (3, 100), (5, 12), (7, 180)])
def test_the_ring_that_a_message_proposes_is_none_that_it_refuses(machine, lobes, nodes):
    casing = replace(machine.casing, lobes=lobes, nodes=nodes)
    problem = node_problem(casing)
    assert problem.startswith(f"casing.nodes = {nodes}: must be divisible by 4 and by casing.lobes = {lobes}")
    proposed = int(problem.rsplit(" ", 1)[1])
    assert node_problem(replace(casing, nodes=proposed)) is None
    assert 12 <= proposed <= nodes + 4 * lobes


def test_nodes_of_the_disks_mesh_are_counted_as_it_has_them(machine):
    """Eight-node elements: corners and mid-sides, each once."""
    for radial, around in ((1, 4), (3, 36)):
        disk = replace(machine.disk, radial_elements=radial, circumferential_elements=around)
        corners, arcs, spokes = (radial + 1) * around, (radial + 1) * around, radial * around
        assert disk_nodes(disk) == corners + arcs + spokes


def test_deviations_are_relative_and_of_the_mode_that_was_published():
    frequencies = [1.02 * BLISK_HZ.get(mode, 1.0) for mode in range(1, 43)]
    found = blisk_deviation(frequencies)
    assert list(found) == list(BLISK_HZ)
    assert list(found.values()) == pytest.approx([0.02] * len(BLISK_HZ))
    assert list(blisk_deviation(frequencies[:4])) == [1, 2, 3, 4]
    few = casing_deviation([0.5 * hz for hz in CASING_HZ[:3]])
    assert few == {mode: pytest.approx(-0.5) for mode in (1, 2, 3)}
