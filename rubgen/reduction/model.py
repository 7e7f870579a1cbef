"""The reduced system at one speed, as the solver takes it.

O_d is the disk centre.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.machine.faults.fault import Narrowing, Ramp
from rubgen.machine.support_laws.law import SupportLaw


@dataclass(frozen=True, kw_only=True)
class CasingSurface:
    """Undeformed inner surface r(theta) = mean_radius + sum_j amplitude_j cos(order_j (theta - phase_j)), in m, rad."""

    mean_radius: float
    """Mean radius, m."""
    amplitude: FloatArray
    """Amplitude of each harmonic (harmonics,), m."""
    order: FloatArray
    """Order of each harmonic (harmonics,)."""
    phase: FloatArray
    """Polar angle phase_j of each harmonic (harmonics,), rad. There it is largest, or least where the amplitude is
    negative, as for the casing's lobes."""


@dataclass(frozen=True, kw_only=True)
class Recovery:
    """Data that sensors need in addition to q: linear functionals of the blisk's n coordinates, and geometry."""

    root_strain: Callable[[int], FloatArray]
    """For a blade's number, the row (n,) of the spanwise strain at its root."""
    torsion: FloatArray
    """Row (n,) of the rotation of O_d about Z, rad."""
    torsion_stiffness: float
    """Torsional stiffness of the drive, N m/rad. The spring turns with the drive."""
    torsion_damping: float
    """Torsional damping of the drive, N m s/rad."""
    casing_radius: float
    """Mean radius of the casing's inner surface, m."""
    casing_thickness: float
    """Radial thickness of the casing, m."""
    chord_slope: float
    """Tangential displacement along a tip's chord per unit of axial distance."""
    blisk_mass: float
    """Mass of disk and blades, kg."""


@dataclass(frozen=True, kw_only=True)
class GrowingLoad:
    """A load on O_d that grows within the record."""

    ramp: Ramp
    """Its share at each time."""
    loads: ComplexArray
    """When it has grown; as `TurningForces.loads`."""
    of_springs: bool
    """Whether the lateral springs apply it, as `SpinningSystem.spring_load`."""


@dataclass(frozen=True, kw_only=True)
class TurningForces:
    """Forces on the blisk that depend on its angle or motion, so that no constant matrix contains them.

    O_d has the displacement u and the absolute velocity v_abs = v + Omega e_z x u in the turning frame. On O_d act:

    - uneven supports: -k_a Q u - c_a Q v_abs, with Q = [[cos 2 theta, -sin 2 theta], [-sin 2 theta, -cos 2 theta]].
    - the laws of the support.
    - the loads of faults: Re sum_m loads[m] e^(i m theta).

    On all of the blisk acts gravity: -g M T (sin theta, cos theta), with T the rigid motions along x and y.
    """

    stiffness: float = 0.0
    """k_a = (k_X - k_Y) / 2, N/m."""
    damping: float = 0.0
    """c_a = (c_X - c_Y) / 2, N s/m."""
    laws: tuple[SupportLaw, ...] = ()
    """Laws of the support, functions of u and v_abs."""
    weight: FloatArray | None = None
    """g M T (n, 2), N."""
    loads: ComplexArray | None = None
    """Loads of faults on O_d (orders, 2) in the turning frame, N; row m turns with m theta."""
    growing: tuple[GrowingLoad, ...] = ()
    """Further loads that grow within the record."""

    @property
    def is_periodic(self) -> bool:
        """Whether a force depends only on the angle theta, so that O_d moves in the turning frame without rub.

        Loads that grow do not count.
        """
        return self.weight is not None or self.loads is not None

    @property
    def uneven(self) -> bool:
        """Whether the forces of supports and laws depend on theta."""
        return bool(self.stiffness or self.damping) or any(law.TURNS for law in self.laws)

    @property
    def stiffening(self) -> float:
        """Largest stiffness in N/m that uneven springs and laws add to the support."""
        return abs(self.stiffness) + sum(law.stiffening_n_per_m for law in self.laws)


@dataclass(frozen=True, kw_only=True)
class SpinningSystem:
    """M q'' + C q' + K q = force + contact, constant matrices of the turning frame at one spin speed.

    The state is q = [tip_0 (radial, tangential, axial), ..., tip_{n_blades-1}, O_d x, O_d y, blisk modes, casing
    modes], n in all. Tip translations are absolute (they contain the motion of O_d) and lie along the blade's own
    axes, which turn with the blisk: blade k stands at angle theta + blade_angles[k]. The casing modes live in the
    inertial frame and are mass-normalised.

    """

    speed: float
    """Spin speed Omega in rad/s."""
    M: FloatArray
    """Mass matrix (n, n)."""
    C: FloatArray
    """Damping and gyroscopic matrix (n, n)."""
    K: FloatArray
    """Stiffness matrix (n, n) with centrifugal, support and circulatory terms."""
    force: FloatArray
    """Constant force (n,), N: unbalances, uneven growth on O_d, lost masses and blades, loads of faults that are
    constant in the turning frame, the Euler force of a changing speed."""
    n_blades: int
    """Number of blades."""
    n_casing: int
    """Number of casing modes."""
    tip_radius: float
    """Radius of the blade tips at rest, m."""
    blade_angles: FloatArray
    """Angle of each blade on the disk (n_blades,), rad."""
    tip_static: FloatArray
    """Steady centrifugal displacement of the tips in the full model (n_blades, 3), m, along the blade's own axes.

    It is no part of q. Positions of the tips add it to q. The tip of a lost blade is put 5 % of its radius inside, so
    that it never touches."""
    surface: CasingSurface
    """Undeformed inner surface of the casing."""
    casing_modes: FloatArray
    """X and Y displacement of each casing mode (nodes, 2, n_casing). Nodes stand at equal steps of angle from 0."""
    lateral_stiffness: float
    """Lateral stiffness of the disk support, mean of X and Y, N/m."""
    lateral_damping: float
    """Lateral damping of the disk support, mean of X and Y, N s/m."""
    casing_rotations: FloatArray | None = None
    """Rotation of the ring's cross-section about Z of each mode (nodes, n_casing); None where it is not known."""
    half_thickness: float = 0.0
    """How far the casing's inner surface lies inside the ring's centre line, m; 0 where it is not known."""
    recovery: Recovery | None = None
    """What sensors need; None where the system was not reduced from a machine."""
    turning: TurningForces | None = None
    """Forces that `M`, `C`, `K` and `force` do not contain; None for most machines."""
    narrowings: tuple[Narrowing, ...] = ()
    """How the clearance closes within the record."""
    spring_load: FloatArray | None = None
    """Part (2,) of `force` on O_d that the lateral springs apply, because a bow moves their place of rest, N."""

    @property
    def starting(self) -> "SpinningSystem":
        """The system without the laws whose motion must settle; the system itself if it has no such law.

        Its motion without rub is known before the run, so a run starts from this motion.
        """
        forces = self.turning
        if forces is None or not any(law.SETTLES for law in forces.laws):
            return self
        known = tuple(law for law in forces.laws if not law.SETTLES)
        return replace(self, turning=replace(forces, laws=known))

    @property
    def ramps(self) -> tuple[Ramp, ...]:
        """The growth of each fault that grows within the record; empty if no fault grows."""
        growing = tuple(load.ramp for load in self.turning.growing) if self.turning else ()
        return (*growing, *(narrowing.ramp for narrowing in self.narrowings))

    @property
    def centre(self) -> int:
        """Index of O_d x in q; O_d y follows."""
        return 3 * self.n_blades

    @property
    def casing_start(self) -> int:
        """Index of the first casing mode in q."""
        return len(self.M) - self.n_casing
