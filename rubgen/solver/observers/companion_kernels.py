"""A companion of the run starts near the run, takes the same steps, and is brought back near the run repeatedly.

z are the coordinates in the order of the blocks (`linalg.blocks`).

The largest Lyapunov exponent is the mean growth of the distance (Benettin, Galgani, Giorgilli, Strelcyn 1980).
"""

import math

from rubgen.arrays import FloatArray
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.block_kernels import Product, quadratic
from rubgen.solver.scheme.model_kernels import Laws, Model
from rubgen.solver.scheme.motion_kernels import Motion, motion_at, put_in_order, recover
from rubgen.solver.scheme.state_kernels import OK, Scratch, Snapshots, State
from rubgen.solver.scheme.step_kernels import advance, shift_gaps


@allocation_free_kernel
def bring_back(main: FloatArray, scale: float, companion: FloatArray) -> None:
    """Scale the companion's distance from the run: `companion` becomes main + scale (companion - main).

    An element whose distance is not finite becomes the element of `main`. Both arrays have the same length.
    """
    for i in range(companion.shape[0]):
        away = companion[i] - main[i]
        companion[i] = main[i] + scale * away if math.isfinite(away) else main[i]


@allocation_free_kernel
def distance(laws: Laws, mass: Product, main: FloatArray, companion: tuple[Motion, Motion], scratch: Scratch) -> float:
    """Return sqrt(d_v^T M d_v + Omega^2 d_q^T M d_q), with d the difference between the run and its companion.

    `main` (2, size of z) is z of the run at two successive steps, `companion` its motions at these steps. `mass` is M
    in blocks. `scratch.z_force` and `scratch.z_change` are overwritten.
    """
    speed, dt = laws.speed, laws.dt
    for i in range(scratch.z_change.shape[0]):
        scratch.z_force[i] = companion[1].z[i] - main[1, i]
        scratch.z_change[i] = (scratch.z_force[i] - (companion[0].z[i] - main[0, i])) / dt
    kinetic = quadratic(mass, scratch.z_change, scratch.z_change)
    return math.sqrt(kinetic + speed * speed * quadratic(mass, scratch.z_force, scratch.z_force))


@inlined_kernel
def renormalise(
    model: Model, snapshots: Snapshots, number: int, closeness: float, companion: tuple[Motion, Motion], state: State
) -> float:
    """Bring the companion back to the distance `closeness` from the run, without changing the direction.

    Returns ln(distance / closeness), the growth since the last renormalisation. If the distance is 0 or NaN, NaN is
    returned and the companion is not changed.

    - snapshots: of the run's turn.
    - number: the snapshot that the companion has reached.
    - closeness: distance to leave, in the energy norm of `distance`, sqrt(J).
    - companion: the companion's motions at the step before the snapshot and at the snapshot; changed.
    - state: state of the companion, not of the run; its `contact.step_gaps` are scaled in the same way.
    """
    size = distance(model.laws, model.energy.M, snapshots.z[number], companion, state.scratch)
    if not size > 0.0:
        return math.nan
    for i in range(2):
        bring_back(snapshots.z[number, i], closeness / size, companion[i].z)
        bring_back(snapshots.step_gaps[number, i], closeness / size, state.contact.step_gaps[i])
        recover(model.harmonics, companion[i], state.scratch.share)
    return math.log(size / closeness)


@allocation_free_kernel
def run_companion(
    model: Model, opening: FloatArray, snapshots: Snapshots, closeness: float, state: State, growth_out: FloatArray
) -> int:
    """Run the companion through the run's last turn. Return OK or the code of a failed step (`step_kernels`).

    A failed step ends it: the remaining numbers of `growth_out` are then not written.

    - opening (steps + 2,): added to the radius of the surface, m.
    - snapshots: of the run's turn.
    - closeness: distance after each renormalisation, sqrt(J).
    - state: state of the companion; changed.
    - growth_out (snapshots,): written: ln of the distance's growth between snapshots.
    """
    buffer, first, second, third = state.buffer, 0, 1, 2
    step = 0
    for number in range(snapshots.steps.shape[0]):
        while step < snapshots.steps[number]:
            before, now, after = motion_at(buffer, first), motion_at(buffer, second), motion_at(buffer, third)
            code, _ = advance(model, step, opening, before, now, after, state)
            if code != OK:
                return code
            first, second, third = second, third, first
            shift_gaps(state.contact)
            step += 1
        pair = motion_at(buffer, first), motion_at(buffer, second)
        growth_out[number] = renormalise(model, snapshots, number, closeness, pair, state)
    put_in_order(buffer, first)
    return OK
