"""The clearance of all tips to the undeformed surface, for eight blades at a time in vector registers."""

from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils

from rubgen.arrays import FloatArray
from rubgen.linalg.vector_kernels import Emitter, compile_as

BASE, NEAREST, ASIDE, BEND = range(4)
"""Numbers of `set_tip_bounds`: base in m, 1 / radius in 1/m, and the two coefficients of |t| in 1 and 1/m."""


def set_tip_bounds(
    tips: FloatArray,
    displacement: FloatArray,
    numbers: tuple[float, float, float, float],
    amplitude: FloatArray,
    order: FloatArray,
    cosine: FloatArray,
    sine: FloatArray,
    bounds_out: FloatArray,
) -> None:
    """Write base - a - |t| (aside + bend |t|) + sum_j amplitude_j (at_j - order_j t / radius slope_j) of all tips.

    a and t are a tip's radial and tangential displacement from its radius at rest, the steady one and `displacement` (2
    or more, width) together, m. at_j and slope_j are the cosine and the sine of order_j (theta + the blade's angle -
    phase_j). `clearance_bounds` explains the terms.

    - tips (2 + 2 n_harmonics, width): `Tips.bound_rows`.
    - numbers: at BASE, NEAREST, ASIDE and BEND.
    - amplitude, order (n_harmonics,): of the surface's harmonics, amplitudes in m.
    - cosine, sine (n_harmonics,): of order_j (theta - phase_j).
    - bounds_out (width,): written, m. `width` is a multiple of eight.
    """
    base, nearest, aside, bend = numbers
    t = tips[1] + displacement[1]
    bounds_out[:] = base - (tips[0] + displacement[0]) - np.abs(t) * (aside + bend * np.abs(t))
    for j in range(len(amplitude)):
        cos_tip, sin_tip = tips[2 + 2 * j], tips[3 + 2 * j]
        at, slope = cosine[j] * cos_tip - sine[j] * sin_tip, sine[j] * cos_tip + cosine[j] * sin_tip
        bounds_out += amplitude[j] * (at - order[j] * nearest * t * slope)


def _set_tip_bounds(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    emit, index = Emitter(context, builder), ir.IntType(64)
    kinds = signature.args
    tips, displacement, bounds = (emit.array(kinds[i], args[i]) for i in (0, 1, 7))
    waves = [emit.array(kinds[i], args[i]).data for i in (3, 4, 5, 6)]
    base, nearest, aside, bend = (emit.in_all_lanes(builder.extract_value(args[2], i)) for i in range(4))
    size = cgutils.get_or_insert_function(  # type: ignore[no-untyped-call]
        builder.module, ir.FunctionType(emit.vector, [emit.vector]), "llvm.fabs.v8f64"
    )
    harmonics = emit.shape(emit.array(kinds[3], args[3]), 0)
    total = cgutils.alloca_once_value(builder, emit.zero)  # type: ignore[no-untyped-call]

    def place(array: Any, line: Any, row: Any) -> Any:
        return emit.load(emit.line_of(array, line), row)

    with cgutils.for_range(builder, emit.row_count(emit.shape(bounds, 0))) as loop:
        row = loop.index
        a, t = (builder.fadd(place(tips, index(i), row), place(displacement, index(i), row)) for i in (0, 1))
        away = builder.call(size, [t])
        lost = builder.fmul(away, builder.call(emit.fma, [bend, away, aside]))
        builder.store(builder.fsub(builder.fsub(base, a), lost), total)
        moved = builder.fmul(nearest, t)
        with cgutils.for_range(builder, harmonics) as inner:
            amplitude, order, cosine, sine = (emit.broadcast(each, inner.index) for each in waves)
            line = builder.mul(inner.index, index(2))
            cos_tip, sin_tip = (place(tips, builder.add(line, index(i)), row) for i in (2, 3))
            at = builder.fsub(builder.fmul(cosine, cos_tip), builder.fmul(sine, sin_tip))
            slope = builder.call(emit.fma, [sine, cos_tip, builder.fmul(cosine, sin_tip)])
            wave = builder.fsub(at, builder.fmul(builder.fmul(order, moved), slope))
            builder.store(builder.call(emit.fma, [amplitude, wave, builder.load(total)]), total)
        emit.store(builder.load(total), bounds.data, row)
    return context.get_dummy_value()


compile_as(set_tip_bounds, types.none, _set_tip_bounds)
