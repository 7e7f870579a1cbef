"""Random convolutions after MiniRocket (Dempster, Schmidt, Webb 2021, KDD, doi 10.1145/3447548.3467231).

Libraries with it do not go with rubgen: aeon needs an older numba, sktime an older pandas.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from rubgen.measurement.channel import Float32Array

TAPS = 9
GOLDEN = (5**0.5 + 1) / 2
SPACINGS = (1, 8, 64)
"""Samples between the taps of a kernel. A kernel is not longer than a window."""


def _kernels() -> Float32Array:
    """Return the kernels of MiniRocket (84, TAPS): three weights of 2 and six of -1."""
    kernels = np.full((84, TAPS), -1, dtype=np.float32)
    for kernel, places in zip(kernels, combinations(range(TAPS), 3), strict=True):
        kernel[list(places)] = 2
    return kernels


KERNELS = _kernels()


@dataclass(frozen=True)
class Rocket:
    """Random convolutions with their biases, chosen once for each seed."""

    spacings: tuple[int, ...]
    biases: Float32Array
    """(channels, spacings, kernels, seeds)"""

    def transform(self, window: Float32Array) -> Float32Array:
        """Return the numbers of a window (channels, samples) for each seed: (seeds, numbers).

        They are the share of samples at which each convolution is above its bias, and the mean and the base-10
        logarithm of the standard deviation of each channel. Convolutions cannot see these two: they have zero mean, and
        each channel is scaled to a standard deviation of 1.
        """
        shares = []
        for channel, of_channel in zip(_scaled(window), self.biases, strict=True):
            for spacing, biases in zip(self.spacings, of_channel, strict=True):
                convolved = _convolved(channel, spacing)
                shares.append([np.count_nonzero(convolved > each[:, None], axis=1) / channel.size for each in biases.T])
        spread = np.log10(np.maximum(window.std(axis=1), np.finfo(np.float32).tiny))
        levels = np.broadcast_to(np.concatenate([window.mean(axis=1), spread]), (len(shares[0]), 2 * len(window)))
        return np.concatenate([*map(np.array, shares), levels], axis=1).astype(np.float32)


def fitted(examples: Float32Array, seeds: int) -> Rocket:
    """Choose the biases: each is a quantile of the convolution of a window of `examples` (any, channels, samples).

    The quantiles are a Weyl sequence of the golden ratio, as in the paper. For each of the `seeds` seeds, random
    numbers choose the start of the sequence and the windows.
    """
    _, channels, samples = examples.shape
    spacings = tuple(each for each in SPACINGS if (TAPS - 1) * each < samples)
    biases = np.empty((channels, len(spacings), len(KERNELS), seeds), dtype=np.float32)
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        quantile = rng.random()
        for channel, number in np.ndindex(channels, len(spacings)):
            window = _scaled(examples[rng.integers(len(examples))])
            for kernel, values in enumerate(_convolved(window[channel], spacings[number])):
                quantile = (quantile + GOLDEN) % 1
                biases[channel, number, kernel, seed] = np.quantile(values, quantile)
    return Rocket(spacings, biases)


def _scaled(window: Float32Array) -> Float32Array:
    centred = window - window.mean(axis=1, keepdims=True)
    return np.asarray(centred / np.maximum(centred.std(axis=1, keepdims=True), np.finfo(np.float32).tiny))


def _convolved(channel: Float32Array, spacing: int) -> Float32Array:
    """Return the convolutions (84, samples) of a channel (samples,), with zeros before and after it."""
    padded = np.pad(channel, spacing * (TAPS // 2))
    shifted = [padded[spacing * tap : spacing * tap + channel.size] for tap in range(TAPS)]
    return np.asarray(KERNELS @ np.array(shifted))
