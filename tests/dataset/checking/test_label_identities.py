"""Labels that follow from each other: one that is off by 2 % contradicts the rest."""

import pytest

import rubgen
from rubgen.dataset.checking.consistency import label_problems

FOUND = {
    "contact_duty": "contact_duty and its windows",
    "window_contact_duty": "contact_duty and its windows",
    "window_starts_s": "windows and speed_rpm",
    "window_speeds_rpm": "windows and speed_rpm",
    "lyapunov_per_turn": "lyapunov_per_second and lyapunov_per_turn",
    "lyapunov_per_second": "lyapunov_per_second and lyapunov_per_turn",
}


@pytest.fixture(scope="module")
def row(small_set):
    """A run that rubs, with an exponent."""
    rows = map(rubgen.open(small_set.directory).row, rubgen.open(small_set.directory))
    return next(row for row in rows if row["rub"])


@pytest.mark.parametrize("name", FOUND)
def test_a_label_off_by_two_per_cent_is_found(row, name):
    row = row | {"lyapunov_per_turn": 0.1, "lyapunov_per_second": 0.1 * row["speed_rpm"] / 60}
    assert list(label_problems(row)) == []
    wrong = [1.02 * value for value in row[name]] if isinstance(row[name], list) else 1.02 * row[name]
    assert FOUND[name] in list(label_problems(row | {name: wrong}))


@pytest.mark.parametrize("name", ["window_contact_duty", "window_starts_s", "window_speeds_rpm"])
def test_a_window_that_is_lost_is_found(row, name):
    assert FOUND[name] in list(label_problems(row | {name: row[name][:-1]}))


def test_one_exponent_without_the_other_is_found(row):
    assert FOUND["lyapunov_per_turn"] in list(
        label_problems(row | {"lyapunov_per_turn": 0.1, "lyapunov_per_second": None})
    )


def test_nothing_is_said_of_unequal_turns(row):
    """Whatever the windows are: turns of unequal length have other means, starts and speeds."""
    for window in ([], [0.9] * len(row["window_contact_duty"])):
        changing = row | {"change_times_s": [0.1], "window_speeds_rpm": window, "window_contact_duty": window}
        assert not set(FOUND.values()) & set(label_problems(changing))
