"""Reduce a machine, and give its matrices as functions of the speed.

O_d is the disk centre. Of the blisk, K_e is the elastic stiffness and K_s the springs of its support. At 1 rad/s
K_sigma is the stiffness from centrifugal stress, S the spin softening and G the Coriolis matrix.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.linalg import block_diag, eigh, eigvals

from rubgen.arrays import FloatArray, IntArray
from rubgen.errors import UserError
from rubgen.fem.beam import blade_matrices, static_root_strain
from rubgen.fem.constraints import support_stiffness
from rubgen.linalg.threads import one_blas_thread
from rubgen.machine import Damping, Machine, Unbalance
from rubgen.machine.faults.fault import LostMass
from rubgen.reduction.blisk import ReducedBlisk
from rubgen.reduction.cache import cached_blisk
from rubgen.reduction.casing import ReducedCasing, reduce_casing
from rubgen.reduction.fault_loads import growing_loads, spring_load, steady_loads
from rubgen.reduction.lost_mass import missing_pull, without_masses
from rubgen.reduction.model import Recovery, SpinningSystem, TurningForces
from rubgen.scenario import Reduction
from rubgen.scenario.checks.reducible import reduction_problem
from rubgen.units import rev_per_min

LOST_TIP_SHARE = 0.05
"""How far inside of the others, in tip radii, the place of a lost blade's tip is kept, so that it never touches."""
# e_z x on the translations and rotations of O_d.
S6 = np.kron(np.eye(2), np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))


@dataclass(frozen=True, kw_only=True)
class ReducedModel:
    """A machine reduced to n DoFs: the blisk in its turning frame, then the casing's modes.

    `springs` (N/m, N m/rad) and `dampers` (N s/m, N m s/rad), both (6,), act on O_d in the inertial frame. `beta` (s)
    is the factor of the blisk's elastic damping beta K_e. `machine` is the machine as its faults have altered it.
    `reduction` has the numbers of modes.
    """

    machine: Machine
    reduction: Reduction
    blisk: ReducedBlisk
    casing: ReducedCasing
    springs: FloatArray
    dampers: FloatArray
    beta: float

    @property
    def full_dof(self) -> int:
        """DoFs of the full finite-element model, blisk and casing."""
        return self.blisk.full_size + 3 * self.machine.casing.nodes

    @property
    def reduced_dof(self) -> int:
        """DoFs of the reduced model, blisk and casing."""
        return len(self.blisk.M) + len(self.casing.frequencies_hz)

    def stiffness(self, speed: float) -> FloatArray:
        """Return the undamped symmetric stiffness K_e + K_s + Omega^2 (K_sigma - S) of the blisk at `speed` (rad/s)."""
        T = self.blisk.centre
        K: FloatArray = self.blisk.K + T.T @ (self.springs[:, None] * T) + speed**2 * self.blisk.A
        return K

    def at_speed(self, speed: float, acceleration: float = 0.0) -> SpinningSystem:
        """Return the system at `speed` (rad/s, positive) and `acceleration` (rad/s2): matrices of the turning frame.

        Blisk: C = 2 Omega G + C_s + beta K_e, K = K_e + K_s + Omega^2 (K_sigma - S) + Omega H_s, with C_s = T^T D T and
        H_s = T^T D S6 T. T (6, n) gives the motion of O_d. The dampers D = diag(c) are in the inertial frame and act on
        the absolute velocity (S6 is e_z x). The term Omega H_s makes K unsymmetric. Casing modes: 1, 2 zeta omega,
        omega^2. Each unbalance acts with Omega^2 U outward, on O_d or on a tip. Mistuned blades grow unequally under
        the centrifugal load: the unbalance of this growth acts on O_d. Uneven supports, laws of the support, gravity
        and loads of faults that turn or grow are in the field `turning` of the result, all other loads in `force`.

        A changing speed adds Omega' G to K and -Omega' (f_t + e_z x U) to the forces (Euler force). f_t = int rho N^T
        (e_z x r) is the tangential load of the undeformed blisk. The inertia of the tips' steady growth while the speed
        changes is left out: at most the share Omega' / Omega^2 of the growth.
        """
        with one_blas_thread():
            return self._assemble(speed, acceleration)

    def _assemble(self, speed: float, acceleration: float) -> SpinningSystem:
        blisk, machine, T = self.blisk, self.machine, self.blisk.centre
        damped = self.dampers[:, None] * T
        C = 2 * speed * blisk.G + T.T @ damped + self.beta * blisk.K
        K = self.stiffness(speed) + speed * (damped.T @ (S6 @ T))
        omega = 2 * np.pi * self.casing.frequencies_hz
        count = machine.blades.count
        force = np.zeros(self.reduced_dof)
        force[3 * count : 3 * count + 2] = speed**2 * blisk.growth.unbalance(speed)
        self._add_unbalances(force, speed**2)
        if acceleration:
            K += acceleration * blisk.G
            force -= acceleration * self._euler_load(force / speed**2)
        if machine.faults:
            growth, lost = blisk.growth.at(speed), lost_masses(machine)
            force += speed**2 * missing_pull(lost, machine.tip_radius_m, growth, self.reduced_dof)
            force[3 * count : 3 * count + 2] += speed**2 * blisk.growth.missing + steady_loads(machine, speed)[0].real
        return SpinningSystem(
            speed=speed,
            M=block_diag(blisk.M, np.eye(len(omega))),
            C=block_diag(C, np.diag(2 * machine.damping.casing * omega)),
            K=block_diag(K, np.diag(omega**2)),
            force=force,
            n_blades=count,
            n_casing=len(omega),
            tip_radius=machine.tip_radius_m,
            blade_angles=2 * np.pi * np.arange(count) / count,
            tip_static=self._tip_static(speed),
            surface=self.casing.surface,
            casing_modes=self.casing.modes_xy,
            casing_rotations=self.casing.rotations,
            half_thickness=machine.casing.thickness_m / 2,
            lateral_stiffness=float(self.springs[0]),
            lateral_damping=float(self.dampers[0]),
            recovery=self._recovery(speed),
            turning=self._turning_forces(speed),
            narrowings=tuple(each for fault in machine.faults for each in fault.narrowings(machine)),
            spring_load=spring_load(machine, speed) if machine.faults else None,
        )

    def _tip_static(self, speed: float) -> FloatArray:
        """Return the steady growth of the tips (blades, 3) in m; the place of a lost blade's tip is kept inside."""
        growth = self.blisk.growth.at(speed)
        growth[list(self.machine.lost_blades), 0] = -LOST_TIP_SHARE * self.machine.tip_radius_m
        return growth

    @property
    def _shifts(self) -> FloatArray:
        """The coordinates (blisk DoFs, 2) of the blisk moved by 1 m along x and along y; 0 where no blade is."""
        shifts = rigid_shifts(self.machine.blades.count, len(self.blisk.M))
        moved = np.zeros_like(shifts)
        moved[self.own_dofs] = shifts[self.own_dofs]
        return moved

    @property
    def own_dofs(self) -> IntArray:
        """Indices of the blisk's coordinates, without the tips of lost blades."""
        lost = 3 * np.array(self.machine.lost_blades, dtype=np.int64)[:, None] + np.arange(3)
        return np.setdiff1d(np.arange(len(self.blisk.M)), lost)

    def root_strain(self, blade: int, speed: float) -> FloatArray:
        """Return the row (blisk DoFs,) that multiplies the blisk's DoFs to the spanwise strain at a blade's root.

        The strain is on one face of the blade, as in `fem.beam.root_strain_row`. Tip and root come from the reduced
        basis. The blade between them has its static shape at `speed` in rad/s (`static_root_strain`). The basis at rest
        alone underestimates the strain by 37 % at 8,500 rev/min in the preset. Bending by inertia between tip and root
        is left out. The steady strain of the centrifugal load is no part of it.
        """
        blades, rim = self.machine.blades, self.machine.disk.rim_radius_m
        stiffness = 1 + blades.stiffness_deviations[blade]
        tip, root = static_root_strain(blades, rim, blade_matrices(blades, rim), speed=speed, stiffness=stiffness)
        row: FloatArray = root @ self.blisk.roots[blade]
        row[3 * blade : 3 * blade + 3] += tip
        return row

    def _recovery(self, speed: float) -> Recovery:
        machine = self.machine
        return Recovery(
            root_strain=partial(self.root_strain, speed=speed),
            torsion=self.blisk.centre[5],
            torsion_stiffness=float(self.springs[5]),
            torsion_damping=float(self.dampers[5]),
            casing_radius=machine.casing_mean_radius_m,
            casing_thickness=machine.casing.thickness_m,
            chord_slope=float(1 / np.tan(np.deg2rad(machine.blades.tip_angle_deg))),
            blisk_mass=self.blisk_mass,
        )

    @property
    def blisk_mass(self) -> float:
        """Mass of disk and blades in kg, t^T M t of the rigid motion t along x."""
        shift = self._shifts[:, 0]
        return float(shift @ self.blisk.M @ shift)

    def _turning_forces(self, speed: float) -> TurningForces | None:
        """Return the forces of supports, gravity and faults that turn against the blisk or are not linear; or None.

        A steady load of a fault that is constant in the turning frame is in the system's `force`.
        """
        support, g = self.machine.disk_support, self.machine.gravity_m_per_s2
        loads, growing = steady_loads(self.machine, speed), growing_loads(self.machine, speed)
        loads[0] = 0.0
        laws = support.laws + tuple(
            law for fault in self.machine.faults for law in fault.support_laws(self.machine, speed)
        )
        stiffness = float(self.springs[0]) * support.lateral_stiffness_anisotropy
        damping = float(self.dampers[0]) * support.lateral_damping_anisotropy
        if not (stiffness or damping or laws or g or loads.any() or growing):
            return None
        weight = np.zeros((self.reduced_dof, 2))
        weight[: len(self.blisk.M)] = g * self.blisk.M @ self._shifts
        return TurningForces(
            stiffness=stiffness,
            damping=damping,
            laws=laws,
            weight=weight if g else None,
            loads=loads if loads.any() else None,
            growing=growing,
        )

    def _add_unbalances(self, force: FloatArray, scale: float) -> None:
        """Add each unbalance times `scale` along its own direction, on O_d or on a tip."""
        machine, centre = self.machine, 3 * self.machine.blades.count
        main = Unbalance(kg_m=machine.unbalance_kg_m, angle_deg=machine.unbalance_angle_deg)
        for each in (main, *machine.unbalances):
            if each.blade is not None:
                force[3 * each.blade] += scale * each.kg_m
            else:
                angle = np.deg2rad(each.angle_deg or 0.0)
                force[centre] += scale * each.kg_m * np.cos(angle)
                force[centre + 1] += scale * each.kg_m * np.sin(angle)

    def _euler_load(self, unbalance: FloatArray) -> FloatArray:
        """f_t + e_z x U (n,): what Omega' loads, with U (n,) in kg m as the forces on tips and O_d at 1 rad/s."""
        load = np.zeros(self.reduced_dof)
        load[: len(self.blisk.M)] = self.blisk.euler
        centre = 3 * self.machine.blades.count
        for first in (*range(0, centre, 3), centre):
            load[first] -= unbalance[first + 1]
            load[first + 1] += unbalance[first]
        return load

    def blisk_frequencies_hz(self, speed: float = 0.0) -> FloatArray:
        """Compute the undamped natural frequencies (blisk DoFs,) in Hz of the turning frame, ascending.

        `speed` is in rad/s. Lost blades have no frequencies. An inertial-frame whirl at omega appears at omega - Omega
        (forward) or omega + Omega (backward), without sign. Above a critical speed the stiffness is indefinite, so the
        quadratic problem is solved directly.
        """
        own = self.own_dofs
        M, G, K = (X[np.ix_(own, own)] for X in (self.blisk.M, self.blisk.G, self.stiffness(speed)))
        with one_blas_thread():
            if speed == 0:
                squares: FloatArray = eigh(K, M, eigvals_only=True)
                return np.sqrt(squares) / (2 * np.pi)
            values = eigvals(*linearised(M, 2 * speed * G, K))
        frequencies: FloatArray = np.sort(np.abs(values.imag))[::2] / (2 * np.pi)
        return frequencies

    def modes_at_rest(self) -> tuple[FloatArray, FloatArray]:
        """Compute the blisk's undamped modes at rest: omega^2 (modes,) ascending, and shapes (blisk DoFs, modes).

        The modal masses are 1 kg. A lost blade adds no modes, and the shapes are zero at its tip.
        """
        own = self.own_dofs
        part = np.ix_(own, own)
        with one_blas_thread():
            squares, vectors = eigh(self.stiffness(0.0)[part], self.blisk.M[part])
        shapes = np.zeros((len(self.blisk.M), squares.size))
        shapes[own] = vectors
        return squares, shapes

    @property
    def casing_frequencies_hz(self) -> FloatArray:
        """Natural frequencies of the casing's modes in Hz, ascending."""
        return self.casing.frequencies_hz

    @property
    def critical_speed_rpm(self) -> float:
        """Speed in rev/min at which undamped forward lateral whirl is synchronous with the rotation.

        At this speed K_e + K_s + Omega^2 (K_sigma - S) is singular: an unbalance, static in the turning frame, acts
        against no stiffness. If there are several such speeds, it is the speed with the largest share of energy in the
        lateral springs. Uneven springs count with their mean, and laws of the support are left out.
        """
        with one_blas_thread():
            inverse_squares, modes = eigh(-self.blisk.A, self.stiffness(0.0))
        centre = 3 * self.machine.blades.count
        share = self.springs[0] * (modes[centre] ** 2 + modes[centre + 1] ** 2)
        lateral = np.argmax(np.where(inverse_squares > 0, share, 0.0))
        return rev_per_min(float(1 / np.sqrt(inverse_squares[lateral])))


def rigid_shifts(blades: int, size: int) -> FloatArray:
    """Return the coordinates (size, 2) of the reduced blisk moved as a rigid body by 1 m along x and along y.

    Exact: constraint modes represent every rigid motion that does not strain the springs of the basis. Lateral motions
    strain no such spring, so the modes are zero.
    """
    angle = 2 * np.pi * np.arange(blades) / blades
    shifts = np.zeros((size, 2))
    shifts[: 3 * blades : 3] = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    shifts[1 : 3 * blades : 3] = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    shifts[3 * blades : 3 * blades + 2] = np.eye(2)
    return shifts


def reduce(machine: Machine, reduction: Reduction) -> ReducedModel:
    """Reduce a machine with its faults: two-step Craig-Bampton for the blisk, modes for the casing.

    `reduction` has the numbers of modes. The blisk comes from the cache where possible. The result has the same bits
    with and without the cache, and with any number of BLAS threads. Raises UserError for meshes, mode numbers or lobes
    that do not fit, for a reduction that needs too much memory, and for matrices that cannot be factorised.
    """
    for fault in machine.faults:
        machine = fault.altered(machine)
    problem = reduction_problem(machine, reduction)
    if problem:
        raise UserError(problem)
    try:
        with one_blas_thread():
            parts = machine.disk, machine.blades, machine.disk_support
            blisk = cached_blisk(*parts, reduction, machine.lost_blades)
            blisk = without_masses(blisk, lost_masses(machine), machine.tip_radius_m)
            casing = reduce_casing(machine, reduction.casing_modes)
    except (np.linalg.LinAlgError, RuntimeError) as error:  # of LAPACK, ARPACK and SuperLU
        raise UserError(
            f"machine {machine.name}: its stiffness or mass cannot be factorised ({_first_line(error)}); correct its "
            f"sizes, stiffnesses or materials, which are {_materials(machine)}"
        ) from error
    springs = support_stiffness(machine.disk_support)
    return ReducedModel(
        machine=machine,
        reduction=reduction,
        blisk=blisk,
        casing=casing,
        springs=springs,
        dampers=support_damping(machine.damping, springs, blisk.rigid_inertia),
        beta=elastic_damping(machine.damping, blisk.blade_frequency),
    )


def lost_masses(machine: Machine) -> list[LostMass]:
    """Return the masses that the faults of a machine have taken from tips."""
    return [each for fault in machine.faults for each in fault.lost_masses(machine)]


def _first_line(error: Exception) -> str:
    return str(error).split("\n")[0].rstrip(".")


def _materials(machine: Machine) -> str:
    """Return modulus and density of each part, as in its keys."""
    parts = {"disk": machine.disk.material, "blades": machine.blades.material, "casing": machine.casing.material}
    return ", ".join(
        f"{part} {each.youngs_modulus_pa:g} Pa and {each.density_kg_per_m3:g} kg/m3" for part, each in parts.items()
    )


def support_damping(damping: Damping, stiffness: FloatArray, inertia: FloatArray) -> FloatArray:
    """Return the constants (6,) of the dampers beside the springs of O_d, in N s/m and N m s/rad: c = 2 zeta sqrt(k m).

    - damping: the ratios zeta: lateral for x and y, axial, tilt for two axes, torsion.
    - stiffness (6,): k of the springs.
    - inertia (6,): m, m, m, I_d, I_d, I_p.

    So zeta is the ratio of the blisk moving as a rigid body on one spring. The elastic mode with this motion has nearly
    the same ratio if it is not near a mode of the blades. Its modal mass is not used for c: near a veering with a blade
    mode the modal mass doubles, and c would double too, within the range of stiffness that data sets vary.
    """
    ratio = np.array([damping.lateral, damping.lateral, damping.axial, damping.tilt, damping.tilt, damping.torsion])
    constants: FloatArray = 2 * ratio * np.sqrt(stiffness * inertia)
    return constants


def elastic_damping(damping: Damping, blade_frequency: float) -> float:
    """Return beta of the internal damping beta K_e, in s, for the damping ratio `damping.blade`.

    `blade_frequency` is the first frequency of a clamped blade, rad/s.
    """
    return 2 * damping.blade / blade_frequency


def linearised(M: FloatArray, C: FloatArray, K: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return A and B (2 n, 2 n): the eigenvalues of A z = s B z are the roots s of (M s^2 + C s + K) q = 0.

    z = (q, s q / c) with c^2 = |K| / |M|. Without c the blocks of A differ by ten orders of magnitude, and rounding
    changed a frequency of a mistuned blisk by 1.5e-8 of its value.
    """
    size, c = len(M), np.sqrt(np.linalg.norm(K) / np.linalg.norm(M))
    return np.block([[np.zeros((size, size)), c * np.eye(size)], [-K / c, -C]]), block_diag(np.eye(size), M)
