"""Make the casing surface and the blade tips of a system in the form that the contact kernels take."""

import numpy as np

from rubgen.arrays import FloatArray, frozen
from rubgen.contact.geometry_kernels import FAR_AWAY, Surface, Tips
from rubgen.contact.liner_kernels import Liner, Wear
from rubgen.errors import UserError
from rubgen.reduction.model import CasingSurface, SpinningSystem
from rubgen.scenario import ContactLaw
from rubgen.scenario import Liner as LinerSpec

CENTRE_LINE = ContactLaw()
"""Contact without options: on the smooth surface, which moves like the ring's centre line."""


def periodic_derivative(values: FloatArray) -> FloatArray:
    """Differentiate values (n, ...) at n equal steps of a full turn by the angle (rad).

    Exact for orders below n / 2.
    """
    n = values.shape[0]
    order = 1j * np.fft.rfftfreq(n, 1 / n)
    if n % 2 == 0:
        order[-1] = 0  # the sawtooth of order n / 2 has no slope at the nodes
    spectrum = np.fft.rfft(values, axis=0) * order.reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray(np.fft.irfft(spectrum, n, axis=0))


def hermite_bends(values: FloatArray, slopes: FloatArray, step: float) -> FloatArray:
    """Return the largest second derivative by the angle of each mode's displacement (n_casing,) between nodes.

    It is the length of the vector in X and Y, per rad^2 and unit of the mode. The Hermite cubic's second derivative is
    linear in the angle, so its length is largest at a node.

    - values, slopes (nodes, 2, n_casing): displacement at the nodes and its derivative by the angle.
    - step: angle between nodes, rad.
    """
    next_values, next_slopes = np.roll(values, -1, axis=0), np.roll(slopes, -1, axis=0)
    rise = 6 * (next_values - values) / step**2
    ends = rise - (4 * slopes + 2 * next_slopes) / step, (2 * slopes + 4 * next_slopes) / step - rise
    return np.asarray(np.max([np.sqrt((end**2).sum(axis=1)).max(axis=0) for end in ends], axis=0))


def with_zeros(numbers: FloatArray) -> FloatArray:
    """Append zeros to the casing's coordinates (..., n_casing) until their number is a multiple of eight."""
    missing = -numbers.shape[-1] % 8
    return np.ascontiguousarray(np.concatenate([numbers, np.zeros((*numbers.shape[:-1], missing))], axis=-1))


def surface_modes(system: SpinningSystem, contact: ContactLaw) -> FloatArray:
    """Return X and Y displacement (nodes, 2, n_casing) of the contact surface at the nodes per unit of each mode.

    It is the displacement u of the ring's centre line. With `contact.half_thickness` it is u - (h / 2) phi e_theta of
    the inner surface, half a thickness inside the centre line, with phi the rotation of the cross-section. Force and
    velocity belong to the same point. A force F there therefore also turns the cross-section by the moment (-(h / 2)
    e_r) x F, and no work is lost. Raises UserError where `half_thickness` is set and the system has no rotations.
    """
    modes = np.ascontiguousarray(system.casing_modes, dtype=float)
    if not contact.half_thickness:
        return modes
    if system.casing_rotations is None:
        raise UserError("half_thickness = true: the system holds no rotations of the casing's cross-sections; add them")
    angle = 2 * np.pi * np.arange(len(modes)) / len(modes)
    e_theta = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    return modes - system.half_thickness * e_theta[:, :, None] * system.casing_rotations[:, None, :]


def casing_surface(system: SpinningSystem, contact: ContactLaw = CENTRE_LINE) -> Surface:
    """Make the surface r(psi) e_r + u(psi) of a system: smooth undeformed curve, Hermite-interpolated displacement.

    `contact` may select the inner surface's displacement, chords between the nodes instead of the smooth curve, and a
    liner. Nodal slopes come from the Fourier series of the nodal displacements, so u is exact to fourth order in the
    node distance, and continuous in slope. The displacement of each mode between nodes is at most the largest nodal
    value plus a quarter of the node distance times the largest slope. The arrays are read-only. Raises UserError where
    `contact.half_thickness` is set and the system has no rotations.
    """
    modes = surface_modes(system, contact)
    nodes = modes.shape[0]
    slopes = periodic_derivative(modes)
    step = 2 * np.pi / nodes
    size, slope_size = (np.sqrt((field**2).sum(axis=1)).max(axis=0) for field in (modes, slopes))
    curve = system.surface
    steepness = float(np.abs(curve.amplitude * curve.order).sum())
    bend = float(np.abs(curve.amplitude * curve.order**2).sum())
    bends = hermite_bends(modes, slopes, step)
    between = slope_size + 0.5 * step * bends
    angle = step * np.arange(nodes)[:, None]
    corners = node_radii(curve, nodes) if contact.surface == "chords" else np.zeros(0)
    inset, slope = chord_bounds(corners, bend) if len(corners) else (0.0, steepness)
    return frozen(
        Surface(
            mean_radius=float(curve.mean_radius),
            amplitude=np.asarray(curve.amplitude, dtype=float),
            order=np.asarray(curve.order, dtype=float),
            phase=np.asarray(curve.phase, dtype=float),
            table=np.ascontiguousarray(np.concatenate([modes, slopes], axis=1).transpose(0, 2, 1)),
            node_step=step,
            mode_displacement=np.ascontiguousarray(size + 0.25 * step * slope_size),
            mode_slope=np.ascontiguousarray(between + size + 0.25 * step * slope_size),
            mode_bend=np.ascontiguousarray(bends + 2 * between + size + 0.25 * step * slope_size),
            radial=with_zeros(modes[:, 0] * np.cos(angle) + modes[:, 1] * np.sin(angle)),
            tangential=with_zeros(modes[:, 1] * np.cos(angle) - modes[:, 0] * np.sin(angle)),
            steepness=steepness,
            bend=bend,
            corners=corners,
            inset=inset,
            slope=slope,
            liner=liner_of(contact.liner, float(curve.mean_radius)),
        )
    )


def blade_tips(system: SpinningSystem) -> Tips:
    """Make the tips of a system, with read-only arrays.

    They have one radius at rest, m; the steady displacement along the blades' axes (3, n_blades), m; each blade's angle
    on the disk, rad; and the cosines and sines of this angle and of its multiples by the orders of the surface.
    """
    angle, static = np.asarray(system.blade_angles, dtype=float), np.asarray(system.tip_static.T, dtype=float)
    orders = [order * angle for order in np.asarray(system.surface.order, dtype=float)]
    rows = with_zeros(np.array([*static[:2], *(wave(each) for each in orders for wave in (np.cos, np.sin))]))
    rows[0, len(angle) :] = -FAR_AWAY
    return frozen(
        Tips(
            radius=float(system.tip_radius),
            static=np.ascontiguousarray(static),
            angle=angle,
            cos_angle=np.cos(angle),
            sin_angle=np.sin(angle),
            bound_rows=rows,
        )
    )


def node_radii(curve: CasingSurface, nodes: int) -> FloatArray:
    """Return the radius (nodes,) of the smooth undeformed curve at equal steps of polar angle from 0, m."""
    angle = 2 * np.pi * np.arange(nodes) / nodes
    return np.asarray(curve.mean_radius + np.cos(np.subtract.outer(angle, curve.phase) * curve.order) @ curve.amplitude)


def chord_bounds(corners: FloatArray, bend: float) -> tuple[float, float]:
    """Return a bound of how far chords between nodes lie inside the smooth curve, m, and of their |dr/dpsi|, m/rad.

    `corners` (nodes,) are the radii of the nodes, m; `bend` is a bound of the curve's |d2r/dpsi2|, m. Chords and curve
    meet at the nodes. They differ by at most h^2 / 8 times the largest second derivative of the difference: `bend` plus
    r + 2 r'^2 / r of a straight line, whose |r'| is largest at its ends.
    """
    step, next_values = 2 * np.pi / len(corners), np.roll(corners, -1)
    at_start = corners / np.tan(step) - corners**2 / (next_values * np.sin(step))
    at_end = next_values**2 / (corners * np.sin(step)) - next_values / np.tan(step)
    slope = float(np.abs([at_start, at_end]).max())
    nearest = float(corners.min()) * np.cos(step / 2)
    return step**2 / 8 * (bend + float(corners.max()) + 2 * slope**2 / nearest), slope


def liner_of(spec: LinerSpec | None, radius: float) -> Liner:
    """Make the constants of the liner that a recipe specifies. For None the liner has no bins: there is no liner.

    `radius` (m) of the surface turns angles into lengths.
    """
    if spec is None:
        return Liner(bins=0, thickness=0.0, rate=0.0, area=1.0)
    area = spec.width_m * radius * 2 * np.pi / spec.bins
    return Liner(bins=spec.bins, thickness=spec.thickness_m, rate=spec.wear_m2_per_n, area=float(area))


def unworn(liner: Liner) -> Wear:
    """Return the state of a liner before any contact: no depth, no removed volume."""
    return Wear(depth=np.zeros(liner.bins), earlier=np.zeros((2, liner.bins)), sums=np.zeros(2))
