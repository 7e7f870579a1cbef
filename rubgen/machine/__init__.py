"""What is simulated: frozen, validated descriptions of a blisk, its supports and its casing."""

from rubgen.machine.load import load_machine, preset_names
from rubgen.machine.machine import (
    BladeRow,
    Casing,
    Damping,
    Disk,
    Machine,
    Material,
    Mistuning,
    Unbalance,
)
from rubgen.machine.support_laws.disk_support import DiskSupport
from rubgen.machine.support_laws.squeeze_film import SqueezeFilm

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
