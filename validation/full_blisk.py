"""Natural frequencies of the full blisk, to compare the reduced blisk with."""

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from rubgen.arrays import FloatArray
from rubgen.fem.blisk import BliskModel
from rubgen.fem.constraints import factorize, on_springs, support_stiffness
from rubgen.machine import DiskSupport


def blisk_frequencies(model: BliskModel, support: DiskSupport, modes: int) -> FloatArray:
    """Lowest natural frequencies (modes,) in Hz of the full blisk at rest on its supports, undamped."""
    K = on_springs(model.K, support_stiffness(support))
    factor = factorize(K)
    inverse = LinearOperator(K.shape, matvec=factor.solve, dtype=np.float64)
    start = np.sin(1.0 + np.arange(K.shape[0]))
    squares = eigsh(
        K,
        k=modes,
        M=model.M,
        sigma=0.0,
        OPinv=inverse,
        v0=start,
        return_eigenvectors=False,
        tol=1e-12,
        ncv=2 * modes + 20,
    )
    return np.sqrt(np.sort(squares)) / (2 * np.pi)
