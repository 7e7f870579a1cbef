"""Bounds of tip clearance and of casing displacement. They only save work: no bit of a run depends on them."""

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.geometry_kernels import Surface, Tips, tip_position, undeformed_radius
from rubgen.contact.tip_rows_kernels import set_tip_bounds
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
    """Return the smallest clearance r(angle of P) - |P| over all tips P and states, m; negative with a tip outside r.

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

    The tip is at the radius a, with the distance t from the blade's axis. t / a replaces arctan(t / a).

    - displacement (2 or more, n_blades or more): radial and tangential displacement of each blade's tip, m.
    - theta: angle of the blisk, rad.
    """
    along = tips.radius + tips.static[0, blade] + displacement[0, blade]
    aside = tips.static[1, blade] + displacement[1, blade]
    angle: float = theta + tips.angle[blade] + aside / along
    return angle


@inlined_kernel
def angle_error(tip_shift: float) -> float:
    """Return a bound of the error of `tip_angle` in rad, for |a - radius| and |t| up to s = `tip_shift` radii.

    |x - arctan x| <= |x|^3 / 3 with |x| = |t / a| <= 4/3 s. Valid for s < LARGEST_TIP_SHIFT.
    """
    return 0.8 * tip_shift * tip_shift * tip_shift


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

    - displacement (2 or more, width): radial and tangential displacement of each blade's tip, then zeros, m.
    - opening: added to the radius of the surface, m.
    - tip_shift: bound of |a - radius| and |t|, in tip radii; below LARGEST_TIP_SHIFT.
    - cos_orders, sin_orders (n_harmonics,): cosine and sine of order_j (theta - phase_j).
    - bounds_out (width,): written, m; beyond 1e5 m behind the last blade. `width` is the number of blades up to a
      multiple of eight.
    """
    base = surface.mean_radius + opening - tips.radius - surface.inset
    nearest = 1.0 / tips.radius
    # 1 / (radius + a) differs from 1 / radius by a share of at most 2 tip_shift.
    aside = nearest * surface.steepness * tip_shift * (2.0 + tip_shift)
    bend = nearest * (0.5 + tip_shift + surface.bend * nearest)
    set_tip_bounds(
        tips.bound_rows, displacement, (base, nearest, aside, bend), surface.amplitude, surface.order, cos_orders,
        sin_orders, bounds_out,
    )  # fmt: skip


class Deformation(NamedTuple):
    """Bounds of the casing's displacement u on the whole ring in one step."""

    displacement: float
    """Of |u|, m."""
    slope: float
    """Of the derivatives of u_r and u_t by the polar angle, m."""
    sag: float
    """How far u_r and u_t may lie beside a straight line between their values at two nodes, m."""


@inlined_kernel
def deformation_bounds(surface: Surface, q_casing: FloatArray, displacement: float) -> Deformation:
    """Return bounds of the casing's deformation. `displacement` is the bound of `casing_displacement_bound`, m.

    `q_casing` (n_casing,) are the casing's modal coordinates.
    """
    slope, bend = 0.0, 0.0
    for j in range(q_casing.shape[0]):
        size = abs(q_casing[j])
        slope += size * surface.mode_slope[j]
        bend += size * surface.mode_bend[j]
    return Deformation(displacement, slope, 0.125 * surface.node_step * surface.node_step * bend)


@inlined_kernel
def radius_shortfall(surface: Surface, deformation: Deformation, tip_shift: float) -> float:
    """Return how far the deformed surface's radius at a tip's polar angle may lie below r + opening + u_r there, m.

    r is the unworn surface's radius, and u_r the linear interpolation between nodes at the angle of `tip_angle`.
    `tip_shift` is the bound of the tips' displacement, in tip radii; below LARGEST_TIP_SHIFT.

    A surface point at psi is at a polar angle that differs from psi by at most |u_t| / |X|. Its radius is therefore
    less by at most this angle times the slope.
    """
    nearest = NEAREST_SHARE * surface.mean_radius
    turned = deformation.displacement / nearest
    shortfall: float = (surface.slope + deformation.slope) * turned
    return shortfall + deformation.slope * angle_error(tip_shift) + deformation.sag


@inlined_kernel
def closer_radius_shortfall(
    surface: Surface, deformation: Deformation, tip_shift: float, opening: float, tangential: float, aside: float
) -> float:
    """Return how far that radius may lie below r + opening + u_r - r' u_t / R, m; much less than `radius_shortfall`.

    r, u_r and the first three parameters are as in `radius_shortfall`. r' is the slope of the smooth curve at the angle
    of the blade, R its mean radius, and u_t interpolated as u_r is.

    The surface point at the polar angle phi was at phi - d before the deformation, with tan d = u_t / (r + opening +
    u_r). The radius is at least r + opening + u_r at phi - d. To first order in d that is the expression above, with
    the linear interpolation and the tip's approximate angle. What they leave out is bounded by sums of products.

    - opening: added to the radius of the surface, m.
    - tangential: u_t, m.
    - aside: |t| / a of the tip, rad.
    """
    nearest, error = NEAREST_SHARE * surface.mean_radius, angle_error(tip_shift)
    turned = deformation.displacement / nearest
    missed = deformation.sag + deformation.slope * (turned + error)  # of u_t at phi - d
    size = abs(tangential)
    here = (size + missed) / nearest  # bound of |d|
    unlike = 1.0 / NEAREST_SHARE - 1.0 + abs(opening) / surface.mean_radius  # of R / (r + opening + u_r)
    angle = missed / nearest + unlike * size / surface.mean_radius + turned * turned * turned / 3
    shortfall: float = deformation.sag + deformation.slope * (error + here)
    shortfall += surface.steepness * angle + surface.bend * here * aside
    return shortfall + 0.5 * surface.bend * turned * turned


@inlined_kernel
def radial_margin(surface: Surface, deformation: Deformation, margin: float) -> float:
    """Return the largest radial distance to the surface, m, of a point that is at most `margin` (m) from the surface.

    The radial distance is a bound of `tighten`, r + opening + u_r at the point's polar angle, less a shortfall
    and the point's radius. Let X be the nearest place of the surface, for which the shortfall holds. From X's polar
    angle to the point's the bound changes by at most F times their difference. F is the slope of r + u_r, and what u_t
    and r' change on this way in `closer_radius_shortfall`. This way and the one along the radius are at right angles;
    the margin is their hypotenuse.
    """
    nearest = NEAREST_SHARE * surface.mean_radius
    slope = (surface.slope + deformation.slope) * (1.0 + deformation.slope / nearest)
    slope = (slope + surface.bend * deformation.displacement / nearest) / nearest
    return margin * (1.0 + 0.5 * slope * slope)


@inlined_kernel
def larger_margin(surface: Surface, approach: float) -> float:
    """Return the margin to try after a smaller one, m: twice the `approach` (m), but never much of a radius.

    Beyond a hundredth of the surface's radius it is four radii, and so it is for an approach that is NaN. Every tip is
    within four radii. Even their `radial_margin` is less than FAR_AWAY.
    """
    margin = 2.0 * approach
    return margin if margin < 0.01 * surface.mean_radius else 4.0 * surface.mean_radius


@inlined_kernel
def curve_slope(surface: Surface, tips: Tips, blade: int, cos_orders: FloatArray, sin_orders: FloatArray) -> float:
    """Return dr/dpsi of the smooth curve, m, at the polar angle of a blade: theta plus the blade's angle on the disk.

    `cos_orders` and `sin_orders` (n_harmonics,) are cosine and sine of order_j (theta - phase_j).
    """
    slope = 0.0
    for j in range(surface.amplitude.shape[0]):
        cos_tip, sin_tip = tips.bound_rows[2 + 2 * j, blade], tips.bound_rows[3 + 2 * j, blade]
        slope -= surface.amplitude[j] * surface.order[j] * (sin_orders[j] * cos_tip + cos_orders[j] * sin_tip)
    return slope


@inlined_kernel
def tighten(
    surface: Surface,
    tips: Tips,
    casing: FloatArray,
    displacement: FloatArray,
    theta: float,
    cos_orders: FloatArray,
    sin_orders: FloatArray,
    opening: float,
    tip_shift: float,
    deformation: Deformation,
    enough: float,
    bounds: FloatArray,
) -> bool:
    """Replace every clearance bound that the casing's displacement could undo by one to the deformed surface.

    A bound that is NaN is replaced too. Return True if all replaced bounds are positive, or none is replaced: then no
    tip touches. A tip whose bound is then above `enough` is inside the deformed surface, and farther from it than the
    margin for which `enough` is the `radial_margin`. The new bound uses `radius_shortfall`. Where this bound is not
    above `enough`, one with `closer_radius_shortfall` takes its place.

    - casing (a multiple of eight,): the casing's modal coordinates, then zeros.
    - displacement (2 or more, n_blades or more): radial and tangential displacement of each blade's tip, m.
    - theta: angle of the blisk, rad.
    - cos_orders, sin_orders (n_harmonics,): cosine and sine of order_j (theta - phase_j).
    - opening: added to the radius of the surface, m.
    - tip_shift: bound of the tips' displacement, in tip radii; below LARGEST_TIP_SHIFT.
    - deformation: the casing's.
    - bounds (a multiple of eight,): bounds of `clearance_bounds`; changed, m.
    """
    positive, nodes = True, surface.radial.shape[0]
    shortfall = radius_shortfall(surface, deformation, tip_shift)
    far = deformation.displacement + shortfall + enough  # u_r is nowhere larger than the displacement
    for row in range(bounds.shape[0] // LANES):
        near = not_above(bounds, row, far)
        while near != 0:
            k = LANES * row + lowest_bit(near)
            near &= near - 1
            position = tip_angle(tips, k, displacement, theta) * (1.0 / surface.node_step)
            first = math.floor(position)
            at = int(first % nodes)
            after = at + 1 if at + 1 < nodes else 0
            free = bounds[k] + blended_product(surface.radial, at, after, position - first, casing)
            bounds[k] = free - shortfall
            if not bounds[k] > enough:
                tangential = blended_product(surface.tangential, at, after, position - first, casing)
                aside = abs(tips.static[1, k] + displacement[1, k]) / (tips.radius * (1.0 - tip_shift))
                shift = curve_slope(surface, tips, k, cos_orders, sin_orders) * tangential / surface.mean_radius
                least = closer_radius_shortfall(surface, deformation, tip_shift, opening, tangential, aside)
                bounds[k] = free - shift - least
            positive = positive and bounds[k] > 0.0
    return positive
