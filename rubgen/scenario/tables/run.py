"""The tables of a recipe that are the same in every run: its turns, its speed, its files, its sensors."""

from typing import Annotated, Literal

from pydantic import Field

from rubgen.format_names import FORMAT_NAMES, FormatName
from rubgen.machine.quantities import (
    AdcBits,
    Duration,
    NoiseScale,
    Rate,
    Speed,
    SpeedSwing,
    StepCount,
    StrictModel,
    Switch,
    TurnCount,
    about,
)
from rubgen.scenario.scenario import ProfileName
from rubgen.sensors.load import DEFAULT_SET


class Simulation(StrictModel):
    """`[simulation]`: turns and steps of every run. The keys are fields of `Operation`."""

    settle_turns: Annotated[
        TurnCount | Literal["auto"],
        about(
            'Turns before the record, in which transients decay. "auto" takes them from the slowest '
            "decay of the model; give a number to study transients."
        ),
    ] = "auto"
    record_turns: Annotated[
        TurnCount,
        about(
            "Turns of the record of a steady run, from which its labels come. More turns resolve slow motions better."
        ),
        Field(json_schema_extra={"minimum": 500}),
    ] = 500
    steps_per_turn: Annotated[
        StepCount,
        about(
            "Least number of integration steps in a turn. It is doubled where stability or the sample "
            "rate needs it; raise it to check that a result does not depend on the step."
        ),
    ] = 1024
    closing_turns: Annotated[
        TurnCount, about("Turns at the start in which the clearance closes to its value. Fewer start the rub harder.")
    ] = 40


class Profile(StrictModel):
    """`[operation]`: how the speed changes from `speed_rpm` of `[vary]`. The keys are fields of `Operation`."""

    profile: Annotated[
        ProfileName, about("How the speed changes: not at all, linearly up, linearly down, or as a sine.")
    ] = "steady"
    end_speed_rpm: Annotated[Speed | None, about("Speed at the end of a run-up or coast-down, which need it.")] = None
    duration_s: Annotated[
        Duration | None,
        about(
            'Duration of a record whose speed changes; every profile but "steady" needs it. A longer '
            "one passes a critical speed more slowly."
        ),
    ] = None
    fluctuation_rpm: Annotated[SpeedSwing, about("Amplitude of a fluctuating speed, which needs it.")] = 0.0
    fluctuation_period_s: Annotated[Duration, about("Period of a fluctuating speed.")] = 1.0
    forbidden_speed_rpm: Annotated[
        tuple[tuple[Speed, Speed], ...],
        about(
            "Bands of speed, each with its lower and upper end, that no run may enter, as an "
            "operator's manual forbids them."
        ),
    ] = ()


class Output(StrictModel):
    """`[output]`: the formats of the files, and the length of the recorded signals, which end with the record."""

    formats: Annotated[
        tuple[FormatName, ...],
        Field(min_length=1, max_length=len(FORMAT_NAMES)),
        about(
            "Files of each run. Parquet is for learning, MCAP for robotics tools and Foxglove, .rrd "
            "for the Rerun viewer; each holds the whole run, so leave out what you do not need."
        ),
    ] = (
        "parquet",
        "mcap",
        "rrd",
    )
    signal_seconds: Annotated[
        Duration,
        about(
            "Length of the recorded signals: the end of the record. Longer signals make larger files "
            "and cost little time."
        ),
    ] = 1.0


class Sensors(StrictModel):
    """`[sensors]`: a sensor set by its name or the path of a TOML file, and how its signals are recorded."""

    set: Annotated[
        str, Field(min_length=1), about("A sensor set of rubgen by its name, or the path of a sensor set in TOML.")
    ] = DEFAULT_SET
    sample_rate_hz: Annotated[
        Rate, about("Samples a second of every recorded channel. A higher rate may need more integration steps.")
    ] = 25600.0
    noise: Annotated[NoiseScale, about("Factor of every sensor's own noise. 0 switches noise off; 2 doubles it.")] = 1.0
    adc_bits: Annotated[AdcBits, about("Bits of the converter, where a sensor has none of its own.")] = 16
    keep_clean: Annotated[
        Switch,
        about(
            "Whether each channel is also recorded as an ideal sensor would record it. Turn it on to learn denoising."
        ),
    ] = False
