"""N lobes give N contact zones; the total force of a symmetric period-1 rub carries orders k N alone."""

import numpy as np
import pytest

import rubgen
from rubgen.labels import Motion


@pytest.fixture(scope="module")
def two_zones():
    scenario = rubgen.make_scenario("zeng2019", speed_rpm=10000.0, disk_support_stiffness_n_per_m=2e8, friction=0.0)
    return rubgen.simulate(scenario).labels


def test_symmetric_period_1_with_two_zones(two_zones):
    assert two_zones.motion is Motion.PERIOD_1
    assert two_zones.period == 1
    assert two_zones.contact_zones == 2
    assert two_zones.contact_zones_symmetric is True
    assert two_zones.has_2fr is True


def test_total_force_has_even_orders_only(two_zones):
    force = two_zones.orders["contact_force"].amplitudes
    odd, even = force[0::2], force[1::2]
    assert even[:3].min() > 1.0
    assert odd.max() < 1e-2 * even[:3].min()


def test_disk_centre_has_odd_orders_only(two_zones):
    centre = two_zones.orders["blisk_x"].amplitudes
    assert two_zones.orders["blisk_x"].dominant == 1
    assert centre[2] > 1e-8
    assert centre[1::2].max() < 1e-2 * centre[[0, 2, 4]].min()


def test_three_lobes_give_orders_three_and_six():
    scenario = rubgen.make_scenario(
        "zeng2019", lobes=3, speed_rpm=10000.0, disk_support_stiffness_n_per_m=2e8, friction=0.0
    )
    labels = rubgen.simulate(scenario).labels
    assert labels.contact_zones == 3
    zones = np.sort(labels.contact_zone_centres)
    assert np.allclose(np.diff(zones), 2 * np.pi / 3, atol=np.radians(2))
    force = labels.orders["contact_force"].amplitudes
    others = np.delete(force, np.arange(2, 20, 3))
    assert min(force[2], force[5]) > 10 * others.max()
