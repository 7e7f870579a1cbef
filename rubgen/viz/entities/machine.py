"""Send the machine in 3D to Rerun: shapes once, motions as few numbers."""

import numpy as np
import rerun as rr

from rubgen.arrays import FloatArray, IntArray
from rubgen.machine import Machine
from rubgen.measurement.motion import MotionFrames
from rubgen.viz.colors import BLUE, GREY, UNBALANCE, impulse_color, rgba
from rubgen.viz.entities.machine_shape import (
    Mesh,
    blade_leanings,
    blade_mesh,
    blade_placements,
    casing_angles,
    casing_curve,
    casing_radius,
    disk_mesh,
    drawing_factor,
    plate_mesh,
    plate_shapes,
    shaft_mesh,
    spring,
    unbalance_text,
    unbalances,
    undeformed_curve,
)
from rubgen.viz.entities.signals import time_column
from rubgen.viz.replay import Replay

SHAFT_SHARE = 0.45
"""Half the length of the drawn shaft over the tip radius."""
SPRINGS = 24
MOST_FLASHES = 24
UNBALANCE_SHARE = 0.035
"""Radius of an unbalance's mark over the tip radius."""
LARGEST_POINT, SMALLEST_POINT = 0.055, 0.015
"""Radii of contact points over the tip radius, for the hardest touch and for the lightest."""
STEEL, DARK_STEEL, RING = 0xB9C4CEFF, 0x7D8A96FF, 0x9FB4C7FF


def send_machine(stream: rr.RecordingStream, replay: Replay) -> None:
    """Send casing, supports, blisk and contact points under `/machine`. Nothing is sent without frames."""
    frames = replay.frames
    if frames is None or not frames.time.size:
        return
    factor = drawing_factor(replay.scenario.machine, frames)
    stream.log("/machine", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    _send_casing(stream, replay, frames, factor)
    _send_rotor(stream, replay, frames, factor)
    _send_supports(stream, replay, factor)
    _send_contact_points(stream, replay, frames, factor)


def _send_casing(stream: rr.RecordingStream, replay: Replay, frames: MotionFrames, factor: float) -> None:
    """Send plates that move with the ring, and the inner surface at rest as a line."""
    machine, angle = replay.scenario.machine, casing_angles()
    _log_mesh(stream, "/machine/casing/ring", plate_mesh(), RING)
    curve = casing_curve(machine, frames, angle, factor, replay.closed)
    places = np.concatenate([curve, np.zeros((*curve.shape[:2], 1))], axis=2)
    _send_instances(stream, "/machine/casing/ring", frames, places, plate_shapes(machine, factor))
    rest = undeformed_curve(machine, np.append(angle, 0.0), factor)
    line = np.column_stack([rest, np.full(len(rest), machine.casing.width_m / 2)])
    stream.log("/machine/casing/at_rest", rr.LineStrips3D([line], colors=rgba(GREY), radii=0.0015), static=True)


def _send_instances(
    stream: rr.RecordingStream, entity: str, frames: MotionFrames, places: FloatArray, shapes: FloatArray
) -> None:
    """Send copies of a mesh at `places` and in `shapes`, each (frames, copies, ...) or (copies, ...).

    Rerun 0.41 combines no pose from static and changing or from older and newer parts. Constant parts are therefore
    sent with every frame; they compress.
    """
    count = max(places.shape[-2], shapes.shape[-3])
    n = frames.time.size
    columns = rr.InstancePoses3D.columns(
        translations=np.broadcast_to(places, (n, count, 3)).reshape(-1, 3),
        mat3x3=np.broadcast_to(shapes, (n, count, 3, 3)).reshape(-1, 3, 3),
    )
    stream.send_columns(entity, time_column(frames.time), columns.partition([count] * n))


def _send_rotor(stream: rr.RecordingStream, replay: Replay, frames: MotionFrames, factor: float) -> None:
    machine = replay.scenario.machine
    half = frames.angle / 2
    cosine, sine = np.cos(frames.angle), np.sin(frames.angle)
    x, y = factor * frames.centre.T
    centre = np.column_stack([cosine * x - sine * y, sine * x + cosine * y, np.zeros_like(x)])
    turning = np.column_stack([np.zeros((len(half), 2)), np.sin(half), np.cos(half)])
    columns = rr.Transform3D.columns(translation=centre, quaternion=turning)
    stream.send_columns("/machine/rotor", time_column(frames.time), columns)
    _log_mesh(stream, "/machine/rotor/disk", disk_mesh(machine.disk), DARK_STEEL)
    shaft = shaft_mesh(machine.disk, SHAFT_SHARE * machine.tip_radius_m)
    _log_mesh(stream, "/machine/rotor/shaft", shaft, STEEL)
    _log_mesh(stream, "/machine/rotor/blades", blade_mesh(machine.blades), STEEL)
    leanings = blade_leanings(machine, frames, factor)
    _send_instances(stream, "/machine/rotor/blades", frames, blade_placements(machine), leanings)
    _send_unbalances(stream, machine, frames, leanings)


def _send_unbalances(stream: rr.RecordingStream, machine: Machine, frames: MotionFrames, leanings: FloatArray) -> None:
    """Send unbalances of the disk on its front face, and unbalances of blades, which move with the tips."""
    disk, size = machine.disk, UNBALANCE_SHARE * machine.tip_radius_m
    marks = unbalances(machine)
    place = 0.9 * disk.rim_radius_m
    share = (place - disk.bore_radius_m) / (disk.rim_radius_m - disk.bore_radius_m)
    height = (disk.bore_thickness_m + share * (disk.rim_thickness_m - disk.bore_thickness_m)) / 2 + size / 2
    on_disk = [(each, each.angle_deg) for each in marks if each.angle_deg is not None]
    if on_disk:
        angle = np.radians([degrees for _, degrees in on_disk])
        places = np.column_stack([place * np.cos(angle), place * np.sin(angle), np.full(angle.size, height)])
        texts = [unbalance_text(each) for each, _ in on_disk]
        points = rr.Points3D(places, colors=rgba(UNBALANCE), radii=size, labels=texts, show_labels=True)
        stream.log("/machine/rotor/unbalance/disk", points, static=True)
    on_blades = [(each, each.blade) for each in marks if each.blade is not None]
    if on_blades:
        blades = [blade for _, blade in on_blades]
        tips = blade_placements(machine)[blades] + leanings[..., 0][:, blades] * machine.blades.length_m
        columns = rr.Points3D.columns(positions=tips.reshape(-1, 3)).partition([len(blades)] * len(tips))
        stream.send_columns("/machine/rotor/unbalance/blades", time_column(frames.time), columns)
        texts = [f"{unbalance_text(each)}, blade {blade}" for each, blade in on_blades]
        look = rr.Points3D.from_fields(colors=rgba(UNBALANCE), radii=size, labels=texts, show_labels=True)
        stream.log("/machine/rotor/unbalance/blades", look, static=True)


def _log_mesh(stream: rr.RecordingStream, entity: str, mesh: Mesh, color: int) -> None:
    shape = rr.Mesh3D(
        vertex_positions=mesh.vertices,
        triangle_indices=mesh.triangles,
        vertex_normals=mesh.normals,
        albedo_factor=color,
    )
    stream.log(entity, shape, static=True)


def _send_supports(stream: rr.RecordingStream, replay: Replay, factor: float) -> None:
    """Send springs of the casing, and springs of the shaft at either end."""
    machine = replay.scenario.machine
    angle = 2 * np.pi * np.arange(SPRINGS) / SPRINGS
    radius = machine.tip_radius_m + factor * (casing_radius(machine, angle) - machine.tip_radius_m)
    ground = float(radius.max()) + 0.2 * machine.tip_radius_m
    springs = [
        spring(r * np.array([np.cos(a), np.sin(a), 0.0]), ground * np.array([np.cos(a), np.sin(a), 0.0]))
        for a, r in zip(angle, radius, strict=True)
    ]
    stream.log("/machine/casing/springs", rr.LineStrips3D(springs, colors=rgba(GREY), radii=0.0012), static=True)
    reach, bore = SHAFT_SHARE * machine.tip_radius_m, machine.disk.bore_radius_m
    supports = [
        spring(
            np.array([bore * np.cos(a), bore * np.sin(a), z]), np.array([3 * bore * np.cos(a), 3 * bore * np.sin(a), z])
        )
        for a in np.pi / 2 * np.arange(4)
        for z in (-reach, reach)
    ]
    stream.log("/machine/supports", rr.LineStrips3D(supports, colors=rgba(BLUE), radii=0.002), static=True)


def _send_contact_points(stream: rr.RecordingStream, replay: Replay, frames: MotionFrames, factor: float) -> None:
    """`flash`: touches between a frame and the next, or within the turn where frames are rarer; `trace`: dense ones."""
    touches = replay.touches
    if not touches.blade.size:
        return
    rows = _touches_of_frames(replay, frames)
    frame = np.repeat(np.arange(len(rows)), [row.size for row in rows])
    chosen = np.concatenate(rows)
    curve = casing_curve(replay.scenario.machine, frames, casing_angles(), factor, replay.closed)
    positions = _on_curves(curve[frame], touches.angle[chosen])
    share = np.sqrt(touches.impulse / touches.impulse.max())[chosen]
    radii = replay.scenario.machine.tip_radius_m * (SMALLEST_POINT + (LARGEST_POINT - SMALLEST_POINT) * share)
    colors = impulse_color(share)
    columns = rr.Points3D.columns(positions=positions, radii=radii, colors=colors)
    lengths = [row.size for row in rows]
    stream.send_columns("/machine/contact/flash", time_column(frames.time), columns.partition(lengths))
    dense = frames.dense[frame] == 1
    columns = rr.Points3D.columns(positions=positions[dense], radii=radii[dense] / 3, colors=colors[dense])
    lengths = [row.size for row, near in zip(rows, frames.dense, strict=True) if near]
    stream.send_columns(
        "/machine/contact/trace", time_column(frames.time[frames.dense == 1]), columns.partition(lengths)
    )


def _touches_of_frames(replay: Replay, frames: MotionFrames) -> list[IntArray]:
    """Return the numbers of the touches in each frame, the hardest ones where they are many."""
    touches = replay.touches
    end = np.minimum(np.append(frames.time[1:], replay.seconds), frames.time + replay.turn_seconds)
    last = touches.start + touches.duration
    rows = []
    for start, stop in zip(frames.time, end, strict=True):
        row = np.flatnonzero((touches.start < stop) & (last > start))
        rows.append(row[np.argsort(-touches.impulse[row], kind="stable")[:MOST_FLASHES]])
    return rows


def _on_curves(curves: FloatArray, angle: FloatArray) -> FloatArray:
    """Return points (n, 3) at polar angles (n,) on closed curves (n, stations, 2), one each."""
    stations = curves.shape[1]
    place = np.mod(angle, 2 * np.pi) * stations / (2 * np.pi)
    low = np.floor(place).astype(int) % stations
    share, row = (place - np.floor(place))[:, None], np.arange(len(angle))
    flat = (1 - share) * curves[row, low] + share * curves[row, (low + 1) % stations]
    return np.column_stack([flat, np.zeros(len(flat))])
