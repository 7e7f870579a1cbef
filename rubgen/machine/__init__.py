"""What is simulated: frozen, validated descriptions of a blisk, its supports and its casing."""

from rubgen.machine.load import load_machine, preset_names
from rubgen.machine.machine import (
    STRICT,
    BladeRow,
    Casing,
    Damping,
    Disk,
    DiskSupport,
    Finite,
    Machine,
    Material,
    Mistuning,
    NonNegative,
    Positive,
    Ratio,
    SqueezeFilm,
    Unbalance,
)

__all__ = [
    "STRICT",
    "BladeRow",
    "Casing",
    "Damping",
    "Disk",
    "DiskSupport",
    "Finite",
    "Machine",
    "Material",
    "Mistuning",
    "NonNegative",
    "Positive",
    "Ratio",
    "SqueezeFilm",
    "Unbalance",
    "load_machine",
    "preset_names",
]
