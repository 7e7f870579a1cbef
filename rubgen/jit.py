"""The one decorator for compiled kernels.

Numba's on-disk cache looks at the file of the compiled function alone and misses a change in a kernel that it calls
from another file. The cache therefore lives in a folder that is named after a hash of every kernel source of rubgen.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import numba

from rubgen.cache_root import cache_root

P = ParamSpec("P")
R = TypeVar("R")


@cache
def kernel_cache_dir() -> Path:
    """Folder of the compiled kernels: `cache_root()`, `kernels`, then a hash of numba's version and kernel sources."""
    root = Path(__file__).parent
    digest = hashlib.sha256(numba.__version__.encode())
    for source in [*sorted(root.rglob("*_kernels.py")), Path(__file__)]:
        digest.update(source.relative_to(root).as_posix().encode())
        digest.update(source.read_bytes())
    return cache_root() / "kernels" / digest.hexdigest()[:16]


def kernels_are_compiled() -> bool:
    """Whether kernels of this code were compiled before: a run need not wait for the compiler."""
    config: Any = numba.config
    return bool(config.DISABLE_JIT) or any(kernel_cache_dir().rglob("*.nbi"))


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile `function` with numba, without the GIL, without fastmath, cached in `kernel_cache_dir()`.

    Kernels live in files named `*_kernels.py`, take arrays and scalars only, and never raise (a division by zero gives
    inf or NaN). `NUMBA_DISABLE_JIT=1` runs them as plain Python.
    """
    return _compiled(function)


def allocation_free_kernel(function: Callable[P, R]) -> Callable[P, R]:
    """A `kernel` for inner loops that allocates nothing: one that does fails to compile.

    Without allocation numba need not count references, which cost a third of a step of the solver where arrays come in
    named tuples.
    """
    return _compiled(function, _nrt=False)


def inlined_kernel(function: Callable[P, R]) -> Callable[P, R]:
    """An `allocation_free_kernel` that is put into its callers.

    A call passes every field of every named tuple, 100 to 300 words, which costs more than a short kernel itself.
    """
    return _compiled(function, _nrt=False, forceinline=True)


def _compiled(function: Callable[P, R], **options: bool) -> Callable[P, R]:
    config: Any = numba.config
    njit: Any = numba.njit
    previous = config.CACHE_DIR
    config.CACHE_DIR = str(kernel_cache_dir())
    try:
        return cast("Callable[P, R]", njit(cache=True, nogil=True, error_model="numpy", **options)(function))
    finally:
        config.CACHE_DIR = previous
