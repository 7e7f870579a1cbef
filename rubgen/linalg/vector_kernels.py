"""Functions on rows of eight numbers in vector registers, for kernels whose sums numba does not keep there by itself.

Each function stands twice: as plain Python, and as the same in LLVM's vector type, which compiled kernels take instead
(`compile_as`). Arrays are C-contiguous. The compiled order of a sum is fixed, on every processor.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.core.typing.templates import signature as typed
from numba.extending import lower_builtin

from rubgen.arrays import FloatArray

LANES = 8


class Emitter:
    """Writes the vector code of one function into LLVM's builder. Its methods return LLVM values."""

    def __init__(self, context: Any, builder: Any) -> None:
        self.context, self.builder = context, builder
        self.index, double = ir.IntType(64), ir.DoubleType()
        self.vector = ir.VectorType(double, LANES)
        self.zero = ir.Constant(self.vector, [ir.Constant(double, 0.0)] * LANES)
        kind = ir.FunctionType(self.vector, [self.vector] * 3)
        self.fma = cgutils.get_or_insert_function(builder.module, kind, "llvm.fma.v8f64")  # type: ignore[no-untyped-call]

    def array(self, kind: Any, array: Any) -> Any:
        """Return an argument of the function as an array. `kind` is its numba type."""
        return self.context.make_array(kind)(self.context, self.builder, array)

    def shape(self, array: Any, axis: int) -> Any:
        """Return the length of an array along an axis."""
        return self.builder.extract_value(self.builder.load(array._get_ptr_by_name("shape")), axis)

    def line_of(self, array: Any, number: Any) -> Any:
        """Return the address at which line `number` of a two-dimensional array begins."""
        return self.builder.gep(array.data, [self.builder.mul(number, self.shape(array, 1))])

    def at_row(self, data: Any, row: Any) -> Any:
        """Return the address at which the row of eight with number `row` begins, counted from `data`."""
        place = self.builder.gep(data, [self.builder.mul(row, self.index(LANES))])
        return self.builder.bitcast(place, self.vector.as_pointer())

    def load(self, data: Any, row: Any) -> Any:
        """Load the row of eight with number `row` into a register."""
        value = self.builder.load(self.at_row(data, row))
        value.align = 8
        return value

    def store(self, value: Any, data: Any, row: Any) -> None:
        """Write the register `value` to the row of eight with number `row`."""
        self.builder.store(value, self.at_row(data, row)).align = 8

    def broadcast(self, data: Any, place: Any) -> Any:
        """Load number `place` of an array into all lanes of a register."""
        return self.in_all_lanes(self.builder.load(self.builder.gep(data, [place])))

    def in_all_lanes(self, number: Any) -> Any:
        """Put one number into all lanes of a register."""
        single = self.builder.insert_element(self.zero, number, ir.IntType(32)(0))
        return self.builder.shuffle_vector(
            single, self.zero, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES)
        )

    def lane_sum(self, total: Any) -> Any:
        """Add the eight lanes of a register, by halves."""
        lanes = [self.builder.extract_element(total, ir.IntType(32)(i)) for i in range(LANES)]
        while len(lanes) > 1:
            half = len(lanes) // 2
            lanes = [self.builder.fadd(lanes[i], lanes[half + i]) for i in range(half)]
        return lanes[0]

    def row_count(self, numbers: Any) -> Any:
        """Return the number of rows of eight that `numbers` numbers fill."""
        return self.builder.udiv(numbers, self.index(LANES))

    def call(self, name: str, result: Any, body: Callable[..., Any], *arguments: Any) -> Any:
        """Call a function of LLVM whose code `body` writes once in a module. Returns the function's value.

        The code is thus not repeated at each call. If the arguments are addresses and numbers, a call costs next to
        nothing.

        - name: name of the function; one name has one body.
        - result: LLVM's type of the value.
        - body: takes an emitter and the arguments, and returns the value, or None for a function without a value.
        """
        module, symbol = self.builder.module, f"rubgen.{name}"
        if symbol not in module.globals:
            function = ir.Function(module, ir.FunctionType(result, [each.type for each in arguments]), symbol)
            function.linkage = "linkonce_odr"
            function.attributes.add("noinline")
            within = type(self)(self.context, ir.IRBuilder(function.append_basic_block("entry")))
            value = body(within, *function.args)
            _ = within.builder.ret_void() if value is None else within.builder.ret(value)
        return self.builder.call(module.globals[symbol], arguments)


def compile_as(plain: Callable[..., Any], result: Any, vector_code: Callable[..., Any]) -> None:
    """Register vector code for a plain function: compiled kernels take it wherever their source calls the function.

    - plain: the function in Python, which runs without compiling.
    - result: numba type of its result.
    - vector_code: writes the code, with numba's arguments of a lowering (context, builder, signature, arguments).
    """

    def generic(_template: Any, args: Any, _keywords: Any) -> Any:
        return typed(result, *args)  # type: ignore[no-untyped-call]

    infer_global(plain)(type(f"{plain.__name__} typing", (AbstractTemplate,), {"generic": generic}))  # type: ignore[no-untyped-call]
    lower_builtin(plain, types.VarArg(types.Any))(vector_code)  # type: ignore[no-untyped-call]


def blended_product(a: FloatArray, first: int, second: int, share: float, x: FloatArray) -> float:
    """Return x.(a_first + share (a_second - a_first)): x times a row interpolated between two rows of a.

    a is (any, a multiple of eight), x has the length of a row.
    """
    return float((a[first] + share * (a[second] - a[first])) @ x)


def not_above(x: FloatArray, row: int, limit: float) -> int:
    """Return which of the eight numbers in row `row` of x are not above the limit, as bits: bit i for number i.

    x is (a multiple of eight,). A NaN is not above the limit.
    """
    return int(sum(1 << i for i, value in enumerate(x[LANES * row : LANES * (row + 1)]) if not value > limit))


def lowest_bit(bits: int) -> int:
    """Return the number, from 0, of the lowest bit of `bits` that is set. `bits` is not zero."""
    return (bits & -bits).bit_length() - 1


def square_of_farthest(a: FloatArray, b: FloatArray) -> float:
    """Return the largest squared distance between the same columns of a and b, both (2, a multiple of eight).

    A column with a NaN is left out. Without any other column the result is 0.
    """
    return float(np.fmax.reduce(np.square(a[:2] - b[:2]).sum(axis=0), initial=0.0))


def _blended_product(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    emit = Emitter(context, builder)
    a, x = emit.array(signature.args[0], args[0]), emit.array(signature.args[4], args[4])
    left, right, share = emit.line_of(a, args[1]), emit.line_of(a, args[2]), emit.in_all_lanes(args[3])
    total = cgutils.alloca_once_value(builder, emit.zero)  # type: ignore[no-untyped-call]
    builder.store(emit.zero, total)
    with cgutils.for_range(builder, emit.row_count(emit.shape(x, 0))) as loop:
        start = emit.load(left, loop.index)
        between = builder.call(emit.fma, [share, builder.fsub(emit.load(right, loop.index), start), start])
        product = builder.call(emit.fma, [between, emit.load(x.data, loop.index), builder.load(total)])
        builder.store(product, total)
    return emit.lane_sum(builder.load(total))


def _not_above(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    emit = Emitter(context, builder)
    x = emit.array(signature.args[0], args[0])
    near = builder.fcmp_unordered("<=", emit.load(x.data, args[1]), emit.in_all_lanes(args[2]))
    return builder.zext(builder.bitcast(near, ir.IntType(LANES)), emit.index)


def _lowest_bit(_context: Any, builder: Any, _signature: Any, args: Any) -> Any:
    return builder.cttz(args[0], ir.IntType(1)(0))


def _square_of_farthest(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    emit = Emitter(context, builder)
    a, b = (emit.array(kind, array) for kind, array in zip(signature.args, args, strict=True))
    one = emit.index(1)
    ends = [(a.data, b.data), (emit.line_of(a, one), emit.line_of(b, one))]
    largest = cgutils.alloca_once_value(builder, emit.zero)  # type: ignore[no-untyped-call]
    builder.store(emit.zero, largest)
    with cgutils.for_range(builder, emit.row_count(emit.shape(a, 1))) as loop:
        x, y = (builder.fsub(emit.load(p, loop.index), emit.load(q, loop.index)) for p, q in ends)
        square = builder.fadd(builder.fmul(x, x), builder.fmul(y, y))
        so_far = builder.load(largest)
        builder.store(builder.select(builder.fcmp_ordered(">", square, so_far), square, so_far), largest)
    lanes = [builder.extract_element(builder.load(largest), ir.IntType(32)(i)) for i in range(LANES)]
    while len(lanes) > 1:
        p, q, *rest = lanes
        lanes = [*rest, builder.select(builder.fcmp_ordered(">", p, q), p, q)]
    return lanes[0]


compile_as(blended_product, types.float64, _blended_product)
compile_as(not_above, types.int64, _not_above)
compile_as(lowest_bit, types.int64, _lowest_bit)
compile_as(square_of_farthest, types.float64, _square_of_farthest)
