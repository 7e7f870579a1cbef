"""Names for the array types that signatures use, and records whose arrays cannot be written."""

from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
BoolArray = npt.NDArray[np.bool_]
ComplexArray = npt.NDArray[np.complex128]
AnyArray = npt.NDArray[Any]
SparseMatrix = sp.csr_array[Any]
Record = TypeVar("Record", bound=tuple[Any, ...])


def frozen(record: Record) -> Record:
    """Copy a named tuple so that its arrays are read-only, also arrays in named tuples within it.

    The copy shares their memory; the arrays of `record` itself stay writable. A kernel that writes into an array of the
    copy does not compile.
    """
    return type(record)(*(_frozen_value(value) for value in record))


def _frozen_value(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        view = value.view()
        view.flags.writeable = False
        return view
    return frozen(value) if isinstance(value, tuple) and hasattr(value, "_fields") else value
