"""What the sensors of a run feel besides its motion: the values of one run, and how a recipe draws them.

A new key is one field of `Surroundings`, one entry in `SURROUNDINGS`, and its signal in `measurement/surroundings.py`.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass as plain_dataclass
from typing import Annotated, Any, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, create_model, model_validator
from pydantic.dataclasses import dataclass

from rubgen.machine.problems import validated
from rubgen.machine.quantities import (
    STRICT,
    BackgroundLevel,
    Height,
    Order,
    PathGain,
    Rate,
    SpectralSlope,
    SpeedExponent,
    Spread,
)
from rubgen.scenario.distributions import Distribution

MOST_TONES = 16


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Tone:
    """A sine on the casing from another machine: at an `order` of the speed, or at a fixed `frequency_hz`.

    `level_m_per_s2` is its rms acceleration, averaged over the circumference.
    """

    order: Order | None = None
    frequency_hz: Rate | None = None
    level_m_per_s2: BackgroundLevel = 0.0

    @model_validator(mode="after")
    def _has_one_frequency(self) -> Self:
        if (self.order is None) == (self.frequency_hz is None):
            raise ValueError("a tone has either an order or a frequency_hz; give one of the two")
        return self

    def order_at(self, rotation_frequency_hz: float) -> float:
        """Return the tone's frequency over that of the rotation."""
        return self.order if self.order is not None else (self.frequency_hz or 0.0) / rotation_frequency_hz


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Surroundings:
    """What the sensors of one run feel besides its motion (docs/surroundings.md); every level is 0 where not given.

    The three levels of the casing are rms accelerations. The background and the blade passing have theirs at 10,000
    rev/min and go as (speed / 10,000)^`speed_exponent`. The background's power spectral density falls as
    1/f^`background_slope`. `path_gain` scales what the casing feels of the machine's frame. The frequency and the
    modal mass of each of its modes are those of the machine times exp(`frame_spread` x), x normal and independent.
    """

    background_m_per_s2: BackgroundLevel = 0.0
    background_slope: SpectralSlope = 1.0
    speed_exponent: SpeedExponent = 1.5
    blade_passing_m_per_s2: BackgroundLevel = 0.0
    runout_m: Height = 0.0
    shaft_drift_m: Height = 0.0
    path_gain: PathGain = 0.0
    frame_spread: Spread = 0.0
    tones: Annotated[tuple[Tone, ...], Field(max_length=MOST_TONES)] = ()


@plain_dataclass(frozen=True)
class SurroundingsKey:
    """A key of `[surroundings]`: its unit and meaning."""

    key: str
    unit: str
    meaning: str


SURROUNDINGS = (
    SurroundingsKey(
        "background_m_per_s2", "m/s2", "rms of the casing's broadband background, 10 Hz to 20 kHz, at 10,000 rev/min"
    ),
    SurroundingsKey("background_slope", "1", "exponent by which the background's power falls with frequency"),
    SurroundingsKey("speed_exponent", "1", "exponent by which background and blade passing rise with the speed"),
    SurroundingsKey(
        "blade_passing_m_per_s2", "m/s2", "rms of the casing's answer to the blades' pressure, at 10,000 rev/min"
    ),
    SurroundingsKey("runout_m", "m", "amplitude of order 1 of the shaft's runout under the proximity probes"),
    SurroundingsKey("shaft_drift_m", "m", "slow movement of the shaft over the recorded signals"),
    SurroundingsKey("path_gain", "1", "share of the frame's motion that the casing feels; 1 is the machine's frame"),
    SurroundingsKey("frame_spread", "1", "spread of frequencies and masses of the frame's modes about the machine's"),
)


def surroundings_values(around: Surroundings) -> dict[str, float | list[float]]:
    """Return the values of a run by column: one for each key, and three lists with one value for each tone."""
    values: dict[str, float | list[float]] = {each.key: getattr(around, each.key) for each in SURROUNDINGS}
    values["tones_order"] = [tone.order or 0.0 for tone in around.tones]
    values["tones_frequency_hz"] = [tone.frequency_hz or 0.0 for tone in around.tones]
    values["tones_m_per_s2"] = [tone.level_m_per_s2 for tone in around.tones]
    return values


_TABLE = ConfigDict(extra="forbid", frozen=True)
_VALUES: TypeAdapter[Any] = TypeAdapter(Surroundings)


class ToneTable(BaseModel):
    """`[[surroundings.tones]]`: a sine at an `order` of the speed, or at a fixed `frequency_hz`."""

    model_config = _TABLE
    order: Distribution | None = Field(default=None, description="frequency over that of the rotation")
    frequency_hz: Distribution | None = Field(default=None, description="fixed frequency, Hz")
    level_m_per_s2: Distribution = Field(description="rms acceleration over the circumference, m/s2")


_FIELDS: dict[str, Any] = {
    each.key: (Distribution | None, Field(default=None, description=f"{each.meaning}, {each.unit}"))
    for each in SURROUNDINGS
}
SurroundingsTable = create_model(
    "SurroundingsTable",
    __config__=_TABLE,
    __doc__="`[surroundings]`: a number fixes a level, a table draws it.",
    tones=(Annotated[tuple[ToneTable, ...], Field(max_length=MOST_TONES)], ()),
    **_FIELDS,
)


def drawn(table: BaseModel, seed: int, index: int) -> Surroundings:
    """Draw the values of run number `index`. Each key has random numbers of its own, whatever other keys there are."""

    def value(key: str, distribution: Distribution) -> float:
        generator = np.random.default_rng([seed, index, zlib.crc32(key.encode())])
        return float(distribution.quantile(generator.random()))

    return _with(table, value, "")


def extremes(table: BaseModel, source: str = "") -> tuple[Surroundings, Surroundings]:
    """Return all least and all largest values that can be drawn.

    Raises UserError, beginning with `source`, where one of them is not allowed.
    """
    least = _with(table, lambda _, distribution: min(distribution.extremes()), source)
    return least, _with(table, lambda _, distribution: max(distribution.extremes()), source)


def _with(table: BaseModel, value: Callable[[str, Distribution], float], source: str) -> Surroundings:
    """Return the values that `value` gives for the key and the distribution of each entry of the table."""

    def of(part: BaseModel, place: str) -> dict[str, Any]:
        given = [(key, getattr(part, key)) for key in type(part).model_fields if key != "tones"]
        return {key: value(f"{place}{key}", entry) for key, entry in given if entry is not None}

    tones = [of(tone, f"tones.{number}.") for number, tone in enumerate(table.tones)]  # type: ignore[attr-defined]
    values = {**of(table, ""), "tones": tones}
    surroundings: Surroundings = validated(source, values, _VALUES, lambda path: ("surroundings", *path))
    return surroundings
