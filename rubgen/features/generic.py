"""Generic features of a signal, by the package tsfel (the extra `rubgen[tsfel]`)."""

from __future__ import annotations

import warnings
from functools import cache
from typing import Any

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.errors import UserError

DOMAINS = ("statistical", "temporal", "spectral")


def generic_features(signal: FloatArray, rate_hz: float) -> dict[str, float]:
    """Compute the features of tsfel of a signal (samples,): `tsfel_mean` and so on, in lower case, `_` for other signs.

    `rate_hz` is the sample rate. Features with a length that depends on the signal (spectra, histograms) are left out:
    windows could not share columns. Entropies, fractal dimensions and Lempel-Ziv complexity are left out too. A value
    that is not finite becomes NaN. Raises UserError where tsfel is not installed.
    """
    tsfel = _tsfel()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of divisions by zero and the like in single features
        found = tsfel.time_series_features_extractor(_settings(), signal, fs=rate_hz, verbose=0, n_jobs=None)
    values = {_name(name): float(value) for name, value in zip(found.columns, found.iloc[0], strict=True)}
    return {name: value if np.isfinite(value) else np.nan for name, value in values.items()}


@cache
def _settings() -> dict[str, Any]:
    tsfel = _tsfel()
    listed = ("Histogram", "FFT", "ECDF", "Wavelet", "Spectrogram", "MFCC", "LPCC", "Lempel", "fractal", "entropy")
    every = {domain: tsfel.get_features_by_domain(domain)[domain] for domain in DOMAINS}
    return {
        domain: {name: each for name, each in of.items() if not any(word in name for word in listed)}
        for domain, of in every.items()
    }


def _name(name: str) -> str:
    return "tsfel_" + "_".join("".join(c if c.isalnum() else " " for c in name.split("_", 1)[-1].lower()).split())


@cache
def _tsfel() -> Any:
    try:
        import tsfel
    except ImportError:
        raise UserError("--set tsfel: the package tsfel is not installed; pip install 'rubgen[tsfel]'") from None
    return tsfel
