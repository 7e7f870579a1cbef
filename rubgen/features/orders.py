"""Features at orders of the speed, and of the orbit of a shaft."""

from __future__ import annotations

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.features.turns import circles
from rubgen.features.vocabulary import FRACTIONS, ORDERS, SIDES


def order_features(turned: FloatArray) -> FloatArray:
    """Compute the features `vocabulary.ORDER`, as (channels, features), of signals (channels, turns, points a turn).

    `turned` is from `by_turn`. A feature that needs more turns is NaN.
    """
    count, turns, _ = turned.shape
    whole = circles(turned, ORDERS)
    parts = np.concatenate([circles(turned, [p], q) for p, q in FRACTIONS.values()])
    phase = np.where(np.abs(whole[0]) > 0, np.mod(-np.rad2deg(np.angle(whole[0])), 360), np.nan)
    if not turns:
        return np.column_stack([np.zeros(count), *(2 * np.abs([*whole, *parts])), phase, *np.full((3, count), np.nan)])
    mean_turn = turned.mean(axis=1)
    synchronous = mean_turn.var(axis=1)
    variance = np.array([signal.var() for signal in turned.reshape(count, -1)])  # row by row: in the cache
    not_1x = np.sqrt(np.maximum(variance - 2 * np.abs(whole[0]) ** 2, 0))
    rest = np.sqrt(np.maximum(variance - synchronous, 0)) if turns > 1 else np.full(count, np.nan)
    amplitudes = 2 * np.abs([*whole, *parts])
    return np.column_stack([np.full(count, turns), *amplitudes, phase, np.sqrt(synchronous), rest, not_1x])


def orbit_features(turned: FloatArray, angles_deg: tuple[float, float]) -> FloatArray:
    """Compute the features `vocabulary.ORBIT` (features,) of two shaft probes (2, turns, points a turn).

    - turned: the signals of the probes, from `by_turn`. Features of lengths have the unit of the signals.
    - angles_deg: directions of the probes from X towards Y, the sense of rotation. They must not be parallel.

    A feature that needs more turns is NaN. The full spectrum is the Fourier series of x + iy over the angle of the
    shaft. Source: API 670; Bently and Hatch, Fundamentals of Rotating Machinery Diagnostics, chapter 8.
    """
    angle = np.deg2rad(angles_deg)
    probes = np.column_stack([np.cos(angle), np.sin(angle)])
    x, y = np.tensordot(np.linalg.inv(probes), turned, axes=1)
    place: ComplexArray = (x + 1j * y)[None]
    sides = []
    for name in SIDES:
        p, q = FRACTIONS.get(name, (int(name.split("_")[0]), 1))
        sides += [*circles(place, (p, -p), q)[:, 0]]
    one = 2 * SIDES.index("1")
    forward, backward = sides[one : one + 2]
    inclination = np.mod(np.rad2deg(np.angle(forward) + np.angle(backward)) / 2, 180)
    distance = np.abs(place - place.mean()).max(initial=0.0) if place.size else np.nan
    sizes = np.abs(sides)
    major, minor = sizes[one] + sizes[one + 1], sizes[one] - sizes[one + 1]
    return np.array([major, minor, inclination, distance, *sizes])
