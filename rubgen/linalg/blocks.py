"""Find the blocks into which a system's matrices fall, and store matrices block by block for kernels.

Equal blades couple only within one nodal diameter, so harmonics over the blades divide the blisk into small blocks.
Nothing is assumed: the blocks are the sets of coordinates that the matrices connect. Mistuned blades make one large
block, with the same code. q are physical coordinates, y the same with the tips as harmonics, z is y in the order of the
blocks, padded to rows of eight.
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.sparse.csgraph import connected_components

from rubgen.arrays import BoolArray, FloatArray, IntArray
from rubgen.linalg.block_kernels import Product
from rubgen.linalg.harmonic_kernels import Harmonics
from rubgen.linalg.lanes_kernels import COUNT, FIRST, KIND, MOST_ROWS, line_kind
from rubgen.linalg.vector_kernels import LANES

COUPLING_TOLERANCE = 1e-9
"""An entry couples when it exceeds this share of `scale_of`. Rounding of the reduction is 1e-12 to 1e-10 between nodal
diameters; a mistuned blade couples far above."""

ROUNDING = 1e-14
"""Entries up to this share of `scale_of` are rounding in a matrix of differences, such as K - K^T."""


def aligned(array: FloatArray) -> FloatArray:
    """Return a copy of an array that begins at a cache line.

    Rows of eight across two cache lines would load half as fast.
    """
    buffer = np.zeros(array.size + LANES)
    start = (-buffer.ctypes.data // 8) % LANES
    out = buffer[start : start + array.size].reshape(array.shape)
    out[...] = array
    return out


def padded(size: int) -> int:
    """Round `size` up to a multiple of eight."""
    return -(-size // LANES) * LANES


@lru_cache(maxsize=8)
def blade_harmonics(blades: int) -> FloatArray:
    """Return orthonormal real harmonics (blades, blades) over the blade number k, one harmonic in each column.

    The columns are 1, cos, sin, cos 2, sin 2, ..., and for an even number of blades (-1)^k, each normalised. The array
    is read-only.
    """
    k = np.arange(blades)
    columns = [np.ones(blades) / np.sqrt(blades)]
    for d in range(1, (blades + 1) // 2):
        columns += [np.sqrt(2 / blades) * wave(2 * np.pi * ((d * k) % blades) / blades) for wave in (np.cos, np.sin)]
    if blades % 2 == 0:
        columns.append((-1.0) ** k / np.sqrt(blades))
    harmonics = np.stack(columns, axis=1)
    harmonics.setflags(write=False)
    return harmonics


def coupled(matrix: FloatArray) -> BoolArray:
    """Return which entries (n, n) of a matrix couple two coordinates.

    An entry couples if it exceeds COUPLING_TOLERANCE times `scale_of`. Smaller entries are rounding.
    """
    return np.asarray(np.abs(matrix) > COUPLING_TOLERANCE * scale_of(matrix))


def scale_of(matrix: FloatArray) -> FloatArray:
    """Return the scale (n, n) relative to which an entry of a matrix is small.

    For entry (i, j) it is sqrt(m_i m_j), with m_i the largest size of an entry in row i or column i.
    """
    size = np.abs(matrix)
    scale = np.sqrt(np.maximum(size.max(axis=0), size.max(axis=1)))
    return np.asarray(np.multiply.outer(scale, scale))


@dataclass(frozen=True)
class Blocks:
    """The blocks of a system, and the index of each coordinate in z."""

    transform: FloatArray
    """T (n, n), orthonormal, q = T y."""
    lanes: list[IntArray]
    """Arrays (8, m) of the coordinates of up to eight blocks of one size, -1 without a block. Coordinate i of all eight
    is one row of z."""
    single: list[IntArray]
    """Arrays (m,) of the coordinates of one block, which follow one another in z."""
    place: IntArray
    """Index in z of each y (n,)."""
    rows: int
    """Number of rows of eight in z."""

    def product(self, matrix: FloatArray) -> Product:
        """Store a matrix (n, n) of the coordinates q in blocks, for products in kernels.

        Entries between blocks are dropped.
        """
        return self._packed(self.transform.T @ matrix @ self.transform, triangle=False)

    def without_zeros(self, matrix: FloatArray, like: FloatArray) -> Product:
        """Store a matrix as `product` does, but with rounding set to 0, and without lines that have only zeros.

        A line is one sum of products of a kernel (`lanes_kernels`).

        - matrix (n, n): in the coordinates q.
        - like (n, n): the matrix, such as K, from whose entries `matrix` was computed. Entries of `matrix` up to
          ROUNDING times its `scale_of` are rounding. They are compared with the tips as harmonics.
        """
        Y = self.transform.T @ matrix @ self.transform
        size = ROUNDING * scale_of(self.transform.T @ like @ self.transform)
        product = self._packed(np.where(np.abs(Y) > size, Y, 0.0), triangle=False)
        used = zip(product.lines[:, FIRST], entry_rows(product.lines), strict=True)
        kept = [bool(product.entries[first : first + rows].any()) for first, rows in used]
        return Product(np.ascontiguousarray(product.lines[kept]), product.entries)

    def skew_pairs(self, matrix: FloatArray, like: FloatArray, most: int) -> FloatArray | None:
        """Divide a skew-symmetric matrix into pairs of vectors a, b: the matrix is the sum of a b^T - b a^T.

        - matrix (n, n): in the coordinates q. Its symmetric part is ignored.
        - like (n, n): the matrix, such as K, from whose entries `matrix` was computed. Entries up to ROUNDING times its
          `scale_of` count as zero.
        - most: largest number of pairs.

        Returns the vectors (pairs, 2, 8 rows) in the order of z, or None if `most` pairs are not enough. Each pair
        clears the two rows and columns of the largest entry that is left, relative to the scale of `like`.
        """
        left = self.transform.T @ matrix @ self.transform
        left = (left - left.T) / 2
        size = ROUNDING * scale_of(self.transform.T @ like @ self.transform)
        pairs: list[list[FloatArray]] = []
        while (large := np.abs(left) > size).any():
            if len(pairs) == most:
                return None
            i, j = np.unravel_index(np.argmax(np.divide(np.abs(left), size, where=large, out=0 * size)), left.shape)
            a, b = left[:, i] / left[i, j], left[:, j]
            pairs.append([self.vector(a), self.vector(b)])
            left = left - (np.outer(a, b) - np.outer(b, a))
        return aligned(np.array(pairs).reshape(-1, 2, self.rows * LANES))

    def damping(self, matrix: FloatArray, *, whole: bool = False) -> Product:
        """Store a damping matrix C as a triangle, so that a kernel computes d^T C d as 2 d^T (triangle d).

        The triangle is the lower triangle of the symmetric part of C with half its diagonal, for vectors d in the order
        of z.

        - matrix (n, n): C, in the coordinates q.
        - whole: store all entries of the triangle. Without it, blocks that are stored side by side lack the entries
          between coordinates that the symmetric part does not connect (`coupled`): these are 0 or rounding. Coriolis
          forces couple more coordinates within a block than dampers do.
        """
        Y = self.transform.T @ matrix @ self.transform
        Y = (Y + Y.T) / 2
        order = np.argsort(self.place)
        lower = np.zeros_like(Y)
        ordered = Y[np.ix_(order, order)]
        lower[np.ix_(order, order)] = np.tril(ordered, -1) + np.diag(np.diag(ordered)) / 2
        return self._packed(lower, triangle=True, coupling=np.ones_like(Y, dtype=bool) if whole else coupled(Y))

    def connected(self, coordinates: IntArray) -> IntArray:
        """Return the indices of all coordinates of y in the blocks that contain any of the `coordinates`, sorted."""
        blocks = [block for bundle in self.lanes for block in bundle] + self.single
        found = [block[block >= 0] for block in blocks if np.isin(block, coordinates).any()]
        return np.sort(np.concatenate(found))

    def vector(self, y: FloatArray) -> FloatArray:
        """Return y (n,) as z: in the order of the blocks, with zeros as padding."""
        z = np.zeros(self.rows * LANES)
        z[self.place] = y
        return aligned(z)

    def to_z(self, q: FloatArray) -> FloatArray:
        """Return physical coordinates q (n,) as z."""
        return self.vector(self.transform.T @ q)

    def to_q(self, z: FloatArray) -> FloatArray:
        """Return z as physical coordinates q (n,)."""
        return np.asarray(self.transform @ z[self.place])

    def _packed(self, Y: FloatArray, *, triangle: bool, coupling: BoolArray | None = None) -> Product:
        """Return lines and entries of a matrix in y. A triangle has only the columns up to its rows of results.

        In blocks side by side only the entries of a triangle that `coupling` (n, n) connects.
        """
        lines: list[tuple[int, int, int, int, int]] = []
        entries: list[FloatArray] = []
        row = 0
        for bundle in self.lanes:
            size = bundle.shape[1]
            parts = [(part, slice(0, size)) for part in parts_of(size)]
            if coupling is not None:
                parts = _triangle_parts(_coupling_of(bundle, coupling))
            for part, columns in parts:
                left, right = bundle[:, None, part], bundle[:, columns, None]
                block = np.where(left >= 0, Y[left, right], 0.0)
                _append(lines, entries, (0, row + part.start, row + columns.start), block.transpose(1, 2, 0))
            row += size
        for block_of in self.single:
            size = len(block_of)
            rows = padded(size) // LANES
            Z = np.zeros((rows * LANES, size))
            Z[:size] = Y[np.ix_(block_of, block_of)]
            for part in parts_of(rows):
                count = min(part.stop * LANES, size) if triangle else size
                block = Z[part.start * LANES : part.stop * LANES, :count]
                _append(lines, entries, (1, row + part.start, row * LANES), block.T.reshape(count, -1, LANES))
            row += rows
        table = np.array(lines, dtype=np.int64).reshape(-1, 5)
        return Product(table, aligned(np.concatenate([np.zeros((0, LANES)), *entries])))


def entry_rows(lines: IntArray) -> IntArray:
    """Return how many rows of eight entries each line (any, 5) reads."""
    return np.asarray(lines[:, COUNT] * (lines[:, KIND] // 2 + 1))


def parts_of(rows: int) -> list[slice]:
    """Divide `rows` rows of results, 1 or more, into parts of nearly equal size, none larger than MOST_ROWS.

    Return the parts as slices.
    """
    count = -(-rows // MOST_ROWS)
    ends = [part * (rows // count) + min(part, rows % count) for part in range(count + 1)]
    return [slice(start, end) for start, end in pairwise(ends)]


def _coupling_of(bundle: IntArray, coupling: BoolArray) -> BoolArray:
    """Return which coordinates (m, m) of a bundle any of its blocks couples."""
    used = bundle[bundle[:, 0] >= 0]
    return np.asarray(np.any([coupling[np.ix_(block, block)] for block in used], axis=0))


def _triangle_parts(coupling: BoolArray) -> list[tuple[slice, slice]]:
    """Return rows and columns of the lower triangle (m, m) in blocks that cover all connected entries.

    A connected set consists of runs of neighbours. Each run makes a block with itself and with each run of the set
    before it.
    """
    label = connected_components(coupling | coupling.T, directed=False)[1]
    ends = [*(np.flatnonzero(np.diff(label)) + 1).tolist(), len(label)]
    runs = [slice(start, end) for start, end in zip([0, *ends], ends, strict=False)]
    blocks = []
    for i, run in enumerate(runs):
        for part in parts_of(run.stop - run.start):
            rows = slice(run.start + part.start, run.start + part.stop)
            before = [other for other in runs[:i] if label[other.start] == label[run.start]]
            blocks += [(rows, columns) for columns in [*before, slice(run.start, rows.stop)]]
    return blocks


def _append(
    lines: list[tuple[int, int, int, int, int]],
    entries: list[FloatArray],
    place: tuple[int, int, int],
    part: FloatArray,
) -> None:
    """Add a line with entries (count, rows, 8); `place` is whether it is scaled, its ROW and its START."""
    (scaled, row, start), (count, rows, _) = place, part.shape
    lines.append((line_kind(rows, scaled=bool(scaled)), row, sum(map(len, entries)), start, count))
    entries.append(part.reshape(-1, LANES))


def find_blocks(matrices: list[FloatArray], blades: int) -> Blocks:
    """Find the blocks of coordinates of a system. No entry of any of the `matrices` (n, n) couples two blocks.

    The first 3 `blades` coordinates are the tips, three for each blade. They are first changed to harmonics over the
    blades: equal blades then couple only within one nodal diameter. Blocks are the connected components of the entries
    that `coupled` finds. If that saves work, up to eight blocks of equal size are stored side by side, so that a kernel
    computes them at once. Mistuned blades make one large block.
    """
    n = len(matrices[0])
    T = np.eye(n)
    for a in range(3):
        tips = np.arange(a, 3 * blades, 3)
        T[np.ix_(tips, tips)] = blade_harmonics(blades) if blades else 0
    adjacent = np.any([coupled(T.T @ matrix @ T) for matrix in matrices], axis=0)
    count, label = connected_components(adjacent, directed=False)
    parts = [np.flatnonzero(label == i) for i in range(count)]
    lanes, single = _arranged(parts)
    place, row = np.zeros(n, dtype=np.int64), 0
    for bundle in lanes:
        lane, i = np.nonzero(bundle >= 0)
        place[bundle[lane, i]] = (row + i) * LANES + lane
        row += bundle.shape[1]
    for block in single:
        place[block] = row * LANES + np.arange(len(block))
        row += padded(len(block)) // LANES
    return Blocks(T, lanes, single, place, row)


def _arranged(parts: list[IntArray]) -> tuple[list[IntArray], list[IntArray]]:
    """Lay blocks of one size side by side in lanes where this is less work than one by one."""
    lanes: list[IntArray] = []
    single: list[IntArray] = []
    for size in sorted({len(part) for part in parts}, reverse=True):
        alike = [part for part in parts if len(part) == size]
        bundles = -(-len(alike) // LANES)
        if bundles * size > len(alike) * -(-size // LANES):
            single += alike
            continue
        for first in range(0, len(alike), LANES):
            bundle = np.full((LANES, size), -1, dtype=np.int64)
            for lane, part in enumerate(alike[first : first + LANES]):
                bundle[lane] = part
            lanes.append(bundle)
    return lanes, single


def half_turn(blades: int) -> int:
    """Return the number of blades whose sums over the harmonics determine all tips: half of an even number, else all.

    Harmonics of an even number of blades keep or change their sign after half a turn.
    """
    return blades // 2 if blades % 2 == 0 else blades


def share_width(blades: int) -> int:
    """Return the number of scratch values that `recover_tips` needs for each tip coordinate."""
    half = half_turn(blades)
    return blades // half * padded(half)


def system_harmonics(blocks: Blocks, blades: int) -> Harmonics:
    """Make the constants with which kernels compute blade tips from z.

    `blades` is the number of blades, equally spaced.
    """
    width, n, half = padded(blades), len(blocks.place), half_turn(blades)
    order = np.arange(blades)
    if half < blades:  # those of even nodal diameters first
        order = np.argsort((order + 1) // 2 % 2, kind="stable")
    basis = np.zeros((blades, width))
    basis[:, :blades] = blade_harmonics(blades)[:, order]
    places = np.zeros((3, width), dtype=np.int64)
    places[:, :blades] = blocks.place[: 3 * blades].reshape(blades, 3)[order].T
    rows = padded(half) // LANES
    lines: list[tuple[int, int, int, int, int]] = []
    entries: list[FloatArray] = []
    for part in parts_of(rows):
        for first in range(0, blades, half):
            block = np.zeros((rows * LANES, half))
            block[:half] = basis[:half, first : first + half]
            block = block[part.start * LANES : part.stop * LANES]
            _append(lines, entries, (1, first // half * rows + part.start, first), block.T.reshape(half, -1, LANES))
    return Harmonics(
        aligned(basis),
        aligned(np.concatenate(entries)),
        np.array(lines, dtype=np.int64),
        places,
        blocks.place[3 * blades : n].copy(),
    )
