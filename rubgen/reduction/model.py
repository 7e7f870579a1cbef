"""The reduced system at one speed, as the solver takes it."""

from collections.abc import Callable
from dataclasses import dataclass

from rubgen.arrays import FloatArray
from rubgen.machine import SqueezeFilm


@dataclass(frozen=True, kw_only=True)
class CasingSurface:
    """Undeformed inner surface r(theta) = mean_radius + sum_j amplitude_j cos(order_j (theta - phase_j)), in m, rad."""

    mean_radius: float
    amplitude: FloatArray
    order: FloatArray
    phase: FloatArray


@dataclass(frozen=True, kw_only=True)
class Recovery:
    """What sensors see beside the coordinates: linear functionals of the blisk's n coordinates, and geometry.

    `root_strain` gives the row (n,) of the spanwise strain at a blade's root. `torsion` (n,) is the turn of O_d about
    Z, on a spring `torsion_stiffness` and a damper `torsion_damping` that turn with the drive. `casing_radius` and
    `casing_thickness` are those of the ring in m; `chord_slope` is the tangential way along a tip's chord for one of
    axial way. `blisk_mass` is that of disk and blades, kg.
    """

    root_strain: Callable[[int], FloatArray]
    torsion: FloatArray
    torsion_stiffness: float
    torsion_damping: float
    casing_radius: float
    casing_thickness: float
    chord_slope: float
    blisk_mass: float


@dataclass(frozen=True, kw_only=True)
class TurningForces:
    """Forces on the blisk that turn against it or depend on its state, so that no constant matrix holds them.

    On O_d, u its displacement and v_abs = v + Omega e_z x u its absolute velocity, in the turning frame:
    -k_a Q u - c_a Q v_abs - C(u) v_abs, Q = [[cos 2 theta, -sin 2 theta], [-sin 2 theta, -cos 2 theta]], with
    `stiffness` k_a = (k_X - k_Y) / 2 in N/m, `damping` c_a likewise in N s/m, C of the squeeze `film`. On all of the
    blisk: -g M T (sin theta, cos theta), with `weight` (n, 2) = g M T in N, T the rigid motions along x and y.
    """

    stiffness: float = 0.0
    damping: float = 0.0
    film: SqueezeFilm | None = None
    weight: FloatArray | None = None


@dataclass(frozen=True, kw_only=True)
class SpinningSystem:
    """M q'' + C q' + K q = force + contact, constant matrices of the turning frame at one spin speed.

    The state is q = [tip_0 (radial, tangential, axial), ..., tip_{n_blades-1}, O_d x, O_d y, blisk modes, casing
    modes], n in all. Tip translations are absolute (they contain the motion of O_d) and lie along the blade's own
    axes, which turn with the blisk: blade k stands at angle theta + blade_angles[k]. The casing modes live in the
    inertial frame and are mass-normalised.

    `M`, `C`, `K` are (n, n) and contain every gyroscopic, centrifugal, support and damping term; `force` (n,) is the
    unbalance, on O_d x, and where mistuned blades grow unevenly a little on O_d x and y. `tip_static` (n_blades, 3) is
    the steady centrifugal displacement of the full model at this speed along the same axes as the tips; it is added to
    the tips wherever a position is needed, and is no part of q.
    `casing_modes` (nodes, 2, n_casing) holds the X and Y displacement of each mode at the nodes, which stand at equal
    steps of polar angle from 0. `lateral_stiffness` and `lateral_damping` are the support's, per axis, in N/m, N s/m:
    the mean of X and Y where they differ.
    `casing_rotations` (nodes, n_casing) is the rotation of the ring's section about Z of each mode at the nodes, and
    `half_thickness` (m) how far the inner surface lies inside the centre line; None and 0 where they are not known.
    `recovery` is None where the system was not reduced from a machine.
    `turning` holds what `M`, `C`, `K`, `force` do not; None for most machines.
    """

    speed: float
    M: FloatArray
    C: FloatArray
    K: FloatArray
    force: FloatArray
    n_blades: int
    n_casing: int
    tip_radius: float
    blade_angles: FloatArray
    tip_static: FloatArray
    surface: CasingSurface
    casing_modes: FloatArray
    lateral_stiffness: float
    lateral_damping: float
    casing_rotations: FloatArray | None = None
    half_thickness: float = 0.0
    recovery: Recovery | None = None
    turning: TurningForces | None = None

    @property
    def centre(self) -> int:
        """Index of O_d x in q; O_d y follows."""
        return 3 * self.n_blades

    @property
    def casing_start(self) -> int:
        """Index of the first casing mode in q."""
        return len(self.M) - self.n_casing
