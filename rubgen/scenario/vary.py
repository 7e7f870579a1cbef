"""The keys of `[vary]`: what each one changes in a scenario, where it is read back, and what it may be.

A new key is one entry at the end of `PARAMETERS`: each entry owns one dimension of the Sobol sequence, so the order
must not change.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from pydantic import ValidationError

from rubgen.errors import UserError
from rubgen.machine.machine import LEAST_LENGTH, LEAST_STIFFNESS, MOST_LOBES
from rubgen.machine.problems import nearest
from rubgen.machine.sentences import sentence
from rubgen.scenario.scenario import LEAST_RPM, Scenario

DEFAULT_SPEED_RPM = 10_000.0
"""Speed where none is given: the machine itself has none."""


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One key of `[vary]`; allowed values lie in [minimum, maximum], without the minimum where `above` is set."""

    key: str
    unit: str
    meaning: str
    read: Callable[[Scenario], float]
    apply: Callable[[Scenario, float], Scenario]
    minimum: float = 0.0
    maximum: float = math.inf
    above: bool = True
    whole: bool = False

    def allows(self, value: float) -> bool:
        """Whether the value is finite, in range, and whole where it must be."""
        low = value > self.minimum if self.above else value >= self.minimum
        return math.isfinite(value) and low and value <= self.maximum and (not self.whole or value == int(value))

    @property
    def allowed(self) -> str:
        """The allowed range in words."""
        kind = "a whole number of " if self.whole else ""
        low = f"{kind}{'above' if self.above else 'at least'} {self.minimum:g}"
        return low if math.isinf(self.maximum) else f"{low} and at most {self.maximum:g}"


def _operation(name: str) -> Callable[[Scenario, float], Scenario]:
    def apply(scenario: Scenario, value: float) -> Scenario:
        changes: dict[str, Any] = {name: value}
        return replace(scenario, operation=replace(scenario.operation, **changes))

    return apply


def _record_seconds(scenario: Scenario) -> float:
    operation = scenario.operation
    return operation.duration_s or operation.record_turns / operation.rotation_frequency_hz


def _casing(*names: str) -> Callable[[Scenario, float], Scenario]:
    def apply(scenario: Scenario, value: float) -> Scenario:
        changes: dict[str, Any] = dict.fromkeys(names, value)
        casing = replace(scenario.machine.casing, **changes)
        return replace(scenario, machine=replace(scenario.machine, casing=casing))

    return apply


def _lobes(scenario: Scenario, value: float) -> Scenario:
    casing = replace(scenario.machine.casing, lobes=int(value))
    return replace(scenario, machine=replace(scenario.machine, casing=casing))


def _disk_support(scenario: Scenario, value: float) -> Scenario:
    support = replace(scenario.machine.disk_support, lateral_stiffness_n_per_m=value)
    return replace(scenario, machine=replace(scenario.machine, disk_support=support))


def _support_anisotropy(scenario: Scenario, value: float) -> Scenario:
    support = replace(scenario.machine.disk_support, lateral_stiffness_anisotropy=value)
    return replace(scenario, machine=replace(scenario.machine, disk_support=support))


def _gravity(scenario: Scenario, value: float) -> Scenario:
    return replace(scenario, machine=replace(scenario.machine, gravity_m_per_s2=value))


def _friction(scenario: Scenario, value: float) -> Scenario:
    return replace(scenario, contact=replace(scenario.contact, friction=value))


def _unbalance(scenario: Scenario, value: float) -> Scenario:
    return replace(scenario, machine=replace(scenario.machine, unbalance_kg_m=value))


def _unbalance_angle(scenario: Scenario, value: float) -> Scenario:
    return replace(scenario, machine=replace(scenario.machine, unbalance_angle_deg=value))


def _lateral_damping(scenario: Scenario, value: float) -> Scenario:
    damping = replace(scenario.machine.damping, lateral=value)
    return replace(scenario, machine=replace(scenario.machine, damping=damping))


PARAMETERS = (
    Parameter(
        key="speed_rpm",
        unit="rev/min",
        meaning="spin speed, of a run-up or coast-down at its start",
        read=lambda scenario: scenario.operation.speed_rpm,
        apply=_operation("speed_rpm"),
        minimum=LEAST_RPM,
        maximum=1e6,
        above=False,
    ),
    Parameter(
        key="clearance_m",
        unit="m",
        meaning="smallest gap between blade tips and casing at rest",
        read=lambda scenario: scenario.machine.casing.clearance_m,
        apply=_casing("clearance_m"),
        minimum=LEAST_LENGTH,
        maximum=100,
        above=False,
    ),
    Parameter(
        key="ovality_m",
        unit="m",
        meaning="largest minus smallest radius of the casing's inner surface",
        read=lambda scenario: scenario.machine.casing.ovality_m,
        apply=_casing("ovality_m"),
        maximum=100,
        above=False,
    ),
    Parameter(
        key="disk_support_stiffness_n_per_m",
        unit="N/m",
        meaning="lateral stiffness of the disk support, mean of X and Y",
        read=lambda scenario: scenario.machine.disk_support.lateral_stiffness_n_per_m,
        apply=_disk_support,
        minimum=LEAST_STIFFNESS,
        maximum=1e16,
        above=False,
    ),
    Parameter(
        key="casing_support_stiffness_n_per_m",
        unit="N/m",
        meaning="radial and circumferential stiffness under each casing node",
        read=lambda scenario: scenario.machine.casing.radial_support_stiffness_n_per_m,
        apply=_casing("radial_support_stiffness_n_per_m", "circumferential_support_stiffness_n_per_m"),
        minimum=LEAST_STIFFNESS,
        maximum=1e16,
        above=False,
    ),
    Parameter(
        key="friction",
        unit="1",
        meaning="Coulomb coefficient of sliding friction",
        read=lambda scenario: scenario.contact.friction,
        apply=_friction,
        maximum=0.3,
        above=False,
    ),
    Parameter(
        key="lobes",
        unit="1",
        meaning="number of lobes of the casing's inner surface",
        read=lambda scenario: scenario.machine.casing.lobes,
        apply=_lobes,
        minimum=2,
        maximum=MOST_LOBES,
        above=False,
        whole=True,
    ),
    Parameter(
        key="unbalance_kg_m",
        unit="kg m",
        meaning="mass unbalance of the blisk",
        read=lambda scenario: scenario.machine.unbalance_kg_m,
        apply=_unbalance,
        maximum=1e7,
        above=False,
    ),
    Parameter(
        key="casing_thickness_m",
        unit="m",
        meaning="radial thickness of the casing ring",
        read=lambda scenario: scenario.machine.casing.thickness_m,
        apply=_casing("thickness_m"),
        minimum=LEAST_LENGTH,
        maximum=100,
        above=False,
    ),
    Parameter(
        key="lateral_damping",
        unit="1",
        meaning="damping ratio of the blisk moving laterally as a rigid body, from the dampers beside the disk support",
        read=lambda scenario: scenario.machine.damping.lateral,
        apply=_lateral_damping,
        maximum=0.99,
        above=False,
    ),
    Parameter(
        key="support_anisotropy",
        unit="1",
        meaning="lateral stiffness of the disk support, (k_X - k_Y) / (k_X + k_Y)",
        read=lambda scenario: scenario.machine.disk_support.lateral_stiffness_anisotropy,
        apply=_support_anisotropy,
        minimum=-0.9,
        maximum=0.9,
        above=False,
    ),
    Parameter(
        key="gravity_m_per_s2",
        unit="m/s2",
        meaning="gravity along -Y on the blisk; 0 for a vertical axis",
        read=lambda scenario: scenario.machine.gravity_m_per_s2,
        apply=_gravity,
        maximum=1e4,
        above=False,
    ),
    Parameter(
        key="end_speed_rpm",
        unit="rev/min",
        meaning="spin speed at the end of a run-up or coast-down",
        read=lambda scenario: scenario.operation.end_speed_rpm or scenario.operation.speed_rpm,
        apply=_operation("end_speed_rpm"),
        minimum=LEAST_RPM,
        maximum=1e6,
        above=False,
    ),
    Parameter(
        key="duration_s",
        unit="s",
        meaning="duration of the record, and of a run-up or coast-down",
        read=_record_seconds,
        apply=_operation("duration_s"),
        maximum=1e5,
    ),
    Parameter(
        key="fluctuation_rpm",
        unit="rev/min",
        meaning="amplitude of a fluctuation of the speed",
        read=lambda scenario: scenario.operation.fluctuation_rpm,
        apply=_operation("fluctuation_rpm"),
        maximum=1e6,
        above=False,
    ),
    Parameter(
        key="fluctuation_period_s",
        unit="s",
        meaning="period of a fluctuation of the speed",
        read=lambda scenario: scenario.operation.fluctuation_period_s,
        apply=_operation("fluctuation_period_s"),
        maximum=1e5,
    ),
    Parameter(
        key="unbalance_angle_deg",
        unit="deg",
        meaning="angle of the unbalance from blade 0, in the sense of rotation",
        read=lambda scenario: scenario.machine.unbalance_angle_deg,
        apply=_unbalance_angle,
        minimum=-360.0,
        maximum=360.0,
        above=False,
    ),
)
KEYS = tuple(parameter.key for parameter in PARAMETERS)


def parameter(key: str, source: str = "") -> Parameter:
    """The entry of that key; UserError with the nearest key when there is none. `source` names the file, if any."""
    for entry in PARAMETERS:
        if entry.key == key:
            return entry
    raise UserError(f"{source}{key}: unknown key; {nearest(key, list(KEYS))}")


def vary(scenario: Scenario, values: Mapping[str, float], source: str = "") -> Scenario:
    """The scenario with these keys of `[vary]` changed; UserError for an unknown key or a value out of range."""
    for key, value in values.items():
        entry = parameter(key, source)
        if not entry.allows(value):
            share = 1 < value <= 100 and entry.maximum < 1
            remedy = f"{value:g} % is written {value / 100:g}" if share else "change the value"
            raise UserError(f"{source}{key} = {value:g}: must be {entry.allowed}; {remedy}")
        try:
            scenario = entry.apply(scenario, value)
        except ValidationError as error:
            text = sentence(error.errors()[0], "", [])
            raise UserError(f"{source}{key} = {value:g}: {text}; change the value") from None
    return scenario


def varied_values(scenario: Scenario) -> dict[str, float]:
    """The value of every key of `[vary]` in this scenario, in the order of the keys."""
    return {entry.key: entry.read(scenario) for entry in PARAMETERS}
