"""Make the turning forces in the form that the kernels of the scheme take."""

import numpy as np
import scipy.linalg as la

from rubgen.arrays import AnyArray, ComplexArray, FloatArray
from rubgen.linalg.blocks import Blocks, aligned
from rubgen.machine.support_laws.disk_support import LAWS
from rubgen.machine.support_laws.law import SupportLaw
from rubgen.reduction.model import SpinningSystem, TurningForces
from rubgen.solver.supports.support_kernels import Support


def support_of(system: SpinningSystem, blocks: Blocks, dt: float) -> Support:
    """Build the kernels' constants of a system's turning forces, for a step of `dt` s.

    The result is not active for a system without such forces.
    """
    forces = system.turning
    if forces is None:
        return _support(TurningForces(), active=False)
    n, tips = len(system.M), 3 * system.n_blades
    centre = np.array([system.centre, system.centre + 1])
    weight = np.zeros((n, 2)) if forces.weight is None else forces.weight
    loads = np.column_stack([np.eye(n)[:, centre], -weight])
    A = system.M / dt**2 + system.C / (2 * dt)
    columns, rows = la.solve(A, loads), la.solve(A.T, loads[:, :2])
    moved = blocks.connected(centre)
    return _support(
        forces,
        active=True,
        centre=blocks.place[centre],
        places=blocks.place[moved],
        columns=(blocks.transform.T @ columns)[moved],
        weight=(blocks.transform.T @ weight)[moved],
        compliance=columns[centre, :2],
        rows=np.stack([blocks.to_z(row) for row in rows.T]),
        tip_columns=columns[:tips, :2],
        tip_rows=rows[:tips],
    )


def _support(
    forces: TurningForces,
    *,
    active: bool,
    centre: AnyArray | None = None,
    places: AnyArray | None = None,
    **arrays: FloatArray,
) -> Support:
    """Make the kernels' record; arrays that are not given are empty."""
    none = np.zeros(0, dtype=np.int64)
    empty = np.zeros((0, 2))
    names = ("columns", "weight", "compliance", "rows", "tip_columns", "tip_rows")
    given = {name: aligned(arrays.get(name, empty)) for name in names}
    return Support(
        active=active,
        yields=bool(forces.stiffness or forces.damping or forces.laws),
        stiffness=forces.stiffness,
        damping=forces.damping,
        laws=law_rows(forces.laws),
        limit=min((law.limit_m for law in forces.laws), default=np.inf),
        centre=none if centre is None else centre,
        places=none if places is None else places,
        **load_tables(forces),
        **given,
    )


def load_tables(forces: TurningForces) -> dict[str, FloatArray]:
    """Return the tables `loads`, `slopes` and `growing` of `Support` by name. The slopes are zero."""
    parts = [each.loads for each in forces.growing]
    steady = np.zeros((0, 2), dtype=np.complex128) if forces.loads is None else forces.loads
    orders = max(map(len, [steady, *parts]))
    return {
        "loads": _row_of_parts(steady, orders),
        "slopes": np.zeros((orders, 4)),
        "growing": np.array([_row_of_parts(part, orders) for part in parts]).reshape(len(parts), orders, 4),
    }


def _row_of_parts(loads: ComplexArray, orders: int) -> FloatArray:
    """Return real and imaginary part of x and y (orders, 4), with zeros behind the given orders."""
    padded = np.zeros((orders, 2), dtype=np.complex128)
    padded[: len(loads)] = loads
    return padded.view(np.float64)


def law_rows(laws: tuple[SupportLaw, ...]) -> FloatArray:
    """Return a row for each law: its number in the registry, its constants, and zeros up to the longest row."""
    rows = [(float(LAWS.index(type(law))), *law.numbers) for law in laws]
    width = max((len(row) for row in rows), default=1)
    return np.array([[*row, *[0.0] * (width - len(row))] for row in rows]).reshape(len(rows), width)
