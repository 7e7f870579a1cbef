"""Every term of the losses in the bounds of clearance is needed: states that lose nearly all that a bound allows."""

import math
from dataclasses import replace

import numpy as np
import pytest
from test_contact_geometry import RADIUS, ring

from rubgen.contact import blade_tips, casing_surface
from rubgen.contact.clearance_kernels import (
    NEAREST_SHARE,
    Deformation,
    angle_error,
    casing_displacement_bound,
    closer_radius_shortfall,
    deformation_bounds,
    radial_margin,
    radius_shortfall,
)
from rubgen.contact.geometry_kernels import hermite, hermite_slope, tip_position, undeformed_radius
from rubgen.solver.scheme.model import relative_tip_shift
from tests.contact_calls import screened

STATES = {
    "sag": {"rises": 1.0, "sag": 1e-3},
    "turned": {"rises": 1.0, "u": 1e-3, "slope": 0.5},
    "angle": {"rises": 1.0, "slope": 0.3, "tip_shift": 0.2},
    "near": {"rises": 5.0, "u": 0.01},
    "open": {"rises": -5.0, "u": 0.01, "f": 1.4, "opening": 0.3},
    "arctan": {"rises": -5.0, "u": 0.4, "f": 1.1},
    "aside": {"bend": 1.0, "u": 1e-3, "aside": 0.2},
    "bend": {"bend": 10.0, "u": 0.02},
}


def worst(*, rises=0.0, u=0.0, sag=0.0, slope=0.0, bend=0.0, aside=0.0, f=NEAREST_SHARE, tip_shift=0.0, opening=0.0):
    """What the radius loses at most where u_t is taken for `u`, beside a mean radius of 1, and the bounds of the loss.

    The curve rises by `rises` at the blade's angle. Its second derivative is -`bend`, the point is `aside` of the
    blade. r + opening + u_r is f. u_t and u_r are wrong by the sag and by as much as they change on the way.
    """
    error = angle_error(tip_shift)
    largest = (u + sag + slope * error) / (1 - slope / NEAREST_SHARE)
    turned = math.atan(largest / f)
    surface = casing_surface(ring(ovality=0.0))
    surface = surface._replace(mean_radius=1.0, bend=bend, steepness=abs(rises) + bend * (aside + turned))
    surface = surface._replace(slope=surface.steepness)
    deformation = Deformation(largest, slope, sag)
    both = sag + slope * (error + turned) + bend * turned * (aside + 0.5 * turned)
    close = closer_radius_shortfall(surface, deformation, tip_shift, opening, u, aside)
    wide = radius_shortfall(surface, deformation, tip_shift)
    return both + rises * (turned - u), close, both + abs(rises) * turned, wide


@pytest.mark.parametrize("state", STATES.values(), ids=STATES.keys())
def test_a_surface_can_lose_most_of_what_the_bounds_allow_and_no_more(state):
    lost, allowed, of_wide, allowed_wide = worst(**state)
    assert 0.65 * allowed < lost <= allowed * (1 + 1e-9)
    assert of_wide <= allowed_wide * (1 + 1e-9)


@pytest.mark.parametrize("lobes", [1, 3, 12, 40])
def test_the_bound_to_the_undeformed_surface_holds_for_tips_far_aside(lobes):
    rng = np.random.default_rng(lobes)
    for _ in range(150):
        system = ring(0.04 * rng.random(), lobes, phase=rng.uniform(-7, 7))
        surface, tips, theta = casing_surface(system), blade_tips(system), rng.uniform(-7, 7)
        moved = (
            10 ** rng.uniform(-3, 0)
            * 0.24
            * RADIUS
            * 10 ** rng.uniform(-2, 0, size=(2, 9))
            * rng.choice([-1, 1], size=(2, 9))
        )
        tip_shift = relative_tip_shift(tips, np.abs(moved).max())
        free = screened(surface, tips, np.zeros(3), moved, theta, 0.0, 1e-5, tip_shift)[0]
        for k in range(9):
            q = np.zeros(27)
            q[3 * k : 3 * k + 2] = moved[:, k]
            x, y, _, _ = tip_position(tips, k, q, math.cos(theta), math.sin(theta))
            clear = undeformed_radius(surface, math.atan2(y, x) % (2 * math.pi))[0] - math.hypot(x, y)
            assert free[k] <= clear


@pytest.mark.parametrize("shift", [1e-3, 0.1, 0.2499])
def test_the_angle_s_error_is_that_of_a_tip_moved_inward_and_aside(shift):
    error = shift / (1 - shift) - math.atan(shift / (1 - shift))
    assert error <= angle_error(shift) < 2.5 * error


def field(surface, node, place):
    """|u|, the larger derivative of u_r and u_t, and u_r beside the straight line, of a mode behind a node."""
    h, nodes = surface.node_step, len(surface.table)
    (start, end), ends = surface.table[[node, (node + 1) % nodes], 0], surface.radial[[node, (node + 1) % nodes], 0]
    u, change = (
        complex(*(w[0] * start[:2] + w[1] * end[:2] + w[2] * start[2:] + w[3] * end[2:]))
        * np.exp(-1j * (node + place) * h)
        for w in (hermite(place, h), hermite_slope(place, h))
    )
    slope = change - 1j * u
    return abs(u), max(abs(slope.real), abs(slope.imag)), abs(u.real - ends[0] - place * (ends[1] - ends[0]))


def mode(kind, nodes, rng):
    """A mode (nodes, 2, 1): radial waves of 12th order, or X and Y that no wave between the nodes would have."""
    angle, noise = 2 * np.pi * np.arange(nodes) / nodes, rng.normal(size=(nodes, 2, 1))
    if kind == "waves":
        u = np.cos(12 * angle + rng.uniform(0, 7)) * np.exp(1j * angle)
        return np.stack([u.real, u.imag], axis=1)[:, :, None]
    if kind == "sawtooth":
        return (-1.0) ** np.arange(nodes)[:, None, None] * noise[:1]
    if kind == "highest":
        return np.cos((nodes - 1) // 2 * angle[:, None, None] + rng.uniform(0, 7)) * noise[:1]
    return noise


ROUGH = [(kind, nodes) for kind in ("random", "sawtooth", "highest") for nodes in (5, 6, 12)]


@pytest.mark.parametrize(("kind", "nodes"), [*ROUGH, ("waves", 120)])
def test_displacement_slope_and_sag_of_modes_are_bounded_between_nodes(kind, nodes):
    rng, largest = np.random.default_rng(nodes), np.zeros(3)
    for _ in range(2 if nodes == 120 else 20):
        surface, q = casing_surface(replace(ring(), casing_modes=mode(kind, nodes, rng))), np.ones(1)
        bounds = deformation_bounds(surface, q, casing_displacement_bound(surface, q))
        found = [field(surface, node, place) for node in range(nodes) for place in np.linspace(0, 1, 9)]
        largest = np.maximum(largest, np.max(found, axis=0) / np.array(bounds))
    assert np.all(largest <= 1 + 1e-12)
    assert kind != "waves" or largest.min() > 0.7  # the bounds of rough modes are wider


def test_a_bound_is_replaced_where_displacement_and_losses_together_can_undo_it():
    system, q, theta = ring(ovality=8e-3), np.array([0.0, 1e-3, 0.0]), math.pi / 2
    surface, tips = casing_surface(system), blade_tips(system)
    deformation = deformation_bounds(surface, q, casing_displacement_bound(surface, q))
    loss, enough = radius_shortfall(surface, deformation, 0.025), radial_margin(surface, deformation, 2e-5)
    for share, replaced in ((0.5, True), (0.99, True), (1.01, False)):
        moved = np.zeros((2, 9))
        free = screened(surface, tips, q, moved, theta, 0.0, 2e-5, 0.025)[0]
        moved[0, 0] = free[0] - (deformation.displacement + enough + share * loss)
        free, bounds, _, _ = screened(surface, tips, q, moved, theta, 0.0, 2e-5, 0.025)
        assert (bounds[0] != free[0]) == replaced
