"""Where a blade tip stands against the deformed casing surface.

The surface is X(psi) = (r(psi) + opening) e_r(psi) + u(psi): the undeformed curve plus the casing's elastic
displacement, interpolated between the nodes by periodic cubic Hermite polynomials (continuous in slope). The undeformed
curve is smooth; as an option it is the polygon through the nodes, and worn where there is a liner.
"""

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray
from rubgen.contact.liner_kernels import Liner, worn_depth
from rubgen.jit import allocation_free_kernel, inlined_kernel

FOOT_TOLERANCE = 1e-10
FOOT_ITERATIONS = 20
FAR_AWAY = 1e6
"""Distance in m of a tip that does not exist from the surface."""


class Surface(NamedTuple):
    """The casing's inner surface as kernels take it, without wear. Lengths are in m, angles in rad."""

    mean_radius: float
    """Mean radius of the smooth curve."""
    amplitude: FloatArray
    """Amplitudes of its harmonics (n_harmonics,)."""
    order: FloatArray
    """Their orders."""
    phase: FloatArray
    """Their phases, as in `CasingSurface`."""
    table: FloatArray
    """X, Y and their derivatives by the polar angle for each node and mode (nodes, n_casing, 4)."""
    node_step: float
    """Angle between two nodes."""
    mode_displacement: FloatArray
    """Bound of the displacement anywhere on the ring per unit of each mode (n_casing,)."""
    mode_slope: FloatArray
    """Bound of the first derivative of the radial and tangential displacement by the angle per unit of each mode
    (n_casing,)."""
    mode_bend: FloatArray
    """Bound of their second derivatives (n_casing,)."""
    radial: FloatArray
    """Radial displacement at the nodes per unit of each mode, and zeros behind (nodes, a multiple of eight)."""
    tangential: FloatArray
    """Tangential displacement, likewise."""
    steepness: float
    """Bound of |dr/dpsi| of the smooth curve."""
    bend: float
    """Bound of |d2r/dpsi2| of the smooth curve."""
    corners: FloatArray
    """Radii at the nodes (nodes,) where chords join them, else (0,)."""
    inset: float
    """Bound of how far the unworn surface lies inside of the smooth curve."""
    slope: float
    """Bound of |dr/dpsi| of the unworn surface."""
    liner: Liner
    """The liner's constants."""


class Tips(NamedTuple):
    """The blade tips as kernels take them."""

    radius: float
    """Radius at rest, m."""
    static: FloatArray
    """Steady displacement along the blade's axes (3, n_blades), m."""
    angle: FloatArray
    """Angle of each blade on the disk (n_blades,), rad."""
    cos_angle: FloatArray
    """Its cosine (n_blades,)."""
    sin_angle: FloatArray
    """Its sine (n_blades,)."""
    bound_rows: FloatArray
    """What `set_tip_bounds` takes of each blade (2 + 2 n_harmonics, the blades up to a multiple of eight): the radial
    and tangential part of `static`, and for each harmonic cosine and sine of its order times the angle. Behind the last
    blade the first row has -FAR_AWAY, the others have zeros."""


@allocation_free_kernel
def chord_radius(start: float, end: float, angle: float, step: float) -> tuple[float, float, float]:
    """Return r, dr/dpsi and d2r/dpsi2 on the straight line between two nodes, at `angle` (rad) after the first node.

    On the line 1 / r is a sinusoid of the angle. `start` and `end` are the radii of the nodes, m; `step` is the angle
    between them, rad.
    """
    sine = math.sin(step)
    inverse = (math.sin(step - angle) / start + math.sin(angle) / end) / sine
    change = (math.cos(angle) / end - math.cos(step - angle) / start) / sine
    radius = 1 / inverse
    slope = -change * radius * radius
    return radius, slope, 2 * slope * slope / radius + radius


@inlined_kernel
def undeformed_radius(surface: Surface, psi: float) -> tuple[float, float, float]:
    """Return r, dr/dpsi and d2r/dpsi2 of the undeformed, unworn surface at the polar angle psi (rad), in m."""
    radius, slope, bend = smooth_radius(surface, psi)
    if surface.corners.shape[0] > 0:
        first, second, s = interval(psi, surface.node_step, surface.corners.shape[0])
        angle = s * surface.node_step
        radius, slope, bend = chord_radius(surface.corners[first], surface.corners[second], angle, surface.node_step)
    return radius, slope, bend


@inlined_kernel
def worn_radius(surface: Surface, worn: FloatArray, psi: float) -> tuple[float, float, float]:
    """Return r, dr/dpsi and d2r/dpsi2 of the undeformed surface with its wear, in m, at the polar angle psi (rad).

    `worn` (bins,) are the coefficients of the worn depth, m; empty without a liner.
    """
    radius, slope, bend = undeformed_radius(surface, psi)
    if worn.shape[0] > 0:
        depth, depth_slope, depth_bend = worn_depth(worn, psi)
        radius, slope, bend = radius + depth, slope + depth_slope, bend + depth_bend
    return radius, slope, bend


@inlined_kernel
def smooth_radius(surface: Surface, psi: float) -> tuple[float, float, float]:
    """Return r, dr/dpsi and d2r/dpsi2 of the smooth curve r = R + sum_j a_j cos(n_j (psi - phase_j)), m; psi in rad."""
    radius, slope, bend = surface.mean_radius, 0.0, 0.0
    for j in range(surface.amplitude.shape[0]):
        order = surface.order[j]
        angle = order * (psi - surface.phase[j])
        cosine, sine = surface.amplitude[j] * math.cos(angle), surface.amplitude[j] * math.sin(angle)
        radius += cosine
        slope -= order * sine
        bend -= order * order * cosine
    return radius, slope, bend


@allocation_free_kernel
def interval(psi: float, node_step: float, nodes: int) -> tuple[int, int, float]:
    """Return the numbers of the two nodes around the polar angle psi, and the share of the interval before psi.

    psi is in rad and need not lie in [0, 2 pi). The `nodes` nodes are `node_step` rad apart, and node 0 is at the angle
    0.
    """
    position = psi / node_step
    first = math.floor(position)
    return int(first % nodes), int((first + 1) % nodes), position - first


@allocation_free_kernel
def load_interval(table: FloatArray, first: int, second: int, q_casing: FloatArray, ends_out: FloatArray) -> None:
    """Write displacement and slope (X, Y, X', Y') at the two nodes of an interval into `ends_out` (8,).

    - table (nodes, n_casing, 4): these four values of each node and mode.
    - first, second: numbers of the nodes.
    - q_casing (n_casing,): the casing's modal coordinates.

    The sums are written out, so that the compiler adds the four values of a node at the same time.
    """
    for side, node in enumerate((first, second)):
        x, y, dx, dy = 0.0, 0.0, 0.0, 0.0
        for j in range(q_casing.shape[0]):
            x += table[node, j, 0] * q_casing[j]
            y += table[node, j, 1] * q_casing[j]
            dx += table[node, j, 2] * q_casing[j]
            dy += table[node, j, 3] * q_casing[j]
        ends_out[4 * side], ends_out[4 * side + 1] = x, y
        ends_out[4 * side + 2], ends_out[4 * side + 3] = dx, dy


@allocation_free_kernel
def hermite(s: float, h: float) -> tuple[float, float, float, float]:
    """Return the cubic Hermite weights of first value, second value, first slope, second slope.

    s, 0 to 1, is the position along an interval of length h, here an angle in rad.
    """
    return (1 + 2 * s) * (1 - s) * (1 - s), s * s * (3 - 2 * s), h * s * (1 - s) * (1 - s), h * s * s * (s - 1)


@allocation_free_kernel
def hermite_slope(s: float, h: float) -> tuple[float, float, float, float]:
    """Return the derivatives of the `hermite` weights by the polar angle, at the same s and h."""
    bump = 6 * s * (1 - s) / h
    return -bump, bump, (1 - s) * (1 - 3 * s), s * (3 * s - 2)


@allocation_free_kernel
def hermite_bend(s: float, h: float) -> tuple[float, float, float, float]:
    """Return the second derivatives of the `hermite` weights by the polar angle, at the same s and h."""
    bend = (12 * s - 6) / (h * h)
    return bend, -bend, (6 * s - 4) / h, (6 * s - 2) / h


@allocation_free_kernel
def blend(weights: tuple[float, float, float, float], ends: FloatArray, c: int) -> float:
    """Return component c (0: X, 1: Y) of the casing's displacement at a point of an interval between two nodes.

    `weights` are from `hermite` at this point. With weights of `hermite_slope` or `hermite_bend` the first or second
    derivative is returned. `ends` (8,) is from `load_interval`.
    """
    total: float = weights[0] * ends[c] + weights[1] * ends[4 + c]
    total += weights[2] * ends[2 + c] + weights[3] * ends[6 + c]
    return total


@inlined_kernel
def foot_of(
    surface: Surface, worn: FloatArray, q_casing: FloatArray, opening: float, x: float, y: float, ends_work: FloatArray
) -> tuple[float, float, float, float]:
    """Find the foot of the point (x, y) on the deformed surface: polar parameter psi, gap, and the tangent's X and Y.

    Newton's method on (P - X(psi)).X'(psi) = 0, from the polar angle of P in [-pi, pi]. psi is in rad, the gap in m.
    The gap is n.(P - X) with the inward normal n = e_z x t, positive inside the casing. With chords the foot is on the
    chord at the polar angle of P.

    - worn (bins,): coefficients of the worn depth, m; (0,) without a liner.
    - q_casing (n_casing,): the casing's modal coordinates.
    - opening: added to the radius of the surface, m.
    - x, y: the point in the inertial frame, m.
    - ends_work (8,): scratch.
    """
    h, nodes = surface.node_step, surface.table.shape[0]
    rho = math.sqrt(x * x + y * y)
    cosine, sine = x / rho, y / rho
    psi = math.atan2(y, x)
    loaded = -1
    gap, tx, ty = 0.0, 0.0, 0.0
    for _ in range(FOOT_ITERATIONS):
        first, second, s = interval(psi, h, nodes)
        if first != loaded:
            load_interval(surface.table, first, second, q_casing, ends_work)
            loaded = first
        radius, slope, bend = worn_radius(surface, worn, psi)
        radius += opening
        value, derivative, second_derivative = hermite(s, h), hermite_slope(s, h), hermite_bend(s, h)
        to_x = x - radius * cosine - blend(value, ends_work, 0)
        to_y = y - radius * sine - blend(value, ends_work, 1)
        dx = slope * cosine - radius * sine + blend(derivative, ends_work, 0)
        dy = slope * sine + radius * cosine + blend(derivative, ends_work, 1)
        ddx = (bend - radius) * cosine - 2 * slope * sine + blend(second_derivative, ends_work, 0)
        ddy = (bend - radius) * sine + 2 * slope * cosine + blend(second_derivative, ends_work, 1)
        length_squared = dx * dx + dy * dy
        step = (to_x * dx + to_y * dy) / (length_squared - to_x * ddx - to_y * ddy)
        length = math.sqrt(length_squared)
        tx, ty = dx / length, dy / length
        gap = ty * -to_x + tx * to_y
        if abs(step) < FOOT_TOLERANCE:
            break
        if surface.corners.shape[0] > 0 and math.floor((psi + step) / h) != math.floor(psi / h):
            break  # the point keeps to the chord at its own angle: beyond a corner the next one would send it back
        psi += step
        cosine, sine = math.cos(psi), math.sin(psi)
    return psi, gap, tx, ty


@inlined_kernel
def casing_rows(surface: Surface, psi: float, rows_out: FloatArray) -> None:
    """Write X and Y displacement at the polar angle psi (rad) per unit of each mode into `rows_out` (2, n_casing)."""
    first, second, s = interval(psi, surface.node_step, surface.table.shape[0])
    w = hermite(s, surface.node_step)
    table = surface.table
    for j in range(table.shape[1]):
        for c in range(2):
            rows_out[c, j] = (
                w[0] * table[first, j, c]
                + w[1] * table[second, j, c]
                + w[2] * table[first, j, 2 + c]
                + w[3] * table[second, j, 2 + c]
            )


@inlined_kernel
def tip_position(
    tips: Tips, blade: int, q: FloatArray, cos_theta: float, sin_theta: float
) -> tuple[float, float, float, float]:
    """Return inertial x, y of a blade's tip in m, then cosine and sine of the blade's angle theta + blade_angle.

    q (n,) are the coordinates; `cos_theta` and `sin_theta` are of the blisk's angle.
    """
    cosine = cos_theta * tips.cos_angle[blade] - sin_theta * tips.sin_angle[blade]
    sine = sin_theta * tips.cos_angle[blade] + cos_theta * tips.sin_angle[blade]
    radial = tips.radius + tips.static[0, blade] + q[3 * blade]
    tangential = tips.static[1, blade] + q[3 * blade + 1]
    return radial * cosine - tangential * sine, radial * sine + tangential * cosine, cosine, sine
