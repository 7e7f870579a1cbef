"""The bounds that spare gaps, in states that try to break them: tips just within a margin of a casing bent 10 mm."""

import math
from dataclasses import replace

import numpy as np
import pytest
from test_contact_geometry import NODES, RADIUS, ring

from rubgen.contact import blade_tips, casing_surface
from rubgen.contact.clearance_kernels import (
    NEAREST_SHARE,
    Deformation,
    closer_radius_shortfall,
    larger_margin,
    largest_nodal_displacement,
    radial_margin,
    radius_shortfall,
)
from rubgen.contact.geometry_kernels import tip_position, undeformed_radius
from rubgen.scenario import ContactLaw
from rubgen.solver.scheme.model import CASING_LIMIT_SHARE, TIP_LIMIT_SHARE, bounds_hold, relative_tip_shift
from tests.contact_calls import gap_and_foot, screened

TIP_LIMIT = TIP_LIMIT_SHARE * RADIUS
CASING_LIMIT = CASING_LIMIT_SHARE * RADIUS


def thick_ring(ovality, lobes, phase):
    """The ring with the rotations (u_t - u_r') / r = (n - 1 / n) sin(n t) / r of its sections, 3 mm thick."""
    orders = np.array([1, 2, 4])
    angle = 2 * np.pi * np.arange(NODES) / NODES
    rotations = (orders - 1 / orders) * np.sin(np.multiply.outer(angle, orders)) / RADIUS
    thick = {"casing_rotations": rotations, "half_thickness": 1.5e-3}
    return replace(ring(ovality, lobes, phase=phase, static=2e-3), **thick)


def near_states(surface, tips, rng, bent=(1e-5, CASING_LIMIT), aside=(1e-5, 1e-2)):
    """Tips (2, 9) at a few gaps about a margin, a casing (3,) within its limit, an opening, an angle, and the margin.

    The casing bends by `bent`, the tips aside by some `aside`, m; radially they are moved until the gap is right.
    """
    casing = rng.normal(size=3) * (rng.random(3) < 0.7) + 1e-9
    casing *= 10 ** rng.uniform(*np.log10(bent)) / largest_nodal_displacement(surface, casing)
    tangential = np.clip(rng.normal(size=9) * 10 ** rng.uniform(*np.log10(aside)), -TIP_LIMIT, TIP_LIMIT)
    displacement = np.stack([np.zeros(9), tangential])
    opening, margin = rng.choice([0.0, 1e-4, 1e-3]), rng.choice([2e-5, 3e-4])
    theta = rng.uniform(-20, 20)
    for k, share in enumerate(rng.choice([-0.01, 0.0, 0.9, 0.999], size=9)):
        for _ in range(8):
            gap = gap_and_foot(surface, casing, tip_place(tips, k, displacement, theta), opening)[0]
            displacement[0, k] = np.clip(displacement[0, k] + gap - share * margin, -TIP_LIMIT, TIP_LIMIT)
    return displacement, casing, opening, theta, margin


def tip_place(tips, blade, displacement, theta):
    q = np.zeros(27)
    q[3 * blade : 3 * blade + 2] = displacement[:, blade]
    return np.array(tip_position(tips, blade, q, math.cos(theta), math.sin(theta))[:2])


@pytest.mark.parametrize("lobes", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("contact", [ContactLaw(), ContactLaw(half_thickness=True), ContactLaw(surface="chords")])
def test_no_tip_within_the_margin_is_ever_called_clear(lobes, contact):
    rng, within = np.random.default_rng(lobes), 0
    for ovality in (0.0, 1e-3, 8e-3):
        system = thick_ring(ovality, lobes, rng.uniform(-7, 7))
        surface, tips = casing_surface(system, contact), blade_tips(system)
        tip_shift = relative_tip_shift(tips, TIP_LIMIT)
        assert bounds_hold(surface, tip_shift, CASING_LIMIT)
        for _ in range(20):
            displacement, casing, opening, theta, margin = near_states(surface, tips, rng)
            free, bounds, enough, apart = screened(
                surface, tips, casing, displacement, theta, opening, margin, tip_shift
            )
            places = [tip_place(tips, k, displacement, theta) for k in range(9)]
            gaps = np.array([gap_and_foot(surface, casing, place, opening)[0] for place in places])
            angles = [math.atan2(place[1], place[0]) % (2 * np.pi) for place in places]
            radii = np.array([undeformed_radius(surface, angle)[0] for angle in angles]) + opening
            assert np.all(free <= radii - np.hypot(*np.transpose(places)))
            assert not apart or gaps.min() > 0
            assert np.all(bounds[gaps < margin] <= enough)
            within += int((gaps < margin).sum())
    assert within > 300


def test_the_closer_bound_loses_a_tenth_of_the_wide_one():
    """The wide one loses (r' + u_r') |u| / R: 8 mm times 0.3 mm over 0.4 m are 6 um."""
    surface, casing = casing_surface(ring(8e-3, 2, phase=0.3)), Deformation(3e-4, 1e-3, 0.0)
    wide = radius_shortfall(surface, casing, 0.025)
    close = closer_radius_shortfall(surface, casing, 0.025, 1e-4, 8e-5, 1e-3)
    assert wide > 6e-6
    assert 0 < close < wide / 10


@pytest.mark.parametrize(
    ("approach", "margin"), [(1.9e-3, 3.8e-3), (2.1e-3, 1.6), (1e9, 1.6), (np.inf, 1.6), (np.nan, 1.6)]
)
def test_a_larger_margin_is_twice_the_approach_or_reaches_all_tips_and_no_others(approach, margin):
    """The bounds hold for margins that are small beside the radius; the lanes behind the last blade are FAR_AWAY."""
    surface = casing_surface(replace(ring(), surface=replace(ring().surface, mean_radius=0.4)))
    assert larger_margin(surface, approach) == margin


@pytest.mark.parametrize("rise", [0.03, 0.1, 0.3])
def test_the_radial_margin_is_that_across_the_steepest_surface_where_it_is_nearest(rise):
    surface = casing_surface(ring(0.0))._replace(mean_radius=1.0, slope=rise * NEAREST_SHARE)
    across = math.hypot(1.0, rise)
    assert across <= radial_margin(surface, Deformation(0.0, 0.0, 0.0), 1.0) < 1.0 + 1.1 * (across - 1.0)
