"""Make taps, the true signals of a run, in the form that the kernels take.

A new kind of sampled tap is one function and one line in `TAP_ROWS`.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.geometry_kernels import Surface, casing_rows, undeformed_radius
from rubgen.linalg.block_kernels import Product
from rubgen.linalg.blocks import Blocks, aligned, padded
from rubgen.linalg.vector_kernels import LANES
from rubgen.reduction.model import Recovery, SpinningSystem
from rubgen.solver.scheme.model_kernels import Laws
from rubgen.solver.scheme.tap_kernels import (
    CONTACT_FORCE,
    CONTACT_TORQUE,
    FORCE_X,
    FORCE_Y,
    Rays,
    Taps,
    Timing,
    X,
    Y,
)
from rubgen.taps import (
    CasingAcceleration,
    CentreDisplacement,
    ContactForce,
    ContactTorque,
    DriveTorque,
    RingStrain,
    RootStrain,
    SupportForce,
    Tap,
    TipClearance,
    TipTiming,
)

SOURCES = ("shaft", "acceleration", "displacement", "position", "change")
"""The inputs of linear functionals, by the names of their fields in `Taps`."""


@dataclass
class TapLayout:
    """Collects the linear functionals of taps: for each source, positions in the sums and the rows there.

    A functional is (source, row): the product of the row with the source's vector. The value of a tap is the sum of its
    functionals. All sources share the positions, which the taps take in their order.
    """

    system: SpinningSystem
    surface: Surface
    blocks: Blocks
    dt: float
    rows: dict[str, list[tuple[int, FloatArray]]] = field(default_factory=lambda: {name: [] for name in SOURCES})
    linear: list[tuple[int, int]] = field(default_factory=list)
    rays: list[tuple[int, int, float]] = field(default_factory=list)
    places: int = 0

    @property
    def recovery(self) -> Recovery:
        """The data of the machine from which strains and drive follow.

        Raises ValueError for a system without a machine.
        """
        if self.system.recovery is None:
            raise ValueError("this system was not reduced from a machine: it has no strain and no drive")
        return self.system.recovery

    def add(self, output: int, **functionals: FloatArray) -> None:
        """Add a linear tap at row `output` of the taps: the sum of its functionals, named by their sources."""
        self.linear.append((output, self._place(**functionals)))

    def add_ray(self, output: int, angle: float) -> None:
        """Add a clearance on the ray at polar angle `angle` (rad), at row `output` of the taps."""
        self.rays.append((output, self.places, angle))
        for row in polar_rows(self.surface, angle):
            self._place(displacement=row)

    def _place(self, **functionals: FloatArray) -> int:
        place = self.places
        self.places += 1
        for source, row in functionals.items():
            self.rows[source].append((place, row))
        return place

    def product(self, source: str) -> Product:
        """Return the functionals of one source in the form of the kernels.

        It has a line for each row of eight sums that is used. `source` is one of SOURCES.
        """
        placed = self.rows[source]
        lines, parts, first = [], [np.zeros((0, LANES))], 0
        for number in sorted({place // LANES for place, _ in placed}):
            part = np.zeros((len(placed[0][1]), LANES))
            for place, row in placed:
                if place // LANES == number:
                    part[:, place % LANES] = row
            lines.append((1, number, first, 0, len(part)))
            first += len(part)
            parts.append(part)
        return Product(np.array(lines, dtype=np.int64).reshape(-1, 5), aligned(np.concatenate(parts)))


def direction(angle_deg: float) -> tuple[float, float]:
    """Return cosine and sine of an angle in degrees, exact at multiples of 90."""
    quarter, rest = divmod(angle_deg, 90.0)
    if rest == 0:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    return float(np.cos(np.deg2rad(angle_deg))), float(np.sin(np.deg2rad(angle_deg)))


def along(angle_deg: float, first: int, second: int) -> FloatArray:
    """Return the row (8,) of a functional on the shaft's signals: the part of a vector along a direction, deg from X.

    `first` and `second` are the numbers of the vector's X and Y part in the signals.
    """
    row = np.zeros(LANES)
    row[first], row[second] = direction(angle_deg)
    return row


def only(signal: int) -> FloatArray:
    """Return the row of a linear functional on the shaft's signals: the value of the signal with this number."""
    return np.asarray(np.eye(LANES)[signal])


def polar_rows(surface: Surface, angle: float) -> list[FloatArray]:
    """Return rows (n_casing,) for radial and tangential displacement and d(radial)/d(angle) at a polar angle, rad."""
    cosine, sine = np.cos(angle), np.sin(angle)
    n_casing = len(surface.mode_displacement)
    at, aside = np.zeros((2, n_casing)), np.zeros((2, 2, n_casing))
    casing_rows(surface, angle, at)
    width = 1e-3 * surface.node_step
    for side, sign in enumerate((1, -1)):
        casing_rows(surface, angle + sign * width, aside[side])
    slope = (aside[0] - aside[1]) / (2 * width)
    radial, tangential = cosine * at[0] + sine * at[1], cosine * at[1] - sine * at[0]
    return [radial, tangential, cosine * slope[0] + sine * slope[1] + tangential]


def ring_strain_row(system: SpinningSystem, recovery: Recovery, angle: float) -> FloatArray:
    """Return the row of the hoop strain at the casing's outer face: (u_t' + u_r) / R + (h / 2) (u_t' - u_r'') / R^2.

    It has a value for each casing mode, at the polar angle `angle` in rad. R is the mean radius of the inner surface, h
    the thickness. The first term is the stretch of the centre line. The second is the bending of a thin ring, from the
    rotation (u_t - u_r') / R of the cross-section (Love 1888). Derivatives are taken of the trigonometric polynomial
    through the nodes.
    """
    modes = system.casing_modes
    nodes = len(modes)
    t = 2 * np.pi * np.arange(nodes)[:, None] / nodes
    radial = modes[:, 0] * np.cos(t) + modes[:, 1] * np.sin(t)
    tangential = modes[:, 1] * np.cos(t) - modes[:, 0] * np.sin(t)
    n = np.fft.rfftfreq(nodes, 1 / nodes)
    weight = np.where((n == 0) | (2 * n == nodes), 1, 2) / nodes * np.exp(1j * n * angle)

    def value(values: FloatArray, derivative: int) -> FloatArray:
        return np.asarray((weight * (1j * n) ** derivative @ np.fft.rfft(values, axis=0)).real)

    R, h = recovery.casing_radius, recovery.casing_thickness
    stretch = (value(tangential, 1) + value(radial, 0)) / R
    return np.asarray(stretch + h / 2 * (value(tangential, 1) - value(radial, 2)) / R**2)


def _root_strain(layout: TapLayout, output: int, tap: RootStrain) -> None:
    if tap.blade >= layout.system.n_blades:
        raise ValueError(f"tap {tap.name}: blade {tap.blade} of {layout.system.n_blades}")
    row = layout.recovery.root_strain(tap.blade)
    layout.add(output, position=layout.blocks.to_z(_on_blisk(layout.system, row)))


def _drive_torque(layout: TapLayout, output: int, _tap: DriveTorque) -> None:
    recovery, to_z = layout.recovery, layout.blocks.to_z
    torsion = to_z(_on_blisk(layout.system, recovery.torsion))
    velocity = torsion / layout.dt
    layout.add(output, position=-recovery.torsion_stiffness * torsion, change=-recovery.torsion_damping * velocity)


def _on_blisk(system: SpinningSystem, row: FloatArray) -> FloatArray:
    return np.concatenate([row, np.zeros(system.n_casing)])


TAP_ROWS: dict[type[Tap], Callable[[TapLayout, int, Any], None]] = {
    CentreDisplacement: lambda layout, output, tap: layout.add(output, shaft=along(tap.angle_deg, X, Y)),
    SupportForce: lambda layout, output, tap: layout.add(output, shaft=along(tap.angle_deg, FORCE_X, FORCE_Y)),
    ContactForce: lambda layout, output, _: layout.add(output, shaft=only(CONTACT_FORCE)),
    ContactTorque: lambda layout, output, _: layout.add(output, shaft=only(CONTACT_TORQUE)),
    CasingAcceleration: lambda layout, output, tap: layout.add(
        output, acceleration=polar_rows(layout.surface, np.deg2rad(tap.angle_deg))[0]
    ),
    RingStrain: lambda layout, output, tap: layout.add(
        output, displacement=ring_strain_row(layout.system, layout.recovery, np.deg2rad(tap.angle_deg))
    ),
    TipClearance: lambda layout, output, tap: layout.add_ray(output, np.deg2rad(tap.angle_deg)),
    RootStrain: _root_strain,
    DriveTorque: _drive_torque,
}


def sampled_taps(taps: tuple[Tap, ...]) -> list[Tap]:
    """Return the taps that have a value at every step."""
    return [tap for tap in taps if not isinstance(tap, TipTiming)]


def timing_taps(taps: tuple[Tap, ...]) -> list[TipTiming]:
    """Return the taps that are events: passages under a probe."""
    return [tap for tap in taps if isinstance(tap, TipTiming)]


def build_taps(
    taps: tuple[Tap, ...], system: SpinningSystem, surface: Surface, blocks: Blocks, laws: Laws, theta: FloatArray
) -> Taps:
    """Build the constants and scratch of the kernels for these taps of a system.

    - surface: inner surface of the casing.
    - blocks: blocks of the system's matrices.
    - laws: its dt and the limit of the tips are used.
    - theta (steps,): angles of a turn's steps, rad.

    Raises ValueError for a blade that does not exist, and for strain or drive of a system without a machine. Raises
    KeyError for a `HousingAcceleration`, which the solver does not record.
    """
    layout = TapLayout(system, surface, blocks, laws.dt)
    for output, tap in enumerate(sampled_taps(taps)):
        TAP_ROWS[type(tap)](layout, output, tap)
    return Taps(
        **{source: layout.product(source) for source in SOURCES},
        linear=np.array(layout.linear, dtype=np.int64).reshape(-1, 2),
        rays=_rays(layout, theta),
        timing=_timing(system, timing_taps(taps), theta, laws.tip_limit),
        centre=system.centre,
        lateral_stiffness=float(system.lateral_stiffness),
        lateral_damping=float(system.lateral_damping),
        spring_load=np.array([np.zeros(2) if system.spring_load is None else system.spring_load, np.zeros(2)]),
        signals=aligned(np.zeros(LANES)),
        sums=aligned(np.zeros(padded(layout.places))),
        bend=np.zeros(system.n_casing),
    )


def _rays(layout: TapLayout, theta: FloatArray) -> Rays:
    output, place, angle = np.array(layout.rays, dtype=float).reshape(-1, 3).T
    blades, shares = _blades_around_rays(layout.system, angle, theta)
    undeformed = np.array([undeformed_radius(layout.surface, each) for each in angle]).reshape(-1, 3)
    return Rays(
        output.astype(np.int64), place.astype(np.int64), angle.copy(), undeformed[:, 0].copy(), undeformed[:, 1].copy(),
        blades, shares,
    )  # fmt: skip


def _timing(system: SpinningSystem, probes: list[TipTiming], theta: FloatArray, tip_limit: float) -> Timing:
    recovery = system.recovery
    angle = np.deg2rad(np.array([probe.angle_deg for probe in probes], dtype=float))
    slope = 0.0 if recovery is None else recovery.chord_slope
    return Timing(
        angle=angle,
        axial=np.array([probe.axial_m for probe in probes], dtype=float),
        chord_slope=slope,
        # Three steps, what the axial displacement of the tip may do, and the curvature of the tip's way.
        near_angle=6 * np.pi / len(theta) + 2 * abs(slope) * tip_limit / system.tip_radius + 2e-3,
        blade=_blades_around_rays(system, angle, theta)[0],
        arrivals=np.zeros((2 * (system.n_blades + 1) * len(probes), 4)),
    )


def turned_taps(taps: Taps, system: SpinningSystem, theta: FloatArray) -> Taps:
    """Return the same taps for steps at other angles `theta` (steps,) of the blisk, rad."""
    blade, share = _blades_around_rays(system, taps.rays.angle, theta)
    passing, _ = _blades_around_rays(system, taps.timing.angle, theta)
    return taps._replace(rays=taps.rays._replace(blade=blade, share=share), timing=taps.timing._replace(blade=passing))


def _blades_around_rays(system: SpinningSystem, rays: FloatArray, theta: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the blades (steps, rays, 2) on either side of each ray at angles `theta`, and the ray's share between."""
    if not len(rays):
        return np.zeros((len(theta), 0, 2), dtype=np.int64), np.zeros((len(theta), 0))
    turn = 2 * np.pi
    order = np.argsort(np.mod(system.blade_angles, turn), kind="stable")
    placed = np.mod(system.blade_angles, turn)[order]
    local = np.mod(np.subtract.outer(rays, theta).T, turn)
    after = np.searchsorted(placed, local, side="right")
    first, second = (after - 1) % len(placed), after % len(placed)
    pitch = np.mod(placed[second] - placed[first], turn)
    pitch = np.where(pitch == 0, turn, pitch)
    share = np.mod(local - placed[first], turn) / pitch
    return np.stack([order[first], order[second]], axis=-1).astype(np.int64), np.ascontiguousarray(share)
