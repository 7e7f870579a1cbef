"""Keep BLAS to one thread: more threads split sums otherwise, and change the last bits."""

from contextlib import AbstractContextManager
from functools import cache

import scipy.linalg  # noqa: F401  # with numpy's own, all BLAS libraries that rubgen uses are loaded then
from threadpoolctl import ThreadpoolController


def one_blas_thread() -> AbstractContextManager[object]:
    """Let the BLAS libraries of numpy and scipy use one thread in the block, so that sums always have the same bits.

    Irregular motion magnifies differences in the last bits.
    """
    limit: AbstractContextManager[object] = _controller().limit(limits=1, user_api="blas")
    return limit


@cache
def _controller() -> ThreadpoolController:
    """Return the libraries of this process. It takes 3 ms to find them, so they are looked for once."""
    return ThreadpoolController()
