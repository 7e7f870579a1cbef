import numpy as np
import pytest

from tests.contact_calls import sliding_friction


def test_friction_is_tangent_unit_and_opposes_slip_at_random_angles():
    rng = np.random.default_rng(6)
    for _ in range(100):
        angle = rng.uniform(0, 2 * np.pi)
        tangent = np.array([-np.sin(angle), np.cos(angle)])
        tip, casing = rng.normal(size=3), rng.normal(size=2)
        force = sliding_friction(tip, casing, tangent)
        assert np.linalg.norm(force) == pytest.approx(1)
        assert force[:2] @ [np.cos(angle), np.sin(angle)] == pytest.approx(0, abs=1e-15)
        relative = tip - [*casing, 0]
        slip = np.array([*((relative[:2] @ tangent) * tangent), relative[2]])
        np.testing.assert_allclose(force, -slip / np.linalg.norm(slip), atol=1e-14)


def test_no_slip_gives_no_direction():
    assert not sliding_friction(np.array([1.0, 2.0, 0.0]), np.array([1.0, 2.0]), np.array([0.6, 0.8])).any()
