"""What chords instead of the smooth curve do to a tip that passes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.contact import casing_surface
from rubgen.contact.geometry_kernels import undeformed_radius
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw


@dataclass(frozen=True, kw_only=True)
class Artefact:
    """What chords are beside the smooth curve over the polar angles `angle` (points,) in rad.

    `inside` (points,) is how far they lie inside of it in m, `approach` (points,) how fast they come nearer to a tip
    on a circle, in m/s; `hits` (nodes,) are the jumps of that speed at the nodes.
    """

    angle: FloatArray
    inside: FloatArray
    approach: FloatArray
    hits: FloatArray
    tip_speed: float


def artefact(system: SpinningSystem, points: int = 72000) -> Artefact:
    """The artefact of chords in a system at its speed, from the contact surface itself."""
    smooth, chords = (casing_surface(system, ContactLaw(surface=kind)) for kind in ("smooth", "chords"))
    angle = 2 * np.pi * (np.arange(points) + 0.5) / points
    curve, polygon = (np.array([undeformed_radius(each, psi) for psi in angle]) for each in (smooth, chords))
    nodes = 2 * np.pi * np.arange(len(system.casing_modes)) / len(system.casing_modes)
    before, after = (np.array([undeformed_radius(chords, psi + side * 1e-9)[1] for psi in nodes]) for side in (-1, 1))
    return Artefact(
        angle=angle,
        inside=curve[:, 0] - polygon[:, 0],
        approach=-system.speed * (polygon[:, 1] - curve[:, 1]),
        hits=system.speed * (before - after),
        tip_speed=system.speed * system.tip_radius,
    )
