"""`docs/difficulty.md` from the runs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.baseline.scores import best_threshold
from validation.difficulty.features import NAMES, OF_SIGNAL, OF_SPECTRUM
from validation.difficulty.runs import Cases
from validation.difficulty.scores import FOLDS, SEEDS, Boosted, boosted, chance_level
from validation.markdown import table

PLANT, SILENCE = "plant", "silence"


@dataclass(frozen=True, kw_only=True)
class Best:
    """The feature of a channel with the best threshold."""

    feature: int
    """Its place in NAMES."""
    score: float
    """The balanced accuracy."""


def best_of(features: FloatArray, found: Cases) -> Best:
    """The best threshold over the features (runs, features) of a channel."""
    scores = [best_threshold(values, found.rub).score for values in features.T]
    return Best(feature=int(np.argmax(scores)), score=float(np.max(scores)))


def best_feature(found: Cases) -> FloatArray:
    """The feature (runs,) with the best threshold of all channels in the plant."""
    best = [best_of(found.features[PLANT][:, number], found) for number in range(len(found.channels))]
    channel = int(np.argmax([each.score for each in best]))
    return found.features[PLANT][:, channel, best[channel].feature]


def accelerations(found: Cases, place: str) -> FloatArray:
    """All features of the accelerometers (runs, any)."""
    chosen = [number for number, name in enumerate(found.channels) if "_acc_" in name]
    return found.features[place][:, chosen].reshape(found.rub.size, -1)


def page(found: Cases, learned: Boosted, recipe: str) -> str:
    """The page; `learned` is gradient boosting on the accelerometers in the plant."""
    parts = [_introduction(found, recipe), _thresholds(found), _learned(found, learned), _confusers(found, learned)]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _introduction(found: Cases, recipe: str) -> str:
    orders = len(NAMES) - len(OF_SIGNAL) - len(OF_SPECTRUM)
    return f"""
# How hard a rub is to find

`make difficulty` makes this page from {found.rub.size} runs of the recipe `{recipe}`; {found.rub.sum()} of them rub.
Each run is simulated once and measured twice: in the plant, with its surroundings, and in silence, without them. The
faults of the machine are in both. The score is the balanced accuracy, the mean of the shares of rubs and of other runs
that are called so: 0.5 is a guess, 1 is always right. Each channel has {len(NAMES)} features: {len(OF_SIGNAL)} of the
signal, {len(OF_SPECTRUM)} of its spectrum, and {orders} amplitudes at orders of the speed
(`validation/difficulty/features.py`).
"""


def _thresholds(found: Cases) -> str:
    rows = []
    for number, channel in enumerate(found.channels):
        plant, silence = (best_of(found.features[place][:, number], found) for place in (PLANT, SILENCE))
        cells = (
            f"{plant.score:.2f}",
            f"`{NAMES[plant.feature]}`",
            f"{silence.score:.2f}",
            f"`{NAMES[silence.feature]}`",
        )
        rows.append([f"`{channel}`", *cells])
    chance = chance_level(found.rub)
    return f"""
## One threshold

The best threshold on the best feature of each channel. Threshold and feature are chosen on the same runs, so the score
is an upper bound. A feature without information reaches {chance:.2f} in 95 % of cases.

{table(["channel", "in the plant", "feature", "in silence", "feature"], rows)}
"""


def _learned(found: Cases, learned: Boosted) -> str:
    runs = found.rub.size
    rows = [
        ["accelerometers, in the plant", _plus_minus(learned)],
        ["accelerometers, in silence", _plus_minus(boosted(accelerations(found, SILENCE), found.rub))],
        ["all channels, in the plant", _plus_minus(boosted(found.features[PLANT].reshape(runs, -1), found.rub))],
    ]
    return f"""
## Gradient boosting

scikit-learn's `HistGradientBoostingClassifier` with its default settings on all features, in {FOLDS} folds by run. Mean
and standard deviation over {SEEDS} choices of the folds.

{table(["features of", "balanced accuracy"], rows)}
"""


def _confusers(found: Cases, learned: Boosted) -> str:
    kinds = sorted(set().union(*found.faults))
    healthy = np.array([not faults for faults in found.faults])
    groups = {"no fault": healthy}
    groups |= {f"`{kind}`": np.array([kind in faults for faults in found.faults]) for kind in kinds}
    rows = []
    for name, group in groups.items():
        quiet, rubs = group & ~found.rub, group & found.rub
        cells = (str(quiet.sum()), _share(learned.called_rub(quiet)), str(rubs.sum()), _share(learned.called_rub(rubs)))
        rows.append([name, *cells])
    return f"""
## What is taken for a rub

The share of runs that gradient boosting on the accelerometers in the plant calls a rub, by the faults of the run. A run
with two faults counts in both rows.

{table(["runs with", "without rub", "called a rub", "with rub", "called a rub"], rows)}

## The background

![Score over the level of the background](difficulty.png)

The runs in five groups of equal size by the level of their background. Bars: standard deviation over the choices of the
folds.
"""


def _plus_minus(learned: Boosted) -> str:
    mean, deviation = learned.accuracy()
    return f"{mean:.3f} ± {deviation:.3f}"


def _share(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.2f}"
