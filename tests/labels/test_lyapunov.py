import numpy as np
import pytest

from rubgen.labels.lyapunov import BLOCKS, lyapunov


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
