import math

import numpy as np
import pytest

from rubgen.units import rad_per_s, rev_per_min


def test_sixty_revolutions_a_minute_are_one_turn_a_second():
    assert rad_per_s(60.0) == pytest.approx(2 * math.pi, rel=1e-15)
    assert rev_per_min(2 * math.pi) == pytest.approx(60.0, rel=1e-15)
    speeds = np.array([1.0, 8820.0])
    np.testing.assert_allclose(rev_per_min(rad_per_s(speeds)), speeds, rtol=1e-15)
