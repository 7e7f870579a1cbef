"""The forms of the entries of the registry of labels. Each function takes fields of `Label`."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Literal

from rubgen.arrays import FloatArray
from rubgen.labels.harmonics import TapOrders
from rubgen.labels.labels import Labels
from rubgen.solver.response import EnergyBalance

Role = Literal["target", "truth", "diagnostic"]
"""What a label is for: an answer that a model may learn, the true motion, or how good the simulation or a label is."""
Value = Callable[[Labels], object]
"""How a label is read: a Python value, None where it is undefined, any iterable for a list. NaN becomes None."""


@dataclass(frozen=True)
class Label:
    """One label of a run. Its value is null where the run failed or the label is undefined."""

    name: str
    """Public name, with the unit as its end."""
    kind: str
    """text, flag, integer, integers (list), number or numbers (list)."""
    unit: str
    """Empty for a text, a flag and a count; "1" for a ratio."""
    meaning: str
    """One line for tables."""
    value: Value
    words: type[StrEnum] | None = None
    """The words that a text may be, or whose numbers (`class_numbers`) a list has."""
    from_taps: bool = False
    """Whether it needs the signals at every step, which the compact record does not have."""
    role: Role = "truth"


@dataclass(frozen=True)
class TapLabel:
    """One label of each true signal (tap).

    Its name is `<tap>_<ending>`; `{tap}` in its meaning stands for the tap's name.
    """

    ending: str
    kind: str
    unit: str | None
    """None for the unit of the tap."""
    meaning: str
    value: Callable[[TapOrders], object]


@dataclass(frozen=True)
class WindowLabel:
    """One label of each true signal (tap) in windows, a column of data files only. Its name is `<tap>_<ending>`."""

    ending: str
    meaning: str
    value: Callable[[FloatArray], object]
    """Its value from amplitudes (windows, 20) in the unit of the tap."""


@dataclass(frozen=True)
class EnergyLabel:
    """One energy term of a run, a column of Parquet files only; null where the run failed."""

    name: str
    unit: str
    meaning: str
    value: Callable[[EnergyBalance], float]
    role: Role = "truth"


def text(name: str, meaning: str, words: type[StrEnum], value: Value, *, role: Role = "truth") -> Label:
    """Make a label whose value is a word of `words`."""
    return Label(name, "text", "", meaning, value, words=words, role=role)


def flag(name: str, meaning: str, value: Value, *, from_taps: bool = False, role: Role = "truth") -> Label:
    """Make a label whose value is a truth value."""
    return Label(name, "flag", "", meaning, value, from_taps=from_taps, role=role)


def count(name: str, meaning: str, value: Value, *, unit: str = "", role: Role = "truth") -> Label:
    """Make a label whose value is a whole number."""
    return Label(name, "integer", unit, meaning, value, role=role)


def counts(name: str, meaning: str, value: Value, *, unit: str = "", from_taps: bool = False) -> Label:
    """Make a label whose value is a list of whole numbers."""
    return Label(name, "integers", unit, meaning, value, from_taps=from_taps)


def number(name: str, unit: str, meaning: str, value: Value, *, role: Role = "truth") -> Label:
    """Make a label whose value is a number."""
    return Label(name, "number", unit, meaning, value, role=role)


def numbers(name: str, unit: str, meaning: str, value: Value, *, role: Role = "truth") -> Label:
    """Make a label whose value is a list of numbers."""
    return Label(name, "numbers", unit, meaning, value, role=role)
