"""The shaft's angle within a turn."""

import numpy as np

from rubgen.measurement.shaft import in_turn


def test_an_angle_within_a_turn_is_never_the_whole_turn():
    """A tiny negative angle rounds up to 2 pi, which is 0."""
    angles = np.array([-1e-20, 0.0, 2 * np.pi, -2 * np.pi, -1e-3, 7.0, -700.0])
    turned = in_turn(angles)
    assert np.all((turned >= 0) & (turned < 2 * np.pi))
    np.testing.assert_allclose(np.exp(1j * turned), np.exp(1j * angles), atol=1e-12)
    assert turned[0] == 0.0
