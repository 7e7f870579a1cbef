"""Sums of products over rows of eight numbers, the solver's inner loops, written for vector registers.

Each function stands twice, as plain Python and in vector code (`vector_kernels`). Both take C-contiguous arrays of
float64 of any shape, read as rows of eight or as single numbers. Products are fused with the sums. A line describes one
sum of products: which rows of entries are multiplied with which part of a vector, and where the sums go.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core import cgutils

from rubgen.arrays import FloatArray, IntArray
from rubgen.linalg.vector_kernels import LANES, Emitter, compile_as

MOST_ROWS = 6
"""Rows of results that one line may give: they share each load of x."""
CHAINS = 4
"""Independent partial sums that keep a processor busy: a fused product takes about four cycles, and two may start in
each. One or two rows have so many sums in all. Three or more rows have one sum each."""
TOGETHER = 4
"""How many vectors `dot_lines_each` takes: with `MOST_ROWS` their sums fill most of 32 vector registers."""
KIND, ROW, FIRST, START, COUNT = range(5)
"""A line: its kind; the first row of results; the first of its rows of entries; the first row or number of x; how
many. See `line_kind`."""


def line_kind(rows: int, *, scaled: bool) -> int:
    """Return the number at KIND of a line with `rows` rows of results, 1 to `MOST_ROWS`.

    With `scaled` the entries are multiplied with single numbers of x, else with rows of eight.
    """
    return 2 * (rows - 1) + int(scaled)


def line_sum(line: IntArray, a: FloatArray, x: FloatArray) -> FloatArray:
    """Return the rows of results (rows, 8) of one line, with the entries `a` (any, 8) and the vector `x`.

    Row r is the sum over j < COUNT of a[FIRST + j rows + r] times x_(START + j). x_i is row i of x in rows of eight,
    and for a scaled line the single number i of x.
    """
    rows, scaled = line[KIND] // 2 + 1, line[KIND] % 2
    entries = a.reshape(-1, LANES)[line[FIRST] : line[FIRST] + rows * line[COUNT]].reshape(-1, rows, LANES)
    part = slice(line[START], line[START] + line[COUNT])
    factors = x.reshape(-1)[part, None] if scaled else x.reshape(-1, LANES)[part]
    return np.asarray((entries * factors[:, None]).sum(axis=0))


def _results(line: IntArray) -> slice:
    return slice(line[ROW], line[ROW] + line[KIND] // 2 + 1)


def add_lines(lines: IntArray, a: FloatArray, x: FloatArray, out: FloatArray) -> None:
    """Add the sums of each line to its rows of `out`.

    `lines` is (any, 5), `a` (any, 8) are the entries, `x` the vector.
    """
    for line in lines:
        out.reshape(-1, LANES)[_results(line)] += line_sum(line, a, x)


def set_two_lines(
    lines: IntArray, a: FloatArray, b: FloatArray, x: FloatArray, y: FloatArray, base: FloatArray, out: FloatArray
) -> None:
    """Set each row of `out` to the same row of `base` plus the sums of a with x and of b with y along the same lines.

    `lines` (any, 5) contain each row of results once; `a` and `b` (any, 8) are entries.
    """
    for line in lines:
        row = _results(line)
        out.reshape(-1, LANES)[row] = base.reshape(-1, LANES)[row] + (line_sum(line, a, x) + line_sum(line, b, y))


def gather_lines(
    lines: IntArray, a: FloatArray, z: FloatArray, places: IntArray, first: int, second: int, out: FloatArray
) -> None:
    """Write each line's sums with the numbers of z at `places[c]` into its rows of `out[c]`.

    c is `first`, then `second`; both share each load of a. `lines` (any, 5) must be scaled; their START and COUNT count
    along `places[c]`. `a` (any, 8) are the entries, `places` (vectors, any) indices in z. `out` is (vectors, a multiple
    of eight).
    """
    for line in lines:
        for c in (first, second):
            out[c].reshape(-1, LANES)[_results(line)] = line_sum(line, a, z[places[c]])


def dot_lines(lines: IntArray, a: FloatArray, x: FloatArray, left: FloatArray) -> float:
    """Return left^T (matrix x): the sum of the products of each line's sums with its rows of `left`.

    `lines` is (any, 5), `a` (any, 8) are the entries, `x` and `left` the vectors.
    """
    return sum(float((line_sum(line, a, x) * left.reshape(-1, LANES)[_results(line)]).sum()) for line in lines)


def dot_lines_each(lines: IntArray, a: FloatArray, x: FloatArray, left: FloatArray, out: FloatArray) -> None:
    """Write left[i]^T (matrix x[i]) into `out[i]`, as `dot_lines`, for i < TOGETHER; all share each load of a.

    `lines` is (any, 5), `a` (any, 8) are the entries. x and left are (TOGETHER, a multiple of eight), `out` is
    (TOGETHER,).
    """
    for i in range(TOGETHER):
        out[i] = dot_lines(lines, a, x[i], left[i])


def dot_rows(a: FloatArray, b: FloatArray, count: int) -> float:
    """Return the sum of the products of the first `count` rows of eight of a and b."""
    return float(a.reshape(-1)[: LANES * count] @ b.reshape(-1)[: LANES * count])


def dot_pairs(pairs: FloatArray, left: FloatArray, right: FloatArray) -> float:
    """Return left^T matrix right for the sum of a b^T - b a^T over `pairs` (any, 2, a multiple of eight) of a, b."""
    return sum(float((a @ left) * (b @ right) - (b @ left) * (a @ right)) for a, b in pairs)


Source = tuple[Any, Any]
"""Entries a and x."""
Factors = Callable[[Any], list[Any]]
"""Takes a place, returns what each source has there, in all lanes or as a row of eight."""


class _Emitter(Emitter):
    """Writes sums of products along lines."""

    def sum_products(
        self, sources: list[Source], first: Any, start: Any, count: Any, *, rows: int, broadcast: bool
    ) -> list[Any]:
        """Return for each row the sum over sources and j < count of a[first + j rows + row] x[start + j].

        Each row has as many partial sums as fill `CHAINS`, the sources' apart.
        """
        builder = self.builder
        together = max(1, CHAINS // (rows * len(sources)))
        sums = [
            [cgutils.alloca_once_value(builder, self.zero) for _ in range(together * len(sources))]  # type: ignore[no-untyped-call]
            for _ in range(rows)
        ]
        for total in [total for row in sums for total in row]:
            builder.store(self.zero, total)
        step = self.index(together)
        whole = builder.mul(builder.udiv(count, step), step)
        with cgutils.for_range_slice(builder, self.index(0), whole, step) as (j, _):
            for u in range(together):
                place = builder.add(j, self.index(u))
                self._add(sources, first, start, place, [row[u * len(sources) :] for row in sums], broadcast=broadcast)
        if together > 1:
            with cgutils.for_range_slice(builder, whole, count, self.index(1)) as (j, _):
                self._add(sources, first, start, j, sums, broadcast=broadcast)
        return [self._halves([builder.load(each) for each in row]) for row in sums]

    def _add(
        self, sources: list[Source], first: Any, start: Any, j: Any, sums: list[list[Any]], *, broadcast: bool
    ) -> None:
        builder, rows = self.builder, len(sums)
        base, place = builder.add(first, builder.mul(j, self.index(rows))), builder.add(start, j)
        for i, (a, x) in enumerate(sources):
            right = self.broadcast(x, place) if broadcast else self.load(x, place)
            for row in range(rows):
                left = self.load(a, builder.add(base, self.index(row)))
                total = sums[row][i]
                builder.store(builder.call(self.fma, [left, right, builder.load(total)]), total)

    def _halves(self, parts: list[Any]) -> Any:
        """Return the sum of one, two or four parts."""
        while len(parts) > 1:
            parts = [self.builder.fadd(*parts[i : i + 2]) for i in range(0, len(parts), 2)]
        return parts[0]

    def sum_shared(self, a: Any, factors: Factors, sources: int, line: list[Any], rows: int) -> list[list[Any]]:
        """Return for each source and each row the sum over j < COUNT of a[FIRST + j rows + row] factor[START + j].

        `factors` returns the factor of each of the `sources` at a place: one number in all lanes, or a row of eight.
        All sources share each load of a.
        """
        builder = self.builder
        sums = [[cgutils.alloca_once_value(builder, self.zero) for _ in range(rows)] for _ in range(sources)]  # type: ignore[no-untyped-call]
        for total in [total for each in sums for total in each]:
            builder.store(self.zero, total)
        with cgutils.for_range(builder, line[COUNT]) as loop:
            base = builder.add(line[FIRST], builder.mul(loop.index, self.index(rows)))
            right = factors(builder.add(line[START], loop.index))
            for row in range(rows):
                left = self.load(a, builder.add(base, self.index(row)))
                for number, each in zip(right, sums, strict=True):
                    total = builder.call(self.fma, [left, number, builder.load(each[row])])
                    builder.store(total, each[row])
        return [[builder.load(total) for total in each] for each in sums]

    def sum_crossed(self, a: Any, firsts: list[Any], vectors: list[Any], rows: Any) -> list[list[Any]]:
        """Return for each of `firsts` and each of `vectors` the sum of the products of a's rows and the vector's.

        They are `rows` rows of eight: of a from row `first` on, of the vector from its start. A sum is one number.
        """
        builder = self.builder
        sums = [[cgutils.alloca_once_value(builder, self.zero) for _ in vectors] for _ in firsts]  # type: ignore[no-untyped-call]
        for total in [total for each in sums for total in each]:
            builder.store(self.zero, total)
        with cgutils.for_range(builder, rows) as loop:
            right = [self.load(vector, loop.index) for vector in vectors]
            for first, each in zip(firsts, sums, strict=True):
                left = self.load(a, builder.add(first, loop.index))
                for number, total in zip(right, each, strict=True):
                    builder.store(builder.call(self.fma, [left, number, builder.load(total)]), total)
        return [[self.lane_sum(builder.load(total)) for total in each] for each in sums]


Visit = Callable[[list[Any], int, bool], None]
"""Takes the five numbers of a line, how many rows of results it has, and whether it is scaled."""


def _summed(emit: _Emitter, sources: list[Source], use: Callable[[Any, Any], None]) -> Visit:
    """Return a visit that passes each row of results of a line, with the sum over the sources there, to `use`."""

    def visit(line: list[Any], rows: int, broadcast: bool) -> None:
        totals = emit.sum_products(sources, line[FIRST], line[START], line[COUNT], rows=rows, broadcast=broadcast)
        for row, total in enumerate(totals):
            use(emit.builder.add(line[ROW], emit.index(row)), total)

    return visit


def _each_line(emit: _Emitter, lines: Any, count: Any, visit: Visit) -> None:
    """Loop over `count` lines, with code of its own for each kind."""
    builder, index = emit.builder, emit.index
    with cgutils.for_range(builder, count) as loop:
        line = [
            builder.load(builder.gep(lines, [builder.add(builder.mul(loop.index, index(5)), index(i))]))
            for i in range(5)
        ]
        done = builder.append_basic_block("line.done")
        switch = builder.switch(line[KIND], done)
        for rows in range(1, MOST_ROWS + 1):
            for broadcast in (False, True):
                case = builder.append_basic_block("line.kind")
                switch.add_case(index(line_kind(rows, scaled=broadcast)), case)
                builder.position_at_end(case)
                visit(line, rows, broadcast)
                builder.branch(done)
        builder.position_at_end(done)


def _add_lines(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the vector code of `add_lines`."""
    caller = _Emitter(context, builder)
    lines, a, x, out = (caller.array(kind, array) for kind, array in zip(signature.args, args, strict=True))

    def body(emit: _Emitter, lines: Any, count: Any, a: Any, x: Any, out: Any) -> None:
        def add(row: Any, total: Any) -> None:
            emit.store(emit.builder.fadd(emit.load(out, row), total), out, row)

        _each_line(emit, lines, count, _summed(emit, [(a, x)], add))

    caller.call("add_lines", ir.VoidType(), body, lines.data, caller.shape(lines, 0), a.data, x.data, out.data)
    return context.get_dummy_value()


def _set_two_lines(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the vector code of `set_two_lines`."""
    caller = _Emitter(context, builder)
    lines, *others = (caller.array(kind, array) for kind, array in zip(signature.args, args, strict=True))

    def body(emit: _Emitter, lines: Any, count: Any, a: Any, b: Any, x: Any, y: Any, base: Any, out: Any) -> None:
        def place(row: Any, total: Any) -> None:
            emit.store(emit.builder.fadd(emit.load(base, row), total), out, row)

        _each_line(emit, lines, count, _summed(emit, [(a, x), (b, y)], place))

    caller.call(
        "set_two_lines", ir.VoidType(), body, lines.data, caller.shape(lines, 0), *[each.data for each in others]
    )
    return context.get_dummy_value()


def _gather_lines(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the vector code of `gather_lines`."""
    caller, chosen = _Emitter(context, builder), args[4:6]
    arrays = [(kind, array) for kind, array in zip(signature.args, args, strict=True) if isinstance(kind, types.Array)]
    lines, a, z, places, out = (caller.array(kind, array) for kind, array in arrays)

    def body(emit: _Emitter, lines: Any, count: Any, a: Any, z: Any, *ends: Any) -> None:
        numbers, outputs = list(ends[:2]), ends[2:]

        def gathered(place: Any) -> list[Any]:
            return [emit.broadcast(z, emit.builder.load(emit.builder.gep(each, [place]))) for each in numbers]

        def visit(line: list[Any], rows: int, broadcast: bool) -> None:
            if broadcast:
                sums = emit.sum_shared(a, gathered, len(numbers), line, rows)
                for output, totals in zip(outputs, sums, strict=True):
                    for row, total in enumerate(totals):
                        emit.store(total, output, emit.builder.add(line[ROW], emit.index(row)))

        _each_line(emit, lines, count, visit)

    ends = [caller.line_of(array, c) for array in (places, out) for c in chosen]
    caller.call("gather_lines", ir.VoidType(), body, lines.data, caller.shape(lines, 0), a.data, z.data, *ends)
    return context.get_dummy_value()


def _dot_lines(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the vector code of `dot_lines`."""
    caller = _Emitter(context, builder)
    lines, a, x, left = (caller.array(kind, array) for kind, array in zip(signature.args, args, strict=True))

    def body(emit: _Emitter, lines: Any, count: Any, a: Any, x: Any, left: Any) -> Any:
        builder = emit.builder
        sums = cgutils.alloca_once(builder, emit.vector)  # type: ignore[no-untyped-call]
        builder.store(emit.zero, sums)

        def add(row: Any, total: Any) -> None:
            builder.store(builder.call(emit.fma, [emit.load(left, row), total, builder.load(sums)]), sums)

        _each_line(emit, lines, count, _summed(emit, [(a, x)], add))
        return emit.lane_sum(builder.load(sums))

    return caller.call(
        "dot_lines", ir.DoubleType(), body, lines.data, caller.shape(lines, 0), a.data, x.data, left.data
    )


def _dot_lines_each(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the vector code of `dot_lines_each`."""
    caller = _Emitter(context, builder)
    lines, a, x, left, out = (caller.array(kind, array) for kind, array in zip(signature.args, args, strict=True))

    def body(emit: _Emitter, lines: Any, count: Any, a: Any, out: Any, *vectors: Any) -> None:
        builder, rights, lefts = emit.builder, vectors[:TOGETHER], vectors[TOGETHER:]
        sums = [cgutils.alloca_once_value(builder, emit.zero) for _ in rights]  # type: ignore[no-untyped-call]

        def visit(line: list[Any], rows: int, broadcast: bool) -> None:
            def factors(place: Any) -> list[Any]:
                return [emit.broadcast(each, place) if broadcast else emit.load(each, place) for each in rights]

            shared = emit.sum_shared(a, factors, TOGETHER, line, rows)
            for total, vector, totals in zip(sums, lefts, shared, strict=True):
                for row, part in enumerate(totals):
                    own = emit.load(vector, builder.add(line[ROW], emit.index(row)))
                    builder.store(builder.call(emit.fma, [own, part, builder.load(total)]), total)

        _each_line(emit, lines, count, visit)
        for i, total in enumerate(sums):
            builder.store(emit.lane_sum(builder.load(total)), builder.gep(out, [emit.index(i)]))

    vectors = [caller.line_of(array, caller.index(i)) for array in (x, left) for i in range(TOGETHER)]
    caller.call("dot_lines_each", ir.VoidType(), body, lines.data, caller.shape(lines, 0), a.data, out.data, *vectors)
    return context.get_dummy_value()


def _dot_rows(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the vector code of `dot_rows`."""
    emit = _Emitter(context, builder)
    a, b = (emit.array(kind, array).data for kind, array in zip(signature.args[:2], args[:2], strict=True))
    none = emit.index(0)
    (total,) = emit.sum_products([(a, b)], none, none, args[2], rows=1, broadcast=False)
    return emit.lane_sum(total)


def _dot_pairs(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Write the vector code of `dot_pairs`."""
    caller = _Emitter(context, builder)
    pairs, left, right = (caller.array(kind, array) for kind, array in zip(signature.args, args, strict=True))

    def body(emit: _Emitter, pairs: Any, count: Any, rows: Any, left: Any, right: Any) -> Any:
        builder, double = emit.builder, ir.DoubleType()
        total = cgutils.alloca_once_value(builder, ir.Constant(double, 0.0))  # type: ignore[no-untyped-call]
        builder.store(ir.Constant(double, 0.0), total)
        with cgutils.for_range(builder, count) as loop:
            first = builder.mul(builder.add(loop.index, loop.index), rows)
            (al, ar), (bl, br) = emit.sum_crossed(pairs, [first, builder.add(first, rows)], [left, right], rows)
            part = builder.fsub(builder.fmul(al, br), builder.fmul(bl, ar))
            builder.store(builder.fadd(builder.load(total), part), total)
        return builder.load(total)

    return caller.call(
        "dot_pairs", ir.DoubleType(), body, pairs.data, caller.shape(pairs, 0),
        caller.row_count(caller.shape(pairs, 2)), left.data, right.data,
    )  # fmt: skip


compile_as(add_lines, types.void, _add_lines)
compile_as(set_two_lines, types.void, _set_two_lines)
compile_as(gather_lines, types.void, _gather_lines)
compile_as(dot_lines, types.float64, _dot_lines)
compile_as(dot_lines_each, types.void, _dot_lines_each)
compile_as(dot_pairs, types.float64, _dot_pairs)
compile_as(dot_rows, types.float64, _dot_rows)
