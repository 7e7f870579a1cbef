import json
import math
from dataclasses import replace

import numpy as np
import pytest

from rubgen.labels import label
from rubgen.reduction import reduce
from rubgen.solver.integrate import integrate
from rubgen.units import rad_per_s
from validation.rows import read_rows
from validation.sensitivity import __main__ as command
from validation.sensitivity import outcome as outcome_module
from validation.sensitivity.cases import AUTO, CASES, STUDIES, case, with_operation
from validation.sensitivity.figures import halving_figure, study_figure
from validation.sensitivity.halving import SPEEDS_RPM, Pair, equal_share, halve, scenario
from validation.sensitivity.outcome import Outcome, outcome_of, run, run_piece
from validation.sensitivity.page import page
from validation.sensitivity.results import Result, change
from validation.store import Store

STUDY = {study.name: study for study in STUDIES}
SHORT = {"settle_turns": 40, "record_turns": 40, "steps_per_turn": 512}


@pytest.fixture(scope="module")
def short():
    return with_operation(case("light"), **SHORT)


@pytest.fixture(scope="module")
def rub(short):
    return run(short)


def failed(outcome: Outcome) -> Outcome:
    nothing = dict.fromkeys(("impulse", "impulse_error", "contact_duty", "indicator_blisk"), math.nan)
    return replace(outcome, status="diverged", motion="", rub=False, force_orders=[], blisk_orders=[], **nothing)


def made_up(rub: Outcome, **changes) -> Outcome:
    return replace(rub, motion="period-1", period=1, steps_per_turn=1024, **changes)


def test_outcome_holds_what_the_labels_say(short, rub):
    model = reduce(short.machine, short.reduction)
    response = integrate(model.at_speed(short.operation.speed_rad_per_s), short.operation, short.contact)
    labels = label(response)
    assert (rub.motion, rub.zones, rub.rub) == (labels.motion.value, labels.contact_zones, True)
    assert rub.impulse == response.impulse_per_turn.mean() > 0
    blocks = response.impulse_per_turn.reshape(10, 4).mean(axis=1)
    assert rub.impulse_error == pytest.approx(blocks.std(ddof=1) / math.sqrt(10))
    force = response.taps["contact_force"][-40 * 512 :]
    line = np.exp(-2j * np.pi * 2 * np.arange(force.size) / 512)
    assert rub.force_orders[1] == pytest.approx(2 / force.size * abs(np.sum(force * line)), rel=1e-9)


def test_growth_is_that_without_contact(short, rub):
    """The steady one at 10,000 rev/min, 242.8 um by the independent model of the reference, and a Jeffcott orbit.

    Its radius is U Omega^2 / |k (1 - Omega^2 / omega_c^2) + i c Omega|, c = 2 zeta sqrt(k m) of the rigid mass m =
    122.7 kg, which 143.65 Hz on 1e8 N/m give.
    """
    speed, k = short.operation.speed_rad_per_s, 2e8
    critical = rad_per_s(rub.critical_speed_rpm)
    drag = 2 * short.machine.damping.lateral * math.sqrt(k * 122.7) * speed
    orbit = short.machine.unbalance_kg_m * speed**2 / abs(complex(k * (1 - (speed / critical) ** 2), drag))
    assert rub.growth == pytest.approx(242.8e-6 + orbit, rel=5e-3)


def test_sensors_do_not_raise_the_steps_but_stability_does(short):
    assert run(short).steps_per_turn == 512
    assert run(with_operation(short, steps_per_turn=64)).steps_per_turn == 256


@pytest.mark.parametrize("nodes", [120, 360])
def test_other_nodes_are_the_same_casing(nodes):
    scenario = case("light")
    other = STUDY["casing_nodes"].apply(scenario, nodes)
    before, after = (reduce(s.machine, s.reduction).casing_frequencies_hz for s in (scenario, other))
    assert np.abs(after / before - 1).max() < 2e-4
    assert other.machine.casing.nodes == nodes


def test_each_study_changes_its_own_number():
    scenario = case("chaotic")
    assert STUDY["steps"].apply(scenario, 256).operation.steps_per_turn == 256
    assert STUDY["settle_turns"].apply(scenario, AUTO).operation.settle_turns == "auto"
    for name in ("blade_modes", "disk_modes", "blisk_modes", "casing_modes"):
        changed = STUDY[name].apply(scenario, 7)
        assert changed.reduction == replace(scenario.reduction, **{name: 7})
        assert changed.machine == scenario.machine
    for study in STUDIES:
        assert study.default in study.values
        assert study.yardstick in study.values
        assert study.apply(scenario, study.default) == scenario


def test_speeds_are_those_of_the_paper():
    assert len(SPEEDS_RPM) == 105
    assert (SPEEDS_RPM[0], SPEEDS_RPM[-1]) == (2460, 14940)


def test_an_outcome_comes_back_from_its_arrays(rub, monkeypatch):
    for asked in (rub, failed(rub), replace(rub, period=None, symmetric=None)):
        monkeypatch.setattr(outcome_module, "run", lambda _, asked=asked: asked)
        again = outcome_of(outcome_module.run_arrays(case("light")))
        assert repr(again) == repr(asked)  # NaN is not equal to itself


def test_pairs_compare_labels_and_impulses(rub):
    base = made_up(rub, impulse=1.0)
    assert Pair(speed_rpm=1, whole=made_up(rub, impulse=1.03), half=base).impulse_change == pytest.approx(0.03)
    equal = Pair(speed_rpm=1, whole=base, half=made_up(rub, impulse=2.0, zones=3))
    assert equal.equal
    assert not equal.equal_zones
    others = [replace(base, motion="chaotic", period=None), replace(base, rub=False), failed(base)]
    pairs = [Pair(speed_rpm=1, whole=other, half=base) for other in others]
    assert [pair.equal for pair in pairs] == [False] * 3
    assert [pair.impulse_change for pair in pairs] == [None] * 3
    assert equal_share([equal, *pairs]) == 0.25
    doubled = Pair(speed_rpm=1, whole=replace(base, motion="period-k", period=2), half=replace(base, motion="period-k"))
    assert not doubled.equal


def test_the_step_is_halved(rub):
    asked = []
    halve(lambda scenario: asked.append(scenario.operation) or rub, [6780], lambda scenario: scenario)
    assert [(operation.speed_rpm, operation.steps_per_turn) for operation in asked] == [(6780, 1024), (6780, 2048)]


def test_where_labels_differ_the_next_record_is_looked_at(rub):
    asked = []
    answers = [replace(rub, motion=name, period=None) for name in ("chaotic", "quasi-periodic", "quasi-periodic")]

    def outcome(scenario):
        asked.append(scenario.operation)
        return answers[len(asked) - 1]

    (pair,) = halve(outcome, [6780], lambda scenario: scenario)
    assert (asked[2].steps_per_turn, asked[2].settle_turns) == (1024, rub.settle_turns + rub.record_turns)
    assert pair.changes_by_itself
    assert not replace(pair, later=pair.whole).changes_by_itself


def test_changes_are_relative_and_undefined_for_failed_runs(rub):
    assert change(replace(rub, impulse=3.0), replace(rub, impulse=2.0), lambda o: o.impulse) == pytest.approx(0.5)
    assert math.isnan(change(failed(rub), rub, lambda o: o.force_orders[1]))
    assert math.isnan(change(rub, failed(rub), lambda o: o.impulse))
    assert math.isnan(change(rub, replace(rub, impulse=0.0), lambda o: o.impulse))


def test_pairs_without_both_runs_are_left_out(rub):
    assert halve(lambda scenario: rub if scenario.operation.steps_per_turn == 1024 else None, [6780], lambda s: s) == []


def made_up_results(rub: Outcome) -> list[Result]:
    return [
        Result(case=name, value=value, outcome=made_up(rub, impulse=1.0 + (0.5 if value == 13 else 0.0)))
        for value in (9, 11, 13)
        for name in CASES
    ]


def test_figures_show_the_changes(rub):
    results = made_up_results(rub)
    results[0] = replace(results[0], outcome=failed(rub))
    impulse, _, lowest, _ = study_figure(STUDY["casing_modes"], results).axes
    (line,) = [line for line in impulse.lines if len(line.get_xdata()) == 3 and line.get_color() == "#d55e00"]
    assert np.allclose(line.get_ydata(), [0, 0, 50])
    assert [tick.get_text() for tick in lowest.get_xticklabels()] == ["9", "11", "13"]
    whole = made_up(rub, impulse=1.1)
    lower = halving_figure([Pair(speed_rpm=9000.0, whole=whole, half=made_up(rub, impulse=1.0))]).axes[1]
    assert np.allclose(lower.lines[0].get_ydata(), [10.0])


def test_page_names_every_other_speed_and_impulse(rub):
    base = made_up(rub, impulse=1.0)
    pairs = [
        Pair(speed_rpm=7000.0, whole=base, half=base),
        Pair(
            speed_rpm=7120.0,
            whole=replace(base, motion="chaotic", period=None, indicator_blisk=0.876),
            half=base,
            later=replace(base, motion="quasi-periodic", period=None),
        ),
        Pair(speed_rpm=7240.0, whole=made_up(rub, impulse=1.05), half=base),
    ]
    text = page({"casing_modes": made_up_results(rub)}, pairs)
    assert "equal at 2 of 3 speeds, 66.7 %" in " ".join(text.split())
    assert "at 1 of these speeds the label changes without a change of the step" in " ".join(text.split())
    assert "Only 3 of the 105 speeds are finished" in text
    (row,) = [line for line in text.splitlines() if line.startswith("| 7120 |")]
    (header,) = [line for line in text.splitlines() if "next record" in line and line.startswith("|")]
    cells = dict(zip(header.split(" | "), row.split(" | "), strict=True))
    assert cells["motion"] == "chaotic / period-1"
    assert cells["next record"] == "quasi-periodic"
    assert cells["K blisk"].startswith("0.88 / ")
    assert "beyond 2 %: 7240 rev/min +5.0 %" in " ".join(text.split())
    assert "| 7000 |" not in text
    assert "Not run yet: steps, blade_modes" in text
    assert "| 13 | light | period-1 |" in text
    assert "+50.00" in text


def test_page_names_other_labels(rub):
    results = made_up_results(rub)
    results[0] = replace(results[0], outcome=failed(rub))
    text = " ".join(page({"casing_modes": results}, []).split())
    assert "runs have the same class of motion as at the default. Others: light at 9: diverged" in text


@pytest.fixture
def made(rub, monkeypatch):
    """The scenarios that are run; each gives the same made-up outcome."""
    scenarios = []
    monkeypatch.setattr(outcome_module, "run", lambda scenario: scenarios.append(scenario) or rub)
    return scenarios


def test_a_quick_study_writes_everything_and_goes_on(tmp_path, made):
    arguments = ["casing_modes", "halving", "--quick", "--workers", "1"]
    assert command.main(arguments, tmp_path) == 0
    out = tmp_path / "out" / "sensitivity-quick"
    names = {"casing_modes.json", "halving.json", "sensitivity-casing_modes.png", "sensitivity-halving.png"}
    assert {path.name for path in out.iterdir()} - {"pieces", ".results", ".results.lock"} == names | {"sensitivity.md"}
    count = 5 * 3 + 2 * len(command.QUICK_SPEEDS)
    assert len(made) == count
    assert len(json.loads((out / "casing_modes.json").read_text(encoding="utf-8"))) == 15
    assert command.main(arguments, tmp_path) == 0
    assert len(made) == count


def test_finished_runs_alone(tmp_path, made):
    store = Store(tmp_path / "out" / "sensitivity-quick")
    speed = command.QUICK_SPEEDS[1]
    quick = command.Finished(store, quick=True)
    with store.claimed():
        store.compute([run_piece(quick.shorten(scenario(speed, steps))) for steps in (1024, 2048)], 1)
    assert command.main(["--quick", "--finished"], tmp_path) == 0
    assert len(made) == 2
    assert [row["speed_rpm"] for row in read_rows(store.root / "halving.json")] == [speed]
    assert not (store.root / "steps.json").exists()


def test_an_unknown_study_is_refused(tmp_path, capsys):
    with pytest.raises(SystemExit):
        command.main(["stepz"], tmp_path)
    assert "no study 'stepz'; choose from steps" in capsys.readouterr().err
