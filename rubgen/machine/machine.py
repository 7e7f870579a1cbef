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
    about,
)
from rubgen.machine.support_laws.disk_support import DiskSupport


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Material:
    """Linear isotropic elastic material."""

    youngs_modulus_pa: Annotated[
        Modulus, about("Young's modulus, from the data sheet: steel has 2.06e11, titanium 1.1e11, aluminium 7e10.")
    ]
    poisson_ratio: Annotated[PoissonRatio, about("Poisson's ratio, from the data sheet: metals have 0.25 to 0.35.")]
    density_kg_per_m3: Annotated[
        Density, about("Mass per volume, from the data sheet: steel has 7,850, titanium 4,430, aluminium 2,700.")
    ]

    @property
    def shear_modulus_pa(self) -> float:
        """Shear modulus G = E / (2 (1 + nu)), in Pa."""
        return self.youngs_modulus_pa / (2 * (1 + self.poisson_ratio))


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Disk:
    """Annular disk whose thickness is linear in the radius, and its mesh of eight-node shells."""

    material: Annotated[Material, about("Material of the disk.")]
    bore_radius_m: Annotated[Length, about("Inner radius of the disk, from the drawing.")]
    rim_radius_m: Annotated[Length, about("Outer radius of the disk, where the blades begin, from the drawing.")]
    bore_thickness_m: Annotated[
        Length,
        about(
            "Axial thickness at the bore. From there it is linear in the radius. A thicker disk is heavier and stiffer."
        ),
    ]
    rim_thickness_m: Annotated[Length, about("Axial thickness at the rim. A thicker rim couples the blades less.")]
    radial_elements: Annotated[
        RadialElements,
        about("Number of shell elements from bore to rim. Raise it until `rubgen modes` no longer changes."),
    ] = 7
    circumferential_elements: Annotated[
        CircumferentialElements,
        about(
            "Number of shell elements around the disk, a multiple of the number of blades. Raise it "
            "until `rubgen modes` no longer changes."
        ),
    ] = 72

    @model_validator(mode="after")
    def _bore_is_inside(self) -> Self:
        if self.bore_radius_m >= self.rim_radius_m:
            rim = f"rim_radius_m = {self.rim_radius_m:g}"
            raise ValueError(f"bore_radius_m = {self.bore_radius_m:g} must be below {rim}; change one of them")
        return self


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Mistuning:
    """Relative deviation of each blade's elastic stiffness: `pattern`, or values drawn with `relative_std` and `seed`.

    Young's modulus and shear modulus of blade k are multiplied by 1 + deviation_k. All blades have the same mass and
    shape. A pattern begins with blade 0, on x of the turning frame, and continues counter-clockwise. Draws are
    independent and normal with mean 0, so the mean of one draw is not exactly 0.
    """

    pattern: Annotated[
        Annotated[tuple[StiffnessDeviation, ...], Field(min_length=1)] | None,
        about(
            "Relative deviation of the stiffness of each blade, beginning with blade 0. Give it where "
            "the deviations were measured; else give relative_std and seed."
        ),
    ] = None
    relative_std: Annotated[
        DeviationSpread | None,
        about(
            "Standard deviation from which the deviation of each blade is drawn. Give it, with seed, "
            "where only the scatter of the blades is known."
        ),
    ] = None
    seed: Annotated[Seed | None, about("Seed of that draw. Another seed is another blisk of the same scatter.")] = None

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        given = (self.pattern is not None, self.relative_std is not None, self.seed is not None)
        if given not in ((True, False, False), (False, True, True)):
            raise ValueError("must have pattern alone, or relative_std with its seed; give one of the two")
        return self

    def deviations(self, count: int) -> tuple[float, ...]:
        """Return the relative deviations of `count` blades: the pattern, or values that `seed` fixes."""
        if self.pattern is not None:
            return self.pattern
        drawn = np.random.default_rng(self.seed).standard_normal(count)
        return tuple((drawn * (self.relative_std or 0.0)).tolist())


@dataclass(frozen=True, kw_only=True, config=STRICT)
class BladeRow:
    """Blades on the rim, equal except for their mistuning: chord, thickness and angle are linear from root to tip.

    The angle in degrees is between the thickness normal and the axis of rotation Z. Without `mistuning` all blades have
    the material's stiffness.
    """

    material: Annotated[Material, about("Material of the blades.")]
    count: Annotated[BladeCount, about("Number of blades. It is also the order of blade passing.")]
    length_m: Annotated[
        Length, about("Length of a blade from the rim to its tip. Longer blades have lower frequencies.")
    ]
    root_chord_m: Annotated[
        Length,
        about(
            "Chord of the profile at the root. The profile is a rectangle of chord and thickness, "
            "both linear to the tip."
        ),
    ]
    tip_chord_m: Annotated[Length, about("Chord of the profile at the tip.")]
    root_thickness_m: Annotated[
        Length, about("Thickness of the profile at the root. A thicker root raises the frequencies of the blade.")
    ]
    tip_thickness_m: Annotated[
        Length, about("Thickness of the profile at the tip. A thinner tip is lighter and more flexible.")
    ]
    root_angle_deg: Annotated[
        Angle,
        about(
            "Angle between the thickness normal of the profile and the axis of rotation, at the root. "
            "It couples bending with the axial direction."
        ),
    ]
    tip_angle_deg: Annotated[
        Angle, about("The same angle at the tip. Another angle than at the root is a twisted blade.")
    ]
    elements: Annotated[
        BladeElements, about("Number of beam elements of a blade. Raise it until `rubgen modes` no longer changes.")
    ] = 20
    mistuning: Annotated[
        Mistuning | None,
        about(
            "Deviations of the blades' stiffness from each other. Without it all blades are equal; "
            "real blisks differ by a few percent."
        ),
    ] = None

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

    material: Annotated[Material, about("Material of the casing ring.")]
    thickness_m: Annotated[
        Length, about("Radial thickness of the ring. A thinner ring yields more to a rub and has lower frequencies.")
    ]
    width_m: Annotated[Length, about("Axial width of the ring. A wider ring is heavier and stiffer.")]
    clearance_m: Annotated[
        Length,
        about(
            "Smallest gap between blade tips and casing at rest. A smaller one makes a rub that "
            "begins earlier and is harder."
        ),
    ]
    ovality_m: Annotated[
        Height,
        about(
            "Largest minus smallest radius of the inner surface. 0 is a round casing, which blades "
            "touch all around or on one side."
        ),
    ]
    lobes: Annotated[
        Lobes,
        about(
            "Number of narrow places around the inner surface. 2 is an oval; 3 is what a three-jaw "
            "chuck or three supports leave."
        ),
    ] = 2
    lobe_angle_deg: Annotated[
        Angle, about("Angle of the first narrow place from +X. Change it to rub elsewhere relative to the sensors.")
    ] = 0.0
    radial_support_stiffness_n_per_m: Annotated[
        Stiffness,
        about(
            "Radial stiffness of the spring under each node of the ring. A higher one makes contact "
            "forces larger and shorter."
        ),
    ]
    circumferential_support_stiffness_n_per_m: Annotated[
        Stiffness,
        about("Circumferential stiffness of the spring under each node of the ring. It carries the friction of a rub."),
    ]
    nodes: Annotated[
        CasingNodes,
        about(
            "Number of nodes around the ring, a multiple of 4 and of the number of lobes. Raise it "
            "until `rubgen modes` no longer changes."
        ),
    ] = 180


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Damping:
    """Damping ratios at rest, each with its own mechanism.

    lateral, tilt, axial, torsion: dampers parallel to the support springs, in the inertial frame, c = 2 zeta sqrt(k m).
    The blisk as a rigid body on this spring has the ratio. Its elastic modes have somewhat less
    (docs/preset-zeng2019.md). blade: elastic (internal) damping beta K_e with the ratio at the first mode of a blade
    clamped at its root. casing: the same ratio for every casing mode.
    """

    lateral: Annotated[
        DampingRatio,
        about(
            "Damping ratio of the blisk that moves laterally as a rigid body. It decides the "
            "amplitude at the critical speed."
        ),
    ]
    tilt: Annotated[DampingRatio, about("Damping ratio of the blisk that tilts as a rigid body.")]
    axial: Annotated[DampingRatio, about("Damping ratio of the blisk that moves axially as a rigid body.")]
    torsion: Annotated[DampingRatio, about("Damping ratio of the blisk that turns against its drive as a rigid body.")]
    blade: Annotated[
        DampingRatio,
        about(
            "Damping ratio of the first mode of a clamped blade. Blisks have little; a lower one "
            "makes blades ring longer after a touch."
        ),
    ]
    casing: Annotated[
        DampingRatio,
        about("Damping ratio of every mode of the casing. A lower one makes the casing ring longer after a touch."),
    ]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Unbalance:
    """A further unbalance, mass times radius: on the disk at an angle, or at the tip of a blade.

    The angle is counted from blade 0 in the sense of rotation. An unbalance at a tip also pulls the blade outward and,
    where the speed changes, bends it. An unbalance on the disk acts only on O_d.
    """

    kg_m: Annotated[UnbalanceSize, about("Mass times radius of this unbalance.")]
    angle_deg: Annotated[
        Angle | None,
        about(
            "Angle on the disk from blade 0, in the sense of rotation. Give it for an unbalance on "
            "the disk; else give blade."
        ),
    ] = None
    blade: Annotated[
        BladeNumber | None,
        about(
            "Number of the blade at whose tip the unbalance is. Give it for a heavy or light blade; "
            "else give angle_deg."
        ),
    ] = None

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        if (self.angle_deg is None) == (self.blade is None):
            raise ValueError("must have angle_deg or blade; give one of the two")
        return self


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Machine:
    """A blisk on its supports, with its unbalance and damping, in its casing.

    `unbalance_kg_m` is on the disk at `unbalance_angle_deg` from blade 0, in the sense of rotation. `unbalances` are in
    addition. Gravity acts along -Y, only on the blisk; the casing's own sag is part of its shape. 0 is a vertical axis.
    The `frame` carries forces of the disk's support to sensors; without a frame sensors feel no such forces. A machine
    has at most one fault of each kind (docs/faults.md).
    """

    name: Annotated[str, Field(min_length=1), about("Name of the machine in tables, figures and messages.")]
    disk: Annotated[Disk, about("The disk and its mesh.")]
    blades: Annotated[BladeRow, about("The blades and their mesh.")]
    casing: Annotated[Casing, about("The casing ring, its gap to the blades, its shape and its mesh.")]
    disk_support: Annotated[DiskSupport, about("Springs that carry the disk centre, and laws beside them.")]
    damping: Annotated[Damping, about("Damping ratios of the parts.")]
    unbalance_kg_m: Annotated[
        UnbalanceSize,
        about(
            "Mass times radius of the unbalance on the disk. It drives the whirl that closes the gap; "
            "grade G 2.5 of ISO 21940 is 0.0025 m/s over the speed in rad/s, times the mass of the "
            "blisk."
        ),
    ]
    unbalance_angle_deg: Annotated[
        Angle, about("Angle of unbalance_kg_m from blade 0, in the sense of rotation. It decides which blades touch.")
    ] = 0.0
    unbalances: Annotated[tuple[Unbalance, ...], about("Further unbalances, on the disk or at tips of blades.")] = ()
    gravity_m_per_s2: Annotated[
        Gravity, about("Gravity along -Y on the blisk. Give 9.81 for a horizontal axis; 0 is a vertical one.")
    ] = 0.0
    frame: Annotated[
        Frame | None,
        about(
            "Modes of the frame that carry forces of the disk's support to the casing's and the "
            "housing's sensors. Without it those sensors feel no such forces."
        ),
    ] = None
    faults: Annotated[
        tuple[AnyFault, ...],
        about("Faults of the machine, of each kind at most one. Without it the machine is healthy."),
    ] = ()

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
    def lost_blades(self) -> tuple[int, ...]:
        """Numbers of the blades that the machine's faults have taken away, ascending."""
        return tuple(sorted({blade for fault in self.faults for blade in fault.lost_blades(self)}))

    @property
    def casing_mean_radius_m(self) -> float:
        """Mean radius of the casing's undeformed inner surface, in m."""
        return self.tip_radius_m + self.casing.clearance_m + self.casing.ovality_m / 2
