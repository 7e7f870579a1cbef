"""The tables of a recipe that are alike in every run: its turns, its speed, its files, its sensors."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from rubgen.format_names import FORMAT_NAMES, FormatName
from rubgen.machine.quantities import (
    AdcBits,
    Duration,
    NoiseScale,
    Rate,
    Speed,
    SpeedSwing,
    StepCount,
    Switch,
    TurnCount,
)
from rubgen.scenario.scenario import ProfileName
from rubgen.sensors.load import DEFAULT_SET

_STRICT = ConfigDict(extra="forbid", frozen=True)


class Simulation(BaseModel):
    """`[simulation]`: turns and steps of every run, as in `Operation`."""

    model_config = _STRICT
    settle_turns: TurnCount | Literal["auto"] = "auto"
    record_turns: TurnCount = 500
    steps_per_turn: StepCount = 1024
    closing_turns: TurnCount = 40


class Profile(BaseModel):
    """`[operation]`: the profile of the speed, as in `Operation`; it starts at `speed_rpm` of `[vary]`."""

    model_config = _STRICT
    profile: ProfileName = "steady"
    end_speed_rpm: Speed | None = None
    duration_s: Duration | None = None
    fluctuation_rpm: SpeedSwing = 0.0
    fluctuation_period_s: Duration = 1.0
    forbidden_speed_rpm: tuple[tuple[Speed, Speed], ...] = ()


class Output(BaseModel):
    """`[output]`: the files to write, and the length of the signals: the end of the record."""

    model_config = _STRICT
    formats: Annotated[tuple[FormatName, ...], Field(min_length=1, max_length=len(FORMAT_NAMES))] = (
        "parquet",
        "mcap",
        "rrd",
    )
    signal_seconds: Duration = 1.0


class Sensors(BaseModel):
    """`[sensors]`: a set of rubgen or the path of a TOML file, and the other keys of `Sensing`."""

    model_config = _STRICT
    set: Annotated[str, Field(min_length=1)] = DEFAULT_SET
    sample_rate_hz: Rate = 25600.0
    noise: NoiseScale = 1.0
    adc_bits: AdcBits = 16
    keep_clean: Switch = False
