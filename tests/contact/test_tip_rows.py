"""The bounds of eight tips at a time, as compiled kernels have them, against the same in plain Python."""

import numpy as np
import pytest

from rubgen.contact.tip_rows_kernels import set_tip_bounds
from rubgen.jit import kernel


def _bounds(tips, displacement, numbers, amplitude, order, cosine, sine, out):
    set_tip_bounds(tips, displacement, numbers, amplitude, order, cosine, sine, out)


compiled = kernel(_bounds)


@pytest.mark.parametrize("width", [8, 16, 40, 208])
@pytest.mark.parametrize("harmonics", [0, 1, 3])
@pytest.mark.parametrize("rows", [2, 3])
def test_the_bounds_are_those_of_plain_python(width, harmonics, rows):
    rng = np.random.default_rng(width + harmonics)
    tips, displacement = rng.normal(size=(2 + 2 * harmonics, width)), rng.normal(size=(rows, width))
    displacement[0, 3], displacement[1, 5], displacement[0, width - 1] = np.nan, np.nan, np.inf
    numbers, waves = tuple(rng.normal(size=4).tolist()), rng.normal(size=(4, harmonics))
    found, expected = np.full((2, width), 7.0)
    compiled(tips, displacement, numbers, *waves, found)
    _bounds(tips, displacement, numbers, *waves, expected)
    assert np.flatnonzero(np.isnan(expected)).tolist() == [3, 5]
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13)
