"""Shapes of the machine as triangles and lines, with its small deviations enlarged.

The circle of the tip radius is drawn to scale. All deviations from it (lobes, clearance, deflection of the casing,
motion of tips and disk) are multiplied by one factor. Tips and casing that touch in the run therefore also touch in the
picture.
"""

import math
from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.machine import BladeRow, Disk, Machine, Unbalance
from rubgen.measurement.motion import MotionFrames

DRAWN_SHARE = 0.12
"""Largest drawn deviation as a share of the tip radius."""
STATIONS = 72
"""Plates around the casing; of five degrees each. A wave of order nine has eight."""
PLATE_SHARE = 0.012
"""Drawn thickness of the casing over the tip radius; the true one would be invisible."""
ROUND = 72
BLADE_CROSS_SECTIONS = 24
COILS, COIL_WIDTH_M = 5, 0.01
"""Of a drawn spring."""


@dataclass(frozen=True)
class Mesh:
    """A surface of triangles: `vertices` (n, 3) in m, `triangles` (m, 3) of vertex numbers, unit `normals` (n, 3)."""

    vertices: FloatArray
    triangles: IntArray
    normals: FloatArray


def drawing_factor(machine: Machine, frames: MotionFrames | None) -> float:
    """Choose the factor by which deviations from the tip circle are enlarged: 1, 2 or 5 times a power of ten.

    It is the largest such factor with which each of these lengths stays within DRAWN_SHARE of the tip radius: half the
    ovality, the clearance, the casing's offset, every coordinate of a tip's displacement (radial, tangential, axial)
    and of the disk centre's (X, Y). Lost blades and the casing's deflection do not count. With `frames` None or empty
    only ovality, clearance and offset count.
    """
    offsets = (each.amplitude_m for fault in machine.faults for each in fault.surface_harmonics(machine))
    largest = max(machine.casing.ovality_m / 2, machine.casing.clearance_m, *offsets)
    if frames is not None and frames.time.size:
        tips = np.delete(frames.tips, machine.lost_blades, axis=1)
        largest = max(largest, float(np.abs(tips).max()), float(np.abs(frames.centre).max()))
    wanted = DRAWN_SHARE * machine.tip_radius_m / largest
    power = 10.0 ** math.floor(math.log10(wanted))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted * (1 + 1e-9))


def casing_angles(stations: int = STATIONS) -> FloatArray:
    """Return `stations` equally spaced polar angles of drawn points of the casing, rad."""
    return 2 * np.pi * np.arange(stations) / stations


def casing_radius(machine: Machine, angle: FloatArray) -> FloatArray:
    """Return the inner radius of the undeformed casing at the given polar angles (rad), m, with harmonics of faults."""
    casing = machine.casing
    wave = np.cos(casing.lobes * (angle - np.radians(casing.lobe_angle_deg)))
    radius = machine.casing_mean_radius_m - casing.ovality_m / 2 * wave
    for fault in machine.faults:
        for each in fault.surface_harmonics(machine):
            radius = radius + each.amplitude_m * np.cos(each.order * (angle - each.phase_rad))
    return np.asarray(radius)


def casing_curve(
    machine: Machine, frames: MotionFrames, angle: FloatArray, factor: float, closed: FloatArray
) -> FloatArray:
    """Return drawn points (frames, stations, 2) of the casing's deformed inner surface, m.

    The displacement is linear between the casing's nodes.

    - angle (stations,): polar angles, rad.
    - factor: factor by which deviations from the tip circle are enlarged.
    - closed (frames,): how far faults have closed the clearance, m.
    """
    nodes = frames.casing_modes.shape[0]
    place = np.mod(angle, 2 * np.pi) * nodes / (2 * np.pi)
    low, share = np.floor(place).astype(int) % nodes, place - np.floor(place)
    modes = frames.casing_modes
    shape = (1 - share)[:, None, None] * modes[low] + share[:, None, None] * modes[(low + 1) % nodes]
    displacement = np.einsum("sdc,fc->fsd", shape, frames.casing)
    displacement -= np.multiply.outer(closed, np.column_stack([np.cos(angle), np.sin(angle)]))
    return np.asarray(undeformed_curve(machine, angle, factor) + factor * displacement)


def undeformed_curve(machine: Machine, angle: FloatArray, factor: float) -> FloatArray:
    """Return drawn points (stations, 2) of the casing at rest, m, at polar angles `angle` (rad).

    It is the casing at the start of the record. Deviations from the tip circle are enlarged by `factor`.
    """
    radius = machine.tip_radius_m + factor * (casing_radius(machine, angle) - machine.tip_radius_m)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def plate_mesh() -> Mesh:
    """Make a box of side 1 that begins at x = 0: x outward, y along the casing, z along its width.

    Copies of it, stretched and turned, draw the casing.
    """
    faces = []
    for axis in range(3):
        for side in (-0.5, 0.5):
            first, second = np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
            middle = side * np.eye(3)[axis] + [0.5, 0.0, 0.0]
            corners = [middle + a * first + b * second for a, b in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
            normals = np.tile(2 * side * np.eye(3)[axis], (4, 1))
            faces.append(Mesh(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]]), normals))
    return joined(faces)


def plate_shapes(machine: Machine, factor: float) -> FloatArray:
    """Return matrices (stations, 3, 3) that stretch and turn `plate_mesh` into the plates of the casing at rest.

    The stations are `casing_angles()`. `factor` is as in `undeformed_curve`.
    """
    curve = undeformed_curve(machine, casing_angles(), factor)
    chord = (np.roll(curve, -1, axis=0) - np.roll(curve, 1, axis=0)) / 2
    length = np.linalg.norm(chord, axis=1)
    tangent = chord / length[:, None]
    shapes = np.zeros((len(curve), 3, 3))
    thickness = max(machine.casing.thickness_m, PLATE_SHARE * machine.tip_radius_m)
    shapes[:, 0, 0], shapes[:, 1, 0] = thickness * tangent[:, 1], -thickness * tangent[:, 0]
    shapes[:, :2, 1] = 1.02 * chord
    shapes[:, 2, 2] = machine.casing.width_m
    return shapes


def ribbon_triangles(stations: int) -> IntArray:
    """Return the triangles of a closed band between two rings of `stations` points, numbered one ring first."""
    here, there = np.arange(stations), (np.arange(stations) + 1) % stations
    lower = np.column_stack([here, there, here + stations])
    upper = np.column_stack([there, there + stations, here + stations])
    return np.concatenate([lower, upper]).astype(np.int64)


def disk_mesh(disk: Disk) -> Mesh:
    """Make the annular disk, whose thickness is linear in the radius."""
    inner, outer = disk.bore_radius_m, disk.rim_radius_m
    low, high = disk.bore_thickness_m / 2, disk.rim_thickness_m / 2
    return revolved([(inner, -low), (outer, -high), (outer, high), (inner, low)])


def shaft_mesh(disk: Disk, reach: float) -> Mesh:
    """Make the shaft through the bore, from -reach to reach along Z."""
    radius = disk.bore_radius_m
    return revolved([(1e-4, -reach), (radius, -reach), (radius, reach), (1e-4, reach)])


def revolved(profile: list[tuple[float, float]]) -> Mesh:
    """Revolve a closed profile of points (radius, z), m, about Z. Each side of the profile has its own normals.

    The points go counter-clockwise, with the radius to the right and z upward: the normals then point outward.
    """
    angle = 2 * np.pi * np.arange(ROUND) / ROUND
    parts = []
    for (r1, z1), (r2, z2) in zip(profile, profile[1:] + profile[:1], strict=True):
        length = math.hypot(r2 - r1, z2 - z1)
        out, along = (z2 - z1) / length, -(r2 - r1) / length
        ends = [
            np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(ROUND, z)]) for r, z in ((r1, z1), (r2, z2))
        ]
        normal = np.column_stack([out * np.cos(angle), out * np.sin(angle), np.full(ROUND, along)])
        parts.append(Mesh(np.concatenate(ends), ribbon_triangles(ROUND), np.concatenate([normal, normal])))
    return joined(parts)


def blade_mesh(blades: BladeRow) -> Mesh:
    """Make one blade along x with its root at the origin: a rectangle that narrows, thins and turns to the tip."""
    span = np.linspace(0.0, 1.0, BLADE_CROSS_SECTIONS)
    corners = _blade_corners(blades, span)
    parts = [_strip(corners[:, side], corners[:, (side + 1) % 4]) for side in range(4)]
    cap = corners[-1]
    facing = np.tile([1.0, 0.0, 0.0], (4, 1))
    return joined([*parts, Mesh(cap, np.array([[0, 1, 2], [0, 2, 3]]), facing)])


def _blade_corners(blades: BladeRow, span: FloatArray) -> FloatArray:
    """Return corners (places, 4, 3) of the cross-sections; the thickness normal stands at the stagger angle to Z."""
    chord = blades.root_chord_m + span * (blades.tip_chord_m - blades.root_chord_m)
    thickness = blades.root_thickness_m + span * (blades.tip_thickness_m - blades.root_thickness_m)
    angle = np.radians(blades.root_angle_deg + span * (blades.tip_angle_deg - blades.root_angle_deg))
    normal = np.column_stack([np.zeros_like(span), np.sin(angle), np.cos(angle)])
    chordwise = np.column_stack([np.zeros_like(span), -np.cos(angle), np.sin(angle)])
    axis = np.column_stack([blades.length_m * span, np.zeros_like(span), np.zeros_like(span)])
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    across = [a * chord[:, None] / 2 * chordwise + b * thickness[:, None] / 2 * normal for a, b in signs]
    return np.stack([axis + each for each in across], axis=1)


def _strip(first: FloatArray, second: FloatArray) -> Mesh:
    """Make a band between two lines of points (n, 3)."""
    n = len(first)
    here = np.arange(n - 1)
    triangles = np.concatenate(
        [np.column_stack([here, here + 1, here + n]), np.column_stack([here + 1, here + n + 1, here + n])]
    )
    normal = np.cross(second - first, np.gradient(first, axis=0))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    outward = np.sign(np.sum(normal * ((first + second) / 2 * [0, 1, 1]), axis=1, keepdims=True))
    normal = normal * np.where(outward == 0, 1, outward)
    return Mesh(np.concatenate([first, second]), triangles, np.concatenate([normal, normal]))


def joined(parts: list[Mesh]) -> Mesh:
    """Join several meshes into one."""
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    return Mesh(
        np.concatenate([part.vertices for part in parts]),
        np.concatenate([part.triangles + start for part, start in zip(parts, starts, strict=True)]),
        np.concatenate([part.normals for part in parts]),
    )


def unbalances(machine: Machine) -> list[Unbalance]:
    """Return all unbalances of the machine that are not zero; `unbalance_kg_m` is the first."""
    own = Unbalance(kg_m=machine.unbalance_kg_m, angle_deg=machine.unbalance_angle_deg)
    return [each for each in (own, *machine.unbalances) if each.kg_m > 0]


def unbalance_text(unbalance: Unbalance) -> str:
    """Return the text drawn beside an unbalance, with its size in g m."""
    return f"unbalance {1e3 * unbalance.kg_m:.3g} g m"


def blade_angles(blades: BladeRow) -> FloatArray:
    """Return the angles of the blades in the turning frame, from blade 0, rad."""
    return 2 * np.pi * np.arange(blades.count) / blades.count


def blade_placements(machine: Machine) -> FloatArray:
    """Return the position of each blade's root in the blisk's turning frame, (n_blades, 3) in m."""
    angle = blade_angles(machine.blades)
    rim = machine.disk.rim_radius_m
    return np.column_stack([rim * np.cos(angle), rim * np.sin(angle), np.zeros_like(angle)])


def blade_leanings(machine: Machine, frames: MotionFrames, factor: float) -> FloatArray:
    """Return matrices (frames, n_blades, 3, 3) that turn `blade_mesh` to each blade's direction and lean it to its tip.

    They apply in the blisk's turning frame, about the root: `blade_placements` adds the position of the root. The
    matrix of blade k is R_k (I + s d e_x^T / L), with R_k the rotation about Z by its angle on the disk, s the factor
    of the drawing, L the blade's length and d the tip's displacement relative to the disk centre (radial, tangential,
    axial). A lost blade shrinks to its root.
    """
    angle = blade_angles(machine.blades)
    cosine, sine = np.cos(angle), np.sin(angle)
    lateral = frames.centre
    root = np.stack([np.outer(lateral[:, 0], cosine) + np.outer(lateral[:, 1], sine),
                     np.outer(lateral[:, 1], cosine) - np.outer(lateral[:, 0], sine)], axis=-1)  # fmt: skip
    lean = np.broadcast_to(np.eye(3), (*frames.tips.shape, 3)).copy()
    lean[..., :, 0] += factor * frames.tips / machine.blades.length_m
    lean[..., :2, 0] -= factor * root / machine.blades.length_m
    lean[:, list(machine.lost_blades)] = 0.0
    turned = np.zeros((len(angle), 3, 3))
    turned[:, 0, 0], turned[:, 0, 1], turned[:, 1, 0], turned[:, 1, 1] = cosine, -sine, sine, cosine
    turned[:, 2, 2] = 1.0
    return np.asarray(np.einsum("kab,fkbc->fkac", turned, lean))


def drawn_tips(machine: Machine, frames: MotionFrames, factor: float) -> FloatArray:
    """Return the drawn positions (frames, n_blades, 2) of the tips in the inertial frame, m.

    Deviations from the tip circle are enlarged by `factor`. A lost blade has its tip at the rim.
    """
    angle = frames.angle[:, None] + blade_angles(machine.blades)
    radial = machine.tip_radius_m + factor * frames.tips[..., 0]
    tangential = factor * frames.tips[..., 1]
    lost = list(machine.lost_blades)
    radial[..., lost], tangential[..., lost] = machine.disk.rim_radius_m, 0.0
    x = radial * np.cos(angle) - tangential * np.sin(angle)
    y = radial * np.sin(angle) + tangential * np.cos(angle)
    return np.stack([x, y], axis=-1)


def spring(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return a zigzag line (points, 3) from `start` (3,) to `end` (3,), in m, in the plane across Z."""
    share = np.concatenate([[0.0, 0.15], np.linspace(0.2, 0.8, 2 * COILS), [0.85, 1.0]])
    side = np.concatenate([[0.0, 0.0], COIL_WIDTH_M * (-1.0) ** np.arange(2 * COILS), [0.0, 0.0]])
    along = end - start
    across = np.array([-along[1], along[0], 0.0]) / np.linalg.norm(along[:2])
    return np.asarray(start + share[:, None] * along + side[:, None] * across)
