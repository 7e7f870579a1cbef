"""The keys of `[machines.vary]`: where each value stands in a machine, and what is allowed.

A new key is one entry at the end of `MACHINE_KEYS`. Each entry has one dimension of the Sobol sequence of the machines,
so the order must not change.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from operator import attrgetter, getitem
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from rubgen.machine import Machine
from rubgen.machine.problems import first_problem
from rubgen.machine.quantities import (
    Angle,
    BladeCount,
    CasingShare,
    DampingRatio,
    DeviationSpread,
    FrameFrequency,
    Length,
    Lobes,
    ModalMass,
    Stiffness,
)
from rubgen.scenario.vary import KEYS, PARAMETERS

Values = dict[str, Any]
"""A machine as nested values, keys as in its TOML."""
_MACHINE = TypeAdapter(Machine)


@dataclass(frozen=True)
class MachineKey:
    """One key of `[machines.vary]`: unit, meaning, kind of quantity, how it is written and how it is read."""

    key: str
    unit: str
    meaning: str
    quantity: Any
    write: Callable[[Values, float], None]
    """Puts a value into the values of a machine."""
    read: Callable[[Machine], float]

    @property
    def whole(self) -> bool:
        """Whether the key takes only whole numbers."""
        return self.quantity in (BladeCount, Lobes)

    @property
    def about(self) -> str:
        """The description of the key for the recipe's schema."""
        return f"{self.meaning[0].upper()}{self.meaning[1:]}. Without it the machine's own value."

    @property
    def of_frame(self) -> bool:
        """Whether the key describes the machine's frame."""
        return self.key.startswith("frame_")


def _plain(key: str, unit: str, meaning: str, quantity: Any, *places: str) -> MachineKey:
    """Make a key whose value stands at these places of the machine."""

    def write(values: Values, value: float) -> None:
        for place in places:
            *parts, name = place.split(".")
            reduce(getitem, parts, values)[name] = value

    return MachineKey(key, unit, meaning, quantity, write, attrgetter(places[0]))


def _as_in_vary(key: str) -> MachineKey:
    """Make the key that stands in `[vary]` too: drawn once a machine here, in each run there."""
    entry = next(entry for entry in PARAMETERS if entry.key == key)
    places = (place.removeprefix("machine.") for place in entry.places)
    return _plain(key, entry.unit, entry.meaning, entry.quantity, *places)


def _scaled(key: str, unit: str, meaning: str, quantity: Any, first: str, other: str) -> MachineKey:
    """Make a key of the blades' root whose tip keeps its ratio to the root."""

    def write(values: Values, value: float) -> None:
        blades = values["blades"]
        blades[other] *= value / blades[first]
        blades[first] = value

    return MachineKey(key, unit, meaning, quantity, write, attrgetter(f"blades.{first}"))


def _of_frame(key: str, unit: str, meaning: str, quantity: Any, name: str) -> MachineKey:
    """Make a key of the frame's first mode; the other modes keep their ratio to it."""

    def write(values: Values, value: float) -> None:
        modes = values["frame"]["modes"]
        factor = value / modes[0][name]
        for mode in modes:
            mode[name] *= factor

    def read(machine: Machine) -> float:
        return float(getattr(machine.frame.modes[0], name)) if machine.frame else float("nan")

    return MachineKey(key, unit, meaning, quantity, write, read)


def _write_count(values: Values, count: float) -> None:
    """Set the number of blades; every blade needs a node at the rim, so the disk gets the nearest number of sectors."""
    disk, number = values["disk"], int(count)
    disk["circumferential_elements"] = number * max(1, round(disk["circumferential_elements"] / number))
    values["blades"]["count"] = number


def _write_twist(values: Values, twist: float) -> None:
    blades = values["blades"]
    middle = (blades["root_angle_deg"] + blades["tip_angle_deg"]) / 2
    blades |= {"root_angle_deg": middle - twist / 2, "tip_angle_deg": middle + twist / 2}


def _write_stagger(values: Values, stagger: float) -> None:
    blades = values["blades"]
    half = (blades["tip_angle_deg"] - blades["root_angle_deg"]) / 2
    blades |= {"root_angle_deg": stagger - half, "tip_angle_deg": stagger + half}


def _write_radius(values: Values, radius: float) -> None:
    casing = values["casing"]
    tip = values["disk"]["rim_radius_m"] + values["blades"]["length_m"]
    casing["clearance_m"] = radius - tip - casing["ovality_m"] / 2


def _write_mistuning(values: Values, deviation: float) -> None:
    values["blades"]["mistuning"] = {"relative_std": deviation, "seed": 0}


MACHINE_KEYS = (
    MachineKey(
        "blade_count",
        "1",
        "number of blades; the disk's mesh follows",
        BladeCount,
        _write_count,
        attrgetter("blades.count"),
    ),
    _plain("blade_length_m", "m", "length of a blade from rim to tip", Length, "blades.length_m"),
    _scaled(
        "blade_chord_m", "m", "chord at the root; the tip's keeps its ratio", Length, "root_chord_m", "tip_chord_m"
    ),
    _scaled(
        "blade_thickness_m",
        "m",
        "thickness of a blade at the root; the tip's keeps its ratio",
        Length,
        "root_thickness_m",
        "tip_thickness_m",
    ),
    MachineKey(
        "blade_twist_deg",
        "deg",
        "angle of the tip less that of the root",
        Angle,
        _write_twist,
        lambda machine: machine.blades.tip_angle_deg - machine.blades.root_angle_deg,
    ),
    MachineKey(
        "blade_stagger_deg",
        "deg",
        "mean of the angles at root and tip",
        Angle,
        _write_stagger,
        lambda machine: (machine.blades.tip_angle_deg + machine.blades.root_angle_deg) / 2,
    ),
    _plain("disk_bore_radius_m", "m", "radius of the disk's bore", Length, "disk.bore_radius_m"),
    _plain("disk_rim_radius_m", "m", "radius of the disk's rim", Length, "disk.rim_radius_m"),
    _plain("disk_bore_thickness_m", "m", "thickness of the disk at the bore", Length, "disk.bore_thickness_m"),
    _plain("disk_rim_thickness_m", "m", "thickness of the disk at the rim", Length, "disk.rim_thickness_m"),
    _as_in_vary("clearance_m"),
    _as_in_vary("ovality_m"),
    _as_in_vary("lobes"),
    _as_in_vary("casing_thickness_m"),
    _plain("casing_width_m", "m", "axial width of the casing ring", Length, "casing.width_m"),
    _as_in_vary("casing_support_stiffness_n_per_m"),
    _as_in_vary("disk_support_stiffness_n_per_m"),
    _as_in_vary("support_anisotropy"),
    _plain(
        "tilt_stiffness_nm_per_rad",
        "N m/rad",
        "stiffness of the disk support against tilting",
        Stiffness,
        "disk_support.tilt_stiffness_nm_per_rad",
    ),
    _as_in_vary("lateral_damping"),
    _plain("tilt_damping", "1", "damping ratio of the blisk tilting", DampingRatio, "damping.tilt"),
    _plain("blade_damping", "1", "damping ratio of a blade's first mode", DampingRatio, "damping.blade"),
    _plain("casing_damping", "1", "damping ratio of every casing mode", DampingRatio, "damping.casing"),
    MachineKey(
        "mistuning",
        "1",
        "standard deviation of the blades' relative stiffness; each machine draws its own pattern",
        DeviationSpread,
        _write_mistuning,
        lambda machine: float(np.std(machine.blades.stiffness_deviations)),
    ),
    _as_in_vary("unbalance_kg_m"),
    _as_in_vary("unbalance_angle_deg"),
    _of_frame(
        "frame_frequency_hz",
        "Hz",
        "frequency of the frame's first mode; the others keep their ratio to it",
        FrameFrequency,
        "frequency_hz",
    ),
    _of_frame(
        "frame_modal_mass_kg",
        "kg",
        "modal mass of the frame's first mode; the others keep their ratio to it",
        ModalMass,
        "modal_mass_kg",
    ),
    _of_frame(
        "frame_casing_share",
        "1",
        "motion of the casing over the housing's in the frame's first mode; the others keep their ratio to it",
        CasingShare,
        "casing_share",
    ),
    MachineKey(
        "casing_radius_m",
        "m",
        "mean radius of the casing's inside; the clearance follows from it, in place of clearance_m",
        Length,
        _write_radius,
        attrgetter("casing_mean_radius_m"),
    ),
)


def own_keys(*, frame: bool) -> tuple[MachineKey, ...]:
    """Return the keys of `[machines.vary]` that `[vary]` does not have: they need columns of their own.

    Keys of the machine's frame are included only with `frame`.
    """
    return tuple(entry for entry in MACHINE_KEYS if entry.key not in KEYS and (frame or not entry.of_frame))


def machine_values(machine: Machine) -> dict[str, float]:
    """Return the machine's value of every key of `[machines.vary]` that `[vary]` does not have, in the key's unit.

    Keys of the frame are included where the machine has a frame.
    """
    return {entry.key: entry.read(machine) for entry in own_keys(frame=machine.frame is not None)}


def with_values(machine: Machine, values: Mapping[str, float], pattern_seed: int = 0) -> Machine:
    """Return the machine with the values of some keys of `[machines.vary]` changed.

    - values: by key, in the key's unit; applied in the order of MACHINE_KEYS. Other keys are ignored. Keys of the frame
      need a machine with a frame.
    - pattern_seed: seed of the mistuning pattern of the blades, used where `values` has "mistuning".

    Raises UserError where the values make no machine, such as a bore larger than the rim.
    """
    changed = _MACHINE.dump_python(machine, mode="json")
    for entry in MACHINE_KEYS:
        if entry.key in values:
            entry.write(changed, values[entry.key])
    if "mistuning" in values:
        changed["blades"]["mistuning"]["seed"] = pattern_seed
    try:
        return _MACHINE.validate_python(changed)
    except ValidationError as error:
        raise first_problem("", error, changed, _MACHINE) from None
