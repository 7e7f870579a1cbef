"""What is simulated: a bladed disk on elastic supports inside a flexible casing.

All lengths in m, stiffness in N/m or N m/rad, density in kg/m3. Values are checked when an object is made. O_d is the
disk centre.
"""

from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator
from pydantic.dataclasses import dataclass

from rubgen.brief import brief
from rubgen.machine.faults.registry import AnyFault
from rubgen.machine.frame import Frame
from rubgen.machine.quantities import (
    STRICT,
    Angle,
    BladeCount,
    BladeElements,
    BladeNumber,
    CasingNodes,
    CircumferentialElements,
    DampingRatio,
    Density,
    DeviationSpread,
    Gravity,
    Height,
    Length,
    Lobes,
    Modulus,
    PoissonRatio,
    RadialElements,
    Seed,
    Stiffness,
    StiffnessDeviation,
    UnbalanceSize,
)
from rubgen.machine.support_laws.disk_support import DiskSupport


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Material:
    """Linear isotropic elastic material."""

    youngs_modulus_pa: Modulus
    poisson_ratio: PoissonRatio
    density_kg_per_m3: Density

    @property
    def shear_modulus_pa(self) -> float:
        """Shear modulus G = E / (2 (1 + nu)), in Pa."""
        return self.youngs_modulus_pa / (2 * (1 + self.poisson_ratio))


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Disk:
    """Annular disk whose thickness is linear in the radius, and its mesh of eight-node shells."""

    material: Material
    bore_radius_m: Length
    rim_radius_m: Length
    bore_thickness_m: Length
    rim_thickness_m: Length
    radial_elements: RadialElements = 7
    circumferential_elements: CircumferentialElements = 72

    @model_validator(mode="after")
    def _bore_is_inside(self) -> Self:
        if self.bore_radius_m >= self.rim_radius_m:
            rim = f"rim_radius_m = {self.rim_radius_m:g}"
            raise ValueError(f"bore_radius_m = {self.bore_radius_m:g} must be below {rim}; change one of them")
        return self


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Mistuning:
    """Relative deviation of each blade's elastic stiffness: `pattern`, or one drawn by `relative_std` and `seed`.

    Blade k has Young's modulus E (1 + deviation_k), and its shear modulus accordingly. All blades have the same mass
    and shape. A pattern begins with blade 0 on x, where the unbalance is, and continues counter-clockwise. Draws are
    independent and normal with mean 0, so the mean of one draw is not exactly 0.
    """

    pattern: Annotated[tuple[StiffnessDeviation, ...], Field(min_length=1)] | None = None
    relative_std: DeviationSpread | None = None
    seed: Seed | None = None

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        given = (self.pattern is not None, self.relative_std is not None, self.seed is not None)
        if given not in ((True, False, False), (False, True, True)):
            raise ValueError("must have pattern alone, or relative_std with its seed; give one of the two")
        return self

    def deviations(self, count: int) -> tuple[float, ...]:
        """Return the pattern itself, or `count` values drawn by numpy's default generator, the same for one seed."""
        if self.pattern is not None:
            return self.pattern
        drawn = np.random.default_rng(self.seed).standard_normal(count)
        return tuple((drawn * (self.relative_std or 0.0)).tolist())


@dataclass(frozen=True, kw_only=True, config=STRICT)
class BladeRow:
    """Blades on the rim, equal except for their mistuning: chord, thickness and stagger are linear from root to tip.

    The angle is the one between the thickness normal and the axis of rotation Z, in degrees. Without `mistuning` all
    blades have the material's stiffness.
    """

    material: Material
    count: BladeCount
    length_m: Length
    root_chord_m: Length
    tip_chord_m: Length
    root_thickness_m: Length
    tip_thickness_m: Length
    root_angle_deg: Angle
    tip_angle_deg: Angle
    elements: BladeElements = 20
    mistuning: Mistuning | None = None

    @model_validator(mode="after")
    def _every_blade_is_stiff(self) -> Self:
        found = self.stiffness_deviations
        if len(found) != self.count:
            raise ValueError(f"mistuning.pattern has {len(found)} values for count = {self.count}; give one a blade")
        if min(found) <= -1:
            raise ValueError(f"mistuning draws a deviation of {min(found):.3g}, no stiffness; lower relative_std")
        return self

    @property
    def stiffness_deviations(self) -> tuple[float, ...]:
        """Relative deviation of stiffness of each blade (count,), 0 without mistuning."""
        return self.mistuning.deviations(self.count) if self.mistuning else (0.0,) * self.count


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Casing:
    """Flexible ring on radial and circumferential springs at its nodes.

    Undeformed inner surface r(theta) = r_mean - (ovality / 2) cos(lobes (theta - lobe_angle)), with
    r_mean = tip radius + clearance + ovality / 2: the smallest gap at rest is the clearance.
    """

    material: Material
    thickness_m: Length
    width_m: Length
    clearance_m: Length
    ovality_m: Height
    lobes: Lobes = 2
    lobe_angle_deg: Angle = 0.0
    radial_support_stiffness_n_per_m: Stiffness
    circumferential_support_stiffness_n_per_m: Stiffness
    nodes: CasingNodes = 180


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Damping:
    """Damping ratios at rest, each with its own mechanism.

    lateral, tilt, axial, torsion: dampers beside the support springs, in the inertial frame, c = 2 zeta sqrt(k m). With
    them the blisk has the ratio as a rigid body on that spring. Its elastic modes have somewhat less
    (docs/preset-zeng2019.md). blade: elastic (internal) damping beta K_e with that ratio at the first mode of a blade
    clamped at its root. casing: the same ratio for every casing mode.
    """

    lateral: DampingRatio
    tilt: DampingRatio
    axial: DampingRatio
    torsion: DampingRatio
    blade: DampingRatio
    casing: DampingRatio


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Unbalance:
    """One more unbalance, mass times radius: on the disk at an angle, or at the tip of a blade.

    The angle is counted from blade 0 in the sense of rotation. An unbalance at a tip also pulls the blade outward and,
    where the speed changes, bends it. An unbalance on the disk acts only on O_d.
    """

    kg_m: UnbalanceSize
    angle_deg: Angle | None = None
    blade: BladeNumber | None = None

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        if (self.angle_deg is None) == (self.blade is None):
            raise ValueError("must have angle_deg or blade; give one of the two")
        return self


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Machine:
    """A blisk on its supports, with its unbalance and damping, in its casing.

    `unbalance_kg_m` is on the disk at `unbalance_angle_deg` from blade 0, in the sense of rotation. `unbalances` are
    further ones. Gravity acts along -Y, only on the blisk; the casing's own sag is part of its shape. 0 is a vertical
    axis. The `frame` takes forces of the disk's support to sensors; without one they feel no such forces. Of each kind
    of fault a machine has at most one (docs/faults.md).
    """

    name: Annotated[str, Field(min_length=1)]
    disk: Disk
    blades: BladeRow
    casing: Casing
    disk_support: DiskSupport
    damping: Damping
    unbalance_kg_m: UnbalanceSize
    unbalance_angle_deg: Angle = 0.0
    unbalances: tuple[Unbalance, ...] = ()
    gravity_m_per_s2: Gravity = 0.0
    frame: Frame | None = None
    faults: tuple[AnyFault, ...] = ()

    __repr__ = brief

    @model_validator(mode="after")
    def _unbalances_have_their_blades(self) -> Self:
        for each in self.unbalances:
            if each.blade is not None and each.blade >= self.blades.count:
                last = self.blades.count - 1
                raise ValueError(f"unbalances: there is no blade {each.blade}; give 0 to {last}")
        return self

    @model_validator(mode="after")
    def _has_each_fault_once(self) -> Self:
        kinds = [fault.kind for fault in self.faults]
        twice = next((kind for kind in kinds if kinds.count(kind) > 1), None)
        if twice:
            raise ValueError(f"faults: {twice} stands twice; keep one of the two")
        return self

    @model_serializer(mode="wrap")
    def _without_absent_parts(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Leave out the parts that the machine does not have: a new key changes no old machine's JSON."""
        values: dict[str, Any] = handler(self)
        absent = [key for key, part in (("frame", self.frame), ("faults", self.faults)) if not part]
        return {key: value for key, value in values.items() if key not in absent}

    @property
    def tip_radius_m(self) -> float:
        """Radius of the blade tips at rest, in m."""
        return self.disk.rim_radius_m + self.blades.length_m

    @property
    def casing_mean_radius_m(self) -> float:
        """Mean radius of the casing's undeformed inner surface, in m."""
        return self.tip_radius_m + self.casing.clearance_m + self.casing.ovality_m / 2
