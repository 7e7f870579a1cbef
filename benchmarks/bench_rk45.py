"""Our run beside scipy's RK45 with a penalty contact, as a laboratory's script has it, in CPU time of one process.

Both take the reduced preset (125 coordinates, 36 tips that may touch) on from the same settled state, of a light and of
a heavy rub. The script: explicit right-hand side in numpy with M^-1 K and M^-1 C made beforehand, contact by each tip's
radial gap to the oval and the casing's own radial displacement there, stiffness PENALTY on what enters, Coulomb
friction along the circle; RK45 at RTOL and an absolute tolerance of ATOL_M in metres (times the spin speed for
velocities). It comes in three forms: all tips at once in whole arrays; one after the other in a loop, as equations are
written down; and that loop compiled with numba. The impulse a turn of both shows that it rubs as ours does.
"""

from __future__ import annotations

import math
import time

import numpy as np
from scipy.integrate import solve_ivp
from threadpoolctl import threadpool_limits

from benchmarks.bench_solver import CASES, STEPS, Case, settled
from benchmarks.penalty_kernels import Penalty, slope_of
from benchmarks.rows import rows_of
from rubgen.arrays import FloatArray
from rubgen.reduction.model import SpinningSystem
from rubgen.solver.scheme.stepper import Stepper

PENALTY = 1e9
"""N/m: of 1e8, 1e9 and 1e10 the least whose impulse a turn is within 2 % of ours in both runs."""
RTOL, ATOL_M = 1e-6, 1e-9
TURNS = 12
LOOPED_TURNS = 4
OUR_TURNS = 400
RUNS = (CASES[0], CASES[2])


class PenaltyModel:
    """The right-hand side y' = f(t, y), y = [q, q', impulse]."""

    def __init__(self, system: SpinningSystem, friction: float) -> None:
        self.system, self.friction = system, friction
        n = len(system.M)
        self.n, self.tips = n, 3 * system.n_blades
        self.inverse = np.linalg.inv(system.M)
        self.rates = -self.inverse @ np.hstack([system.K, system.C])
        self.constant = self.inverse @ system.force
        nodes = len(system.casing_modes)
        angle = 2 * np.pi * np.arange(nodes) / nodes
        x, y = system.casing_modes[:, 0], system.casing_modes[:, 1]
        self.radial = np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y
        self.around = -np.sin(angle)[:, None] * x + np.cos(angle)[:, None] * y

    def contact(self, t: float, q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Normal forces on the tips that touch, their blades, and the casing's shapes there, radial and around."""
        system = self.system
        place = q[: self.tips].reshape(-1, 3) + system.tip_static
        r, v = system.tip_radius + place[:, 0], place[:, 1]
        angle = system.speed * t + system.blade_angles + np.arctan2(v, r)
        surface = system.surface
        inner = surface.mean_radius + np.cos(
            np.multiply.outer(angle, surface.order) - surface.order * surface.phase
        ) @ (surface.amplitude)
        modal = q[system.casing_start :]
        nodal = self.radial @ modal
        at = np.mod(angle, 2 * np.pi) * len(nodal) / (2 * np.pi)
        below = at.astype(np.int64) % len(nodal)
        share, above = at % 1.0, (below + 1) % len(nodal)
        depth = np.hypot(r, v) - inner - ((1 - share) * nodal[below] + share * nodal[above])
        blades = np.flatnonzero(depth > 0)
        share, below, above = share[blades, None], below[blades], above[blades]
        radial = (1 - share) * self.radial[below] + share * self.radial[above]
        around = (1 - share) * self.around[below] + share * self.around[above]
        return PENALTY * depth[blades], blades, radial, around

    def __call__(self, t: float, y: FloatArray) -> FloatArray:
        q, speed = y[: self.n], y[self.n : 2 * self.n]
        normal, blades, radial, around = self.contact(t, q)
        slope = np.empty_like(y)
        slope[: self.n] = speed
        acceleration = self.constant + self.rates @ y[: 2 * self.n]
        if len(blades):
            load = np.zeros(self.n)
            load[3 * blades] = -normal
            load[3 * blades + 1] = -self.friction * normal
            load[self.system.casing_start :] = normal @ (radial + self.friction * around)
            acceleration += self.inverse @ load
        slope[self.n : 2 * self.n] = acceleration
        slope[-1] = normal.sum()
        return slope


class LoopedModel(PenaltyModel):
    """The same, blade by blade."""

    def contact(self, t: float, q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """The same as of `PenaltyModel`."""
        system, surface = self.system, self.system.surface
        modal, nodes = q[system.casing_start :], len(self.radial)
        found = []
        for blade in range(system.n_blades):
            place = q[3 * blade : 3 * blade + 3] + system.tip_static[blade]
            r, v = system.tip_radius + place[0], place[1]
            angle = system.speed * t + system.blade_angles[blade] + math.atan2(v, r)
            inner = surface.mean_radius
            for amplitude, order, phase in zip(surface.amplitude, surface.order, surface.phase, strict=True):
                inner += amplitude * math.cos(order * (angle - phase))
            at = angle % (2 * math.pi) * nodes / (2 * math.pi)
            below, share = int(at) % nodes, at % 1.0
            above = (below + 1) % nodes
            radial = (1 - share) * self.radial[below] + share * self.radial[above]
            depth = math.hypot(r, v) - inner - radial @ modal
            if depth > 0:
                around = (1 - share) * self.around[below] + share * self.around[above]
                found.append((PENALTY * depth, blade, radial, around))
        if not found:
            return np.zeros(0), np.zeros(0, dtype=np.int64), *np.zeros((2, 0, system.n_casing))
        normal, blades, radials, arounds = (np.array(each) for each in zip(*found, strict=True))
        return normal, blades, radials, arounds


class CompiledModel(PenaltyModel):
    """The loop compiled with numba."""

    def __init__(self, system: SpinningSystem, friction: float) -> None:
        super().__init__(system, friction)
        surface = system.surface
        self.constants = Penalty(
            rates=np.ascontiguousarray(self.rates),
            constant=self.constant,
            columns=np.ascontiguousarray(self.inverse.T),
            radial=np.ascontiguousarray(self.radial),
            around=np.ascontiguousarray(self.around),
            tip_static=np.ascontiguousarray(system.tip_static),
            blade_angles=np.ascontiguousarray(system.blade_angles),
            curve=np.column_stack([surface.amplitude, surface.order, surface.phase]).astype(float),
            numbers=np.array([system.tip_radius, surface.mean_radius, system.speed, friction, PENALTY], dtype=float),
        )

    def __call__(self, t: float, y: FloatArray) -> FloatArray:
        slope = np.empty_like(y)
        slope_of(self.constants, t, y, slope)
        return slope


def start_of(stepper: Stepper, model: PenaltyModel) -> FloatArray:
    """[q, q', 0] of the stepper: q' = (q_n - q_n-1) / dt + dt q'' / 2."""
    before, now = stepper.coordinates.before, stepper.coordinates.now
    speed = (now - before) / stepper.dt
    bend = model.constant + model.rates @ np.concatenate([now, speed])
    return np.concatenate([now, speed + stepper.dt / 2 * bend, [0.0]])


def run_script(model: PenaltyModel, start: FloatArray, turns: int) -> tuple[float, float, int]:
    """CPU seconds a simulated second, impulse a turn in N s over the second half of the turns, evaluations a turn."""
    omega = model.system.speed
    turn = 2 * np.pi / omega
    atol = np.concatenate([np.full(model.n, ATOL_M), np.full(model.n, ATOL_M * omega), [1e-6]])
    ends = [turns / 2 * turn, turns * turn]
    begun = time.process_time()
    solution = solve_ivp(model, (0.0, turns * turn), start, "RK45", ends, rtol=RTOL, atol=atol)
    spent = time.process_time() - begun
    if not solution.success:
        raise RuntimeError(f"RK45 ended early: {solution.message}")
    impulse = float(solution.y[-1, 1] - solution.y[-1, 0]) / (turns / 2)
    if not impulse > 0:
        raise RuntimeError("the script's run does not rub")
    return spent / (turns * turn), impulse, solution.nfev // turns


def run_ours(stepper: Stepper) -> tuple[float, float]:
    """CPU seconds a simulated second and impulse a turn in N s."""
    impulse, begun = 0.0, time.process_time()
    for _ in range(OUR_TURNS):
        stepper.run_turn()
        impulse += stepper.result.summary[0]
    seconds = OUR_TURNS * STEPS * stepper.dt
    return (time.process_time() - begun) / seconds, impulse / OUR_TURNS


def measure_case(case: Case) -> list[dict[str, object]]:
    """Rows of one run."""
    stepper, _ = settled(case)
    model, looped, compiled = (
        kind(stepper.system, case.friction) for kind in (PenaltyModel, LoopedModel, CompiledModel)
    )
    start = start_of(stepper, model)
    ours, impulse = run_ours(stepper)
    script, pushed, evaluations = run_script(model, start, TURNS)
    loop, _, _ = run_script(looped, start, LOOPED_TURNS)
    compiled(0.0, start)  # compiles
    fast, _, _ = run_script(compiled, start, TURNS)
    rows = (
        ("ours, CPU s a simulated s", ours, "s", "recorded"),
        ("RK45, whole arrays, CPU s a simulated s", script, "s", "recorded"),
        ("RK45, loop over blades, CPU s a simulated s", loop, "s", "recorded"),
        ("RK45, loop compiled with numba, CPU s a simulated s", fast, "s", "recorded"),
        ("RK45, whole arrays, over ours", script / ours, "ratio", ">= 500"),
        ("RK45, loop over blades, over ours", loop / ours, "ratio", ">= 500"),
        ("RK45, loop compiled with numba, over ours", fast / ours, "ratio", "recorded"),
        ("right-hand sides of RK45 a turn", evaluations, "1", "recorded"),
        ("impulse a turn, ours", impulse, "N s", "> 0"),
        ("impulse a turn, RK45", pushed, "N s", "> 0"),
    )
    return rows_of(rows, f"{case.name}: ")


def measure() -> list[dict[str, object]]:
    """All rows, on one thread."""
    with threadpool_limits(1):
        return [row for case in RUNS for row in measure_case(case)]
