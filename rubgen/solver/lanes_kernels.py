"""Sums of products over rows of eight numbers, the solver's inner loops, written for vector registers.

Numba does not keep sums of eight neighbours in registers by itself, so each function here stands twice: as plain
Python, and as the same sums in LLVM's vector type, which compiled kernels take. Both take C-contiguous arrays of
float64 of any shape, read as rows of eight or as single numbers. The compiled order of a sum is fixed and its products
are fused with the sums, on every processor.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.core.typing.templates import signature as typed
from numba.extending import lower_builtin

from rubgen.arrays import FloatArray, IntArray

LANES = 8
CHAINS = 4
"""Independent partial sums: a fused product takes about four cycles, and two may start in each."""
SCALED, ROW, FIRST, START, COUNT = range(5)
"""A line: whether single numbers of x are meant, not rows; the row of results; the first of its rows of entries; the
first row or number of x; how many."""


def line_sum(line: IntArray, a: FloatArray, x: FloatArray) -> FloatArray:
    """The row (8,) of one line: sum over j < COUNT of a[FIRST + j] times row or number START + j of x."""
    rows = a.reshape(-1, LANES)[line[FIRST] : line[FIRST] + line[COUNT]]
    part = slice(line[START], line[START] + line[COUNT])
    if line[SCALED]:
        return np.asarray(x.reshape(-1)[part] @ rows)
    return np.asarray((rows * x.reshape(-1, LANES)[part]).sum(axis=0))


def add_lines(lines: IntArray, a: FloatArray, x: FloatArray, out: FloatArray) -> None:
    """Add each line's sum to its row of `out`. `lines` (any, 5), `a` (any, 8) entries."""
    for line in lines:
        out.reshape(-1, LANES)[line[ROW]] += line_sum(line, a, x)


def add_two_lines(lines: IntArray, a: FloatArray, b: FloatArray, x: FloatArray, y: FloatArray, out: FloatArray) -> None:
    """`add_lines` of a, x and of b, y in one."""
    add_lines(lines, a, x, out)
    add_lines(lines, b, y, out)


def dot_lines(lines: IntArray, a: FloatArray, x: FloatArray, left: FloatArray) -> float:
    """The products of each line's sum with its row of `left`, summed."""
    return sum(float(line_sum(line, a, x) @ left.reshape(-1, LANES)[line[ROW]]) for line in lines)


def dot_rows(a: FloatArray, b: FloatArray, count: int) -> float:
    """Sum of the products of the first `count` rows of a and b."""
    return float(a.reshape(-1)[: LANES * count] @ b.reshape(-1)[: LANES * count])


Pair = tuple[Any, Any, Any, Any, bool]


class _Emitter:
    """Writes the vector code of one function into LLVM's builder."""

    def __init__(self, context: Any, builder: Any) -> None:
        self.context, self.builder = context, builder
        self.index, double = ir.IntType(64), ir.DoubleType()
        self.vector = ir.VectorType(double, LANES)
        self.zero = ir.Constant(self.vector, [ir.Constant(double, 0.0)] * LANES)
        kind = ir.FunctionType(self.vector, [self.vector] * 3)
        self.fma = cgutils.get_or_insert_function(builder.module, kind, "llvm.fma.v8f64")  # type: ignore[no-untyped-call]

    def array(self, kind: Any, array: Any) -> Any:
        return self.context.make_array(kind)(self.context, self.builder, array)

    def at_row(self, data: Any, row: Any) -> Any:
        place = self.builder.gep(data, [self.builder.mul(row, self.index(LANES))])
        return self.builder.bitcast(place, self.vector.as_pointer())

    def load(self, data: Any, row: Any) -> Any:
        value = self.builder.load(self.at_row(data, row))
        value.align = 8
        return value

    def store(self, value: Any, data: Any, row: Any) -> None:
        self.builder.store(value, self.at_row(data, row)).align = 8

    def spread(self, data: Any, place: Any) -> Any:
        """One number in all lanes."""
        number = self.builder.load(self.builder.gep(data, [place]))
        single = self.builder.insert_element(self.zero, number, ir.IntType(32)(0))
        return self.builder.shuffle_vector(
            single, self.zero, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        )

    def lane_sum(self, total: Any) -> Any:
        """The sum of all lanes, by halves."""
        lanes = [self.builder.extract_element(total, ir.IntType(32)(i)) for i in range(LANES)]
        while len(lanes) > 1:
            half = len(lanes) // 2
            lanes = [self.builder.fadd(lanes[i], lanes[half + i]) for i in range(half)]
        return lanes[0]

    def sum_products(self, pairs: list[Pair], count: Any) -> Any:
        """The sum over j < count and over pairs (a, first, x, start, spread) in `CHAINS` partial sums."""
        builder = self.builder
        sums = [cgutils.alloca_once_value(builder, self.zero) for _ in range(CHAINS)]  # type: ignore[no-untyped-call]
        for each in sums:
            builder.store(self.zero, each)
        together = CHAINS // len(pairs)
        whole = builder.mul(builder.udiv(count, self.index(together)), self.index(together))
        with cgutils.for_range_slice(builder, self.index(0), whole, self.index(together)) as (j, _):
            for u in range(together):
                self._add(pairs, builder.add(j, self.index(u)), sums[u * len(pairs) :])
        with cgutils.for_range_slice(builder, whole, count, self.index(1)) as (j, _):
            self._add(pairs, j, sums)
        parts = [builder.load(each) for each in sums]
        return builder.fadd(builder.fadd(parts[0], parts[1]), builder.fadd(parts[2], parts[3]))

    def _add(self, pairs: list[Pair], j: Any, sums: list[Any]) -> None:
        builder = self.builder
        for (a, first, x, start, spread), total in zip(pairs, sums, strict=False):
            left, place = self.load(a, builder.add(first, j)), builder.add(start, j)
            right = self.spread(x, place) if spread else self.load(x, place)
            builder.store(builder.call(self.fma, [left, right, builder.load(total)]), total)


def _each_line(emit: _Emitter, array: Any, sources: list[tuple[Any, Any]], use: Callable[[Any, Any], None]) -> None:
    """Loop over lines; `use` takes the row and the sum over the sources (a, x) of each."""
    builder, index = emit.builder, emit.index
    lines, count = array.data, builder.extract_value(builder.load(array._get_ptr_by_name("shape")), 0)
    with cgutils.for_range(builder, count) as loop:
        line = [
            builder.load(builder.gep(lines, [builder.add(builder.mul(loop.index, index(5)), index(i))]))
            for i in range(5)
        ]

        def total(spread: bool) -> Any:
            return emit.sum_products([(a, line[FIRST], x, line[START], spread) for a, x in sources], line[COUNT])

        with builder.if_else(builder.icmp_signed("!=", line[SCALED], index(0))) as (scaled, rows):
            with scaled:
                use(line[ROW], total(spread=True))
            with rows:
                use(line[ROW], total(spread=False))


def _adding(pairs: int) -> Callable[..., Any]:
    """The vector code of `add_lines` or of `add_two_lines`."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        emit = _Emitter(context, builder)
        arrays = [emit.array(kind, array) for kind, array in zip(signature.args, args, strict=True)]
        out = arrays[-1].data

        def add(row: Any, total: Any) -> None:
            emit.store(builder.fadd(emit.load(out, row), total), out, row)

        sources = [(arrays[1 + i].data, arrays[1 + pairs + i].data) for i in range(pairs)]
        _each_line(emit, arrays[0], sources, add)
        return context.get_dummy_value()

    return generate


def _dot_lines(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """The vector code of `dot_lines`."""
    emit = _Emitter(context, builder)
    lines, a, x, left = (emit.array(kind, array) for kind, array in zip(signature.args, args, strict=True))
    sums = cgutils.alloca_once(builder, emit.vector)  # type: ignore[no-untyped-call]
    builder.store(emit.zero, sums)

    def add(row: Any, total: Any) -> None:
        builder.store(builder.call(emit.fma, [emit.load(left.data, row), total, builder.load(sums)]), sums)

    _each_line(emit, lines, [(a.data, x.data)], add)
    return emit.lane_sum(builder.load(sums))


def _dot_rows(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """The vector code of `dot_rows`."""
    emit = _Emitter(context, builder)
    a, b = (emit.array(kind, array).data for kind, array in zip(signature.args[:2], args[:2], strict=True))
    none = emit.index(0)
    return emit.lane_sum(emit.sum_products([(a, none, b, none, False)], args[2]))


def _compile_as(plain: Callable[..., Any], result: Any, vector_code: Callable[..., Any]) -> None:
    """Let compiled kernels take the vector code where their source calls the plain function."""

    def generic(_template: Any, args: Any, _keywords: Any) -> Any:
        return typed(result, *args)  # type: ignore[no-untyped-call]

    infer_global(plain)(type(f"{plain.__name__} typing", (AbstractTemplate,), {"generic": generic}))  # type: ignore[no-untyped-call]
    lower_builtin(plain, types.VarArg(types.Any))(vector_code)  # type: ignore[no-untyped-call]


_compile_as(add_lines, types.void, _adding(pairs=1))
_compile_as(add_two_lines, types.void, _adding(pairs=2))
_compile_as(dot_lines, types.float64, _dot_lines)
_compile_as(dot_rows, types.float64, _dot_rows)
