"""`[[faults]]` of a recipe: what is drawn, what a run says of it, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.labels.faults import fault_labels
from rubgen.machine.faults.bow import Bow
from rubgen.machine.load import PRESETS
from rubgen.scenario import make_scenario, parse_recipe
from rubgen.solver import Status
from rubgen.solver.refusal import no_response

BASE = {"name": "faults", "runs": 4, "machine": "zeng2019"}
MISALIGNED = {"kind": "misalignment", "share": 0.3, "parallel_m": {"uniform": [1e-5, 1e-4]}}
BENT = {"kind": "bow", "share": {"uniform": [0.2, 0.6]}, "bow_m": {"log_uniform": [1e-6, 1e-5]}}


def recipe(*faults, **more):
    return parse_recipe({**BASE, **more, "faults": list(faults)}, source="r.toml")


def runs(made, count=300):
    return [{fault.kind: fault for fault in made.scenario(index).machine.faults} for index in range(count)]


def test_kinds_are_drawn_independently_with_their_shares():
    found = runs(recipe(MISALIGNED, BENT))
    has = np.array([["misalignment" in each, "bow" in each] for each in found])
    assert has.mean(axis=0) == pytest.approx([0.3, 0.4], abs=0.08)
    assert has.all(axis=1).mean() == pytest.approx(0.12, abs=0.06)
    sizes = np.array([each["misalignment"].parallel_m for each in found if "misalignment" in each])
    assert 1e-5 <= sizes.min() < 2e-5
    assert 9e-5 < sizes.max() <= 1e-4


def test_a_kind_changes_no_other_and_no_drawn_value_of_vary():
    vary = {"clearance_m": {"uniform": [2e-4, 3e-4]}}
    alone, both = recipe(BENT, vary=vary), recipe(MISALIGNED, BENT, vary=vary)
    assert [each.get("bow") for each in runs(alone, 40)] == [each.get("bow") for each in runs(both, 40)]
    silent = parse_recipe({**BASE, "vary": vary})
    assert both.scenario(3).machine.casing == silent.scenario(3).machine.casing
    assert "faults" not in silent.model_dump(mode="json", exclude_none=True)


def response(status=Status.OK, start_steps=()):
    """A response of 1 ms a step with touches."""
    none = no_response(status, "", speed=1.0, dt=1e-3, steps_per_turn=1, record_turns=1)
    return replace(none, events=replace(none.events, start_step=np.array(start_steps, dtype=np.int64)))


def test_labels_name_the_faults_and_their_severity():
    made = recipe({**MISALIGNED, "share": 1, "parallel_m": 4e-5}, {**BENT, "share": 0})
    labels = fault_labels(made.scenario(0), response())
    found = {"faults": ["misalignment"], "healthy": False, "rub_onset_s": None, "misalignment_m": 4e-5, "bow_m": 0.0}
    assert labels == found
    sound = recipe({**BENT, "share": 0}).scenario(0)
    assert fault_labels(sound, response()) == {"faults": [], "healthy": True, "rub_onset_s": None, "bow_m": 0.0}
    rubbing = fault_labels(sound, response(start_steps=(400, 250)))
    assert (rubbing["healthy"], rubbing["rub_onset_s"]) == (False, pytest.approx(0.25))
    failed = fault_labels(sound, response(Status.DIVERGED))
    assert (failed["healthy"], failed["rub_onset_s"]) == (None, None)
    assert fault_labels(make_scenario(), response()) == {}


def test_a_single_run_takes_kinds_and_keys():
    scenario = make_scenario(fault=["misalignment", "bow"], parallel_m=5e-5, bow_m=2e-6, direction_deg=20)
    misalignment, bow = scenario.machine.faults
    assert (misalignment.parallel_m, misalignment.direction_deg, bow) == (5e-5, 20, Bow(bow_m=2e-6))
    assert scenario.fault_kinds == ("misalignment", "bow")


def test_faults_of_a_machine_are_in_every_run(tmp_path):
    file = tmp_path / "bent.toml"
    file.write_text((PRESETS / "zeng2019.toml").read_text() + '\n[[faults]]\nkind = "bow"\nbow_m = 3e-6\n')
    made = parse_recipe({**BASE, "machine": str(file), "faults": [{**MISALIGNED, "share": 0}]})
    assert made.scenario(0).machine.faults == (Bow(bow_m=3e-6),)
    assert made.fault_kinds == ("misalignment", "bow")
    with pytest.raises(UserError, match=r"faults.0.kind = 'bow': the machine has this fault already"):
        parse_recipe({**BASE, "machine": str(file), "faults": [BENT]})


BAD = {
    "unknown kind": ([{"kind": "misalignmnt"}], "faults.0 = { kind = 'misalignmnt' }: unknown value; did you mean mis"),
    "no kind": ([{"share": 1}], "faults.0 = { share = 1 }: must have a kind; add it"),
    "missing key": ([{"kind": "bow"}], "faults.0.bow_m: this key is missing; add it"),
    "key of another kind": (
        [{**BENT, "parallel_m": 1}],
        "faults.0.parallel_m: unknown key; allowed: angle_deg, bow_m, growth_s, kind",
    ),
    "share beyond 1": ([{**BENT, "share": 1.5}], "faults.0.share = 1.5: a share of the runs must be at least 0 and"),
    "share in percent": ([{**BENT, "share": 30}], "at most 1; 30 % is written 0.3"),
    "drawn share": ([{**BENT, "share": {"uniform": [0, 2]}}], "faults.0.share = { uniform = [0, 2] }: a share of the"),
    "largest value": ([MISALIGNED, {**BENT, "bow_m": {"uniform": [0, 1]}}], "faults.1.bow_m = 1: must be at least 0 a"),
    "text": ([{**BENT, "bow_m": "1e-6"}], "faults.0.bow_m = '1e-6': "),
    "twice": ([BENT, BENT], "faults.1.kind = 'bow': the recipe has this fault already; remove one"),
    "no size": ([{"kind": "misalignment"}], "faults.0: must have parallel_m or angular_deg; give one or both"),
    "drawn whole number": (
        [{"kind": "cracked-blade", "stiffness_loss": 0.1, "blade": {"uniform": [0, 35]}}],
        "faults.0.blade = { uniform = [0, 35] }: takes whole numbers only; give a number or a choice",
    ),
    "no such blade": (
        [{"kind": "lost-tip", "lost_kg": 1e-3, "blade": {"choice": [0, 36]}}],
        "faults: lost-tip: blade = 36: there is no such blade; give 0 to 35",
    ),
    "half a blade": ([{"kind": "lost-tip", "lost_kg": 0.1}], "faults: lost-tip: lost_kg = 0.1: an eighth of a blade"),
    "no table": (["bow"], "faults.0 = 'bow': must be a table"),
}


@pytest.mark.parametrize(("faults", "words"), BAD.values(), ids=BAD.keys())
def test_mistakes_of_a_recipe_are_one_line(faults, words):
    with pytest.raises(UserError) as error:
        recipe(*faults)
    assert str(error.value).startswith(f"r.toml: {words}") or words in str(error.value)
    assert "\n" not in str(error.value)


BAD_KEYS = {
    "unknown kind": ({"fault": "bwo"}, "fault = 'bwo': unknown kind; did you mean bow? allowed: misalignment, bow"),
    "no fault": ({"parallel_m": 1e-5}, "parallel_m: a key of the fault misalignment; name that fault too, or leave"),
    "other fault": ({"fault": "bow", "bow_m": 1e-6, "parallel_m": 1e-5}, "parallel_m: a key of the fault misalignment"),
    "unknown key": ({"fault": "bow", "bw_m": 1e-6}, "bw_m: unknown key; "),
    "missing": ({"fault": "bow"}, "fault.bow.bow_m: this key is missing; add it, at least 0 and at most 0.1"),
    "beyond": ({"fault": "bow", "bow_m": -1}, "fault.bow.bow_m = -1: must be at least 0"),
    "no size": ({"fault": "misalignment"}, "fault.misalignment: must have parallel_m or angular_deg"),
}


@pytest.mark.parametrize(("keys", "words"), BAD_KEYS.values(), ids=BAD_KEYS.keys())
def test_mistakes_of_a_single_run_are_one_line(keys, words):
    with pytest.raises(UserError) as error:
        make_scenario(**keys)
    assert str(error.value).startswith(words)
