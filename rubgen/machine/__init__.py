"""What is simulated: frozen, validated descriptions of a blisk, its supports and its casing."""

from rubgen.machine.load import load_machine, preset_names
from rubgen.machine.machine import (
    BladeRow,
    Casing,
    Damping,
    Disk,
    DiskSupport,
    Machine,
    Material,
    Mistuning,
    SqueezeFilm,
    Unbalance,
)

__all__ = [
    "BladeRow",
    "Casing",
    "Damping",
    "Disk",
    "DiskSupport",
    "Machine",
    "Material",
    "Mistuning",
    "SqueezeFilm",
    "Unbalance",
    "load_machine",
    "preset_names",
]
