"""Matrices that fall into blocks, stored so that they are read in rows of eight numbers.

They act on z: the blade tips as harmonics over the blades (nodal diameters), the other coordinates as they are,
arranged block by block (`linalg.blocks`).
"""

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.jit import allocation_free_kernel, inlined_kernel
from rubgen.linalg.lanes_kernels import add_lines, dot_lines, dot_lines_each


class Product(NamedTuple):
    """A matrix in blocks, for products with z: `lines` (any, 5) and `entries` (any, 8).

    Each line describes up to six rows of eight results: see `lanes_kernels`.
    """

    lines: IntArray
    entries: FloatArray


@inlined_kernel
def multiply(product: Product, z: FloatArray, out: FloatArray) -> None:
    """Add matrix times z to `out`: out += matrix z.

    `z` and `out` are in the order of blocks, padded to rows of eight.
    """
    add_lines(product.lines, product.entries, z, out)


@inlined_kernel
def quadratic(product: Product, left: FloatArray, right: FloatArray) -> float:
    """Return left^T matrix right, with `left` and `right` in the order of blocks as z."""
    total: float = dot_lines(product.lines, product.entries, right, left)
    return total


@inlined_kernel
def quadratic_each(product: Product, left: FloatArray, right: FloatArray, out: FloatArray) -> None:
    """Write left_i^T matrix right_i into `out[i]`, for lines i < TOGETHER of `left` and `right`."""
    dot_lines_each(product.lines, product.entries, right, left, out)


@allocation_free_kernel
def bilinear(product: Product, left: FloatArray, right: FloatArray) -> float:
    """Return left^T matrix right. It is `quadratic` for callers outside of kernels."""
    return quadratic(product, left, right)
