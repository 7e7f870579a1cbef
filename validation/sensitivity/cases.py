"""The runs at which everything is tried, and what is changed in them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from rubgen.scenario import Scenario, make_scenario
from rubgen.scenario.vary import vary

CASES: dict[str, dict[str, float]] = {
    "light": {"speed_rpm": 10000.0, "disk_support_stiffness_n_per_m": 2e8},
    "light, friction 0.01": {"speed_rpm": 10000.0, "disk_support_stiffness_n_per_m": 2e8, "friction": 0.01},
    "heavier": {"speed_rpm": 11400.0},
    "chaotic": {"speed_rpm": 9000.0},
    "chaotic, friction 0.01": {"speed_rpm": 9000.0, "friction": 0.01},
}
"""Runs of the preset zeng2019; the first three are period-1 by default."""

AUTO = 0
"""Stands for settle turns that follow from the model."""


@dataclass(frozen=True, kw_only=True)
class Study:
    """One number that is varied, and the value at which results are the yardstick for the others.

    `quick` are the values of a quick study. `apply` gives the scenario with the value. `model` marks what changes the
    reduced model itself, so that growth and frequencies are worth a look.
    """

    name: str
    quantity: str
    values: tuple[int, ...]
    quick: tuple[int, ...]
    default: int
    yardstick: int
    apply: Callable[[Scenario, int], Scenario]
    model: bool = False

    def text(self, value: int) -> str:
        """The value as it is shown."""
        return "auto" if value == AUTO else str(value)


def case(name: str) -> Scenario:
    """The scenario of one of the CASES."""
    return vary(make_scenario("zeng2019"), CASES[name])


def with_operation(scenario: Scenario, **changes: Any) -> Scenario:
    """The scenario with other values of its operation."""
    return replace(scenario, operation=replace(scenario.operation, **changes))


def _steps(scenario: Scenario, value: int) -> Scenario:
    return with_operation(scenario, steps_per_turn=value)


def _settle(scenario: Scenario, value: int) -> Scenario:
    return with_operation(scenario, settle_turns="auto" if value == AUTO else value)


def _modes(name: str) -> Callable[[Scenario, int], Scenario]:
    def apply(scenario: Scenario, value: int) -> Scenario:
        changes: dict[str, Any] = {name: value}
        return replace(scenario, reduction=replace(scenario.reduction, **changes))

    return apply


def _nodes(scenario: Scenario, value: int) -> Scenario:
    """Springs stand under every node: their sum round the ring is kept, so that it stays the same casing."""
    casing = scenario.machine.casing
    share = casing.nodes / value
    finer = replace(
        casing,
        nodes=value,
        radial_support_stiffness_n_per_m=casing.radial_support_stiffness_n_per_m * share,
        circumferential_support_stiffness_n_per_m=casing.circumferential_support_stiffness_n_per_m * share,
    )
    return replace(scenario, machine=replace(scenario.machine, casing=finer))


STUDIES = (
    Study(
        name="steps",
        quantity="Steps a turn",
        values=(256, 512, 1024, 2048, 4096, 8192),
        quick=(512, 1024, 2048),
        default=1024,
        yardstick=8192,
        apply=_steps,
    ),
    Study(
        name="blade_modes",
        quantity="Modes of each blade",
        values=(2, 4, 8, 16),
        quick=(2, 4),
        default=4,
        yardstick=16,
        apply=_modes("blade_modes"),
        model=True,
    ),
    Study(
        name="disk_modes",
        quantity="Modes of the disk",
        values=(1, 4, 10, 40),
        quick=(4, 10),
        default=4,
        yardstick=40,
        apply=_modes("disk_modes"),
        model=True,
    ),
    Study(
        name="blisk_modes",
        quantity="Modes of the blisk",
        values=(4, 12, 40, 86),
        quick=(4, 12),
        default=4,
        yardstick=86,
        apply=_modes("blisk_modes"),
        model=True,
    ),
    Study(
        name="casing_modes",
        quantity="Modes of the casing",
        values=(5, 7, 9, 11, 13, 15, 23),
        quick=(9, 11, 13),
        default=11,
        yardstick=11,
        apply=_modes("casing_modes"),
        model=True,
    ),
    Study(
        name="casing_nodes",
        quantity="Nodes of the casing",
        values=(60, 120, 180, 360, 720),
        quick=(120, 180),
        default=180,
        yardstick=720,
        apply=_nodes,
        model=True,
    ),
    Study(
        name="settle_turns",
        quantity="Settle turns",
        values=(50, 100, 200, 300, 500, 800, AUTO),
        quick=(50, 100),
        default=AUTO,
        yardstick=800,
        apply=_settle,
    ),
)
