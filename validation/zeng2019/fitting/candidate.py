"""Values of what the paper does not publish, the machine that they make, and its motion at the paper's words.

Unbalance and clearance follow from surface and damping by onset and end of rubbing (`validation.onset`). Damping of
blades and casing stay as they were chosen.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from functools import cache

import numpy as np

from rubgen.machine import Machine, load_machine
from rubgen.scenario import ContactLaw, Operation, Scenario
from validation.onset import Surface, fit_unbalance_and_clearance, matched_clearance
from validation.piece import Arrays, Piece
from validation.zeng2019.fitting.targets import TARGETS, Target
from validation.zeng2019.runs.outcome import outcome_of, run
from validation.zeng2019.size import MACHINE

PRESET_MASS = 5.0
"""The mass of the preset's casing in times the lightest one."""
SETTLE, RECORD = 100, 200
"""Turns of these runs: more candidates with less certain labels."""


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """Values of the unknowns: `mass` in times the lightest casing, `springs` in times those of the frequencies."""

    surface: Surface = "smooth"
    mass: float = PRESET_MASS
    damping: float = 0.10
    friction: float = 0.0
    springs: float = 1.0

    @property
    def piece(self) -> Piece:
        """The piece that runs the candidate at every target."""
        return Piece(classes, astuple(self))


PRESET = Candidate()


def machine_of(candidate: Candidate) -> Machine:
    """The preset with the candidate's values, unbalance and clearance fitted again."""
    preset, ratio = load_machine(MACHINE), candidate.mass / PRESET_MASS
    springs = preset.casing.radial_support_stiffness_n_per_m * ratio * candidate.springs
    casing = replace(
        preset.casing,
        width_m=preset.casing.width_m * ratio,
        radial_support_stiffness_n_per_m=springs,
        circumferential_support_stiffness_n_per_m=springs,
    )
    unbalance, clearance = _unbalance_and_clearance(candidate.damping, candidate.surface)
    return replace(
        preset,
        casing=replace(casing, clearance_m=clearance),
        damping=replace(preset.damping, lateral=candidate.damping, tilt=candidate.damping),
        unbalance_kg_m=unbalance,
    )


@cache
def _unbalance_and_clearance(damping: float, surface: Surface) -> tuple[float, float]:
    preset = load_machine(MACHINE)
    if damping != preset.damping.lateral:
        damped = replace(preset, damping=replace(preset.damping, lateral=damping, tilt=damping))
        return fit_unbalance_and_clearance(damped, surface)
    clearance = preset.casing.clearance_m
    return preset.unbalance_kg_m, clearance if surface == "smooth" else matched_clearance(preset, clearance)


def classes(surface: Surface, mass: float, damping: float, friction: float, springs: float) -> Arrays:
    """Motion of the disk centre (`blisk`) and `casing` at each of TARGETS, or the status of a run that failed."""
    one = Candidate(surface=surface, mass=mass, damping=damping, friction=friction, springs=springs)
    found = [outcome_of(run(_scenario(one, target))) for target in TARGETS]
    return {
        "blisk": np.array([each.motion_centre if each.ok else each.status for each in found]),
        "casing": np.array([each.motion_casing if each.ok else each.status for each in found]),
    }


def _scenario(one: Candidate, target: Target) -> Scenario:
    machine = machine_of(one)
    if target.disk_support is not None:
        support = replace(machine.disk_support, lateral_stiffness_n_per_m=target.disk_support)
        machine = replace(machine, disk_support=support)
    if target.casing_support is not None:
        k = one.mass * target.casing_support
        casing = replace(
            machine.casing, radial_support_stiffness_n_per_m=k, circumferential_support_stiffness_n_per_m=k
        )
        machine = replace(machine, casing=casing)
    operation = Operation(speed_rpm=target.speed_rpm, settle_turns=SETTLE, record_turns=RECORD)
    return Scenario(
        machine=machine, operation=operation, contact=ContactLaw(surface=one.surface, friction=one.friction)
    )
