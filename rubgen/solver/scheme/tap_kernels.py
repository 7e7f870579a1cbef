"""The true signals of a step: taps at step n, and the passages of blades under timing probes.

Every tap but the clearances is a linear functional, eight of them to a row of `Taps.sums`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.geometry_kernels import Tips
from rubgen.contact.liner_kernels import worn_depth
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.block_kernels import Product
from rubgen.linalg.harmonic_kernels import Harmonics
from rubgen.linalg.lanes_kernels import add_lines
from rubgen.solver.scheme.model_kernels import Model
from rubgen.solver.scheme.motion_kernels import Motion, recover_blade
from rubgen.solver.scheme.state_kernels import Coordinates, State
from rubgen.solver.supports.support_kernels import SupportState

X, Y, FORCE_X, FORCE_Y, CONTACT_FORCE, CONTACT_TORQUE, SPEED_X, SPEED_Y = range(8)


class Rays(NamedTuple):
    """Clearances on rays: `output` (rays,) their rows, `sum` (rays,) the first of three places in `Taps.sums`.

    There stand the radial and tangential displacement and the derivative of the radial one. `angle` (rays,) is theirs,
    `radius`, `slope` (rays,) those of the undeformed surface; `blade` (steps, rays, 2) the blades before and after the
    ray and `share` (steps, rays) the way between them.
    """

    output: IntArray
    sum: IntArray
    angle: FloatArray
    radius: FloatArray
    slope: FloatArray
    blade: IntArray
    share: FloatArray


class Timing(NamedTuple):
    """Timing probes, which record passing blades."""

    angle: FloatArray
    """Polar angle of each probe (probes,), rad."""
    axial: FloatArray
    """Axial place of each probe (probes,), m."""
    chord_slope: float
    """Tangential displacement of the tip's chord per unit of axial distance."""
    near_angle: float
    """A blade is evaluated where it is nearer than this to a probe, rad."""
    blade: IntArray
    """The blades on either side of each probe at each step (steps, probes, 2)."""
    arrivals: FloatArray
    """Written (many, 4): probe, blade, time in steps, displacement of the chord along the rotation there, m."""


class Taps(NamedTuple):
    """What the taps need.

    `shaft` acts on `signals` (8,): displacement of O_d and force on its support along X and Y, force and torque of
    contact, velocity of O_d; `acceleration` and `displacement` on the casing's modes, `position` and `change` on z and
    d in z of the blisk. `linear` (any, 2) are the output row and the place in `sums` of each linear tap. `centre` is
    the index of O_d x. `signals`, `sums`, `bend` (n_casing,) are scratch.
    """

    shaft: Product
    acceleration: Product
    displacement: Product
    position: Product
    change: Product
    linear: IntArray
    rays: Rays
    timing: Timing
    centre: int
    lateral_stiffness: float
    lateral_damping: float
    signals: FloatArray
    sums: FloatArray
    bend: FloatArray


@inlined_kernel
def tip_radius_on_ray(tips: Tips, rays: Rays, displacement: FloatArray, step: int, ray: int) -> float:
    """Radius of the tips on a ray: linear in angle between the two blades around it."""
    radius = 0.0
    for side in range(2):
        k = rays.blade[step, ray, side]
        radial = tips.radius + tips.static[0, k] + displacement[0, k]
        tangential = tips.static[1, k] + displacement[1, k]
        share = rays.share[step, ray] if side == 1 else 1 - rays.share[step, ray]
        radius += share * math.sqrt(radial * radial + tangential * tangential)
    return radius


@inlined_kernel
def casing_radius_on_ray(rays: Rays, sums: FloatArray, opening: float, ray: int) -> float:
    """Radius at which the ray meets the deformed surface.

    The point that comes to the ray stood u_t / r before it: r + u_r - (r' + u_r') u_t / r + u_t^2 / (2 r), right to
    second order in the displacements on a circle, where r' = r'' = 0.
    """
    first = rays.sum[ray]
    radial, tangential, slope = sums[first], sums[first + 1], sums[first + 2]
    radius: float = rays.radius[ray] + opening + radial
    radius -= tangential / radius * (rays.slope[ray] + slope - 0.5 * tangential)
    return radius


@inlined_kernel
def read_shaft(model: Model, taps: Taps, coordinates: Coordinates, support: SupportState, step: int) -> None:
    """Into `taps.signals`: displacement and velocity of O_d and force on its support in the inertial frame."""
    speed, dt = model.laws.speed, model.laws.dt
    cosine, sine = model.angles.cosine[step], model.angles.sine[step]
    x, y = coordinates.now[taps.centre], coordinates.now[taps.centre + 1]
    vx = (coordinates.after[taps.centre] - coordinates.before[taps.centre]) / (2 * dt) - speed * y
    vy = (coordinates.after[taps.centre + 1] - coordinates.before[taps.centre + 1]) / (2 * dt) + speed * x
    fx = taps.lateral_stiffness * x + taps.lateral_damping * vx
    fy = taps.lateral_stiffness * y + taps.lateral_damping * vy
    if model.support.active:
        fx, fy = fx - support.force[1, 0], fy - support.force[1, 1]
    taps.signals[X] = cosine * x - sine * y
    taps.signals[Y] = sine * x + cosine * y
    taps.signals[SPEED_X] = cosine * vx - sine * vy
    taps.signals[SPEED_Y] = sine * vx + cosine * vy
    taps.signals[FORCE_X] = cosine * fx - sine * fy
    taps.signals[FORCE_Y] = sine * fx + cosine * fy


@inlined_kernel
def sum_functionals(taps: Taps, coordinates: Coordinates, z: FloatArray, z_change: FloatArray, dt: float) -> None:
    """All linear functionals into `taps.sums`; accelerations are central differences."""
    start = coordinates.now.shape[0] - taps.bend.shape[0]
    for j in range(start, coordinates.now.shape[0]):
        taps.bend[j - start] = (coordinates.after[j] - 2 * coordinates.now[j] + coordinates.before[j]) / (dt * dt)
    taps.sums[:] = 0.0
    add_lines(taps.shaft.lines, taps.shaft.entries, taps.signals, taps.sums)
    add_lines(taps.acceleration.lines, taps.acceleration.entries, taps.bend, taps.sums)
    add_lines(taps.displacement.lines, taps.displacement.entries, coordinates.now[start:], taps.sums)
    add_lines(taps.position.lines, taps.position.entries, z, taps.sums)
    add_lines(taps.change.lines, taps.change.entries, z_change, taps.sums)


@inlined_kernel
def record_taps(
    model: Model,
    taps: Taps,
    coordinates: Coordinates,
    state: State,
    now: Motion,
    step: int,
    opening: float,
    force: float,
    torque: float,
    out: FloatArray,
) -> None:
    """All taps at step n, where q is `coordinates.now`, velocity and acceleration are central differences.

    `force` and `torque` are those of the contact at that time.
    """
    read_shaft(model, taps, coordinates, state.support, step)
    taps.signals[CONTACT_FORCE], taps.signals[CONTACT_TORQUE] = force, torque
    sum_functionals(taps, coordinates, now.z, state.scratch.z_change, model.laws.dt)
    for i in range(taps.linear.shape[0]):
        out[taps.linear[i, 0], step] = taps.sums[taps.linear[i, 1]]
    rays = taps.rays
    for ray in range(rays.output.shape[0]):
        tip = tip_radius_on_ray(model.tips, rays, now.tips, step, ray)
        wide = opening
        if model.surface.liner.bins > 0:
            wide += worn_depth(state.wear.depth, rays.angle[ray])[0]
        out[rays.output[ray], step] = casing_radius_on_ray(rays, taps.sums, wide, ray) - tip


@inlined_kernel
def chord_displacement(tips: Tips, timing: Timing, blade: int, q: FloatArray) -> float:
    """How far the tip's chord stands along the rotation, at any axial place, from where it stands at rest."""
    axial = tips.static[2, blade] + q[3 * blade + 2]
    moved: float = tips.static[1, blade] + q[3 * blade + 1] - timing.chord_slope * axial
    return moved


@inlined_kernel
def angle_beyond(
    tips: Tips, theta: FloatArray, timing: Timing, probe: int, blade: int, step: int, more: float
) -> float:
    """How far a blade that stands `more` rad before its place on the disk is beyond a probe, rad in [-pi, pi]."""
    angle = theta[step] + tips.angle[blade] - timing.angle[probe] + more
    turned: float = angle - 2 * math.pi * math.floor(angle / (2 * math.pi) + 0.5)
    return turned


@inlined_kernel
def is_near(
    tips: Tips, theta: FloatArray, timing: Timing, probe: int, blade: int, step: int, displacement: FloatArray
) -> bool:
    """Whether a blade may pass the probe in this step, from its tangential `displacement` (2, any) alone."""
    along = tips.static[1, blade] + displacement[1, blade] + timing.chord_slope * timing.axial[probe]
    near: bool = abs(angle_beyond(tips, theta, timing, probe, blade, step, along / tips.radius)) < timing.near_angle
    return near


@inlined_kernel
def beyond_probe(
    tips: Tips, theta: FloatArray, timing: Timing, probe: int, blade: int, step: int, q: FloatArray
) -> float:
    """How far a blade's chord at the probe's axial place is beyond the probe, rad in [-pi, pi]."""
    along = chord_displacement(tips, timing, blade, q) + timing.chord_slope * timing.axial[probe]
    radial = tips.radius + tips.static[0, blade] + q[3 * blade]
    beyond: float = angle_beyond(tips, theta, timing, probe, blade, step, math.atan2(along, radial))
    return beyond


@allocation_free_kernel
def record_arrivals(
    harmonics: Harmonics,
    tips: Tips,
    theta: FloatArray,
    timing: Timing,
    motions: tuple[Motion, Motion, Motion],
    step: int,
    clock: int,
    count: int,
) -> int:
    """Blades that pass a probe between steps n and n + 1, the motions at n - 1, n, n + 1; the number in `arrivals`.

    Between the steps the displacement is the parabola through all three, d_n + s (d_n+1 - d_n) - s (1 - s) c / 2 with
    the second difference c.
    """
    before, now, after = motions
    for probe in range(timing.angle.shape[0]):
        for side in range(2):
            blade = timing.blade[step, probe, side]
            if side == 1 and blade == timing.blade[step, probe, 0]:
                continue
            if not is_near(tips, theta, timing, probe, blade, step, now.tips):
                continue
            recover_blade(harmonics, now, blade)
            recover_blade(harmonics, after, blade)
            first = beyond_probe(tips, theta, timing, probe, blade, step, now.q)
            second = beyond_probe(tips, theta, timing, probe, blade, step + 1, after.q)
            if first < 0.0 <= second and second - first < math.pi:
                recover_blade(harmonics, before, blade)
                ago = chord_displacement(tips, timing, blade, before.q)
                there = chord_displacement(tips, timing, blade, now.q)
                then = chord_displacement(tips, timing, blade, after.q)
                bend = 0.5 * (then - 2 * there + ago)
                share = first / (first - second)
                share += share * (1 - share) * bend / tips.radius / (second - first)
                row = timing.arrivals[count]
                row[0], row[1], row[2] = probe, blade, clock + step + share
                row[3] = there + share * (then - there) - share * (1 - share) * bend
                count += 1
    return count
