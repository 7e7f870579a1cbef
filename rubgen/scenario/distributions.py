"""Distributions of varied values: each maps u in [0, 1) to a value by its quantile function.

In a recipe a plain number fixes the value; a table with one key draws it. A new distribution is one class with a field
of its own name, and one line in `Distribution`.
"""

import math
from collections.abc import Mapping
from numbers import Real
from typing import Annotated, Self, TypeVar

from pydantic import BeforeValidator, ConfigDict, Discriminator, Field, RootModel, Tag, model_validator
from pydantic_core import PydanticCustomError
from scipy.special import ndtr, ndtri

from rubgen.machine.problems import nearest
from rubgen.machine.quantities import Finite, Positive, StrictModel, about

T = TypeVar("T")
LEAST_PROBABILITY = 1e-4
"""Least share of a normal density between its ends. With less, all values lie at one end, or are uniform."""


class Constant(RootModel[Finite]):
    """The same value in every run."""

    model_config = ConfigDict(frozen=True)

    def quantile(self, _u: float) -> float:
        """Return the value itself."""
        return self.root

    def extremes(self) -> tuple[float, ...]:
        """Return a tuple of the value: no other value can be drawn."""
        return (self.root,)


class Uniform(StrictModel):
    """`{ uniform = [a, b] }`: equal density between a and b."""

    uniform: Annotated[tuple[Finite, Finite], about("Lower and upper end; every value between is equally likely.")]

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        return _check_order(self, *self.uniform)

    def quantile(self, u: float) -> float:
        """Return a + u (b - a), for u in [0, 1)."""
        low, high = self.uniform
        return low + u * (high - low)

    def extremes(self) -> tuple[float, ...]:
        """Return the least and the largest value that can be drawn."""
        return self.uniform


class LogUniform(StrictModel):
    """`{ log_uniform = [a, b] }`: equal density of the logarithm between a and b, both above 0."""

    log_uniform: Annotated[
        tuple[Finite, Finite],
        about(
            "Lower and upper end, both above 0; every ratio is equally likely. Take it for a value that spans decades."
        ),
    ]

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if min(self.log_uniform) <= 0:
            raise ValueError("both ends must be above 0, there is no logarithm of 0; use uniform or raise the ends")
        return _check_order(self, *self.log_uniform)

    def quantile(self, u: float) -> float:
        """Return a (b / a)^u, for u in [0, 1)."""
        low, high = self.log_uniform
        return float(low * (high / low) ** u)

    def extremes(self) -> tuple[float, ...]:
        """Return the least and the largest value that can be drawn."""
        return self.log_uniform


class NormalShape(StrictModel):
    """Mean and standard deviation of the normal density before it is cut off at min and max."""

    mean: Annotated[Finite, about("Mean of the normal density before it is cut off.")]
    std: Annotated[Positive, about("Standard deviation of the normal density before it is cut off, above 0.")]
    min: Annotated[Finite, about("Least value that is drawn.")]
    max: Annotated[Finite, about("Largest value that is drawn.")]

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        return _check_order(self, self.min, self.max)


class Normal(StrictModel):
    """`{ normal = { mean, std, min, max } }`: the normal density between min and max."""

    normal: Annotated[
        NormalShape,
        about("Mean, standard deviation, least and largest value of a normal density that is cut off at both ends."),
    ]

    @model_validator(mode="after")
    def _reaches_its_ends(self) -> Self:
        shape = self.normal
        low, high = self._shares()
        if high - low < LEAST_PROBABILITY:
            raise ValueError(
                f"mean = {shape.mean:g} and std = {shape.std:g} give hardly a value from min = {shape.min:g} to "
                f"max = {shape.max:g}; change mean or std, or write {{ uniform = [{shape.min:g}, {shape.max:g}] }}"
            )
        return self

    def quantile(self, u: float) -> float:
        """Return mean + std Phi^-1(Phi(a) + u (Phi(b) - Phi(a))), u in [0, 1). a, b: the standardised min and max."""
        shape = self.normal
        low, high = self._shares()
        value = shape.mean + shape.std * float(ndtri(low + u * (high - low)))
        return min(max(value, shape.min), shape.max)

    def extremes(self) -> tuple[float, ...]:
        """Return the least and the largest value that can be drawn."""
        return (self.normal.min, self.normal.max)

    def _shares(self) -> tuple[float, float]:
        """Return the shares of the whole density below min and below max."""
        shape = self.normal
        low, high = (float(ndtr((end - shape.mean) / shape.std)) for end in (shape.min, shape.max))
        return low, high


class Choice(StrictModel):
    """`{ choice = [a, b, ...] }`: each listed value with the same probability."""

    choice: Annotated[tuple[Finite, ...], Field(min_length=1), about("Values of which each is equally likely.")]

    def quantile(self, u: float) -> float:
        """Return the value number floor(u n) of the n listed values, for u in [0, 1)."""
        return self.choice[min(math.floor(u * len(self.choice)), len(self.choice) - 1)]

    def extremes(self) -> tuple[float, ...]:
        """Return every value that can be drawn."""
        return self.choice


DISTRIBUTIONS = ("uniform", "log_uniform", "normal", "choice")


def _kind(value: object) -> str | None:
    """Return the tag of the union; in angle brackets, so that no key of a recipe has the same name."""
    if isinstance(value, Constant) or _are_numbers(value):
        return "<number>"
    names = list(value) if isinstance(value, Mapping) else list(getattr(type(value), "model_fields", ()))
    return f"<{names[0]}>" if len(names) == 1 and names[0] in DISTRIBUTIONS else None


def _known(value: object) -> object:
    """Return the value, where it is a distribution of any kind."""
    if _kind(value) is None:
        raise PydanticCustomError("distribution", "{message}", {"message": _unknown(value)})
    return value


def _unknown(value: object) -> str:
    """Say what to write for a value that is no distribution."""
    allowed = f"give a number or a table of one key: {', '.join(DISTRIBUTIONS)}"
    match value:
        case [low, high] if _are_numbers(low, high):
            return f"a range is written {{ uniform = [{low}, {high}] }}; {allowed}"
        case list() | tuple():
            shown = ", ".join([f"{each!r:.60}" for each in value[:5]] + ["..."] * (len(value) > 5))
            return f"values to choose from are written {{ choice = [{shown}] }}; {allowed}"
        case dict() if len(value) == 2 and _are_numbers(*value.values()) and "mean" not in value:
            low, high = value.values()
            return f"a range is written {{ uniform = [{low}, {high}] }}; {allowed}"
        case dict() if len(value) == 1:
            return f"no such distribution; {nearest(str(next(iter(value))), list(DISTRIBUTIONS))}"
    return f"no such distribution; {allowed}"


def _are_numbers(*values: object) -> bool:
    return all(isinstance(value, Real) and not isinstance(value, bool) for value in values)


Distribution = Annotated[
    Annotated[Constant, Tag("<number>")]
    | Annotated[Uniform, Tag("<uniform>")]
    | Annotated[LogUniform, Tag("<log_uniform>")]
    | Annotated[Normal, Tag("<normal>")]
    | Annotated[Choice, Tag("<choice>")],
    Discriminator(_kind),
    BeforeValidator(_known),
]


def _check_order(distribution: T, low: float, high: float) -> T:
    if low > high:
        raise ValueError(f"the lower end {low:g} is above the upper end {high:g}; swap them")
    return distribution
