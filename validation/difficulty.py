"""How well one threshold on one feature tells rub from no rub, in the plant and in silence: `make difficulty`.

Each run of `datasets/surroundings.toml` is simulated once and measured twice, with and without its surroundings. The
score is the balanced accuracy of the best threshold over all runs, either way round. It is chosen on the same runs: the
last column is the score that a feature without information reaches in 95 % of cases.
"""

from __future__ import annotations

import argparse
import sys
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

import rubgen
from rubgen.arrays import FloatArray
from rubgen.measurement import Recording, measure
from rubgen.scenario import Labelling, parse_recipe

RECIPE = Path(__file__).parent.parent / "datasets" / "surroundings.toml"
LEAST_RUNS = 16
CHANNELS = ("casing_acc_0", "proximity_x")
FEATURES: dict[str, Callable[[FloatArray], float]] = {
    "rms": lambda x: float(np.sqrt(np.mean(x**2))),
    "crest factor": lambda x: float(np.abs(x).max() / np.sqrt(np.mean(x**2))),
    "kurtosis": lambda x: float(np.mean(x**4) / np.mean(x**2) ** 2),
}


def features(recording: Recording) -> list[float]:
    """Every feature of every channel, its mean removed, in the order of CHANNELS and FEATURES."""
    signals = [recording.channels[name].values.astype(np.float64) for name in CHANNELS]
    return [feature(signal - signal.mean()) for signal in signals for feature in FEATURES.values()]


def best_threshold(values: FloatArray, rub: npt.NDArray[np.bool_]) -> float:
    """The balanced accuracy of the best threshold on `values` (runs,) for the flags `rub` (runs,), either way round."""
    ends = np.sort(values)
    middles = (ends[1:] + ends[:-1])[:, None] / 2
    above = values > middles
    scores = (above[:, rub].mean(axis=1) + (~above[:, ~rub]).mean(axis=1)) / 2
    return float(np.maximum(scores, 1 - scores).max())


def main() -> None:
    """Simulate the runs and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=96)
    runs = parser.parse_args().runs
    if runs < LEAST_RUNS:
        parser.error(f"--runs {runs}: at least {LEAST_RUNS}, for both classes to occur")
    recipe = parse_recipe(tomllib.loads(RECIPE.read_text(encoding="utf-8")), runs=runs)
    rub, plant, silence = [], [], []
    for index in range(recipe.runs):
        scenario = replace(recipe.scenario(index), labelling=Labelling(lyapunov=False))
        run = rubgen.simulate(scenario)
        if run.labels and run.recording:
            rng = np.random.default_rng(np.random.SeedSequence(scenario.seed, spawn_key=(index,)))
            silent = measure(run.response, scenario.sensing, seconds=scenario.signal_seconds, rng=rng)
            rub.append(run.labels.rub)
            plant.append(features(run.recording))
            silence.append(features(silent))
    names = [f"`{channel}`, {feature}" for channel in CHANNELS for feature in FEATURES]
    sys.stdout.write(
        f"{len(rub)} runs, {sum(rub)} rub.\n\n| feature | in silence | in the plant | by chance |\n|---|---|---|---|\n"
    )
    flags = np.array(rub)
    noise = np.random.default_rng(0).standard_normal((1000, flags.size))
    chance = float(np.quantile([best_threshold(values, flags) for values in noise], 0.95))
    for name, quiet, loud in zip(names, np.transpose(silence), np.transpose(plant), strict=True):
        scores = (best_threshold(quiet, flags), best_threshold(loud, flags), chance)
        sys.stdout.write(f"| {name} | " + " | ".join(f"{score:.2f}" for score in scores) + " |\n")


if __name__ == "__main__":
    main()
