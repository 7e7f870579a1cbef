"""The runs of the study: each is simulated once and measured twice, with its surroundings and without."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

import rubgen
from rubgen.arrays import FloatArray
from rubgen.measurement import Recording, measure
from rubgen.scenario import Labelling, Recipe, Scenario
from rubgen.scenario.faults import kind_of
from validation.difficulty.features import angle_from, common, orders
from validation.piece import MOTION_LABELS, Arrays, Piece

PLACES = ("plant", "silence")


@dataclass(frozen=True, kw_only=True)
class Cases:
    """All runs that ended well."""

    rub: npt.NDArray[np.bool_]
    """Whether a blade touched in the run (runs,)."""
    channels: tuple[str, ...]
    """Names of the sampled channels."""
    features: dict[str, FloatArray]
    """By place, features (runs, channels, common features, then orders)."""
    background: FloatArray
    """Rms of the background (runs,), m/s2; 0 in silence."""
    faults: tuple[frozenset[str], ...]
    """Kinds of the faults of each run."""


def run_pieces(recipe: Recipe) -> list[Piece]:
    """One piece a run of the recipe, without the exponent, which the study does not need."""
    scenarios = (recipe.scenario(index) for index in range(recipe.runs))
    return [
        Piece(features_of_run, (replace(each, labelling=Labelling(lyapunov=False)),), apart=MOTION_LABELS)
        for each in scenarios
    ]


def features_of_run(scenario: Scenario) -> Arrays:
    """`rub`, and the features by place (channels, features); nothing of a run that failed."""
    run = rubgen.simulate(scenario)
    if run.labels is None or run.recording is None:
        return {}
    rng = np.random.default_rng(np.random.SeedSequence(scenario.seed, spawn_key=(scenario.index,)))
    machine = scenario.machine
    silent = measure(
        run.response,
        scenario.sensing,
        seconds=scenario.signal_seconds,
        rng=rng,
        frame=machine.frame,
        faults=machine.faults,
    )
    blades = machine.blades.count
    recorded = zip(PLACES, (run.recording, silent), strict=True)
    return {"rub": np.array(run.labels.rub)} | {place: _features(each, blades) for place, each in recorded}


def _features(recording: Recording, blades: int) -> FloatArray:
    """All features (channels, features) of the sampled channels."""
    rate = recording.sample_rate_hz
    angle = angle_from(recording.once_per_rev, np.arange(recording.samples) / rate)
    signals = [recording.channels[name].values.astype(np.float64) for name in sampled(recording)]
    return np.array([np.concatenate([common(each, rate), orders(each, angle, blades)]) for each in signals])


def sampled(recording: Recording) -> list[str]:
    """Names of the channels with signals: all but the pulse."""
    return [name for name, channel in recording.channels.items() if channel.quantity != "pulse"]


def cases(recipe: Recipe, kept: list[Arrays]) -> Cases:
    """The runs that ended well.

    - recipe: of the runs.
    - kept: what `features_of_run` returned for each of its runs.
    """
    good = [index for index, arrays in enumerate(kept) if arrays]
    scenarios = [recipe.scenario(index) for index in good]
    return Cases(
        rub=np.array([bool(kept[index]["rub"]) for index in good]),
        channels=tuple(sensor.name for sensor in recipe.sensing.set.sampled),
        features={place: np.array([kept[index][place] for index in good]) for place in PLACES},
        background=np.array(
            [each.surroundings.background_m_per_s2 if each.surroundings else 0.0 for each in scenarios]
        ),
        faults=tuple(frozenset(kind_of(fault) for fault in each.machine.faults) for each in scenarios),
    )
