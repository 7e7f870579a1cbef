"""What the sensors of a run feel besides its motion: the values of one run, and how a recipe draws them.

A new key is one field of `Surroundings`, one entry in `SURROUNDINGS`, and its signal in `measurement/surroundings.py`.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass as plain_dataclass
from typing import Annotated, Any, Self, get_type_hints

import numpy as np
from pydantic import BaseModel, Field, TypeAdapter, create_model, model_validator
from pydantic.dataclasses import dataclass

from rubgen.machine.descriptions import draws
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
    StrictModel,
    about,
)
from rubgen.scenario.distributions import Distribution

MOST_TONES = 16


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Tone:
    """A sine on the casing from another machine: at an `order` of the speed, or at a fixed `frequency_hz`.

    `level_m_per_s2` is its rms acceleration, averaged over the circumference.
    """

    order: Annotated[
        Order | None,
        about("Frequency over that of the rotation. Give it for a gear that the shaft drives; else give frequency_hz."),
    ] = None
    frequency_hz: Annotated[
        Rate | None, about("Fixed frequency. Give it for a neighbouring machine or the mains; else give order.")
    ] = None
    level_m_per_s2: Annotated[
        BackgroundLevel, about("Rms acceleration of the tone over the circumference of the casing.")
    ] = 0.0

    @model_validator(mode="after")
    def _has_one_frequency(self) -> Self:
        if (self.order is None) == (self.frequency_hz is None):
            raise ValueError("a tone has either an order or a frequency_hz; give one of the two")
        return self

    def order_at(self, rotation_frequency_hz: float) -> float:
        """Return the tone's frequency as a multiple of the rotation frequency, given in Hz."""
        return self.order if self.order is not None else (self.frequency_hz or 0.0) / rotation_frequency_hz


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Surroundings:
    """What the sensors of one run feel besides the motion (docs/surroundings.md). Every level is 0 by default.

    The levels of background, blade passing and tones are rms accelerations of the casing. Background and blade passing
    are given at 10,000 rev/min and go as (speed / 10,000)^`speed_exponent`. The background's power spectral density
    falls as 1/f^`background_slope`. `path_gain` is the share of the frame's motion that the casing feels. Each mode of
    the frame has the machine's frequency and modal mass times exp(`frame_spread` x), with independent normal x.
    """

    background_m_per_s2: Annotated[
        BackgroundLevel,
        about(
            "Rms of the casing's broadband background from 10 Hz to 20 kHz, at 10,000 rev/min. "
            "Machines shake with 0.1 to 1,000; raise it to hide a rub."
        ),
    ] = 0.0
    background_slope: Annotated[
        SpectralSlope,
        about("Exponent by which the power of the background falls with frequency. 0 is white, 1 pink, 2 red."),
    ] = 1.0
    speed_exponent: Annotated[
        SpeedExponent, about("Exponent by which background and blade passing rise with the speed.")
    ] = 1.5
    blade_passing_m_per_s2: Annotated[
        BackgroundLevel,
        about(
            "Rms of the casing's answer to the pressure of the blades, at 10,000 rev/min. Raise it to "
            "hide contacts of all blades, which have the same frequency."
        ),
    ] = 0.0
    runout_m: Annotated[
        Height,
        about(
            "Amplitude of order 1 of the shaft's runout under the proximity probes. Orders 2 and 3 "
            "have a half and a third of it."
        ),
    ] = 0.0
    shaft_drift_m: Annotated[
        Height, about("Slow movement of the shaft over the recorded signals, as bearings warm up.")
    ] = 0.0
    path_gain: Annotated[
        PathGain,
        about(
            "Share of the motion of the machine's frame that the casing's sensors feel. 1 is all of "
            "it; 0 keeps the frame off them."
        ),
    ] = 0.0
    frame_spread: Annotated[
        Spread,
        about(
            "Spread of the frequencies and masses of the frame's modes about the machine's. Give it "
            "so that a model cannot learn one frame by heart."
        ),
    ] = 0.0
    tones: Annotated[
        tuple[Tone, ...], Field(max_length=MOST_TONES), about("Tones of gears and of neighbouring machines.")
    ] = ()


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
    """Return the values of a run by column name: a number for each key, and three lists with a value for each tone.

    The order or the fixed frequency that a tone does not have is 0.
    """
    values: dict[str, float | list[float]] = {each.key: getattr(around, each.key) for each in SURROUNDINGS}
    values["tones_order"] = [tone.order or 0.0 for tone in around.tones]
    values["tones_frequency_hz"] = [tone.frequency_hz or 0.0 for tone in around.tones]
    values["tones_m_per_s2"] = [tone.level_m_per_s2 for tone in around.tones]
    return values


_VALUES: TypeAdapter[Any] = TypeAdapter(Surroundings)


def _drawn(record: Any, key: str) -> Any:
    """Return the description of a field of the values, with the range of what may be drawn for it."""
    hint, field = get_type_hints(record, include_extras=True)[key], record.__pydantic_fields__[key]
    return Field(description=field.description, json_schema_extra=draws(hint, field.default))


class ToneTable(StrictModel):
    """`[[surroundings.tones]]`: a tone at an order of the rotation or at a fixed frequency."""

    order: Annotated[Distribution | None, _drawn(Tone, "order")] = None
    frequency_hz: Annotated[Distribution | None, _drawn(Tone, "frequency_hz")] = None
    level_m_per_s2: Annotated[Distribution, _drawn(Tone, "level_m_per_s2")]


_RECORD: Any = Surroundings
_FIELDS: dict[str, Any] = {
    each.key: (Annotated[Distribution | None, _drawn(Surroundings, each.key)], None) for each in SURROUNDINGS
}
_TONES: Any = Annotated[
    tuple[ToneTable, ...],
    Field(max_length=MOST_TONES),
    Field(description=_RECORD.__pydantic_fields__["tones"].description),
]
SurroundingsTable = create_model(
    "SurroundingsTable",
    __base__=StrictModel,
    __doc__="`[surroundings]`: a number fixes a level, a table draws it.",
    tones=(_TONES, ()),
    **_FIELDS,
)


def drawn(table: BaseModel, seed: int, index: int) -> Surroundings:
    """Draw the surroundings of run number `index` from the table `[surroundings]` and the recipe's seed.

    Each key has its own random numbers, which do not depend on the other keys. A key that the table lacks has its
    default. Raises UserError for a drawn value that its key cannot have.
    """

    def value(key: str, distribution: Distribution) -> float:
        generator = np.random.default_rng([seed, index, zlib.crc32(key.encode())])
        return float(distribution.quantile(generator.random()))

    return _with(table, value, "")


def extremes(table: BaseModel, source: str = "") -> tuple[Surroundings, Surroundings]:
    """Return two surroundings: with the least value of every key of the table, and with the largest value.

    Raises UserError, beginning with `source`, where a value is not allowed.
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
