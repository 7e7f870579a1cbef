"""Geometry and natural modes of the machine of a run, for formats of modal analysis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.reduction import ReducedModel

FIRST_OF_CASING, FIRST_OF_TIPS, CENTRE = 1001, 2001, 3001
"""Numbers of nodes."""


@dataclass(frozen=True)
class ShownMode:
    """An undamped mode of the machine at rest without contact, of unit modal mass."""

    name: str
    hertz: float
    nodes: IntArray
    """Numbers of the nodes that move (nodes,), as in `nodes_of`."""
    shape: FloatArray
    """Displacements in x, y, z (nodes, 3), kg^-1/2."""


def nodes_of(model: ReducedModel) -> tuple[IntArray, FloatArray]:
    """Return numbers (nodes,) and positions (nodes, 3) in m of the nodes that represent a machine.

    They are in this order the casing's nodes on its mean inner radius, the tips at rest with blade 0 on x, and the disk
    centre.
    """
    casing, blades = len(model.casing.modes_xy), model.machine.blades.count
    numbers = [*range(FIRST_OF_CASING, FIRST_OF_CASING + casing), *range(FIRST_OF_TIPS, FIRST_OF_TIPS + blades), CENTRE]
    places = np.zeros((len(numbers), 3))
    places[:casing, :2] = model.machine.casing_mean_radius_m * _directions(casing)
    places[casing:-1, :2] = model.machine.tip_radius_m * _directions(blades)
    return np.array(numbers), places


def modes_of(model: ReducedModel, highest_hz: float) -> list[ShownMode]:
    """Return the modes of casing and blisk up to `highest_hz`, the modes of the casing first.

    The modes of the blisk solve K phi = omega^2 M phi of the reduced model at rest: on its supports, without damping,
    rotation and contact. A tip's radial, tangential and axial displacement is turned into x, y, z at the angle of its
    blade.
    """
    found = []
    casing = model.casing
    numbers = FIRST_OF_CASING + np.arange(len(casing.modes_xy))
    for number, hertz in enumerate(casing.frequencies_hz):
        shape = np.column_stack([casing.modes_xy[..., number], np.zeros(numbers.size)])
        found.append(ShownMode(f"casing {number + 1}", float(hertz), numbers, shape))
    squares, vectors = model.modes_at_rest()
    blades = model.machine.blades.count
    numbers = np.append(FIRST_OF_TIPS + np.arange(blades), CENTRE)
    (cosine, sine), moved = _directions(blades).T, model.blisk.centre[:3] @ vectors
    for number, square in enumerate(squares):
        radial, tangential, axial = vectors[: 3 * blades, number].reshape(blades, 3).T
        tips = np.column_stack([radial * cosine - tangential * sine, radial * sine + tangential * cosine, axial])
        hertz = float(np.sqrt(max(square, 0.0)) / (2 * np.pi))
        found.append(ShownMode(f"blisk {number + 1}", hertz, numbers, np.vstack([tips, moved[:, number]])))
    return [mode for mode in found if mode.hertz <= highest_hz]


def _directions(count: int) -> FloatArray:
    angle = 2 * np.pi * np.arange(count) / count
    return np.column_stack([np.cos(angle), np.sin(angle)])
