"""Points of the scrambled Sobol sequence, one for each run, so that any run can be made alone."""

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.scenario.vary import KEYS

DIMENSIONS = 32
"""Dimensions that are always generated, so a key that is added later changes no value of an existing recipe."""


def sobol_point(seed: int, index: int) -> dict[str, float]:
    """One u in [0, 1) for each key of `[vary]`: point `index` of the Sobol sequence scrambled by `seed`.

    Each key has a fixed dimension, whether it is drawn or fixed: fixing one key changes no other key.
    """
    from scipy.stats import qmc  # slow to import, and only needed here

    engine = qmc.Sobol(d=DIMENSIONS, scramble=True, rng=np.random.default_rng(np.random.SeedSequence(seed)))
    if index:
        engine.fast_forward(index)  # fast_forward(0) overflows
    point: FloatArray = engine.random(1)[0]
    return dict(zip(KEYS, point.tolist(), strict=False))
