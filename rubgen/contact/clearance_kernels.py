"""How far from the casing a blade tip certainly is, and the casing from rest: bounds that save work, never decide."""

from __future__ import annotations

import math

from rubgen.arrays import FloatArray
from rubgen.contact.geometry_kernels import Surface, Tips, tip_position, undeformed_radius
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.vector_kernels import LANES, blended_product, lowest_bit, not_above

LARGEST_SPREAD = 0.25
"""The bounds hold for tips nearer than this share of their radius to their place at rest."""
NEAREST_SHARE = 0.9
"""The bounds hold for a deformed surface whose radius is nowhere below this share of its mean one."""


@inlined_kernel
def casing_reach(surface: Surface, q_casing: FloatArray) -> float:
    """An upper bound of the casing's displacement anywhere on the ring, sum_j |q_j| reach_j."""
    reach: float = 0.0
    for j in range(q_casing.shape[0]):
        reach += abs(q_casing[j]) * surface.reach[j]
    return reach


@allocation_free_kernel
def largest_nodal_displacement(surface: Surface, q_casing: FloatArray) -> float:
    """The largest displacement of a casing node, m; NaN when any is."""
    largest = 0.0
    for i in range(surface.table.shape[0]):
        x, y = 0.0, 0.0
        for j in range(q_casing.shape[0]):
            x += surface.table[i, j, 0] * q_casing[j]
            y += surface.table[i, j, 1] * q_casing[j]
        size = x * x + y * y
        if not size <= largest:
            largest = size
    return math.sqrt(largest)


@allocation_free_kernel
def least_clearance(surface: Surface, tips: Tips, states: FloatArray, theta: FloatArray) -> float:
    """The smallest r(angle of P) - |P| over all tips P and states (places, n) at angles `theta` (places,), m.

    r is the undeformed, unworn surface.
    """
    least = math.inf
    for place in range(theta.shape[0]):
        cosine, sine = math.cos(theta[place]), math.sin(theta[place])
        for k in range(tips.angle.shape[0]):
            x, y, _, _ = tip_position(tips, k, states[place], cosine, sine)
            angle = math.atan2(y, x)
            radius, _, _ = undeformed_radius(surface, angle + 2 * math.pi if angle < 0.0 else angle)
            least = min(least, radius - math.hypot(x, y))
    return least


@inlined_kernel
def tip_angle(tips: Tips, blade: int, displacement: FloatArray, theta: float) -> float:
    """Polar angle of a blade's tip, from the `displacement` (2 or more, any) of all, to `angle_error`.

    The tip stands t aside at a radius of a: t / radius for arctan(t / a).
    """
    aside = tips.static[1, blade] + displacement[1, blade]
    angle: float = theta + tips.angle[blade] + aside / tips.radius
    return angle


@inlined_kernel
def angle_error(spread: float) -> float:
    """A bound of the error of `tip_angle` in rad, |a - radius| and |t| below `spread` < LARGEST_SPREAD radii.

    |t / radius - t / a| <= spread 4/3 spread, and |x - arctan x| <= |x|^3 / 3 with |x| <= 4/3 spread.
    """
    return spread * spread * (4.0 / 3.0 + 0.8 * spread)


@inlined_kernel
def clearance_bounds(
    surface: Surface,
    tips: Tips,
    displacement: FloatArray,
    opening: float,
    spread: float,
    cos_orders: FloatArray,
    sin_orders: FloatArray,
    bounds_out: FloatArray,
) -> None:
    """A lower bound of r(angle of P) + opening - |P| for every tip P, into `bounds_out` (n_blades or more,).

    Chords lie inside the smooth curve by at most `surface.inset`. Wear is left out: a worn surface encloses the unworn
    one, so no point is nearer to it.

    With a and t the radial and tangential place of the tip and x = t / a, its polar angle differs from the blade's by
    x but for |x|^3 / 3, r there from r + r' x by at most |r''| x^2 / 2, and |P| <= a + t x / 2. `displacement` (2 or
    more, any) holds the radial and the tangential displacement of each blade's tip, and |a - radius| and |t| are below
    `spread` < LARGEST_SPREAD radii; `cos_orders`, `sin_orders` (n_harmonics,) are those of order_j (theta - phase_j).
    """
    base = surface.mean_radius + opening - tips.radius - surface.inset
    nearest = 1.0 / tips.radius
    # 1 / (radius + a) is 1 / radius but for a share of 2 spread.
    aside = nearest * surface.steepness * spread * (2.0 + spread)
    bend = nearest * (0.5 + spread + surface.bend * nearest)
    for k in range(tips.angle.shape[0]):
        away = abs(tips.static[1, k] + displacement[1, k])
        bounds_out[k] = base - (tips.static[0, k] + displacement[0, k]) - away * (aside + bend * away)
    for j in range(surface.amplitude.shape[0]):
        cosine, sine = surface.amplitude[j] * cos_orders[j], surface.amplitude[j] * sin_orders[j]
        order = surface.order[j] * nearest
        for k in range(tips.angle.shape[0]):
            t = tips.static[1, k] + displacement[1, k]
            at = cosine * tips.cos_order[j, k] - sine * tips.sin_order[j, k]
            slope = sine * tips.cos_order[j, k] + cosine * tips.sin_order[j, k]
            bounds_out[k] += at - order * t * slope


@inlined_kernel
def deformation_bounds(surface: Surface, q_casing: FloatArray, spread: float) -> tuple[float, float]:
    """Bounds of the deformed surface on the whole ring, for `tighten`.

    First, how far its radius at a polar angle may lie below r + opening + u_r, u_r interpolated linearly between the
    nodes and taken at the angle that `tip_angle` gives; second, the slope of r + opening + u_r by the angle. A surface
    point at psi stands at a polar angle that differs by at most |u_t| / |X|, so the radius is less by at most that
    times the slope.
    """
    reach, moved, bend = 0.0, 0.0, 0.0
    for j in range(q_casing.shape[0]):
        size = abs(q_casing[j])
        reach += size * surface.reach[j]
        moved += size * surface.mode_slope[j]
        bend += size * surface.mode_bend[j]
    slope = surface.slope + moved
    h = surface.node_step
    nearest: float = NEAREST_SHARE * surface.mean_radius
    return slope * reach / nearest + moved * angle_error(spread) + 0.125 * h * h * bend, slope / nearest


@inlined_kernel
def inward_displacement(surface: Surface, casing: FloatArray, angle: float) -> float:
    """u_r of the casing at a polar angle, linear between the nodes.

    `casing` (a multiple of eight,) holds the casing's coordinates and zeros.
    """
    nodes = surface.radial.shape[0]
    position = angle * (1.0 / surface.node_step)
    first = math.floor(position)
    at = int(first % nodes)
    after = at + 1 if at + 1 < nodes else 0
    inward: float = blended_product(surface.radial, at, after, position - first, casing)
    return inward


@inlined_kernel
def widened(margin: float, limits: tuple[float, float]) -> float:
    """How much larger than a point's the surface's radius at its angle is, at most, if they are a margin apart.

    `limits` are the deformation bounds: the margin times the Lipschitz constant of that radius.
    """
    return margin * (1.0 + 0.5 * limits[1] * limits[1])


@inlined_kernel
def tighten(
    surface: Surface,
    tips: Tips,
    casing: FloatArray,
    displacement: FloatArray,
    theta: float,
    far: float,
    limits: tuple[float, float],
    bounds: FloatArray,
) -> bool:
    """Make clearance bounds up to `far` bounds to the deformed surface; whether all bounds are positive then.

    To the undeformed surface they were; `bounds` (a multiple of eight,) ends with numbers that are infinite. `casing`
    is as in `inward_displacement`. A tip whose bound is above `widened` of a margin is certainly farther than it inside
    of the deformed surface.
    """
    positive = True
    for row in range(bounds.shape[0] // LANES):
        near = not_above(bounds, row, far)
        while near != 0:
            k = LANES * row + lowest_bit(near)
            near &= near - 1
            inward = inward_displacement(surface, casing, tip_angle(tips, k, displacement, theta))
            bounds[k] += inward - limits[0]
            positive = positive and bounds[k] > 0.0
    return positive
