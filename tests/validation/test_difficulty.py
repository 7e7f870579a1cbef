import numpy as np
import pytest

from validation.difficulty import best_threshold


def test_the_best_threshold_of_values_that_are_known():
    rub = np.array([False, False, True, True])
    assert best_threshold(np.array([1.0, 2.0, 3.0, 4.0]), rub) == 1.0
    assert best_threshold(-np.array([1.0, 2.0, 3.0, 4.0]), rub) == 1.0
    assert best_threshold(np.array([1.0, 3.0, 2.0, 4.0]), rub) == pytest.approx(0.75)
    chance = np.random.default_rng(0).standard_normal((2, 4000))
    assert best_threshold(chance[0], chance[1] > 0) < 0.53
