"""Which nodal diameter a mode has, how much of it is blade, and the shapes to draw."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.fem.blisk import BliskModel
from rubgen.machine import load_machine
from rubgen.reduction.casing import reduce_casing
from validation.piece import Arrays
from validation.zeng2019.models.full import blade_frequencies, blisk_modes, disk_modes, full_blisk
from validation.zeng2019.size import MACHINE

BLADE_COUNT, DISK_COUNT = 6, 30


def nodal_diameters(rings: FloatArray) -> IntArray:
    """Nodal diameter (m,) of modes whose values stand at equal angles, rings (angles, coordinates, m)."""
    power = np.sum(np.abs(np.fft.rfft(rings, axis=0)) ** 2, axis=1)
    return np.asarray(power.argmax(axis=0), dtype=np.int64)


def coupled_modes(count: int) -> Arrays:
    """Blisk, disk and blade apart: frequencies in Hz, nodal diameters, and the blades' share of kinetic energy.

    `blisk_hz`, `blisk_nd`, `blade_share` (count,); `disk_hz`, `disk_nd`; `blade_hz` of one clamped blade.
    """
    _, model = full_blisk()
    blisk, disk = blisk_modes(count), disk_modes(DISK_COUNT)
    tips = blisk.shapes[model.tips[:, :3]]
    rim = np.stack([_local(disk.shapes, model, axis) for axis in range(3)], axis=1)
    blades = slice(model.disk_size, None)
    share = np.einsum("ij,ij->j", blisk.shapes[blades], model.M[blades, blades] @ blisk.shapes[blades])
    return {
        "blisk_hz": blisk.frequencies_hz,
        "blisk_nd": nodal_diameters(tips),
        "blade_share": share,
        "disk_hz": disk.frequencies_hz,
        "disk_nd": nodal_diameters(rim),
        "blade_hz": blade_frequencies(BLADE_COUNT),
    }


def drawn_modes(numbers: list[int]) -> Arrays:
    """Places `xy` (nodes, 2) in m of disk and blades, and `moved` (modes, nodes, 3) along x, y, z, largest 1.

    `numbers` count from 1. Nodes of a blade are its beam's.
    """
    _, model = full_blisk()
    shapes = blisk_modes(max(numbers)).shapes[:, [number - 1 for number in numbers]]
    places = [model.plate.mesh.nodes]
    moved = [shapes[6 : model.disk_size].reshape(-1, 6, len(numbers))[:, :3]]
    radius, size = model.blade_radius, 6 * len(model.blade_radius)
    for k, angle in enumerate(model.angles):
        c, s = np.cos(angle), np.sin(angle)
        places.append(radius[:, None] * np.array([c, s]))
        start = model.disk_size + k * size
        local = shapes[start : start + size].reshape(-1, 6, len(numbers))[:, :3]
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        moved.append(np.einsum("ij,njm->nim", turn, local))
    every = np.concatenate(moved)
    every /= np.abs(every).max(axis=(0, 1))
    return {"xy": np.concatenate(places).astype(np.float32), "moved": every.transpose(2, 0, 1).astype(np.float32)}


def casing_shapes(count: int) -> Arrays:
    """`hz` (count,), radial and tangential displacement `moved` (count, 2, nodes), leading order `order` (count,)."""
    casing = reduce_casing(load_machine(MACHINE), count)
    angle = 2 * np.pi * np.arange(len(casing.modes_xy)) / len(casing.modes_xy)
    e_r = np.column_stack([np.cos(angle), np.sin(angle)])
    both = np.stack([e_r, np.column_stack([-e_r[:, 1], e_r[:, 0]])])
    radial, tangential = np.einsum("dni,nim->dmn", both, casing.modes_xy)
    rings = np.stack([radial.T, tangential.T], axis=1)
    moved = np.stack([radial, tangential], axis=1)
    return {"hz": casing.frequencies_hz, "moved": moved, "order": nodal_diameters(rings)}


def _local(shapes: FloatArray, model: BliskModel, axis: int) -> FloatArray:
    """Radial, tangential or axial displacement (rim nodes, modes) of the disk's rim, where blades are joined."""
    x, y, z = (shapes[model.rim[:, i]] for i in range(3))
    c, s = np.cos(model.angles)[:, None], np.sin(model.angles)[:, None]
    return np.asarray((c * x + s * y, c * y - s * x, z)[axis], dtype=np.float64)
