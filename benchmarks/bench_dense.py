"""Our step beside what a competent user of numba writes in an evening (`dense_kernels`), in CPU time of one thread.

Three runs of `bench_solver` from the same settled states, in whole turns, one after the other; the peer's state is
restored before each of its turns. It comes with the numpy reference's screening of far blades and without any. That it
takes the same step is shown by its state after a turn beside the reference's.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.bench_solver import CASES, STEPS, Case, settled
from benchmarks.cpu_time import cpu_time
from benchmarks.dense_kernels import Dense, run
from benchmarks.rows import rows_of
from rubgen.arrays import FloatArray
from rubgen.solver.scheme.stepper import Stepper
from validation.reference_step import ReferenceStepper

RUNS = CASES[:3]
ROUNDS = 30
"""Turns of each program that are timed, in turns."""


def dense_of(reference: ReferenceStepper, *, screening: bool) -> Dense:
    """The constants of the dense step, from those of the numpy reference."""
    system = reference.system
    curve, nodal = system.surface, reference.cubics[0]
    return Dense(
        free=np.ascontiguousarray(np.hstack([reference.from_now, reference.from_before])),
        constant=reference.constant,
        columns=np.ascontiguousarray(reference.inverse.T),
        cubics=np.ascontiguousarray(reference.cubics.transpose(1, 2, 3, 0)),
        nodal=np.ascontiguousarray(nodal.reshape(-1, nodal.shape[-1])),
        tip_static=np.ascontiguousarray(system.tip_static),
        blade_angles=np.ascontiguousarray(system.blade_angles),
        curve=np.column_stack([curve.amplitude, curve.order, curve.phase]).astype(float),
        numbers=np.array(
            [system.tip_radius, curve.mean_radius, system.speed, reference.friction, reference.dt], dtype=float
        ),
        screening=screening,
    )


def turn_of(dense: Dense, start: FloatArray) -> tuple[FloatArray, int]:
    """The state q_n, q_n-1 after one turn from `start`, and how many of its steps had contact."""
    q = start.copy()
    return q, run(dense, 0.0, 0, STEPS, STEPS, q)


def deviation(dense: Dense, reference: ReferenceStepper, start: FloatArray) -> float:
    """Largest relative difference from the reference's state after one turn, over displacements of blisk and casing.

    RuntimeError where the number of steps with contact differs.
    """
    n = len(start) // 2
    reference.set_state(start[n:], start[:n])
    touched = sum(reference.step(index) > 0 for index in range(STEPS))
    q, own = turn_of(dense, start)
    if own != touched:
        raise RuntimeError(f"the dense step touched in {own} steps of a turn, the reference in {touched}")
    parts = (slice(0, reference.system.casing_start), slice(reference.system.casing_start, n))
    return max(float(np.abs(q[p] - reference.now[p]).max() / np.abs(reference.now[p]).max()) for p in parts)


def times(stepper: Stepper, peers: list[Dense], start: FloatArray) -> list[float]:
    """Median CPU times of a step in us: ours, then each peer's, each over whole turns taken in turns."""
    spent: list[list[float]] = [[] for _ in range(1 + len(peers))]
    for _ in range(ROUNDS):
        spent[0].append(cpu_time(stepper.run_turn))
        for row, peer in zip(spent[1:], peers, strict=True):
            row.append(cpu_time(partial(turn_of, peer, start)))
    return [1e6 * float(np.median(row)) / STEPS for row in spent]


def measure_case(case: Case) -> list[dict[str, object]]:
    """Rows of one run."""
    stepper, reference = settled(case)
    start = np.concatenate([reference.now, reference.before])
    screened, whole = dense_of(reference, screening=True), dense_of(reference, screening=False)
    worst = max(deviation(dense, reference, start) for dense in (screened, whole))
    ours, near, every = times(stepper, [screened, whole], start)
    rows = (
        ("solver step, median CPU", ours, "us", "recorded"),
        ("dense numba step, screened", near, "us", "recorded"),
        ("dense numba step, every blade", every, "us", "recorded"),
        ("dense numba, screened, over solver", near / ours, "ratio", ">= 10"),
        ("dense numba, every blade, over solver", every / ours, "ratio", "recorded"),
        ("dense numba: deviation from the reference over a turn", worst, "1", "<= 1e-9"),
    )
    return rows_of(rows, f"{case.name}: ")


def measure() -> list[dict[str, object]]:
    """All rows, on one thread."""
    with threadpool_limits(1):
        return [row for case in RUNS for row in measure_case(case)]


if __name__ == "__main__":
    for line in measure():
        print(line)
