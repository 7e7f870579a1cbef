"""Which touches are drawn one by one."""

from types import SimpleNamespace

import numpy as np

from rubgen.viz.entities.events import MOST_TOUCHES, shown_touches


def test_of_too_many_touches_the_hardest_are_drawn_in_their_order():
    impulse = np.random.default_rng(1).permutation(np.arange(3.0 * MOST_TOUCHES))
    many = SimpleNamespace(touches=SimpleNamespace(impulse=impulse))
    np.testing.assert_array_equal(shown_touches(many, full=False), np.flatnonzero(impulse >= 2 * MOST_TOUCHES))
    np.testing.assert_array_equal(shown_touches(many, full=True), np.arange(impulse.size))
    few = SimpleNamespace(touches=SimpleNamespace(impulse=impulse[:MOST_TOUCHES]))
    np.testing.assert_array_equal(shown_touches(few, full=False), np.arange(MOST_TOUCHES))
