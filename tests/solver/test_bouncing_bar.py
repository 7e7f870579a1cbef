"""The bar that bounces off a wall, beside its values in tests/validation/test_verification.py."""

import numpy as np
import pytest

from validation.verification.contact.bouncing_bar import bounce


def test_impulse_and_rebound_converge_with_the_order_of_a_dispersed_front() -> None:
    bars = [bounce(elements) for elements in (50, 100, 200, 400)]
    for errors in ([200 - bar.impulse for bar in bars], [10 - bar.rebound for bar in bars]):
        assert np.log2(np.array(errors[:-1]) / errors[1:]) == pytest.approx(2 / 3, abs=0.05)


def test_nothing_pulls_and_nothing_touches_twice() -> None:
    force = bounce(200).force
    assert np.all(force >= 0)
    touching = np.flatnonzero(force)
    assert len(touching) == touching[-1] - touching[0] + 1
