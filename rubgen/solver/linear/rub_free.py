"""Compute the rub-free motion: static in the turning frame, or periodic with uneven supports or gravity.

O_d is the disk centre. E selects its x and y among the coordinates, u and v are its displacement and velocity.
"""

import math
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from rubgen.arrays import ComplexArray, FloatArray, IntArray
from rubgen.contact.clearance_kernels import least_clearance
from rubgen.contact.geometry_kernels import Surface, Tips
from rubgen.reduction.model import SpinningSystem, TurningForces
from rubgen.solver.supports.turning_forces import fault_force, force_derivatives, gravity_force, turning_force

SAMPLES = (9, 17, 33, 65, 129)
"""Numbers of places of a turn for the harmonic balance. The next one is used until the last harmonics are small."""
TAIL = 1e-12
"""The last two harmonics are small below this share of the motion of O_d."""
NEWTON_STEPS = 60
NEWTON_TOLERANCE = 1e-13
LAW_RANGE = 0.999
"""Newton's steps are shortened so that the eccentricity stays below this share of the limit of a law."""
TURN_PLACES = 64
CLEARANCE_PLACES = 1440
"""Places of a turn at which the clearance is evaluated: every quarter of a degree. The error is at most |r''| (pi /
1440)^2 / 2, 40 nm in an oval of 8 mm, 1 um with chords."""

CLEARANCE_MARGIN = 1e-5
"""Least clearance of a run that never touches, m, in addition to the error of these places. The error is 1 um with
chords; the motion itself is exact except for rounding."""


@dataclass(frozen=True, kw_only=True)
class RubFreeMotion:
    """A motion without rub, q(theta) = Re sum_m harmonics[m] e^(i m theta), with the casing at rest."""

    harmonics: ComplexArray
    """Complex amplitudes (H + 1, n)."""
    residual: float
    """Largest unbalanced force on O_d between the places of the balance, over the largest force there.

    It is the truncation error, or large where the iteration found no motion."""

    def at(self, theta: float) -> FloatArray:
        """Return the state q (n,) at the angle of rotation `theta`, rad."""
        q: FloatArray = self.harmonics[0].real.copy()
        for m in range(1, len(self.harmonics)):
            q += (self.harmonics[m] * np.exp(1j * m * theta)).real
        return q

    def over_turn(self) -> FloatArray:
        """Return states q (places, n) at 64 equal steps of one turn; one state where the motion is static."""
        places = 1 if len(self.harmonics) == 1 else TURN_PLACES
        return np.stack([self.at(2 * np.pi * i / places) for i in range(places)])


def free_penetration(motion: RubFreeMotion, surface: Surface, tips: Tips) -> float:
    """Return how deep the tips would enter the casing at rest in this motion, m; negative is a clearance.

    It is the maximum over blades and angles of rotation, every quarter of a degree, of |P_k| - r(angle of P_k). P_k is
    the tip of blade k, r the radius of the undeformed, unworn `surface`.
    """
    theta = 2 * np.pi * np.arange(CLEARANCE_PLACES) / CLEARANCE_PLACES
    turn = np.exp(1j * np.multiply.outer(theta, np.arange(len(motion.harmonics))))
    states = np.ascontiguousarray((turn @ motion.harmonics).real)
    return -float(least_clearance(surface, tips, states, theta))


def never_touches(system: SpinningSystem, surface: Surface, penetration: float) -> bool:
    """Return whether a run at steady speed that starts in its rub-free motion provably never touches.

    It is False if a law of the support is not linear, so that other motions are possible, if the surface has a liner,
    if a fault grows, however late, or if the tips' distance is below 10 um plus the error of `free_penetration`.
    Uneven supports, gravity, mistuned blades, steady loads and a breathing crack are linear.

    - system, surface: of the run.
    - penetration: `free_penetration` of the motion, m; negative where the tips keep a distance of this size.
    """
    forces = system.turning
    if forces is not None and not all(law.LINEAR for law in forces.laws):
        return False
    if system.ramps or surface.liner.bins:
        return False
    bend = float(np.sum(np.abs(system.surface.amplitude) * np.square(system.surface.order)))
    return penetration < -(CLEARANCE_MARGIN + bend * (np.pi / CLEARANCE_PLACES) ** 2 / 2)


def steady_state(system: SpinningSystem) -> FloatArray:
    """Return the exact static motion q (n,) without rub and turning forces: K q = force, with the casing at rest."""
    q = np.zeros(system.M.shape[0])
    start = system.casing_start
    q[:start] = la.solve(system.K[:start, :start], system.force[:start])
    return q


def rub_free_motion(system: SpinningSystem, steps: float = 0) -> RubFreeMotion:
    """Compute the periodic motion without rub, by harmonic balance.

    E selects x and y of the disk centre O_d, u and v are its displacement and velocity in the turning frame. `steps` is
    the number of steps in a turn: the result is then the motion of the time-stepping scheme. With 0 it is the motion of
    the differential equation M q'' + C q' + K q = force + weight(theta) + E (p(theta) + f(theta, u, v)), with p the
    steady loads of faults and f the `turning_force`. Loads that grow are left out. Each harmonic of f on O_d moves the
    blisk by the receptance of that harmonic. This leaves a small system for u alone, solved at equal angles of a turn
    by Newton's method (one step where it is linear). For the scheme's motion 2 (cos m phi - 1) / dt^2 replaces -(m
    Omega)^2 and i sin(m phi) / dt replaces i m Omega, phi = 2 pi / steps: a run that starts from it keeps it.

    With laws of the support there may be more than one motion. The iteration starts from the motion without f,
    shortened to within the range of the laws. If it finds no motion, nothing is raised: `residual` is large. Laws with
    a motion that must settle are left out (`SpinningSystem.starting`): the result is then the motion at the start of a
    run.
    """
    system = system.starting
    forces = system.turning
    if forces is None:
        return RubFreeMotion(harmonics=steady_state(system)[None].astype(np.complex128), residual=0.0)
    periodic = forces.uneven or forces.is_periodic
    for samples in SAMPLES if periodic else (1,):
        balance = _Balance(system, forces, samples, steps)
        u = balance.solve()
        size = np.abs(np.fft.rfft(u, axis=0))
        if samples == 1 or size[-2:].max() <= TAIL * size.max():
            break
    return balance.motion(u)


class _Balance:
    """The equations of u at `samples` places of a turn. The number is odd, so that no harmonic is cut in half."""

    def __init__(self, system: SpinningSystem, forces: TurningForces, samples: int, steps: float) -> None:
        self.system, self.forces, self.samples = system, forces, samples
        self.theta = 2 * np.pi * np.arange(samples) / samples
        orders = np.arange(samples // 2 + 1)
        omega, phi = system.speed, 2 * np.pi / steps if steps else 0.0
        self.second = -((orders * omega) ** 2) if not steps else 2 * (np.cos(orders * phi) - 1) * (omega / phi) ** 2
        self.first = 1j * orders * omega if not steps else 1j * np.sin(orders * phi) * omega / phi
        start, centre = system.casing_start, slice(system.centre, system.centre + 2)
        M, C, K = (matrix[:start, :start] for matrix in (system.M, system.C, system.K))
        unit = np.eye(start)[:, centre]
        moved = [
            la.solve(a * M + b * C + K, np.column_stack([unit, load]))
            for a, b, load in zip(self.second, self.first, self._loads(orders)[:, :start], strict=True)
        ]
        self.columns = np.array([each[:, :2] for each in moved])
        self.alone = np.array([each[:, 2] for each in moved])
        self.receptance = self.columns[:, centre]
        self.u_alone = self._at_places(self.alone[:, centre])
        self.L = self._circulant(self.receptance)
        self.D = self._circulant(np.multiply.outer(self.first, np.eye(2)).astype(np.complex128))

    def _loads(self, orders: IntArray) -> ComplexArray:
        loads = np.zeros((len(orders), len(self.system.M)), dtype=np.complex128)
        loads[0] = self.system.force
        if self.forces.weight is not None:
            loads[1] = -self.forces.weight @ np.array([-1j, 1.0])
        if self.forces.loads is not None:  # `samples` doubles until these orders are far below the last
            count = min(len(self.forces.loads), len(loads))
            loads[:count, self.system.centre : self.system.centre + 2] += self.forces.loads[:count]
        return loads

    def _at_places(self, harmonics: ComplexArray) -> FloatArray:
        """Return the values (samples, 2) of harmonics (H + 1, 2)."""
        return np.asarray((np.exp(1j * np.multiply.outer(self.theta, np.arange(len(harmonics)))) @ harmonics).real)

    def _circulant(self, factor: ComplexArray) -> FloatArray:
        """Return the matrix (2 samples, 2 samples) that multiplies each harmonic of values (samples, 2) by factor."""
        orders, N = np.arange(len(factor)), self.samples
        weight = np.where(orders > 0, 2.0, 1.0) / N
        turn = np.exp(1j * np.multiply.outer(self.theta[:, None] - self.theta, orders)) * weight
        return np.asarray(np.einsum("jkm,mab->jakb", turn, factor).real.reshape(2 * N, 2 * N))

    def solve(self) -> FloatArray:
        """Solve for the places u (samples, 2) by Newton's method with shortened steps."""
        u = self._shortened(np.zeros_like(self.u_alone), self.u_alone)
        residual = self._residual(u)
        for _ in range(NEWTON_STEPS):
            step = -la.solve(self._jacobian(u), residual.ravel()).reshape(u.shape)
            u, residual, moved = self._search(u, residual, step)
            if moved <= NEWTON_TOLERANCE * np.abs(u).max():
                break
        return u

    def _search(self, u: FloatArray, residual: FloatArray, step: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Return the longest of halved steps that makes the residual smaller; the last one where none does."""
        goal = self._shortened(u, step)
        for _ in range(30):
            new = self._residual(goal)
            if np.abs(new).max() <= np.abs(residual).max():
                break
            goal = (u + goal) / 2
        return goal, new, float(np.abs(goal - u).max())

    def _shortened(self, u: FloatArray, step: FloatArray) -> FloatArray:
        """Return u + step, or as much of the step as the laws allow."""
        limit = min((law.limit_m for law in self.forces.laws), default=math.inf)
        while np.hypot(*(u + step).T).max() >= LAW_RANGE * limit:
            step = step / 2
        return u + step

    def _residual(self, u: FloatArray) -> FloatArray:
        v = (self.D @ u.ravel()).reshape(u.shape)
        f = turning_force(self.forces, self.system.speed, self.theta, u, v)
        return np.asarray(u - self.u_alone - (self.L @ f.ravel()).reshape(u.shape))

    def _jacobian(self, u: FloatArray) -> FloatArray:
        v = (self.D @ u.ravel()).reshape(u.shape)
        by_u, by_v = force_derivatives(self.forces, self.system.speed, self.theta, u, v)
        return np.asarray(
            np.eye(u.size) - self.L @ (la.block_diag(*by_u) + la.block_diag(*by_v) @ self.D), dtype=np.float64
        )

    def motion(self, u: FloatArray) -> RubFreeMotion:
        """Return all coordinates, from the forces on O_d at the displacements u."""
        v = (self.D @ u.ravel()).reshape(u.shape)
        F = _harmonics(turning_force(self.forces, self.system.speed, self.theta, u, v))
        q = np.zeros((len(F), len(self.system.M)), dtype=np.complex128)
        q[:, : self.system.casing_start] = self.alone + np.einsum("mna,ma->mn", self.columns, F)
        if self.samples == 1:
            q = q.real.astype(np.complex128)
        return RubFreeMotion(harmonics=q, residual=self._unbalanced(q))

    def _unbalanced(self, q: ComplexArray) -> float:
        """Return the largest share of force on O_d that is missing midway between the places."""
        system, theta = self.system, self.theta + np.pi / self.samples
        centre, orders = slice(system.centre, system.centre + 2), np.arange(len(q))
        M, C, K = system.M[centre], system.C[centre], system.K[centre]
        turn = np.exp(1j * np.multiply.outer(theta, orders))
        inner = (turn @ (self.second[:, None] * q @ M.T + self.first[:, None] * q @ C.T + q @ K.T)).real
        u, v = (turn @ q[:, centre]).real, (turn @ (self.first[:, None] * q[:, centre])).real
        f = turning_force(self.forces, system.speed, theta, u, v)
        load = np.stack([np.broadcast_to(gravity_force(self.forces, t), len(system.M))[centre] for t in theta])
        load += np.array([np.broadcast_to(fault_force(self.forces, t), 2) for t in theta])
        load = load + system.force[centre] + f
        scale = max(float(np.abs(inner).max()), float(np.abs(load).max()), float(np.abs(f).max()))
        return float(np.abs(inner - load).max()) / scale if scale > 0 else 0.0


def _harmonics(values: FloatArray) -> ComplexArray:
    """Return factors of e^(i m theta), m >= 0, whose sum has the values (samples, any) as its real part."""
    factors = np.fft.rfft(values, axis=0) / len(values)
    factors[1:] *= 2
    return np.asarray(factors)
