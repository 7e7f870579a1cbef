"""Bounds of tip clearance and of casing displacement. They only save work: no bit of a run depends on them."""

import math

from rubgen.arrays import FloatArray
from rubgen.contact.geometry_kernels import Surface, Tips, tip_position, undeformed_radius
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.vector_kernels import LANES, blended_product, lowest_bit, not_above

LARGEST_TIP_SHIFT = 0.25
"""The bounds are valid for tips that moved less than this share of their radius from their place at rest."""
NEAREST_SHARE = 0.9
"""The bounds are valid for a deformed surface whose radius is nowhere below this share of its mean radius."""


@inlined_kernel
def casing_displacement_bound(surface: Surface, q_casing: FloatArray) -> float:
    """Return an upper bound of the casing's displacement anywhere on the ring, m: sum_j |q_j| mode_displacement_j.

    `q_casing` (n_casing,) are the casing's modal coordinates.
    """
    displacement: float = 0.0
    for j in range(q_casing.shape[0]):
        displacement += abs(q_casing[j]) * surface.mode_displacement[j]
    return displacement


@allocation_free_kernel
def largest_nodal_displacement(surface: Surface, q_casing: FloatArray) -> float:
    """Return the largest displacement of a casing node, m; NaN if a coordinate is NaN.

    `q_casing` (n_casing,) are the casing's modal coordinates.
    """
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
    """Return the smallest clearance r(angle of P) - |P| over all tips P, m. It is negative where a tip is outside r.

    r is the radius of the undeformed, unworn surface. `states` (places, n) are coordinates of the blisk, each at the
    angle in `theta` (places,), rad.
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
    """Return the polar angle of a blade's tip in rad. Its error is at most `angle_error`.

    The tip is at the radius a, with the distance t from the blade's axis. t / radius replaces arctan(t / a).

    - displacement (2 or more, n_blades or more): radial and tangential displacement of each blade's tip, m.
    - theta: angle of the blisk, rad.
    """
    aside = tips.static[1, blade] + displacement[1, blade]
    angle: float = theta + tips.angle[blade] + aside / tips.radius
    return angle


@inlined_kernel
def angle_error(tip_shift: float) -> float:
    """Return a bound of the error of `tip_angle` in rad, for |a - radius| and |t| up to s = `tip_shift` radii.

    |t / radius - t / a| <= 4/3 s^2, and |x - arctan x| <= |x|^3 / 3 with |x| <= 4/3 s. Valid for s < LARGEST_TIP_SHIFT.
    """
    return tip_shift * tip_shift * (4.0 / 3.0 + 0.8 * tip_shift)


@inlined_kernel
def clearance_bounds(
    surface: Surface,
    tips: Tips,
    displacement: FloatArray,
    opening: float,
    tip_shift: float,
    cos_orders: FloatArray,
    sin_orders: FloatArray,
    bounds_out: FloatArray,
) -> None:
    """Write a lower bound of r(angle of P) + opening - |P| for every tip P, m, into `bounds_out`.

    r is the radius of the undeformed surface. Chords lie inside the smooth curve by at most `surface.inset`. Wear is
    left out: a worn surface encloses the unworn surface, so it is nowhere nearer.

    Let a and t be the radial and tangential position of the tip, and x = t / a. Its polar angle differs from the
    blade's by x, with an error of at most |x|^3 / 3. There r differs from r + r' x by at most |r''| x^2 / 2. |P| is at
    most a + t x / 2.

    - displacement (2 or more, n_blades or more): radial and tangential displacement of each blade's tip, m.
    - opening: added to the radius of the surface, m.
    - tip_shift: bound of |a - radius| and |t|, in tip radii; below LARGEST_TIP_SHIFT.
    - cos_orders, sin_orders (n_harmonics,): cosine and sine of order_j (theta - phase_j).
    - bounds_out (n_blades or more,): written, m.
    """
    base = surface.mean_radius + opening - tips.radius - surface.inset
    nearest = 1.0 / tips.radius
    # 1 / (radius + a) differs from 1 / radius by a share of at most 2 tip_shift.
    aside = nearest * surface.steepness * tip_shift * (2.0 + tip_shift)
    bend = nearest * (0.5 + tip_shift + surface.bend * nearest)
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
def deformation_bounds(surface: Surface, q_casing: FloatArray, tip_shift: float) -> tuple[float, float]:
    """Return two bounds of the deformed surface on the whole ring, for `tighten`.

    The first, in m, is how far the surface's radius at a polar angle may lie below r + opening + u_r, with u_r
    interpolated linearly between the nodes at the angle of `tip_angle`. The second is the largest slope of r + opening
    + u_r by the angle, over the smallest radius.

    - q_casing (n_casing,): the casing's modal coordinates.
    - tip_shift: bound of the tips' displacement, in tip radii; below LARGEST_TIP_SHIFT.

    A surface point at psi is at a polar angle that differs from psi by at most |u_t| / |X|. Its radius is therefore
    less by at most this angle times the slope.
    """
    displacement, moved, bend = 0.0, 0.0, 0.0
    for j in range(q_casing.shape[0]):
        size = abs(q_casing[j])
        displacement += size * surface.mode_displacement[j]
        moved += size * surface.mode_slope[j]
        bend += size * surface.mode_bend[j]
    slope = surface.slope + moved
    h = surface.node_step
    nearest: float = NEAREST_SHARE * surface.mean_radius
    return slope * displacement / nearest + moved * angle_error(tip_shift) + 0.125 * h * h * bend, slope / nearest


@inlined_kernel
def radial_displacement(surface: Surface, casing: FloatArray, angle: float) -> float:
    """Return the radial displacement u_r of the casing at a polar angle, m: linear in the angle between two nodes.

    - casing (a multiple of eight,): the casing's modal coordinates, then zeros.
    - angle: polar angle in the inertial frame, rad; it need not lie in [0, 2 pi). Node i is at i times
      `surface.node_step`.
    """
    nodes = surface.radial.shape[0]
    position = angle * (1.0 / surface.node_step)
    first = math.floor(position)
    at = int(first % nodes)
    after = at + 1 if at + 1 < nodes else 0
    outward: float = blended_product(surface.radial, at, after, position - first, casing)
    return outward


@inlined_kernel
def radial_margin(margin: float, limits: tuple[float, float]) -> float:
    """Return the largest radial distance to the surface, m, of a point that is at most `margin` (m) from the surface.

    It is the margin times the Lipschitz constant of the surface's radius. `limits` are the two `deformation_bounds`.
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
    """Replace every clearance bound of at most `far` by a bound of the clearance to the deformed surface.

    A bound that is NaN is replaced too. Return True if all replaced bounds are positive, or none is replaced. Then no
    tip touches, provided that `far` is at least the bound of the casing's displacement plus limits[0]. A tip whose new
    bound exceeds `radial_margin(margin, limits)`, for any margin in m, is inside the deformed surface and farther than
    the margin from it.

    - casing (a multiple of eight,): the casing's modal coordinates, then zeros.
    - displacement (2 or more, n_blades or more): radial and tangential displacement of each blade's tip, m.
    - theta: angle of the blisk, rad.
    - far: largest bound that is replaced, m.
    - limits: the two `deformation_bounds`.
    - bounds (a multiple of eight,): bounds of `clearance_bounds`, then inf; changed, m.
    """
    positive = True
    for row in range(bounds.shape[0] // LANES):
        near = not_above(bounds, row, far)
        while near != 0:
            k = LANES * row + lowest_bit(near)
            near &= near - 1
            outward = radial_displacement(surface, casing, tip_angle(tips, k, displacement, theta))
            bounds[k] += outward - limits[0]
            positive = positive and bounds[k] > 0.0
    return positive
