"""The 0-1 test for chaos (Gottwald, Melbourne 2009, SIAM J. Appl. Dyn. Syst. 8, 129), by correlation."""

from functools import lru_cache

import numpy as np
from scipy.fft import fft, ifft, next_fast_len

from rubgen.arrays import ComplexArray, FloatArray

FREQUENCIES = np.pi * (0.2 + 0.6 * (np.arange(100) + 0.5) / 100 + 0.002 * np.sin(1.0 + np.arange(100) ** 2))
"""100 fixed c in (pi/5, 4 pi/5): evenly spread, then shifted a little so that no c is a simple fraction of pi."""
DAMPING = 2.5
"""Gottwald and Melbourne's alpha."""
DAMPED_FROM = 200
"""Least number of points for the damped variant: with fewer, n is too short to average out the added oscillation."""


def growth_correlation(observable: FloatArray) -> float:
    """K of a scalar observable (n,), n >= 32 points of a Poincare section: near 1 for chaos, near 0 for regular motion.

    The translation is p_c(n) = sum_{j <= n} phi_j exp(i c j). Its mean square displacement is M_c(n) = mean_j |p_c(j +
    n) - p_c(j)|^2 over n = 1 .. N/10. Without its oscillation it is D_c(n) = M_c(n) - mean(phi)^2 (1 - cos n c)/(1 -
    cos c). The damped variant is D*_c(n) = D_c(n) + DAMPING var(phi) sin(sqrt(2) n): its oscillation is far larger than
    the slow growth that a little noise adds to regular motion. K_c = corr(n, D*_c(n)), and K is the median of K_c over
    all c. The authors scale the oscillation by mean(phi)^2, which depends on the zero of the observable; var(phi) does
    not.

    Not valid for a constant with rounding noise: test for clusters first.
    """
    displacement = _mean_square_displacement(observable)
    steps = np.arange(1, displacement.shape[1] + 1)
    c = FREQUENCIES[:, None]
    oscillation = observable.mean() ** 2 * (1 - np.cos(steps * c)) / (1 - np.cos(c))
    alpha = DAMPING if observable.size >= DAMPED_FROM else 0.0
    damping = alpha * observable.var() * np.sin(np.sqrt(2) * steps)
    return float(np.median(_correlation(steps.astype(np.float64), displacement - oscillation + damping)))


def _mean_square_displacement(observable: FloatArray) -> FloatArray:
    """M_c(n), (frequencies, n_cut), every mean over the same L = N - n_cut starts.

    L M_c(n) = sum |p(j + n)|^2 + sum |p(j)|^2 - 2 Re sum conj(p(j)) p(j + n), the last by Fourier transform.
    """
    size = observable.size
    cut = max(size // 10, 3)
    starts, length = size - cut, next_fast_len(size)
    walk = np.cumsum(observable * _turns(size), axis=1)
    cross = ifft(np.conj(fft(walk[:, :starts], length)) * fft(walk, length))[:, : cut + 1].real
    squares = np.cumsum(np.pad(walk.real**2 + walk.imag**2, ((0, 0), (1, 0))), axis=1)
    energy = squares[:, starts:] - squares[:, : cut + 1]
    return np.asarray((energy + energy[:, :1] - 2 * cross)[:, 1:] / starts, dtype=np.float64)


@lru_cache(maxsize=4)
def _turns(size: int) -> ComplexArray:
    """exp(i c j) (frequencies, size), cached: all observables of a run have one size, and the exponentials are slow."""
    turns = np.exp(1j * FREQUENCIES[:, None] * np.arange(1, size + 1))
    turns.setflags(write=False)
    return np.asarray(turns)


def _correlation(steps: FloatArray, curves: FloatArray) -> FloatArray:
    """Pearson correlation of each row of `curves` with `steps`; 0 for a constant row."""
    s = steps - steps.mean()
    d = curves - curves.mean(axis=1, keepdims=True)
    norm = np.linalg.norm(d, axis=1) * np.linalg.norm(s)
    return np.asarray(d @ s / np.where(norm > 0, norm, 1.0), dtype=np.float64)
