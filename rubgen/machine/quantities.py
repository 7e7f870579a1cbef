"""Kinds of quantities: every number of a machine, recipe or sensor set is one of them.

A value beyond its bounds is an error. A value outside its `Usual` range is allowed but hardly intended:
`rubgen.scenario.checks.plausible` warns of it.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Annotated, Any, get_args, get_type_hints

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError


@dataclass(frozen=True)
class Usual:
    """The usual range `low` to `high` of a value, the reason (`fact`), and the units that people use by mistake."""

    low: float
    high: float
    fact: str
    units: tuple[tuple[str, float], ...] = ()
    """Each unit with its size in ours."""
    ours: str = ""

    def doubt(self, value: float) -> str | None:
        """Return why a value is unusual; None for a value from `low` to `high`, both included.

        The text is `fact`, and asks for the first of `units` in which the value would be usual, if there is one.
        """
        if self.low <= value <= self.high:
            return None
        for unit, size in self.units:
            if self.low <= value * size <= self.high:
                return f"{self.fact}; were {unit} meant, {value * size:g} {self.ours}".rstrip() + "?"
        return self.fact


Place = tuple[int | str, ...]
"""Names of fields, and numbers of elements of a list."""


def usual_values(record: Any, place: Place = ()) -> Iterator[tuple[Place, float, Usual]]:
    """Yield every number of a record, and of records in it, that has a usual range: its path, value and usual range.

    Paths begin with `place`, the path of the record.
    """
    for name, usual in _usual_ranges(record.__class__).items():
        yield from _values(getattr(record, name), usual, (*place, name))


def _values(value: Any, usual: Usual | None, place: Place) -> Iterator[tuple[Place, float, Usual]]:
    if is_dataclass(value):
        yield from usual_values(value, place)
    elif isinstance(value, tuple):
        for number, each in enumerate(value):
            yield from _values(each, usual, (*place, number))
    elif usual and isinstance(value, int | float):
        yield place, value, usual


@cache
def _usual_ranges(kind: type) -> dict[str, Usual | None]:
    hints = get_type_hints(kind, include_extras=True)
    return {field.name: _usual_range(hints[field.name]) for field in fields(kind)}


def _usual_range(hint: Any) -> Usual | None:
    """Return the usual range in the annotation of a type or of one of its parts."""
    if isinstance(hint, Usual):
        return hint
    parts = (*getattr(hint, "__metadata__", ()), *get_args(hint), *getattr(hint, "metadata", ()))
    return next(filter(None, map(_usual_range, parts)), None)


def _no_text(value: object) -> object:
    """Return the value unchanged if it is a number; pydantic would read "0.3" as 0.3 and true as 1."""
    if isinstance(value, str | bytes | bool | np.bool_):
        raise PydanticCustomError("number", "must be a number")
    return value


def _whole(*, usual: Usual | None = None, **bounds: Any) -> Any:
    """Return bounds of a whole number (`ge`, `gt`, `le`, `lt`), for which no text may stand, with its usual range."""
    field: FieldInfo = Field(**bounds)
    field.metadata += [BeforeValidator(_no_text), *([usual] if usual else [])]
    return field


def real(**bounds: Any) -> Any:
    """Return the bounds (`ge`, `gt`, `le`, `lt`) and the `usual` range of a finite number, for its annotated type.

    A text in place of the number is refused.
    """
    return _whole(allow_inf_nan=False, **bounds)


class StrictModel(BaseModel):
    """A pydantic model that refuses unknown keys and whose values cannot be changed."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def about(text: str) -> Any:
    """Return the description of a field, for schemas, reference pages and help texts.

    `text` says what the field is and when to change it. Unit, default and allowed range are left out:
    `rubgen.machine.descriptions` adds them from the field.
    """
    return Field(description=text)


STRICT = ConfigDict(extra="forbid")
MOST_RUNS = 1_000_000
MOST_STEPS = 16_384
MOST_MODES = 500
PERCENT = (("%", 0.01),)
Switch = Annotated[bool, Field(strict=True)]
Seed = Annotated[int, _whole(ge=0, le=2**63 - 1)]
Finite = Annotated[float, real()]
Positive = Annotated[float, real(gt=0)]
"""`Finite` and `Positive` are parts of a distribution: the drawn key has its own bounds."""

# Lengths, places and angles.
Length = Annotated[float, real(ge=1e-7, le=100)]
Height = Annotated[float, real(ge=0, le=100)]
Penetration = Annotated[float, real(ge=-0.1, le=0.1)]
AxialPlace = Annotated[float, real(ge=-100, le=100)]
Angle = Annotated[float, real(ge=-360, le=360)]
Direction = Annotated[float, real(ge=0, lt=360)]
"""Polar angle in the inertial frame, in degrees."""

# Materials, springs, dampers, masses.
Modulus = Annotated[
    float,
    real(
        ge=1,
        le=1e15,
        usual=Usual(1e9, 1.3e12, "no solid of a machine has it", (("GPa", 1e9), ("MPa", 1e6), ("kPa", 1e3)), "Pa"),
    ),
]
"""Usual from plastics to diamond."""
PoissonRatio = Annotated[float, real(gt=-1, lt=0.5, usual=Usual(0, 0.5, "metals have 0.25 to 0.35"))]
Density = Annotated[
    float,
    real(
        ge=1e-3,
        le=1e6,
        usual=Usual(500, 23_000, "no solid of a machine has it", (("g/cm3", 1e3), ("t/mm3", 1e12)), "kg/m3"),
    ),
]
"""Usual from foam to osmium."""
Stiffness = Annotated[float, real(ge=1e-3, le=1e16)]
Anisotropy = Annotated[
    float, real(gt=-1, lt=1, usual=Usual(-0.9, 0.9, "one direction has less than a 19th of the other", PERCENT))
]
DampingRatio = Annotated[float, real(ge=0, lt=1, usual=Usual(0, 0.6, "machines have 0.001 to 0.3", PERCENT))]
Viscosity = Annotated[
    float, real(gt=0, le=1e4, usual=Usual(1e-5, 10, "oils have 0.001 to 1", (("mPa s", 1e-3),), "Pa s"))
]
StiffnessDeviation = Annotated[
    float, real(gt=-1, le=1, usual=Usual(-0.5, 0.5, "blades of a row differ by a few percent", PERCENT))
]
DeviationSpread = Annotated[
    float, real(ge=0, lt=1, usual=Usual(0, 0.2, "blades of a row differ by a few percent", PERCENT))
]
UnbalanceSize = Annotated[float, real(ge=0, le=1e7)]
Gravity = Annotated[float, real(ge=0, le=1e4, usual=Usual(0, 20, "the earth has 9.81", (("mm/s2", 1e-3),), "m/s2"))]
Friction = Annotated[float, real(ge=0, le=0.3)]
Restitution = Annotated[float, real(ge=0, le=1)]
WearRate = Annotated[
    float, real(gt=0, le=1, usual=Usual(1e-18, 1e-7, "linings wear 1e-14 to 1e-9", (("mm3/(N m)", 1e-9),), "m2/N"))
]

# Frame between support and casing.
FRAME_HZ, MODAL_KG = (10.0, 1e6), (1e-6, 1e9)
FrameFrequency = Annotated[
    float,
    real(
        ge=FRAME_HZ[0],
        le=FRAME_HZ[1],
        usual=Usual(100, 20_000, "frames have modes at 300 to 8,000 Hz", (("kHz", 1e3),), "Hz"),
    ),
]
FrameDamping = Annotated[float, real(ge=1e-3, lt=1, usual=Usual(0.002, 0.2, "frames have 0.01 to 0.03", PERCENT))]
ModalMass = Annotated[float, real(ge=MODAL_KG[0], le=MODAL_KG[1])]
CasingShare = Annotated[float, real(ge=-1e3, le=1e3, usual=Usual(-10, 10, "casing and bearing move about equally"))]
FrameOrder = Annotated[int, _whole(ge=0, le=100)]

# Numbers of parts, of the mesh and of modes.
BladeCount = Annotated[int, _whole(ge=2, le=1000)]
BallCount = Annotated[int, _whole(ge=3, le=200)]
BladeElements = Annotated[int, _whole(ge=1, le=200)]
RadialElements = Annotated[int, _whole(ge=1, le=200)]
CircumferentialElements = Annotated[int, _whole(ge=3, le=3600)]
CasingNodes = Annotated[int, _whole(ge=12, le=1440)]
Lobes = Annotated[int, _whole(ge=2, le=100)]
LinerBins = Annotated[int, _whole(ge=36, le=3600)]
BladeNumber = Annotated[int, _whole(ge=0, lt=1000)]
LostBladeCount = Annotated[int, _whole(ge=1, le=250)]
ModeCount = Annotated[int, _whole(ge=0, le=MOST_MODES)]
CasingModeCount = Annotated[int, _whole(ge=1, le=MOST_MODES)]
RunCount = Annotated[int, _whole(ge=1, le=MOST_RUNS)]
TryCount = Annotated[int, _whole(ge=1, le=1000)]
Share = Annotated[float, real(gt=0, le=1)]

# Speeds, turns and times.
Speed = Annotated[float, real(ge=1e-3, le=1e6)]
SpeedSwing = Annotated[float, real(ge=0, le=1e6)]
TurnCount = Annotated[
    int, _whole(ge=1, le=1_000_000, usual=Usual(1, 50_000, "a run of so many turns takes from minutes to hours"))
]
StepCount = Annotated[int, _whole(ge=32, le=MOST_STEPS)]
Duration = Annotated[float, real(gt=0, le=1e5)]
ClockOffset = Annotated[float, real(ge=-1, le=1)]
ClockDrift = Annotated[float, real(ge=-1000, le=1000)]
Jitter = Annotated[float, real(ge=0, le=1)]

# Measuring chains. A reading stands in the sensor's unit.
Rate = Annotated[float, real(gt=0, le=1e9)]
RateOrNone = Annotated[float, real(ge=0, le=1e9)]
Reading = Annotated[float, real(ge=-1e9, le=1e9)]
Level = Annotated[float, real(ge=0, le=1e9)]
NoiseScale = Annotated[float, real(ge=0, le=1e6, usual=Usual(0, 100, "1 is the noise that each sensor has"))]
GainError = Annotated[float, real(gt=-1, le=10, usual=Usual(-0.5, 0.5, "sensors err by a few percent", PERCENT))]
ResonanceDamping = Annotated[float, real(gt=0, lt=1)]
Sensitivity = Annotated[
    float,
    real(
        gt=0,
        le=1e9,
        usual=Usual(
            100, 1e6, "proximity probes have 4000 to 20000", (("mV/um or V/mm", 1e3), ("mV/mil", 1 / 0.0254)), "V/m"
        ),
    ),
]
Bias = Annotated[
    float, real(ge=-1000, le=1000, usual=Usual(-30, 30, "drivers are supplied with 24 V", (("mV", 1e-3),), "V"))
]
MissedShare = Annotated[float, real(ge=0, lt=1, usual=Usual(0, 0.9, "hardly a blade is seen", PERCENT))]
RunoutHarmonic = Annotated[int, _whole(ge=1, le=1000)]
AdcBits = Annotated[int, _whole(ge=8, le=32)]

# Surroundings.
BackgroundLevel = Annotated[
    float,
    real(ge=0, le=1e9, usual=Usual(0, 1e4, "machines shake with 0.1 to 1,000", (("mm/s2", 1e-3),), "m/s2")),
]
PathGain = Annotated[float, real(ge=0, le=1e6, usual=Usual(0, 100, "1 is the machine's own frame"))]
Spread = Annotated[
    float, real(ge=0, le=1, usual=Usual(0, 0.3, "machines of one kind differ by a few percent", PERCENT))
]
SpectralSlope = Annotated[float, real(ge=0, le=4)]
SpeedExponent = Annotated[float, real(ge=0, le=10)]
Order = Annotated[float, real(gt=0, le=10_000)]
