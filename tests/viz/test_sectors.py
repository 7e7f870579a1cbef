import numpy as np

from rubgen.viz.derived import sector_of


def test_the_first_sector_lies_about_zero_and_all_turns_are_one():
    angle = np.radians([0.0, 1.9, 2.1, -1.9, -2.1, 358.1, 357.9, 362.1])
    assert sector_of(angle, 90).tolist() == [0, 0, 1, 0, 89, 0, 89, 1]


def test_an_angle_a_rounding_below_a_turn_has_a_sector():
    just_below = np.array([-np.pi / 90 - 1e-17, -np.pi / 90, np.nextafter(-np.pi / 90, -1)])
    assert set(sector_of(just_below, 90)) <= {0, 89}
