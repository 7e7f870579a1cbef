"""Faults in the reduced model and in runs without rub, beside closed forms and a plain integration."""

from dataclasses import replace
from inspect import signature

import numpy as np
import pytest
from pydantic import TypeAdapter

from rubgen.errors import RubgenWarning, UserError
from rubgen.labels.compact_record import compact_record
from rubgen.labels.faults import fault_labels
from rubgen.labels.labels import Motion
from rubgen.labels.to_json import labels_to_json, remade_labels
from rubgen.machine import Machine, Mistuning, load_machine
from rubgen.machine.faults.bow import Bow
from rubgen.machine.faults.cracked_blade import CrackedBlade
from rubgen.machine.faults.fault import HarmonicLoad
from rubgen.machine.faults.lost_tip import LostTip
from rubgen.machine.faults.misalignment import Misalignment
from rubgen.machine.faults.registry import FAULTS
from rubgen.machine.load import machine_id
from rubgen.pipeline import simulate
from rubgen.reduction import reduce
from rubgen.reduction.fault_loads import turning_harmonics
from rubgen.scenario import ContactLaw, Operation, make_scenario
from rubgen.scenario.faults import FAULT_KEYS
from rubgen.scenario.scenario import Reduction, scenario_dict
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.wants import Wants
from rubgen.units import rad_per_s


@pytest.fixture(scope="module")
def preset():
    return load_machine("zeng2019")


def test_loads_are_the_same_force_in_both_frames():
    rng = np.random.default_rng(0)
    loads = [HarmonicLoad(order=k, x=complex(*rng.normal(size=2)), y=complex(*rng.normal(size=2))) for k in range(4)]
    p = turning_harmonics(loads)
    for theta in rng.uniform(0, 2 * np.pi, 5):
        F = sum((np.array([load.x, load.y]) * np.exp(1j * load.order * theta)).real for load in loads)
        turned = np.array([[np.cos(theta), np.sin(theta)], [-np.sin(theta), np.cos(theta)]]) @ F
        np.testing.assert_allclose((np.exp(1j * theta * np.arange(len(p))) @ p).real, turned, rtol=1e-13)
    rotating = turning_harmonics([HarmonicLoad.rotating(2 + 3j)])
    np.testing.assert_allclose(rotating[0].real, [2, 3])
    assert not rotating[1:].any()


def test_a_machine_without_faults_is_as_before(preset):
    assert "faults" not in TypeAdapter(Machine).dump_python(preset, mode="json")
    scenario = make_scenario(speed_rpm=9000)
    document = scenario_dict(scenario)
    assert "faults" not in document["machine"]
    assert "fault_kinds" not in document
    bent = make_scenario(speed_rpm=9000, fault="bow", bow_m=1e-5)
    assert scenario_dict(bent)["machine"]["faults"] == [
        {"kind": "bow", "bow_m": 1e-5, "angle_deg": 0.0, "start_s": 0.0, "growth_s": None}
    ]
    assert machine_id(bent.machine) != machine_id(preset)


def test_keys_of_faults_are_no_keys_of_a_run():
    assert not set(FAULT_KEYS) & set(signature(make_scenario).parameters)
    columns = [kind.SEVERITY.column for kind in FAULTS.values()]
    assert len(set(columns)) == len(columns)


def test_a_run_keeps_the_motion_of_a_misaligned_shaft_and_books_its_work(preset):
    """The coupling's force at orders 0 to 3 through the receptance of the inertial frame, found in a run."""
    fault = Misalignment(parallel_m=6e-5, angular_deg=0.05, direction_deg=30.0)
    scenario = make_scenario(speed_rpm=9000, clearance_m=4e-3, signal_seconds=0.05, lyapunov=False)
    scenario = replace(scenario, machine=replace(scenario.machine, faults=(fault,)))
    run = simulate(scenario)
    assert run.response.energy.residual < 1e-10
    assert abs(run.response.energy.faults) > 1e-3 * run.response.energy.absolute_work
    assert run.labels.motion.value == "period-1"
    turn = run.response.steps_per_turn
    x = np.fft.rfft(run.response.taps["blisk_x"][-turn:]) / turn * 2
    y = np.fft.rfft(run.response.taps["blisk_y"][-turn:]) / turn * 2
    reaction = fault.coupling_stiffness_n_per_m * fault.severity
    assert fault.severity == pytest.approx(6e-5 + np.deg2rad(0.05) * 0.1 / 2)
    for order, share in ((2, 0.5), (3, 0.1)):
        assert np.hypot(abs(x[order]), abs(y[order])) > 0.1 * share * reaction / 1e8
    assert abs(x[2] / y[2]) == pytest.approx(1 / np.tan(np.deg2rad(30)), rel=0.02)  # along the misalignment
    healthy = simulate(replace(scenario, machine=replace(scenario.machine, faults=())))
    orders = np.abs(np.fft.rfft(healthy.response.taps["blisk_x"][-turn:])) / turn * 2
    assert orders[2:4].max() < 1e-9 * orders[1]  # rounding makes the reduced blisk uneven by up to 1e-10
    assert orders[2] < 1e-6 * abs(x[2])


def test_a_bow_is_followed_at_slow_roll_without_force_on_the_support():
    scenario = make_scenario(speed_rpm=60, unbalance_kg_m=0, sample_rate_hz=1000, fault="bow", bow_m=2e-5, angle_deg=90)
    system = reduce(scenario.machine, Reduction()).at_speed(rad_per_s(60))
    q = rub_free_motion(system).at(0.0)
    assert q[system.centre : system.centre + 2] == pytest.approx([0, 2e-5], abs=1e-7)
    response = integrate(
        system, Operation(speed_rpm=60, settle_turns=1, record_turns=1, closing_turns=1), ContactLaw(), Wants()
    )
    assert np.abs(response.taps["support_force_x"]).max() < 1e-3 * 1e8 * 2e-5


def test_a_casing_off_centre_is_rubbed_on_one_side():
    """Two narrow places of the oval at 0 and 180 degrees; an offset to 0 degrees leaves the rub at 180."""
    keys = {"speed_rpm": 8600, "clearance_m": 7.2e-4, "signal_seconds": 0.2, "lyapunov": False}
    centred, moved = (simulate(make_scenario(**keys, **more)).labels for more in ({}, OFF_CENTRE))
    assert centred.contact_zones == 2
    assert moved.contact_zones == 1
    assert np.degrees(moved.contact_zone_centres[0]) == pytest.approx(180, abs=8)
    assert centred.orders["contact_force"].odd_share < 0.02 < 0.2 < moved.orders["contact_force"].odd_share


OFF_CENTRE = {"fault": "casing-off-centre", "offset_m": 1e-4, "direction_deg": 0.0}
CLOSING = {"fault": "closing-clearance", "closing_m": 2e-4, "start_s": 0.1, "growth_s": 0.2}
WAYS = {"steady": {}, "run-up": {"profile": "run-up", "end_speed_rpm": 9010, "duration_s": 0.5}}


@pytest.mark.parametrize("way", WAYS)
def test_a_clearance_closes_when_it_should(way):
    """The true clearance at two rays, beside that of the same run without the fault."""
    keys = {"speed_rpm": 9000, "clearance_m": 3e-3, "signal_seconds": 0.45, "lyapunov": False, "settle_turns": 60}
    keys |= WAYS[way]
    sound, closing = (simulate(make_scenario(**keys, **more)).response for more in ({}, CLOSING))
    steps = closing.record_steps
    for tap in ("tip_clearance_0", "tip_clearance_90"):
        closed = (sound.taps[tap] - closing.taps[tap])[-steps:]
        time = (steps - len(closed) + np.arange(len(closed))) * closing.dt
        np.testing.assert_allclose(closed, 2e-4 * np.clip((time - 0.1) / 0.2, 0, 1), atol=1e-9)
    assert closing.energy.residual < 1e-10


def test_a_rub_begins_where_the_closed_clearance_is_used_up():
    scenario = make_scenario(speed_rpm=9000, clearance_m=9e-4, lyapunov=False, signal_seconds=0.2, **LATE)
    run = simulate(scenario)
    gap = -run.response.free_penetration
    assert gap > 5e-5
    labels = fault_labels(scenario, run.response)
    assert labels["rub_onset_s"] == pytest.approx(0.5 + 1.5 * gap / 6e-4, abs=60 / 9000)
    assert labels["clearance_closing_m"] == 6e-4
    assert run.labels.rub


def test_a_rub_that_begins_within_the_record_has_no_class_of_motion():
    """The rub itself repeats every turn; the record around its onset looks chaotic to the section."""
    keys = {"speed_rpm": 10_500, "signal_seconds": 0.2}
    closing = {"fault": "closing-clearance", "closing_m": 1.75e-3, "start_s": 0.1, "growth_s": 1.0, "clearance_m": 2e-3}
    assert simulate(make_scenario(**keys)).labels.motion is Motion.PERIOD_1
    run = simulate(make_scenario(**keys, **closing))
    assert run.labels.rub
    assert (run.labels.motion, run.labels.motion_casing) == (Motion.UNDECIDED, Motion.UNDECIDED)
    assert run.labels.lyapunov is None
    assert run.response.companion_growth.size == 0
    stored = labels_to_json(run.labels)
    assert remade_labels(compact_record(run.response)).items() <= stored.items()
    with pytest.warns(RubgenWarning, match="it never begins"):
        scenario = make_scenario(**keys, **closing | {"start_s": 1e3, "clearance_m": 2.5e-4})
    later = simulate(scenario)
    assert later.labels.motion is not Motion.UNDECIDED
    assert later.labels.lyapunov is not None


LATE = {"fault": "closing-clearance", "closing_m": 6e-4, "start_s": 0.5, "growth_s": 1.5}


def test_a_cracked_blade_is_the_mistuned_blade_with_that_stiffness(preset):
    """The same machine from two keys, and an own line below the family of the other blades."""
    cracked = reduce(replace(preset, faults=(CrackedBlade(stiffness_loss=0.2, blade=3),)), Reduction())
    softer = Mistuning(pattern=tuple(-0.2 * (k == 3) for k in range(36)))
    mistuned = reduce(replace(preset, blades=replace(preset.blades, mistuning=softer)), Reduction())
    np.testing.assert_array_equal(cracked.blisk.K, mistuned.blisk.K)
    lines = cracked.blisk_frequencies_hz()
    assert np.count_nonzero((lines > 138) & (lines < 142)) == 1
    growth = cracked.at_speed(900.0).tip_static[:, 0]
    assert np.argmax(growth) == 3


def test_a_lost_tip_is_a_mass_that_is_missing_in_every_term(preset):
    """A rigid turn of all feels m r^2 less, and a run keeps its motion and books its works."""
    radius, lost, count = preset.tip_radius_m, 5e-3, 36
    whole, light = (
        reduce(replace(preset, faults=faults), Reduction()) for faults in ((), (LostTip(lost_kg=lost, blade=3),))
    )
    assert whole.blisk_mass - light.blisk_mass == pytest.approx(lost, rel=1e-9)
    speed, push = 900.0, 50.0
    pulls = [model.at_speed(speed, push).force for model in (whole, light)]
    missing = pulls[1] - pulls[0]
    static = whole.at_speed(speed).tip_static[3]
    assert missing[9:12] == pytest.approx(
        [-lost * (radius + static[0]) * speed**2, -lost * static[1] * speed**2 + lost * radius * push, 0], rel=1e-9
    )
    assert not missing[12 : 3 * count].any()
    scenario = make_scenario(speed_rpm=9000, clearance_m=2e-3, lyapunov=False, signal_seconds=0.1, **LOST)
    run = simulate(scenario)
    assert run.response.energy.residual < 1e-11
    assert run.labels.motion.value == "period-1"


LOST = {"fault": "lost-tip", "lost_kg": 5e-3, "blade": 3}


def test_a_machine_has_each_fault_once(preset):
    twice = (Bow(bow_m=1e-6), Bow(bow_m=2e-6))
    with pytest.raises(ValueError, match="faults: bow stands twice"):
        replace(preset, faults=twice)
    with pytest.raises(UserError, match="the machine has this fault already"):
        make_scenario(fault=["bow", "bow"], bow_m=1e-6)


def test_healthy_is_a_machine_without_a_fault_and_without_a_rub():
    keys = {"speed_rpm": 10_500, "signal_seconds": 0.2, "lyapunov": False}
    found = {}
    for name, more in {"rub": {}, "air": {"clearance_m": 2e-3}}.items():
        scenario = replace(make_scenario(**keys, **more), fault_kinds=("bow",))
        found[name] = fault_labels(scenario, simulate(scenario).response)
    assert [each["healthy"] for each in found.values()] == [False, True]
    assert [each["faults"] for each in found.values()] == [[], []]
    assert [each["bow_m"] for each in found.values()] == [0.0, 0.0]
    bent = make_scenario(**keys, clearance_m=2e-3, fault="bow", bow_m=1e-6)
    assert fault_labels(bent, simulate(bent).response)["healthy"] is False
