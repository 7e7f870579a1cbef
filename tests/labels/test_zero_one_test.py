"""The 0-1 test on circle maps; tests/validation/test_verification.py holds K of the logistic map and Henon's."""

import numpy as np
import pytest

from rubgen.labels.motion.chaos import FREQUENCIES, growth_correlation, mean_square_displacement
from validation.verification.chaos.chaos_indicators import henon

GOLDEN = (np.sqrt(5) - 1) / 2


def circle_map(rotation: float, coupling: float, count: int = 500) -> np.ndarray:
    angle, orbit = 0.1, []
    for _ in range(count + 200):
        angle += rotation - coupling / (2 * np.pi) * np.sin(2 * np.pi * angle)
        orbit.append(np.cos(2 * np.pi * angle))
    return np.array(orbit[200:])


@pytest.mark.parametrize(("rotation", "coupling"), [(GOLDEN, 0.0), (GOLDEN, 0.9), (0.0123, 0.0), (0.4987, 0.0)])
def test_circle_map_is_not_chaotic_on_500_points(rotation: float, coupling: float) -> None:
    assert abs(growth_correlation(circle_map(rotation, coupling))) < 0.15


def test_49_points_are_too_few_for_quasi_periodic_motion() -> None:
    # Why labels need 500 turns: on 49 points most rigid rotations of the circle look chaotic, on 500 none does.
    rotations = np.random.default_rng(0).uniform(0.02, 0.98, 60)
    few, many = (np.array([growth_correlation(circle_map(r, 0.0, n)) for r in rotations]) for n in (49, 500))
    assert np.abs(many).max() < 0.05
    assert np.mean(few > 0.9) > 0.5


def test_an_offset_and_a_scale_do_not_matter() -> None:
    orbit = henon()
    assert growth_correlation(1e-6 * orbit) == pytest.approx(growth_correlation(orbit), abs=1e-9)
    assert growth_correlation(orbit + 0.5) == pytest.approx(growth_correlation(orbit), abs=0.01)


def test_frequencies_lie_where_the_test_is_valid() -> None:
    assert FREQUENCIES.size == 100
    assert np.pi / 5 < FREQUENCIES.min() < FREQUENCIES.max() < 4 * np.pi / 5


@pytest.mark.parametrize("count", [32, 250, 500])
@pytest.mark.parametrize("kind", ["noise", "torus", "chaos"])
def test_mean_square_displacement_is_that_of_the_walk(kind: str, count: int) -> None:
    orbits = {
        "noise": np.random.default_rng(0).standard_normal(count),
        "torus": circle_map(GOLDEN, 0.9, count) + 0.3,
        "chaos": henon()[:count],
    }
    observable, c = orbits[kind], FREQUENCIES[:, None]
    found = mean_square_displacement(observable)
    cut = max(count // 10, 3)
    walk = np.cumsum(observable * np.exp(1j * c * np.arange(1, count + 1)), axis=1)
    starts = walk[:, : count - cut]
    away = [np.mean(np.abs(walk[:, n : n + count - cut] - starts) ** 2, axis=1) for n in range(1, cut + 1)]
    assert found == pytest.approx(np.transpose(away), rel=1e-10)
