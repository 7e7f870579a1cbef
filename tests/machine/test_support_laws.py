"""Laws of the disk support: each stands twice in its file, and the compiled form is the plain one."""

import math
import sys

import numpy as np
import pytest

from rubgen.machine import SqueezeFilm
from rubgen.machine.support_laws.disk_support import SUPPORT_LAWS

EXAMPLES = {"squeeze_film": SqueezeFilm(radius_m=0.05, length_m=0.03, clearance_m=5e-4, viscosity_pa_s=0.05)}


def test_every_law_has_an_example():
    assert {key: type(law) for key, law in EXAMPLES.items()} == SUPPORT_LAWS


@pytest.mark.parametrize("key", EXAMPLES)
def test_the_terms_of_a_law_make_its_force(key):
    law, rng = EXAMPLES[key], np.random.default_rng(1)
    for u, v in zip(rng.uniform(-3e-4, 3e-4, (9, 2)), rng.normal(size=(9, 2)), strict=True):
        s_x, s_y, xx, xy, yx, yy = law.terms(np.array(law.numbers), *u)
        np.testing.assert_allclose(law.force(u, v), [s_x, s_y] - np.array([[xx, xy], [yx, yy]]) @ v, rtol=1e-12)


@pytest.mark.parametrize("key", EXAMPLES)
def test_the_force_is_alike_in_all_directions(key):
    law, turn = EXAMPLES[key], 0.7
    R = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    u, v = np.array([2e-4, -1e-4]), np.array([0.3, 0.1])
    np.testing.assert_allclose(law.force(R @ u, R @ v), R @ law.force(u, v), rtol=1e-12)


@pytest.mark.parametrize("key", SUPPORT_LAWS)
def test_what_is_compiled_stands_in_the_file_of_the_law(key):
    """The key of compiled kernels is made of these files."""
    law = SUPPORT_LAWS[key]
    names = set(law.terms.__code__.co_names)
    own = vars(sys.modules[law.__module__])
    for name in names & set(own):
        assert own[name] is math or isinstance(own[name], int | float), name
