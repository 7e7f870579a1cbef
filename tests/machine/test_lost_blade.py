"""A blade that is lost as a whole: mass, place of the disk, contact, sensors, mistakes."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.export.machine_modes import modes_of
from rubgen.machine import Machine, Unbalance, load_machine
from rubgen.machine.faults.cracked_blade import CrackedBlade
from rubgen.machine.faults.lost_blade import LostBlade
from rubgen.machine.mass import blade_mass
from rubgen.measurement.motion import motion_frames
from rubgen.pipeline import simulate
from rubgen.reduction import ReducedModel, reduce
from rubgen.reduction.modes import blisk_modes
from rubgen.scenario import Reduction, make_scenario
from rubgen.scenario.checks.feasible import SENSOR_PROBLEMS
from rubgen.sensors.kinds.blade_strain import BladeStrain
from rubgen.sensors.kinds.blade_tip_timing import TimingProbe
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.viz.entities.machine_shape import blade_leanings, drawing_factor, drawn_tips

BLADE = 9
LOST = {"fault": "lost-blade", "blade": BLADE}
TIP = slice(3 * BLADE, 3 * BLADE + 3)


@pytest.fixture(scope="module")
def preset() -> Machine:
    return load_machine("zeng2019")


@pytest.fixture(scope="module")
def lost(preset) -> ReducedModel:
    return reduce(replace(preset, faults=(LostBlade(blade=BLADE),)), Reduction())


@pytest.fixture(scope="module")
def run():
    timing = TimingProbe(name="timing", angle_deg=20)
    scenario = make_scenario(
        speed_rpm=9000, free_penetration_m=3e-5, lyapunov=False, settle_turns=60, signal_seconds=0.2,
        **LOST,
    )  # fmt: skip
    sensors = replace(scenario.sensing.set, sensors=(*scenario.sensing.set.sensors, timing))
    return simulate(replace(scenario, sensing=replace(scenario.sensing, set=sensors)))


def test_the_mass_of_a_blade_is_missing_and_its_place_is_coupled_with_nothing(preset, lost):
    whole = reduce(preset, Reduction())
    assert whole.blisk_mass - lost.blisk_mass == pytest.approx(blade_mass(preset.blades), rel=2e-3)
    system = lost.at_speed(900.0)
    for matrix in (system.M, system.C, system.K):
        assert not np.delete(matrix[TIP], range(TIP.start, TIP.stop), axis=1).any()
        assert not np.delete(matrix[:, TIP], range(TIP.start, TIP.stop), axis=0).any()
    assert not system.force[TIP].any()
    assert not rub_free_motion(system).at(0.3)[TIP].any()


def test_gravity_pulls_at_what_is_there(preset):
    model = reduce(replace(preset, gravity_m_per_s2=9.81, faults=(LostBlade(blade=BLADE),)), Reduction())
    turning = model.at_speed(900.0).turning
    assert turning is not None
    assert turning.weight is not None
    assert not turning.weight[TIP].any()


def test_euler_force_and_pull_are_those_of_the_unbalance(lost):
    """At O_d, Omega' U stands across Omega^2 U: both are sums over the same masses, so they agree in size and sense."""
    speed, push = 90.0, 5.0
    steady, pushed = (lost.at_speed(speed, rate).force for rate in (0.0, push))
    shifts = np.zeros((len(steady), 2))
    angle = 2 * np.pi * np.arange(36) / 36
    shifts[:108:3, 0], shifts[1:108:3, 0], shifts[:108:3, 1], shifts[1:108:3, 1] = (
        np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle),
    )  # fmt: skip
    shifts[108:110] = np.eye(2)
    shifts[TIP] = 0.0
    of_speed, of_push = shifts.T @ steady / speed**2, shifts.T @ (pushed - steady) / push
    assert of_push == pytest.approx([of_speed[1], -of_speed[0]], rel=1e-4, abs=1e-6 * np.hypot(*of_speed))


def test_no_list_of_modes_has_modes_of_a_lost_blade(preset, lost):
    size = len(lost.blisk.M) - 3
    assert lost.blisk_frequencies_hz().size == lost.blisk_frequencies_hz(900.0).size == size
    casing = len(lost.casing.frequencies_hz)
    assert len(modes_of(lost, 1e9)) == size + casing
    assert len(blisk_modes(lost, 900.0)) == size
    assert len(modes_of(reduce(preset, Reduction()), 1e9)) == size + 3 + casing


def test_the_other_blades_rub_and_the_lost_one_touches_and_passes_nothing(run):
    touched = np.bincount(run.response.events.blade, minlength=36)
    assert touched.sum() > 10
    assert not touched[BLADE]
    assert run.response.energy.residual < 1e-11
    passed = np.bincount(run.recording.tip_timing["timing"].blade, minlength=36)
    assert not passed[BLADE]
    assert np.delete(passed, BLADE).min() >= 29  # 0.2 s at 150 Hz


def test_pictures_leave_the_lost_blade_away(preset, run):
    frames = motion_frames(run.response, run.recording)
    assert frames is not None
    machine = replace(preset, faults=(LostBlade(blade=BLADE, lost_count=2),))
    leanings = blade_leanings(machine, frames, 5.0)
    assert not leanings[:, BLADE : BLADE + 2].any()
    assert leanings[:, BLADE + 2].any()
    places = drawn_tips(machine, frames, 5.0)[:, BLADE]
    assert np.hypot(*places.T) == pytest.approx(preset.disk.rim_radius_m)
    assert drawing_factor(machine, frames) > drawing_factor(preset, frames)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"blade": 36}, "faults: lost-blade: blade = 36: there is no such blade; give 0 to 35"),
        ({"lost_count": 10}, "faults: lost-blade: lost_count = 10: a quarter of 36 blades"),
    ],
)
def test_what_a_machine_cannot_lose(keys, message):
    with pytest.raises(UserError, match=message):
        make_scenario(**LOST | keys)


def test_nothing_is_put_on_a_lost_blade(preset):
    heavy = replace(preset, unbalances=(Unbalance(kg_m=1e-4, blade=BLADE),))
    assert "an unbalance of the machine is on the lost blade 9" in (
        LostBlade(blade=8, lost_count=2).problem(heavy) or ""
    )
    machine = replace(preset, faults=(LostBlade(blade=BLADE), CrackedBlade(stiffness_loss=0.1, blade=8)))
    assert machine.faults[1].problem(machine) is None
    taken = CrackedBlade(stiffness_loss=0.1, blade=BLADE).problem(machine)
    assert taken == "blade = 9: the fault lost-blade has taken this blade; give another one"
    assert machine.lost_blades == (9,)
    gauge = BladeStrain(name="gauge", blade=BLADE)
    scenario = make_scenario(**LOST)
    sensors = replace(scenario.sensing.set, sensors=(gauge,))
    found = [check(replace(scenario, sensing=replace(scenario.sensing, set=sensors))) for check in SENSOR_PROBLEMS]
    assert "the fault lost-blade has taken this blade" in str(found)
