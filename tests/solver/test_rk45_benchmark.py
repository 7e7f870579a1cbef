"""The script that the benchmark times: its three forms are one model, and it pushes as a contact must."""

import numpy as np
import pytest


@pytest.fixture
def models(small_system, monkeypatch):
    from benchmarks.bench_rk45 import CompiledModel, LoopedModel, PenaltyModel

    system = small_system(clearance=2e-3)
    return system, PenaltyModel(system, 0.1), (LoopedModel(system, 0.1), CompiledModel(system, 0.1))


def state(system, lean):
    """Tips pushed out at random by about `lean` m, all else a little moved."""
    rng = np.random.default_rng(3)
    y = 1e-6 * rng.normal(size=2 * len(system.M) + 1)
    y[: 3 * system.n_blades : 3] = lean * (1 + 0.2 * rng.normal(size=system.n_blades))
    return y


@pytest.mark.parametrize("lean", [0.0, 4e-3])
def test_whole_arrays_and_loops_are_one_model(models, lean):
    system, whole, loops = models
    y = state(system, lean)
    for t in (0.0, 1.234e-3):
        for loop in loops:
            np.testing.assert_allclose(loop(t, y), whole(t, y), rtol=1e-9, atol=1e-9 * np.abs(whole(t, y)).max())


def test_what_enters_is_pushed_back_and_pushes_the_casing(models):
    system, whole, _ = models
    free, y = state(system, 0.0), state(system, 4e-3)
    assert whole(0.0, free)[-1] == 0.0
    n = len(system.M)
    rub = whole(0.0, y)
    assert rub[-1] > 0
    alone = rub[n : 2 * n] - (whole.constant + whole.rates @ y[: 2 * n])
    force = system.M @ alone
    radial, around = force[: 3 * system.n_blades : 3], force[1 : 3 * system.n_blades : 3]
    touched = radial < -1e-3
    assert touched.any()
    np.testing.assert_allclose(around[touched], 0.1 * radial[touched])
    np.testing.assert_allclose(-radial.sum(), rub[-1])
    assert np.abs(force[system.casing_start :]).max() > 0
