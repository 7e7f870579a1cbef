"""A twin of the run that starts beside it, through the same contact code, brought back near it again and again.

The largest Lyapunov exponent is the mean growth of the distance (Benettin, Galgani, Giorgilli, Strelcyn 1980).
"""

from __future__ import annotations

import math

from rubgen.arrays import FloatArray
from rubgen.contact.contact_kernels import ContactWork
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.block_kernels import Product, quadratic
from rubgen.solver.scheme.model_kernels import Model, Scratch
from rubgen.solver.scheme.motion_kernels import Motion, recover
from rubgen.solver.scheme.snapshot_kernels import Marks
from rubgen.solver.scheme.step_kernels import OK, advance, shift_held


@allocation_free_kernel
def bring_back(main: FloatArray, scale: float, twin: FloatArray) -> None:
    """Twin = main + scale (twin - main), entry by entry; what is no number in either becomes that of `main`."""
    for i in range(twin.shape[0]):
        away = twin[i] - main[i]
        twin[i] = main[i] + scale * away if math.isfinite(away) else main[i]


@allocation_free_kernel
def distance(model: Model, mass: Product, main: FloatArray, twin: tuple[Motion, Motion], scratch: Scratch) -> float:
    """Sqrt(d_v^T M d_v + Omega^2 d_q^T M d_q) between `main` (2, any), z at two steps, and the twin at the same."""
    speed, dt = model.laws.speed, model.laws.dt
    for i in range(scratch.z_change.shape[0]):
        scratch.z_force[i] = twin[1].z[i] - main[1, i]
        scratch.z_change[i] = (scratch.z_force[i] - (twin[0].z[i] - main[0, i])) / dt
    kinetic = quadratic(mass, scratch.z_change, scratch.z_change)
    return math.sqrt(kinetic + speed * speed * quadratic(mass, scratch.z_force, scratch.z_force))


@inlined_kernel
def renormalise(
    model: Model,
    mass: Product,
    marks: Marks,
    mark: int,
    closeness: float,
    twin: tuple[Motion, Motion],
    work: ContactWork,
    scratch: Scratch,
) -> float:
    """Bring the twin back to a distance of `closeness` in the direction where it is; gives ln of its growth."""
    size = distance(model, mass, marks.z[mark], twin, scratch)
    if not size > 0.0:
        return math.nan
    for i in range(2):
        bring_back(marks.z[mark, i], closeness / size, twin[i].z)
        bring_back(marks.held[mark, i], closeness / size, work.held[i])
        recover(model.harmonics, twin[i], scratch.share)
    return math.log(size / closeness)


@allocation_free_kernel
def run_twin(
    model: Model,
    mass: Product,
    opening: FloatArray,
    marks: Marks,
    closeness: float,
    motions: tuple[Motion, Motion, Motion],
    work: ContactWork,
    scratch: Scratch,
    growth_out: FloatArray,
) -> int:
    """The twin's turn after the run has made its own; ln of the growth between marks into `growth_out` (marks,).

    `work`, `scratch` and `motions` are the twin's own. A code of `step_kernels`.
    """
    before, now, after = motions
    step = 0
    for mark in range(marks.steps.shape[0]):
        while step < marks.steps[mark]:
            code, _ = advance(model, step, opening, before, now, after, work, scratch)
            if code != OK:
                return code
            before, now, after = now, after, before
            shift_held(work)
            step += 1
        growth_out[mark] = renormalise(model, mass, marks, mark, closeness, (before, now), work, scratch)
    return OK
