"""The abradable liner's depth: a spline that only grows, never beyond the liner, and loses nothing."""

import numpy as np
import pytest
from test_contact_geometry import RADIUS, ring

from rubgen.contact import casing_surface
from rubgen.contact.geometry import unworn
from rubgen.contact.liner_kernels import REMOVED, remove, worn_depth
from rubgen.scenario import ContactLaw, Liner
from tests.contact_calls import gap_and_foot

SPEC = Liner(thickness_m=5e-4, wear_m2_per_n=1e-11, width_m=0.03, bins=120)


@pytest.fixture
def surface():
    return casing_surface(ring(), ContactLaw(liner=SPEC))


def test_a_new_liner_leaves_the_surface_as_it_is(surface):
    plain, point = casing_surface(ring()), RADIUS * np.array([np.cos(1.0), np.sin(1.0)])
    np.testing.assert_array_equal(gap_and_foot(surface, np.zeros(3), point), gap_and_foot(plain, np.zeros(3), point))
    assert plain.liner.bins == 0


def test_volume_removed_is_the_mean_depth_times_the_track_and_the_sum_of_what_was_taken(surface):
    liner, wear, rng = surface.liner, unworn(surface.liner), np.random.default_rng(3)
    taken = rng.uniform(0, 2e-9, 300)
    for psi, volume in zip(rng.uniform(-10, 10, 300), taken, strict=True):
        before = wear.depth.copy()
        remove(liner, psi, volume, wear)
        assert np.all(wear.depth >= before)
    assert wear.depth.max() < SPEC.thickness_m
    assert wear.sums[REMOVED] == pytest.approx(taken.sum(), rel=1e-12)
    angle = np.linspace(0, 2 * np.pi, 12000, endpoint=False)
    mean = np.mean([worn_depth(wear.depth, psi)[0] for psi in angle])
    track = 2 * np.pi * surface.mean_radius * SPEC.width_m
    assert mean * track == pytest.approx(taken.sum(), rel=1e-9)


def test_the_depth_ends_at_the_liners_thickness_and_only_what_is_there_counts(surface):
    liner, wear = surface.liner, unworn(surface.liner)
    for _ in range(50):
        remove(liner, 2.0, 1e-7, wear)
    angle = np.linspace(0, 2 * np.pi, 5000)
    depth = np.array([worn_depth(wear.depth, psi)[0] for psi in angle])
    assert depth.max() == pytest.approx(SPEC.thickness_m, rel=1e-12)
    assert depth.min() >= 0
    assert wear.sums[REMOVED] == pytest.approx(liner.area * wear.depth.sum(), rel=1e-12)
    assert wear.sums[REMOVED] < 50e-7


def test_the_profile_is_smooth_and_its_derivatives_are_right(surface):
    wear, h = unworn(surface.liner), 1e-6
    wear.depth[:] = np.random.default_rng(4).uniform(0, 5e-4, SPEC.bins)
    for psi in np.linspace(-7, 7, 61):
        _, slope, bend = worn_depth(wear.depth, psi)
        before, after = (worn_depth(wear.depth, psi + side * h) for side in (-1, 1))
        assert slope == pytest.approx((after[0] - before[0]) / (2 * h), rel=1e-5, abs=1e-8)
        assert bend == pytest.approx((after[1] - before[1]) / (2 * h), rel=1e-4, abs=1e-4)
    for knot in 2 * np.pi * np.arange(5) / SPEC.bins:
        sides = [worn_depth(wear.depth, knot + side * 1e-12) for side in (-1, 1)]
        np.testing.assert_allclose(*sides, rtol=1e-6)


def test_an_even_wear_opens_the_gap_by_its_depth(surface):
    point = RADIUS * np.array([np.cos(0.4), np.sin(0.4)])
    new = gap_and_foot(surface, np.zeros(3), point)
    worn = gap_and_foot(surface, np.zeros(3), point, worn=np.full(SPEC.bins, 2e-4))
    wide = gap_and_foot(casing_surface(ring()), np.zeros(3), point, 2e-4)
    assert worn[0] > new[0]
    np.testing.assert_allclose(worn, wide, rtol=1e-12)
