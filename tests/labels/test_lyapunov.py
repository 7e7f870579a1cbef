import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rubgen.labels.labels import Motion
from rubgen.labels.motion.decision import Indicators, decide
from rubgen.solver.exponent import BLOCKS, Exponent, lyapunov

SETTLING = 200
"""Periods before an oscillator is on its attractor."""


def correlated(seed: int, turns: int = 500, memory: float = 0.8) -> np.ndarray:
    """Growths about 0.3 whose scatter lasts for some turns."""
    kicks = np.random.default_rng(seed).standard_normal(turns + 50)
    values = [0.0]
    for kick in kicks:
        values.append(memory * values[-1] + 0.1 * kick)
    return 0.3 + np.array(values[-turns:])


def test_the_exponent_is_the_mean_of_what_counts() -> None:
    growth = np.concatenate([np.full(50, 7.0), 0.25 * np.ones(450)])
    exponent = lyapunov(growth)
    assert exponent.per_turn == pytest.approx(0.25)
    assert exponent.error == pytest.approx(0.0, abs=1e-12)
    assert exponent.convergence == pytest.approx(np.full(BLOCKS, 0.25))
    assert exponent.is_positive
    assert not exponent.is_negative


def test_the_error_is_the_scatter_of_the_exponent_though_turns_are_correlated() -> None:
    found = [lyapunov(correlated(seed)) for seed in range(200)]
    scatter = np.std([exponent.per_turn for exponent in found])
    assert np.mean([exponent.per_turn for exponent in found]) == pytest.approx(0.3, abs=3 * scatter / np.sqrt(200))
    error = np.sqrt(np.mean([exponent.error**2 for exponent in found]))
    assert 0.8 < error / scatter < 1.5
    naive = correlated(0).std() / np.sqrt(500)
    assert scatter > 2 * naive


def test_a_drift_is_an_error() -> None:
    exponent = lyapunov(np.linspace(0.0, 0.2, 500))
    assert exponent.error == pytest.approx(0.045, rel=0.02)
    assert exponent.convergence[-1] == pytest.approx(exponent.per_turn)
    assert exponent.convergence[0] < exponent.per_turn


def test_what_lies_within_its_error_has_no_sign() -> None:
    growth = np.random.default_rng(0).standard_normal(500)
    exponent = lyapunov(growth)
    assert not exponent.is_positive
    assert not exponent.is_negative
    assert lyapunov(growth - 2).is_negative


def test_no_growth_or_one_that_is_no_number_has_no_exponent() -> None:
    assert lyapunov(np.zeros(0)) is None
    growth = np.zeros(500)
    growth[321] = np.nan
    assert lyapunov(growth) is None


def van_der_pol(damping: float, force: float, frequency: float) -> np.ndarray:
    """Growths a period of a small difference on the attractor of x'' - damping (1 - x^2) x' + x = force cos(w t).

    The variational equation is integrated beside the oscillator, as the logarithm of its solution's length and its
    direction. On a torus the solution neither grows nor dies out.
    """

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, v, _, angle = state
        drive = force * np.cos(frequency * t)
        c, s = np.cos(angle), np.sin(angle)
        away = -(2 * damping * x * v + 1) * c + damping * (1 - x * x) * s
        return [v, damping * (1 - x * x) * v - x + drive, (c + away) * s, away * c - s * s]

    times = 2 * np.pi / frequency * np.arange(SETTLING + 1 + 500)
    found = solve_ivp(rates, times[[0, -1]], [0.5, 0.1, 0.0, 0.3], "DOP853", times, rtol=1e-8, atol=1e-8)
    return np.diff(found.y[2, SETTLING:])


@pytest.mark.parametrize(
    ("damping", "force", "frequency"), [(1.0, 0.3, 1.7), (0.3, 0.1, 1.6), (1.0, 0.3, 1.3), (0.6, 0.4, 1.9)]
)
def test_on_a_torus_bounded_stretching_is_within_the_error(damping, force, frequency) -> None:
    growth = van_der_pol(damping, force, frequency)
    exponent = lyapunov(growth)
    assert not exponent.is_positive
    assert not exponent.is_negative
    assert abs(exponent.per_turn) < 1.5 * exponent.error
    seen = Indicators(period=None, stray=0.3, growth=0.0, exponent=exponent)
    assert decide(seen).motion is Motion.QUASI_PERIODIC


def test_a_locked_oscillator_is_no_torus() -> None:
    assert lyapunov(van_der_pol(1.0, 0.5, 0.95)).is_negative


def chaotic(seed: int) -> Exponent:
    """The exponent of 500 turns of the logistic map x -> 3.9 x (1 - x)."""
    x, growth = np.random.default_rng(seed).uniform(0.1, 0.9), np.zeros(500)
    for i in range(growth.size):
        growth[i] = np.log(abs(3.9 * (1 - 2 * x)))
        x = 3.9 * x * (1 - x)
    return lyapunov(growth)


def test_the_error_of_a_chaotic_map_is_the_scatter_of_its_exponents() -> None:
    found = [chaotic(seed) for seed in range(300)]
    scatter = np.std([exponent.per_turn for exponent in found])
    error = np.sqrt(np.mean([exponent.error**2 for exponent in found]))
    assert 0.9 < error / scatter < 1.4
    assert all(exponent.is_positive for exponent in found)
