"""How the frequencies of the pre-twisted tapered blade converge; their values are in tests/validation."""

import dataclasses

import numpy as np

from validation.verification.elements.twisted_blades import TWISTED, element_frequencies, shooting_frequency


def test_frequencies_come_from_above_with_the_second_order() -> None:
    # Static shape functions are conforming; shear and torsion rule the order.
    coarse, fine = (element_frequencies(dataclasses.replace(TWISTED, elements=n)) for n in (20, 40))
    exact = np.array([shooting_frequency(w) for w in fine])
    np.testing.assert_allclose(fine, exact, rtol=2e-4)
    assert np.all(fine > exact * (1 - 1e-8))
    assert np.all(coarse > fine)
    np.testing.assert_allclose((coarse - exact) / (fine - exact), 4.0, atol=1.0)


def test_twist_matters() -> None:
    # Else the shooting test would not show that the planes are coupled rightly.
    straight = dataclasses.replace(TWISTED, root_angle_deg=0.0, tip_angle_deg=0.0)
    assert element_frequencies(straight)[1] / element_frequencies(TWISTED)[1] > 1.4
