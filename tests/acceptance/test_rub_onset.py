"""Published facts of the preset: where rubbing begins with speed, and where it ends with the support's stiffness."""

from dataclasses import replace

import pytest

import rubgen


@pytest.mark.parametrize(
    ("speed_rpm", "lateral_stiffness", "rubs"),
    [(6660.0, 1e8, False), (6780.0, 1e8, True), (10000.0, 5.0e8, True), (10000.0, 6.75e8, False)],
)
def test_rub_begins_and_ends_where_the_paper_has_it(speed_rpm, lateral_stiffness, rubs):
    scenario = rubgen.make_scenario(
        "zeng2019", speed_rpm=speed_rpm, disk_support_stiffness_n_per_m=lateral_stiffness, friction=0.0
    )
    run = rubgen.simulate(replace(scenario, operation=replace(scenario.operation, record_turns=120)))
    assert run.response.status.code == "ok"
    assert run.labels.rub is rubs
    assert (run.labels.contact_duty > 0) is rubs
    if rubs:
        assert run.labels.contact_zones == 2
        assert run.labels.motion_casing != "static"
    else:
        assert run.labels.motion_casing == "static"
        assert run.labels.motion_blisk == "period-1"
        assert abs(run.response.taps["casing_acc_0"]).max() == 0
        orders = run.labels.orders["blisk_x"].amplitudes
        assert orders[1:].max() < 1e-9 * orders[0]
