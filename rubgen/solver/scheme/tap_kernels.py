"""Read the true signals of a step: taps at step n, and the passages of blades under timing probes.

Every tap except the clearances is a linear functional. A row of `Taps.sums` holds eight of them. z are the coordinates
in the order of the blocks (`linalg.blocks`). O_d is the disk centre.
"""

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
    """Rays from the axis on which clearances are measured."""

    output: IntArray
    """Row of each ray's clearance in the taps (rays,)."""
    sum: IntArray
    """First of three indices in `Taps.sums` (rays,): radial and tangential displacement, slope of the radial one."""
    angle: FloatArray
    """Polar angle of each ray (rays,), rad."""
    radius: FloatArray
    """Radius of the undeformed surface there (rays,), m."""
    slope: FloatArray
    """Its derivative by the angle (rays,), m."""
    blade: IntArray
    """The blades before and after each ray at each step (steps, rays, 2)."""
    share: FloatArray
    """The ray's share of the angle between the two blades (steps, rays), 0 to 1."""


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
    """Written (rows, 4): probe, blade, time in steps, displacement of the chord along the rotation there, m. There are
    2 (n_blades + 1) rows for each probe."""


class Taps(NamedTuple):
    """Constants and scratch of the taps."""

    shaft: Product
    """Acts on `signals`."""
    acceleration: Product
    """Acts on the accelerations of the casing modes."""
    displacement: Product
    """Acts on the coordinates of the casing modes."""
    position: Product
    """Acts on z of the blisk."""
    change: Product
    """Acts on d in z of the blisk."""
    linear: IntArray
    """Output row and index in `sums` of each linear tap (any, 2)."""
    rays: Rays
    timing: Timing
    centre: int
    """Index of O_d x in q."""
    lateral_stiffness: float
    """Of the disk support, N/m."""
    lateral_damping: float
    """Of the disk support, N s/m."""
    spring_load: FloatArray
    """Force on O_d of springs that are at rest elsewhere, and its change in a step (2, 2), N."""
    signals: FloatArray
    """Scratch (8,): displacement of O_d and force on its support along X and Y, force and torque of contact, velocity
    of O_d, inertial."""
    sums: FloatArray
    """Scratch: the sums of all linear functionals."""
    bend: FloatArray
    """Scratch: accelerations of the casing modes (n_casing,)."""


@inlined_kernel
def tip_radius_on_ray(tips: Tips, rays: Rays, displacement: FloatArray, step: int, ray: int) -> float:
    """Return the radius of the tips on a ray, m: linear in angle between the two blades around it.

    The radius of a tip is sqrt((R + a)^2 + t^2) with the radius R at rest. a and t are its radial and tangential
    displacement, steady and `displacement` (2, n_blades or more) together, m. The angles belong to the undeformed blisk
    at step `step` of the turn. `ray` is the number of the ray in `rays`.
    """
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
    """Return the radius at which a ray from the axis meets the deformed surface, m.

    The surface point on the ray was at the angle u_t / r before the ray, undeformed. r is the undeformed radius on the
    ray, and r' is its derivative by the angle. The radius is r + u_r - (r' + u_r') u_t / r + u_t^2 / (2 r), exact to
    second order in the displacements on a circle, where r' = r'' = 0.

    - sums: values of the linear functionals, with u_r, u_t and u_r' of the ray.
    - opening: added to the radius of the surface, with the depth worn there, m.
    - ray: number of the ray in `rays`.
    """
    first = rays.sum[ray]
    radial, tangential, slope = sums[first], sums[first + 1], sums[first + 2]
    radius: float = rays.radius[ray] + opening + radial
    radius -= tangential / radius * (rays.slope[ray] + slope - 0.5 * tangential)
    return radius


@inlined_kernel
def read_shaft(model: Model, taps: Taps, coordinates: Coordinates, support: SupportState, step: int) -> None:
    """Write displacement, velocity and support force of O_d, in the inertial frame, into `taps.signals`.

    They belong to step n, which is number `step` of the turn; its q is `coordinates.now`. Velocity is a central
    difference.
    """
    speed, dt = model.laws.speed, model.laws.dt
    cosine, sine = model.angles.cosine[step], model.angles.sine[step]
    x, y = coordinates.now[taps.centre], coordinates.now[taps.centre + 1]
    vx = (coordinates.after[taps.centre] - coordinates.before[taps.centre]) / (2 * dt) - speed * y
    vy = (coordinates.after[taps.centre + 1] - coordinates.before[taps.centre + 1]) / (2 * dt) + speed * x
    load = taps.spring_load
    fx = taps.lateral_stiffness * x + taps.lateral_damping * vx - (load[0, 0] + step * load[1, 0])
    fy = taps.lateral_stiffness * y + taps.lateral_damping * vy - (load[0, 1] + step * load[1, 1])
    if model.support.active:
        fx -= support.force[1, 0] - support.force[2, 0]
        fy -= support.force[1, 1] - support.force[2, 1]
    taps.signals[X] = cosine * x - sine * y
    taps.signals[Y] = sine * x + cosine * y
    taps.signals[SPEED_X] = cosine * vx - sine * vy
    taps.signals[SPEED_Y] = sine * vx + cosine * vy
    taps.signals[FORCE_X] = cosine * fx - sine * fy
    taps.signals[FORCE_Y] = sine * fx + cosine * fy


@inlined_kernel
def sum_functionals(taps: Taps, coordinates: Coordinates, z: FloatArray, z_change: FloatArray, dt: float) -> None:
    """Compute all linear functionals of the taps, into `taps.sums`. Accelerations are central differences.

    `taps.signals` must belong to step n. `z` is the motion at step n in blocks, `z_change` is d = (q_n+1 - q_n-1) / 2
    in blocks, `dt` in s.
    """
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
    """Write all taps at step n into column `step` of `out` (taps, steps). q is `coordinates.now`.

    Velocity and acceleration are central differences; `state.scratch.z_change` must contain d = (q_n+1 - q_n-1) / 2 in
    z. `opening` (m) is added to the radius of the surface at step n. `force` (N) and `torque` (N m) are the sums over
    the contacts at step n.
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
    """Return how far the chord of a blade's tip has moved along the rotation from its position at rest, m.

    An axial displacement counts too: the chord is slanted by `timing.chord_slope`. The result is the same at any axial
    position, since the chord is straight and does not turn. `q` (n,) are the coordinates.
    """
    axial = tips.static[2, blade] + q[3 * blade + 2]
    moved: float = tips.static[1, blade] + q[3 * blade + 1] - timing.chord_slope * axial
    return moved


@inlined_kernel
def angle_beyond(
    tips: Tips, theta: FloatArray, timing: Timing, probe: int, blade: int, step: int, more: float
) -> float:
    """Return by which angle a blade has passed a probe, rad in [-pi, pi]; negative before the passage.

    The blade is `more` rad farther along the rotation than its position on the disk. `theta[step]` is the blisk's
    angle, rad. `probe` is the number of the probe in `timing`.
    """
    angle = theta[step] + tips.angle[blade] - timing.angle[probe] + more
    turned: float = angle - 2 * math.pi * math.floor(angle / (2 * math.pi) + 0.5)
    return turned


@inlined_kernel
def is_near(
    tips: Tips, theta: FloatArray, timing: Timing, probe: int, blade: int, step: int, displacement: FloatArray
) -> bool:
    """Return whether a blade may pass the probe in this step: it is nearer to the probe than `timing.near_angle`.

    It is a cheap test before `beyond_probe`. Only the second row of `displacement` (2, n_blades or more) is read, the
    tangential displacement of each tip, m.
    """
    along = tips.static[1, blade] + displacement[1, blade] + timing.chord_slope * timing.axial[probe]
    near: bool = abs(angle_beyond(tips, theta, timing, probe, blade, step, along / tips.radius)) < timing.near_angle
    return near


@inlined_kernel
def beyond_probe(
    tips: Tips, theta: FloatArray, timing: Timing, probe: int, blade: int, step: int, q: FloatArray
) -> float:
    """Return by which angle a blade's chord, at the probe's axial position, has passed the probe, rad in [-pi, pi].

    The value is negative before the passage and 0 under the probe. `timing` describes the probes. `q` (n,) are the
    coordinates at step `step`, with the coordinates of this blade's tip.
    """
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
    """Write blades that pass a probe between steps n and n + 1 into `timing.arrivals`.

    Return the number of arrivals so far. A blade passes where `beyond_probe` changes from negative to 0 or more.
    Between the steps the displacement is a parabola: d_n + s (d_n+1 - d_n) - s (1 - s) c / 2, with c the second
    difference.

    - motions: at steps n - 1, n, n + 1. The tip coordinates of blades near a probe are written into their q.
    - theta (steps + 2,): angle of the blisk, rad.
    - step: number of step n in the turn.
    - clock: number of the turn's first step in the run.
    - count: number of arrivals before this step.
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
