from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import qmc

from rubgen.contact import casing_surface
from rubgen.contact.geometry_kernels import undeformed_radius
from rubgen.labels import Motion
from rubgen.reduction import reduce
from rubgen.solver.integrate import integrate
from rubgen.solver.response import ContactEvents
from validation.zeng2019 import reproduce
from validation.zeng2019.changes import AT_CENTRE, changed, tally
from validation.zeng2019.conclusions.causes import _by_modes
from validation.zeng2019.conclusions.conclusion3 import indices, uncommon
from validation.zeng2019.conclusions.scale import reaches
from validation.zeng2019.differences import Experiment, cause_of, words_of
from validation.zeng2019.figures.figure10 import _onset
from validation.zeng2019.figures.figure16 import unevenness, zones_and_motion
from validation.zeng2019.figures.figure17 import _end, jump
from validation.zeng2019.figures.figure19 import crossings
from validation.zeng2019.fitting.evidence import read_evidence
from validation.zeng2019.fitting.targets import TARGETS, words
from validation.zeng2019.meanings import BOUND, DIMENSION, GEOMETRY, SYMMETRY, UNKNOWN, WORDS
from validation.zeng2019.runs.cases import (
    CASING_SUPPORTS,
    DISK_SUPPORTS,
    NAMED_CASING_SUPPORTS,
    NAMED_DISK_SUPPORTS,
    NAMED_SPEEDS,
    REGIONS,
    SPEEDS,
    case,
    casing_sweep,
    disk_sweep,
    readings,
    swept_speeds,
    within,
)
from validation.zeng2019.runs.contact_pattern import contact_pattern
from validation.zeng2019.runs.measures import fractional, harmonics, looks_regular, segments, strongest
from validation.zeng2019.runs.outcome import POINTS, Outcome, outcome, outcome_of, run, run_piece
from validation.zeng2019.runs.region import one_class, switching
from validation.zeng2019.size import AS_COMPUTED, FULL, MACHINES, QUICK, TWIN, sizes
from validation.zeng2019.statement import Reading, Statement, read_as

TINY = replace(QUICK, settle_turns=50, record_turns=100, thin=30, speed_thin=100)
NONE = np.zeros(0)


def made_up(**changes) -> Outcome:
    """A period-1 rub with symmetric zones, all arrays empty, but for the changes."""
    arrays = {name: NONE for name, field in Outcome.__dataclass_fields__.items() if field.type == "FloatArray"}
    classes = dict.fromkeys(("motion_centre", "motion_blisk", "motion_casing"), "period-1")
    values = {"status": "ok", "reason": "", "rub": True, **classes}
    points = {"points_blisk": np.ones(POINTS), "points_casing": np.ones(POINTS)}
    return Outcome(**(arrays | values | points | {"symmetric": 1, "zones": 2} | changes))


@pytest.fixture(scope="module")
def rub():
    """Scenario and response of a short light rub."""
    values = {"speed_rpm": 10000.0, "disk_support_stiffness_n_per_m": 2e8}
    scenario = case(TINY, **values)
    system = reduce(scenario.machine, scenario.reduction).at_speed(scenario.operation.speed_rad_per_s)
    return scenario, integrate(system, scenario.operation, scenario.contact)


def test_sweeps_are_those_of_the_paper():
    assert (SPEEDS[0], SPEEDS[-1], len(SPEEDS)) == (2460, 14940, 309)
    assert {float(rpm) for rpm in range(2460, 14941, 120)} <= set(SPEEDS)
    assert all(low in SPEEDS and high in SPEEDS for low, high in REGIONS.values())
    assert {1.4e8, 3.7e8, 4.5e8, 5.4e8, 6.75e8} <= {round(k) for k in DISK_SUPPORTS}
    ends = {200, 15500, 16400, 20000, 20900, 26300, 27200, 66800, 67700, 200000}
    assert ends <= {round(k) for k in CASING_SUPPORTS}
    assert list(CASING_SUPPORTS) == sorted(CASING_SUPPORTS)
    assert QUICK.of((1.0, 2.0, 3.0)) == (1.0, 3.0)
    by_120 = swept_speeds(replace(FULL, speed_thin=4))
    assert set(np.diff([rpm for rpm in by_120 if rpm % 120 == 60])) == {120.0}
    assert set(NAMED_SPEEDS) < set(by_120)
    assert (by_120[0], by_120[-1], FULL.option, replace(FULL, speed_thin=4).option) == (2460, 14940, "", " --every 4")
    assert {6660.0, 6780.0} <= set(swept_speeds(QUICK))


def test_an_outcome_holds_what_the_response_says(rub):
    _, response = rub
    found, taps, steps = outcome(response), response.taps, response.steps_per_turn
    assert found.rub
    last = taps["blisk_x"].size - 1
    picked = [taps["blisk_x"][last - back * steps] for back in (0, 1, 48)]
    assert [found.points_blisk[-1], found.points_blisk[-2], found.points_blisk[0]] == picked
    wave = taps["casing_acc_0"][-100 * steps :]
    line = 2 / wave.size * abs(np.sum(wave * np.exp(-2j * np.pi * 3 * np.arange(wave.size) / steps)))
    assert harmonics(found.spectrum_casing)[2] == pytest.approx(line, rel=1e-5)
    assert found.blisk_rms == pytest.approx(taps["blisk_x"][-POINTS * steps :].std())
    assert found.even_field[1] > 100 * found.even_field[0]
    assert found.odd_field[0] > 100 * found.odd_field[1]


def test_an_outcome_comes_back_from_its_arrays(rub):
    scenario, response = rub
    again, direct = outcome_of(run(scenario)), outcome(response)
    assert run_piece(scenario).key == run_piece(replace(scenario)).key
    assert (again.label, again.zones, again.impulse) == (direct.label, direct.zones, direct.impulse)
    np.testing.assert_array_equal(again.points_casing, direct.points_casing)


def test_a_run_that_diverges_has_no_arrays():
    scenario = case(TINY, casing_support_stiffness_n_per_m=2e3)
    found = outcome_of(run(scenario))
    assert (found.ok, found.label, found.points_blisk.size) == (False, "diverged", 0)
    assert found.reason


def test_the_contact_pattern_counts_blades_at_the_same_time(rub):
    """Blades 3 and 4 together for 5 steps, blade 20 alone for 10: a third of the contact has neighbours."""
    _, response = rub
    steps = response.steps_per_turn
    first = (response.record_turns - POINTS) * steps
    events = ContactEvents(
        blade=np.array([3, 4, 20, 7]),
        start_step=np.array([first, first + 2, first + 100, first - 50]),
        steps=np.array([7, 5, 8, 9]),
        angle=np.radians([10.0, 12.0, 190.0, 90.0]),
        impulse=np.array([1.0, 2.0, 3.0, 50.0]),
        friction_loss=np.zeros(4),
        normal_loss=np.zeros(4),
    )
    pattern = contact_pattern(replace(response, events=events), POINTS)
    assert pattern.at_once == 2
    assert pattern.neighbours == pytest.approx(5 / 15)
    assert pattern.on_blades[[3, 4, 20, 7]].tolist() == [1.0, 2.0, 3.0, 0.0]
    assert pattern.on_casing.sum() == pytest.approx(6.0)
    assert pattern.on_casing[60:].sum() == pytest.approx(3.0)


def test_orders_and_lines_between_them():
    spectrum = np.zeros(1001)
    spectrum[[100, 300, 250]] = 4.0, 2.0, 1.0
    assert strongest(harmonics(spectrum)) == 1
    assert strongest(harmonics(spectrum), 2) == 3
    assert fractional(spectrum) == pytest.approx(0.25)
    assert fractional(np.zeros(1001)) == 0
    assert strongest(np.zeros(10)) == 0


def test_points_that_hardly_move_look_like_one():
    calm = made_up(points_blisk=1 + 1e-3 * np.arange(POINTS) / POINTS)
    assert looks_regular(calm, "blisk", 0.1)
    assert not looks_regular(calm, "blisk", 0.01)


def test_stretches_of_one_class_and_mixed_ones():
    found = segments([1, 2, 3, 4, 5, 6, 7], list("aaabcdd"), 2)
    assert found == [("a", 1, 3), ("mixed", 4, 5), ("d", 6, 7)]


def test_the_onset_lies_between_two_runs():
    silent, rubs = made_up(rub=False), made_up()
    assert _onset({6540.0: silent, 6660.0: silent, 6780.0: rubs}).verdict == "agrees"
    assert _onset({6540.0: silent, 6660.0: rubs, 6780.0: rubs}).verdict == "differs"


def test_classes_in_a_range_are_counted_and_failed_runs_left_out():
    wild = made_up(motion_centre="chaotic", motion_blisk="chaotic", symmetric=0)
    runs = dict(enumerate([made_up(), wild, wild, made_up(status="diverged")], start=1))
    assert one_class("x", "chaotic", "blisk", runs, runs.values())[0].verdict == "agrees within 33 % of the runs"
    assert switching("x", ("chaotic", "period-1"), "blisk", runs, runs.values())[0].verdict == "agrees"
    assert switching("x", ("chaotic", "multi-period"), "blisk", runs, runs.values())[0].verdict == "differs"
    assert list(within(runs, 2, 3)) == [2, 3]
    assert all(str(motion) for motion in Motion)


def test_quasi_periodic_motion_stands_for_one_word_alone():
    torus = made_up(motion_centre="quasi-periodic")
    runs = dict(enumerate([made_up(), torus, torus], start=1))
    assert one_class("x", "chaotic", "blisk", runs, runs.values())[0].verdict == "agrees within 33 % of the runs"
    assert switching("x", ("chaotic", "period-1"), "blisk", runs, runs.values())[0].verdict == "agrees"
    assert switching("x", ("chaotic", "multi-period", "period-1"), "blisk", runs, runs.values())[0].verdict == "differs"


def test_where_the_eye_sees_something_else_both_verdicts_are_given():
    """Chaos of a hundredth of the diagram's height looks like one point."""
    calm = made_up(motion_centre="chaotic", points_blisk=1 + 0.01 * np.arange(POINTS) / POINTS)
    tall = made_up(points_blisk=np.linspace(0, 2, POINTS))
    found = one_class("x", "period-1", "blisk", {1: calm, 2: calm}, [calm, tall], fitted=True)[0]
    assert (found.verdict, found.used_for_fitting) == ("differs", True)
    assert (found.by_eye, found.other_bound) == ("agrees", "the scatter of 49 points")
    assert "49 points scatter over 0.49 % of the height of the diagram (median; largest 0.49 %)" in found.found
    assert one_class("x", "period-1", "blisk", {1: made_up()}, [calm, tall])[0].by_eye == ""
    assert one_class("x", "chaotic", "casing", {}, [tall])[0].verdict == "unknowable"


def test_the_end_of_rub_lies_between_two_runs():
    silent, rubs = made_up(rub=False, motion_casing="static"), made_up()
    ended, still = _end({6.6e8: rubs, 6.7e8: rubs, 6.75e8: silent})
    assert (ended.verdict, still.verdict) == ("agrees", "agrees")
    assert _end({6.4e8: rubs, 6.6e8: silent, 6.75e8: silent})[0].verdict == "agrees within 2.2 %"
    assert _end({6.7e8: rubs, 6.75e8: rubs, 7.5e8: silent})[0].verdict == "differs"


def test_a_number_of_modes_without_odd_orders_at_the_point_would_be_a_cause():
    both, even = np.zeros(1001), np.zeros(1001)
    both[[100, 200]] = 3.0, 1.0
    even[200] = 1.0
    with_odd, without = made_up(spectrum_casing=both), made_up(spectrum_casing=even)
    assert _by_modes({5: with_odd, 9: with_odd}).verdict == "differs"
    assert _by_modes({5: with_odd, 9: without}).verdict == "agrees"
    assert _by_modes({5: made_up(status="diverged")}).verdict == "unknowable"


def test_supports_of_the_casing_are_read_in_proportion_to_its_mass():
    assert readings(FULL) == {"as printed": 1, "in proportion to the mass": 5}
    as_computed = readings(replace(FULL, machine=AS_COMPUTED))
    assert as_computed["in proportion to the mass"] == 8
    assert set(NAMED_DISK_SUPPORTS) < set(disk_sweep(QUICK))
    assert set(NAMED_CASING_SUPPORTS) < set(casing_sweep(QUICK, "in proportion to the mass"))


def test_the_paper_s_blisk_is_the_disk_centre_and_the_tips_have_a_row_of_their_own():
    """Tips that chatter alone change neither the verdict nor the tally."""
    chatter = made_up(motion_centre="period-1", motion_blisk="chaotic")
    centre, tips = one_class("x", "period-1", "blisk", {1: chatter}, [chatter])
    assert (centre.verdict, centre.apart, centre.by_words) == ("agrees", "", "differs")
    assert (tips.verdict, tips.apart) == ("differs", "tips")
    assert len(one_class("x", "period-1", "casing", {1: chatter}, [chatter])) == 1


def test_the_disk_centre_of_a_run_is_judged_without_its_tips(rub):
    """Tips that are shaken by more than the disk centre moves change the class of the blisk, not of the centre."""
    _, response = rub
    calm = outcome(response)
    shaken = response.section_q.copy()
    tips = 3 * response.n_blades
    shaken[:, :tips] += 1e-4 * np.random.default_rng(1).standard_normal((len(shaken), tips))
    found = outcome(replace(response, section_q=shaken))
    assert found.motion_centre == calm.motion_centre
    assert found.motion_blisk not in ("period-1", "static")


def test_the_twin_has_the_air_of_the_chords():
    twin, chords = (replace(QUICK, machine=machine).scenario() for machine in (TWIN, AS_COMPUTED))
    assert (twin.contact.surface, chords.contact.surface) == ("smooth", "chords")
    gaps = []
    for scenario in (twin, chords):
        system = reduce(scenario.machine, scenario.reduction).at_speed(700.0)
        surface = casing_surface(system, scenario.contact)
        angle = 2 * np.pi * np.arange(14400) / 14400
        gaps.append(min(undeformed_radius(surface, psi)[0] for psi in angle) - system.tip_radius)
    assert gaps[0] == pytest.approx(gaps[1], abs=1e-8)
    assert sorted(sizes(QUICK)) == sorted(MACHINES)


def test_a_difference_has_the_cause_that_an_experiment_shows():
    def verdict(kind, **more):
        return Statement(statement="Region V: the casing moves in chaotic motion.", verdict=kind, found="x", **more)

    search = read_evidence()
    assert cause_of(verdict("differs"), verdict("agrees"), verdict("differs"), search).name == GEOMETRY
    assert cause_of(verdict("differs"), verdict("agrees"), verdict("agrees"), search).name == DIMENSION
    by_eye = verdict("differs", by_eye="agrees", by_words="agrees")
    assert cause_of(by_eye, verdict("differs"), verdict("differs"), search).name == BOUND
    assert cause_of(verdict("differs", by_words="agrees"), None, None, search).name == WORDS
    assert "candidates of the search" in cause_of(verdict("differs"), None, None, search).experiment
    assert cause_of(verdict("differs"), None, None, []).name == UNKNOWN
    seen = verdict("differs", by_eye="agrees within 34 % of the runs")
    assert cause_of(verdict("differs"), seen, verdict("differs"), []).name == GEOMETRY
    assert cause_of(verdict("differs"), seen, seen, []).name == DIMENSION
    assert cause_of(verdict("differs"), verdict("differs"), seen, []).name == UNKNOWN


@pytest.mark.parametrize(("found", "name"), [("agrees", SYMMETRY), ("differs", UNKNOWN), ("unknowable", UNKNOWN)])
def test_an_experiment_is_a_cause_only_where_it_agrees(found, name):
    one = Statement(statement="Even orders, 2 f_r, stand out.", verdict="differs", found="x")
    tried = Statement(statement="Without.", verdict=found, found="x", about=("ven orders",), cause=SYMMETRY)
    chords = replace(tried, verdict="differs")
    cause = cause_of(one, None, None, [], [Experiment(section="causes", preset=tried, chords=chords)])
    assert cause.name == name
    assert (cause.experiment == '`causes`, "Without": agrees; with zeng2019-as-computed: differs') == (
        found == "agrees"
    )


def test_the_first_reading_that_agrees_is_taken():
    no, yes = Reading(words="one", verdict="differs"), Reading(words="two", verdict="agrees")
    assert read_as(no, yes) == {"by_words": "agrees", "other_words": "two"}
    assert read_as(no, replace(yes, verdict="differs")) == {"by_words": "differs", "other_words": "one; two"}


def test_a_class_that_occurs_once_is_seen_by_another_bound():
    runs = {float(i): made_up(motion_casing="chaotic" if i else "period-k") for i in range(40)}
    rare = switching("Region III", ("chaotic", "multi-period"), "casing", runs, list(runs.values()))[0]
    assert (rare.verdict, rare.by_eye) == ("differs", "agrees")
    none = switching("Region III", ("chaotic", "multi-period", "period-1"), "casing", runs, list(runs.values()))[0]
    assert (none.verdict, none.by_eye) == ("differs", "differs")


def test_runs_of_another_class_than_the_commonest_are_counted():
    names = ("period-1", "period-1", "period-1", "chaotic", "period-k")
    assert uncommon({float(i): made_up(motion_centre=name) for i, name in enumerate(names)}, "blisk") == (2, 5)


def test_fractional_lines_are_measured_against_the_orders_asked_for():
    spectrum = np.zeros(1001)
    spectrum[100], spectrum[150], spectrum[200], spectrum[300] = 1.0, 1e-4, 2e-4, 1e-5
    assert fractional(spectrum) == pytest.approx(1e-4)
    assert fractional(spectrum, 2) == pytest.approx(0.5)


def test_a_verdict_that_changed_has_its_reason():
    section, words_ = "Figure 12: region II from near", "Region II: the blisk moves in period-1 motion."
    now = Statement(statement=words_, verdict="agrees", found="x")
    tips = Statement(statement=f"{words_} (tips)", verdict="differs", found="x", apart="tips")
    rows = changed({(section, one.statement): one for one in (now, tips)})
    row = next(each for each in rows if each[:2] == ("Figure 12", words_))
    assert row[2:] == ("differs", "agrees", AT_CENTRE)
    assert tally({(section, one.statement): one for one in (now, tips)})[2] == ["after", "1", "0", "0", "0", "1"]
    same = {(section, words_): replace(now, verdict="differs")}
    assert not [each for each in changed(same) if each[:2] == ("Figure 12", words_)]


def test_words_of_the_search_belong_to_a_statement():
    asked = words(TARGETS)
    assert [asked[place] for place in words_of("Region V: the casing moves in chaotic motion.")] == ["chaotic"] * 5
    second = words_of("Casing support as printed, region II: the casing moves in period-1 motion.")
    assert [asked[place] for place in second] == ["period-1"]
    assert len(words_of("Region III, second half: the blisk moves in period-1 motion.")) == 2
    assert len(words_of("Disk support, all values: the blisk moves in period-1 motion.")) == 4
    assert words_of("Rub begins between 6,660 and 6,780 rev/min.") == []


def test_two_equations_give_the_unbalance_and_the_clearance_of_the_preset():
    """Within 5 %: with damping the orbit is not exactly in phase with the tip that reaches farthest."""
    scenario = replace(QUICK).scenario()
    found = reaches(scenario)
    (g_1, g_2), (h_1, h_2) = found["growth"], found["whirl"]
    unbalance = (g_2 - g_1 + 1e-6) / (h_1 - h_2)
    assert unbalance == pytest.approx(scenario.machine.unbalance_kg_m, rel=0.05)
    assert g_1 + h_1 * unbalance == pytest.approx(scenario.machine.casing.clearance_m, rel=0.02)
    assert found["inset"] == 0


def test_zones_and_motion_are_counted_both_ways():
    wild = made_up(motion_centre="chaotic", motion_blisk="chaotic", symmetric=0)
    first, _, second, _ = zones_and_motion([made_up()] * 9 + [made_up(symmetric=0)] + [wild] * 3)
    assert (first.verdict, second.verdict) == ("agrees", "agrees")
    assert "9 of 10" in first.found
    assert "3 of 3" in second.found


def test_unevenness_is_that_of_the_halves_right_and_left():
    impulse = np.zeros(120)
    impulse[[0, 119, 60]] = 2.0, 1.0, 1.0
    assert unevenness(made_up(on_casing=impulse)) == pytest.approx(0.5)
    assert unevenness(made_up(on_casing=np.zeros(120))) == 0


def test_a_jump_is_found_where_the_points_jump():
    """Whatever the steps of the sweep: a slow change over a wide step is none."""
    heights = (1.0, 1.1, 5.0, 5.1)
    runs = {k: made_up(points_casing=np.full(POINTS, h)) for k, h in zip((1.0, 2.0, 3.0, 4.0), heights, strict=True)}
    assert jump(runs) == 2.5
    wide = {-100.0: made_up(points_casing=np.full(POINTS, -9.0))} | runs
    assert jump(wide) == 2.5


def test_crossings_are_interpolated():
    k = np.array([0.0, 1.0, 2.0])
    lines = np.array([[0.0, 9.0], [2.0, 5.0], [4.0, np.nan]])
    assert crossings(k, lines, 3.0) == [1.5]
    assert crossings(k, lines, 6.0) == pytest.approx([0.75])


def test_total_indices_of_a_sum_are_its_shares_of_variance():
    """f = 3 a + b of uniform a, b: shares 0.9 and 0.1; a failed run counts as the largest value."""
    both = qmc.Sobol(4, rng=1).random(256)
    a, b = both[:, :2], both[:, 2:]
    points = [a, b, np.column_stack([b[:, 0], a[:, 1]]), np.column_stack([a[:, 0], b[:, 1]])]
    values = np.stack([3 * p[:, 0] + p[:, 1] for p in points], axis=1)[..., None]
    found = indices(values)
    np.testing.assert_allclose(found.total[0], [0.9, 0.1], atol=0.03)
    assert (found.low <= found.total).all()
    assert (found.total <= found.high).all()
    assert found.high[0, 0] - found.low[0, 0] < 0.5
    again = indices(values)
    np.testing.assert_array_equal([again.low, again.high], [found.low, found.high])
    values[0, 0] = np.nan
    assert np.isfinite(indices(values).total).all()


def test_a_sweep_makes_its_page(tmp_path):
    """Both ends and one value between of the sweep, two that figure 18 names, and the two around the end of rub.

    With all machines; the twin takes no value between.
    """
    made = reproduce(tmp_path, figure="18", size=TINY, workers=1)
    assert made.made == 7 + 7 + 6
    assert sum(made.verdicts.values()) == 2
    assert (tmp_path / "figure-18" / "zeng2019-18a.png").exists()
