"""The same step in plain numpy: the kernels' oracle, and the measure of their speed.

Written apart from the kernels: dense matrices over all coordinates at once, all near blades in whole-array operations,
piecewise cubics in power form, nodal slopes by a differentiation matrix, contact forces by an active set of exact
solves, turning forces in matrices that are made and inverted anew in every step.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg as la

from rubgen.arrays import BoolArray, FloatArray, IntArray
from rubgen.reduction.model import SpinningSystem
from rubgen.solver.supports.turning_forces import fault_force, force_derivatives, gravity_force, turning_force

NEWTON_STEPS = 12
NEWTON_TOLERANCE = 1e-10


def differentiation_matrix(nodes: int) -> FloatArray:
    """Derivative by angle at an even number of equal steps: D_jk = (-1)^(j-k) cot((j-k) h / 2) / 2 (Trefethen 2000)."""
    j = np.arange(1, nodes)
    column = np.concatenate([[0.0], 0.5 * (-1.0) ** j / np.tan(j * np.pi / nodes)])
    return np.asarray(la.circulant(column))


class ReferenceStepper:
    """State and step of one system with friction; `before`, `now` (n,) are q at steps n - 1 and n.

    `gaps` (2, n_blades) are those that steps n - 1 and n left, NaN where the geometry is to be asked: restitution
    compares with them.
    """

    def __init__(
        self,
        system: SpinningSystem,
        friction: float,
        steps: int,
        *,
        restitution: float = 0.0,
        start_angle: float = 0.0,
    ) -> None:
        self.system, self.friction, self.steps, self.start_angle = system, friction, steps, start_angle
        self.restitution = restitution
        self.dt = dt = 2 * np.pi / system.speed / steps
        self.inverse = la.inv(system.M / dt**2 + system.C / (2 * dt))
        self.from_now = self.inverse @ (2 * system.M / dt**2 - system.K)
        self.from_before = self.inverse @ (system.C / (2 * dt) - system.M / dt**2)
        self.constant = self.inverse @ system.force
        self.cubics = self._cubics()
        self.set_state(*np.zeros((2, system.M.shape[0])))

    def set_state(self, before: FloatArray, now: FloatArray) -> None:
        """Set q at steps n - 1 and n and forget the gaps there."""
        self.before, self.now = before, now
        self.gaps = np.full((2, self.system.n_blades), np.nan)

    def _cubics(self) -> FloatArray:
        """Coefficients (4, nodes, 2, n_casing) of u in powers of the angle from each node."""
        value = self.system.casing_modes
        nodes = value.shape[0]
        h = 2 * np.pi / nodes
        slope = np.einsum("ij,jcm->icm", differentiation_matrix(nodes), value)
        rise, next_slope = (np.roll(value, -1, axis=0) - value) / h, np.roll(slope, -1, axis=0)
        square = (3 * rise - 2 * slope - next_slope) / h
        cube = (slope + next_slope - 2 * rise) / h**2
        return np.stack([value, slope, square, cube])

    def step(self, index: int, opening: float = 0.0) -> int:
        """One step from theta_index, the surface opened by `opening` after it; how many blades touched."""
        free, inverse = self._free(self.start_angle + 2 * np.pi * index / self.steps)
        theta = self.start_angle + 2 * np.pi * (index + 1) / self.steps
        gaps = np.full(self.system.n_blades, np.nan)
        touching, response = self._contacts(free, inverse, theta, opening, gaps)
        self.before, self.now = self.now, free if response is None else free + response
        self.gaps = np.stack([self.gaps[1], gaps])
        return touching

    def _free(self, theta: float) -> tuple[FloatArray, FloatArray]:
        """The step without contact from `theta`, and the inverse of all that stands before q_n+1."""
        free = self.from_now @ self.now + self.from_before @ self.before + self.constant
        system, forces, dt = self.system, self.system.turning, self.dt
        if forces is None:
            return free, self.inverse
        u = self.now[system.centre : system.centre + 2]
        E = np.eye(len(free))[:, system.centre : system.centre + 2]
        drag = -force_derivatives(forces, system.speed, np.array(theta), u, np.zeros(2))[1]
        at_rest = turning_force(forces, system.speed, np.array(theta), u, np.zeros(2))
        inverse = la.inv(system.M / dt**2 + system.C / (2 * dt) + E @ drag @ E.T / (2 * dt))
        at_rest = at_rest + fault_force(forces, theta)
        load = E @ (at_rest + drag @ E.T @ self.before / (2 * dt)) + gravity_force(forces, theta)
        return inverse @ (la.solve(self.inverse, free) + load), inverse

    def _contacts(
        self, free: FloatArray, inverse: FloatArray, theta: float, opening: float, gaps_out: FloatArray
    ) -> tuple[int, FloatArray | None]:
        """Number of touching blades and A^-1 B lam, None without contact; and the gaps that the step leaves."""
        blades, angle, place, psi, gap, t = self._pairs(free, theta, opening)
        gaps_out[blades] = gap
        law = gap + self.restitution * self._gaps_before(blades, theta, opening) if self.restitution else gap
        if not np.any(law < 0):
            return 0, None
        er = np.array([np.cos(angle), np.sin(angle)])
        et = np.array([-er[1], er[0]])
        n = np.array([-t[1], t[0]])
        shapes = self._shapes(psi)
        f = self._friction(free, blades, place, er, et, t, shapes)
        normal = self._columns(n, np.zeros(len(gap)), blades, er, et, shapes)
        full = self._columns(n + self.friction * f[0] * t, self.friction * f[1], blades, er, et, shapes)
        response = inverse @ full
        lam = active_set(normal.T @ response, law)
        gaps_out[blades] += normal.T @ response @ lam
        return int(np.sum(lam > 0)), response @ lam

    def _pairs(
        self, q: FloatArray, theta: float, opening: float, blades: IntArray | None = None
    ) -> tuple[IntArray, FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """These blades, or those near the surface: number, polar angle, place along their axes, foot, gap, tangent."""
        system = self.system
        place = q[: 3 * system.n_blades].reshape(-1, 3) + system.tip_static
        place[:, 0] += system.tip_radius
        cubics = self.cubics @ q[system.casing_start :]
        blades = self._near(place, cubics, theta, opening) if blades is None else blades
        place, angle = place[blades], theta + system.blade_angles[blades]
        if len(blades) == 0:
            return blades, angle, place, np.zeros(0), np.zeros(0), np.zeros((2, 0))
        er = np.array([np.cos(angle), np.sin(angle)])
        et = np.array([-er[1], er[0]])
        return blades, angle, place, *self._feet(cubics, place[:, 0] * er + place[:, 1] * et, opening)

    def _gaps_before(self, blades: IntArray, theta: float, opening: float) -> FloatArray:
        """Gaps that step n - 1 left, or its geometry has."""
        *_, gap, _ = self._pairs(self.before, theta - 4 * np.pi / self.steps, opening, blades)
        left = self.gaps[0, blades]
        return np.asarray(np.where(np.isnan(left), gap, left))

    def _near(self, place: FloatArray, cubics: FloatArray, theta: float, opening: float) -> IntArray:
        """Blades within 1.2 times the casing's largest nodal displacement, and 0.3 mm, of the undeformed surface."""
        curve = self.system.surface
        angle = theta + self.system.blade_angles + place[:, 1] / place[:, 0]
        radius = curve.mean_radius + opening + np.cos(curve.order * (angle[:, None] - curve.phase)) @ curve.amplitude
        clearance = radius - np.hypot(place[:, 0], place[:, 1])
        return np.flatnonzero(clearance < 1.2 * np.sqrt(np.max(np.sum(cubics[0] ** 2, axis=1))) + 3e-4)

    def _feet(self, cubics: FloatArray, p: FloatArray, opening: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Foot parameter, gap and tangent (2, points) of points p (2, points), by Newton's method."""
        curve = self.system.surface
        h = 2 * np.pi / cubics.shape[1]
        psi = np.arctan2(p[1], p[0])
        for _ in range(NEWTON_STEPS):
            node = np.floor(psi / h)
            s = psi - node * h
            a, b, c, d = cubics[:, node.astype(int) % cubics.shape[1]].transpose(0, 2, 1)
            phase = curve.order * (psi[:, None] - curve.phase)
            cosine, sine = np.cos(phase), np.sin(phase)
            r = curve.mean_radius + opening + cosine @ curve.amplitude
            dr, ddr = -sine @ (curve.amplitude * curve.order), -cosine @ (curve.amplitude * curve.order**2)
            er = np.array([np.cos(psi), np.sin(psi)])
            et = np.array([-er[1], er[0]])
            away = p - r * er - (a + s * (b + s * (c + s * d)))
            along = dr * er + r * et + (b + s * (2 * c + 3 * s * d))
            bend = (ddr - r) * er + 2 * dr * et + (2 * c + 6 * s * d)
            change = np.sum(away * along, axis=0) / np.sum(along * along - away * bend, axis=0)
            if np.abs(change).max() < NEWTON_TOLERANCE:
                break
            psi = psi + change
        t = along / np.hypot(along[0], along[1])
        return psi, t[0] * away[1] - t[1] * away[0], t

    def _shapes(self, psi: FloatArray) -> FloatArray:
        """Displacement (n_blades, 2, n_casing) at psi per unit of each casing mode."""
        a, b, c, d = self.cubics
        h = 2 * np.pi / a.shape[0]
        node = np.floor(psi / h)
        s, i = (psi - node * h)[:, None, None], node.astype(int) % a.shape[0]
        return np.asarray(a[i] + s * (b[i] + s * (c[i] + s * d[i])))

    def _friction(
        self,
        free: FloatArray,
        blades: IntArray,
        place: FloatArray,
        er: FloatArray,
        et: FloatArray,
        t: FloatArray,
        shapes: FloatArray,
    ) -> FloatArray:
        """Friction direction (2, contacts) along t and e_z."""
        speed = (free - self.before) / (2 * self.dt)
        tips = speed[: 3 * self.system.n_blades].reshape(-1, 3)[blades]
        omega = self.system.speed
        velocity = (tips[:, 0] - omega * place[:, 1]) * er + (tips[:, 1] + omega * place[:, 0]) * et
        slip = np.sum((velocity - (shapes @ speed[self.system.casing_start :]).T) * t, axis=0)
        return np.asarray(-np.stack([slip, tips[:, 2]]) / np.hypot(slip, tips[:, 2]))

    def _columns(
        self, f: FloatArray, axial: FloatArray, blades: IntArray, er: FloatArray, et: FloatArray, shapes: FloatArray
    ) -> FloatArray:
        """Columns (n, contacts) of in-plane unit forces f (2, contacts) and axial ones on tips and casing."""
        columns = np.zeros((self.now.shape[0], len(blades)))
        k = np.arange(len(blades))
        columns[3 * blades, k] = np.sum(f * er, axis=0)
        columns[3 * blades + 1, k] = np.sum(f * et, axis=0)
        columns[3 * blades + 2, k] = axial
        columns[self.system.casing_start :] = -np.einsum("kcm,ck->mk", shapes, f)
        return columns


def active_set(W: FloatArray, gap: FloatArray) -> FloatArray:
    """Multipliers 0 <= lam _|_ gap + W lam >= 0 by exact solves on sets of active contacts."""
    active: BoolArray = gap < 0
    lam = np.zeros(len(gap))
    for _ in range(20 * len(gap)):
        lam[:] = 0
        lam[active] = la.solve(W[np.ix_(active, active)], -gap[active]) if active.any() else 0
        wrong = np.where(active, lam < 0, gap + W @ lam < -1e-15)
        if not wrong.any():
            return lam
        active = active ^ wrong
    raise ArithmeticError("the active set of contacts did not settle")
