import json

from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from rubgen.io.plain import labels_dict, scenario_dict
from rubgen.machine import load_machine
from rubgen.scenario import Operation, Scenario

NAMES = [
    "rub",
    "contact_duty",
    "contact_impulse_per_turn_n_s",
    "blades_touched",
    "contact_zones",
    "contact_zone_centres_rad",
    "contact_zone_widths_rad",
    "contact_zones_symmetric",
    "motion_blisk",
    "motion_casing",
    "motion",
    "period_blisk",
    "period_casing",
    "period",
    "has_2fr",
]


def test_labels_have_their_public_names(rub_run):
    taps = ["blisk_x", "casing_acc_0", "contact_force"]
    endings = ["orders", "even_share", "odd_share", "dominant_order"]
    assert list(labels_dict(rub_run.labels)) == NAMES + [f"{tap}_{ending}" for tap in taps for ending in endings]


def test_labels_survive_json(rub_run, free_run):
    for run in (rub_run, free_run):
        plain = labels_dict(run.labels)
        assert json.loads(json.dumps(plain, allow_nan=False)) == plain


def test_what_is_undefined_is_null(free_run):
    plain = labels_dict(free_run.labels)
    assert plain["contact_force_even_share"] is None
    assert plain["contact_zones_symmetric"] is None
    assert plain["contact_zone_centres_rad"] == []


@given(speed=st.floats(min_value=1e-3, max_value=1e6), seed=st.integers(min_value=0, max_value=2**63))
def test_a_scenario_comes_back_from_json_with_every_bit(speed, seed):
    scenario = Scenario(machine=load_machine("zeng2019"), operation=Operation(speed_rpm=speed), seed=seed)
    text = json.dumps(scenario_dict(scenario), allow_nan=False)
    assert TypeAdapter(Scenario).validate_python(json.loads(text)) == scenario
