"""The keys of `[vary]`: where each key is written and read in a scenario, and what is allowed.

A new key is one entry at the end of `PARAMETERS`. Each entry has one dimension of the Sobol sequence, so the order must
not change.
"""

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any

import numpy as np
from pydantic import TypeAdapter, create_model

from rubgen.arrays import FloatArray
from rubgen.machine.problems import validated
from rubgen.machine.quantities import (
    STRICT,
    Angle,
    Anisotropy,
    DampingRatio,
    Duration,
    Friction,
    Gravity,
    Height,
    Length,
    Lobes,
    Penetration,
    Speed,
    SpeedSwing,
    Stiffness,
    UnbalanceSize,
)
from rubgen.scenario.scenario import Scenario

DEFAULT_SPEED_RPM = 10_000.0
"""Speed where none is given: the machine itself has none."""
DIMENSIONS = 32
"""Dimensions that are always generated, so a key that is added later changes no value of an existing recipe."""


@dataclass(frozen=True)
class Parameter:
    """One key of `[vary]`: its unit, meaning and kind of quantity, and its places in a scenario."""

    key: str
    unit: str
    meaning: str
    quantity: Any
    places: tuple[str, ...]

    @property
    def whole(self) -> bool:
        """Whether the key takes only whole numbers."""
        return self.quantity is Lobes

    @property
    def about(self) -> str:
        """The description of the key for the recipe's schema: its field's, or its meaning if it has several fields.

        For a value of the machine, and for the speed, a last sentence says what is used without the key.
        """
        kind: Any = Scenario
        text = None
        for name in self.places[0].split("."):
            field = kind.__pydantic_fields__[name]
            kind, text = field.annotation, field.description
        if len(self.places) > 1 or text is None:
            text = f"{self.meaning[0].upper()}{self.meaning[1:]}."
        if self.places[0].startswith("machine."):
            return f"{text} Without it the machine's own value."
        return f"{text} Without it {DEFAULT_SPEED_RPM:,.0f}." if self.key == "speed_rpm" else text

    def read(self, scenario: Scenario) -> float:
        """Return the value in `scenario` of a key of PARAMETERS.

        Without an end speed, `end_speed_rpm` is `speed_rpm`. Without a duration, `duration_s` is the length of the
        record in s.
        """
        value: float | None = attrgetter(self.places[0])(scenario)
        if value is not None:
            return value
        operation = scenario.operation
        if self.key == "end_speed_rpm":
            return operation.speed_rpm
        return operation.record_turns / operation.rotation_frequency_hz

    def apply(self, scenario: Scenario, value: float) -> Scenario:
        """Return the scenario with `value` in all fields of the key."""
        for place in self.places:
            scenario = _changed(scenario, place.split("."), value)
        return scenario


PARAMETERS = (
    Parameter(
        "speed_rpm", "rev/min", "spin speed, of a run-up or coast-down at its start", Speed, ("operation.speed_rpm",)
    ),
    Parameter(
        "clearance_m",
        "m",
        "smallest gap between blade tips and casing at rest",
        Length,
        ("machine.casing.clearance_m",),
    ),
    Parameter(
        "ovality_m",
        "m",
        "largest minus smallest radius of the casing's inner surface",
        Height,
        ("machine.casing.ovality_m",),
    ),
    Parameter(
        "disk_support_stiffness_n_per_m",
        "N/m",
        "lateral stiffness of the disk support, mean of X and Y",
        Stiffness,
        ("machine.disk_support.lateral_stiffness_n_per_m",),
    ),
    Parameter(
        "casing_support_stiffness_n_per_m",
        "N/m",
        "radial and circumferential stiffness under each casing node",
        Stiffness,
        ("machine.casing.radial_support_stiffness_n_per_m", "machine.casing.circumferential_support_stiffness_n_per_m"),
    ),
    Parameter("friction", "1", "Coulomb coefficient of sliding friction", Friction, ("contact.friction",)),
    Parameter("lobes", "1", "number of lobes of the casing's inner surface", Lobes, ("machine.casing.lobes",)),
    Parameter("unbalance_kg_m", "kg m", "mass unbalance of the blisk", UnbalanceSize, ("machine.unbalance_kg_m",)),
    Parameter(
        "casing_thickness_m", "m", "radial thickness of the casing ring", Length, ("machine.casing.thickness_m",)
    ),
    Parameter(
        "lateral_damping",
        "1",
        "damping ratio of the blisk moving laterally as a rigid body, from the dampers beside the disk support",
        DampingRatio,
        ("machine.damping.lateral",),
    ),
    Parameter(
        "support_anisotropy",
        "1",
        "lateral stiffness of the disk support, (k_X - k_Y) / (k_X + k_Y)",
        Anisotropy,
        ("machine.disk_support.lateral_stiffness_anisotropy",),
    ),
    Parameter(
        "gravity_m_per_s2",
        "m/s2",
        "gravity along -Y on the blisk; 0 for a vertical axis",
        Gravity,
        ("machine.gravity_m_per_s2",),
    ),
    Parameter(
        "end_speed_rpm",
        "rev/min",
        "spin speed at the end of a run-up or coast-down",
        Speed,
        ("operation.end_speed_rpm",),
    ),
    Parameter(
        "duration_s", "s", "duration of the record, and of a run-up or coast-down", Duration, ("operation.duration_s",)
    ),
    Parameter(
        "fluctuation_rpm",
        "rev/min",
        "amplitude of a fluctuation of the speed",
        SpeedSwing,
        ("operation.fluctuation_rpm",),
    ),
    Parameter(
        "fluctuation_period_s",
        "s",
        "period of a fluctuation of the speed",
        Duration,
        ("operation.fluctuation_period_s",),
    ),
    Parameter(
        "unbalance_angle_deg",
        "deg",
        "angle of the unbalance from blade 0, in the sense of rotation",
        Angle,
        ("machine.unbalance_angle_deg",),
    ),
)
FREE_PENETRATION = Parameter(
    "free_penetration_m",
    "m",
    "how deep tips would be without contact; the clearance follows from it",
    Penetration,
    ("free_penetration_m",),
)
"""Drawn in place of the clearance. It is no column of its own: the clearance that follows is one."""
DRAWN = (*PARAMETERS, FREE_PENETRATION)
TWO_CLEARANCES = "free_penetration_m: stands beside clearance_m, which follows from it; keep one of the two"
KEYS = tuple(parameter.key for parameter in PARAMETERS)
KEYS_AT = {place: parameter.key for parameter in PARAMETERS for place in parameter.places}
"""The key of a place of the scenario."""
_FIELDS: dict[str, Any] = {parameter.key: (parameter.quantity, None) for parameter in DRAWN}
_VALUES: TypeAdapter[Any] = TypeAdapter(create_model("Values", __config__=STRICT, **_FIELDS))


def vary(scenario: Scenario, values: Mapping[str, float], source: str = "", table: tuple[str, ...] = ()) -> Scenario:
    """Return the scenario with the values of some keys of `[vary]` changed.

    - values: by key, in the key's unit; `free_penetration_m` is such a key too.
    - source, table: file and table, for messages.

    Raises UserError for an unknown key, or for a value outside of the range of its key. It is not checked whether the
    values go together. A new `clearance_m` does not remove a `free_penetration_m` of the scenario, which replaces it
    later (`with_clearance`).
    """
    checked = validated(source, dict(values), _VALUES, lambda path: (*table, *path))
    for entry in DRAWN:
        if entry.key in values:
            scenario = entry.apply(scenario, getattr(checked, entry.key))
    return scenario


def varied_values(scenario: Scenario) -> dict[str, float]:
    """Return the scenario's value of every key of `[vary]`, in the order of the keys and in their units."""
    return {entry.key: entry.read(scenario) for entry in PARAMETERS}


def _changed(record: Any, place: list[str], value: float) -> Any:
    """Return the record with another value at that place."""
    name, *rest = place
    return replace(record, **{name: _changed(getattr(record, name), rest, value) if rest else value})


def candidate_point(seed: int, index: int, attempt: int) -> dict[str, float]:
    """Return one u in [0, 1) for each key of `[vary]`, for candidate `attempt` of run `index` of a balanced recipe.

    `seed` is the recipe's seed. Candidate 0 has the values of `sobol_point`, as the run without a balance. All other
    candidates are independent draws.
    """
    if attempt == 0:
        return sobol_point(seed, index)
    point = np.random.default_rng([seed, index, attempt, zlib.crc32(b"balance")]).random(len(DRAWN))
    return {entry.key: float(u) for entry, u in zip(DRAWN, point, strict=True)}


def sobol_point(seed: int, index: int) -> dict[str, float]:
    """Return one u in [0, 1) for each key of `[vary]`: point `index` of the Sobol sequence scrambled by `seed`.

    Each key has a fixed dimension. Giving a key a fixed value in the recipe therefore changes no other key.
    """
    from scipy.stats import qmc  # slow to import, and only needed here

    engine = qmc.Sobol(d=DIMENSIONS, scramble=True, rng=np.random.default_rng(np.random.SeedSequence(seed)))
    if index:
        engine.fast_forward(index)  # fast_forward(0) overflows
    point: FloatArray = engine.random(1)[0]
    return {**dict(zip(KEYS, point.tolist(), strict=False)), FREE_PENETRATION.key: float(point[-1])}
