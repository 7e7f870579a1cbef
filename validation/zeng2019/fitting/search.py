"""A search for what the paper does not publish: lateral damping, mass of the casing, friction.

Unbalance and clearance follow from the damping by onset and end of rubbing (`validation.onset`); springs follow
from the mass, since the casing's frequencies fix their ratio. Damping of blades and casing stay as they were chosen.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from itertools import product

import numpy as np
from scipy.optimize import brentq

from rubgen.machine import Machine, load_machine
from rubgen.scenario import ContactLaw, Operation, Scenario
from validation.onset import fit_unbalance_and_clearance, tip_growth
from validation.piece import Arrays, Piece
from validation.zeng2019.runs.cases import END_OF_RUB, ONSET_RPM, SUPPORT_RPM
from validation.zeng2019.runs.outcome import outcome_of, run
from validation.zeng2019.runs.region import CHAOTIC, PERIODIC
from validation.zeng2019.size import MACHINE

DAMPING, MASS, FRICTION = (0.05, 0.10, 0.15), (1.0, 2.0, 3.5, 5.0, 8.0), (0.0, 0.02)
"""The grid; mass in times the lightest reading of the casing, of which the preset has five."""
PRESET_MASS = 5.0
SETTLE, RECORD = 100, 200
"""Turns of these runs: more candidates with less certain labels."""
ANY = "any"
HEAD = """# The preset zeng2019 with the casing's mass, the damping, unbalance and clearance that
# `python -m validation.zeng2019 --fit` found. See docs/zeng2019-fit.md and docs/preset-zeng2019.md.
"""


@dataclass(frozen=True, kw_only=True)
class Target:
    """A run and the paper's words for the motion of blisk and casing; stiffnesses of the casing as printed."""

    speed_rpm: float = SUPPORT_RPM
    disk_support: float | None = None
    casing_support: float | None = None
    blisk: str
    casing: str


FITTED = (
    *(Target(speed_rpm=rpm, blisk=PERIODIC, casing=CHAOTIC) for rpm in (6900.0, 7260.0, 7620.0, 7980.0)),
    *(Target(speed_rpm=rpm, blisk=CHAOTIC, casing=ANY) for rpm in (8130.0, 8340.0)),
    *(Target(speed_rpm=rpm, blisk=PERIODIC, casing=ANY) for rpm in (8640.0, 8880.0)),
    *(Target(speed_rpm=rpm, blisk=CHAOTIC, casing=CHAOTIC) for rpm in (11400.0, 12300.0, 13200.0, 14100.0, 14910.0)),
)
"""Classes of the regions II, III and V: what the search uses."""
PREDICTED = (
    *(Target(disk_support=k, blisk=PERIODIC, casing=PERIODIC) for k in (1.4e8, 2e8, 3e8, 6e8)),
    Target(casing_support=3.8e3, blisk=CHAOTIC, casing=CHAOTIC),
    Target(casing_support=1.82e4, blisk=CHAOTIC, casing=PERIODIC),
    Target(casing_support=2.27e4, blisk=PERIODIC, casing=PERIODIC),
    Target(casing_support=5.06e4, blisk=CHAOTIC, casing=CHAOTIC),
    Target(casing_support=1.25e5, blisk=CHAOTIC, casing=CHAOTIC),
)
"""Classes of the sweeps of both supports: what it does not use."""
TARGETS = FITTED + PREDICTED


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """Values of the unknowns."""

    damping: float
    mass: float
    friction: float

    @property
    def piece(self) -> Piece:
        """The piece that runs the candidate at every target."""
        return Piece(classes, (self.damping, self.mass, self.friction))


PRESET = Candidate(damping=0.10, mass=PRESET_MASS, friction=0.0)


def candidates(thin: int = 1) -> list[Candidate]:
    """The grid, with the preset's own values; every `thin`-th of the others."""
    grid = [Candidate(damping=d, mass=m, friction=f) for d, m, f in product(DAMPING, MASS, FRICTION)]
    return [PRESET, *(one for one in grid[::thin] if one != PRESET)]


def machine_of(damping: float, mass: float) -> Machine:
    """The preset with that lateral and tilt damping and casing mass, unbalance and clearance fitted again."""
    preset, ratio = load_machine(MACHINE), mass / PRESET_MASS
    casing = replace(
        preset.casing,
        width_m=preset.casing.width_m * ratio,
        radial_support_stiffness_n_per_m=preset.casing.radial_support_stiffness_n_per_m * ratio,
        circumferential_support_stiffness_n_per_m=preset.casing.circumferential_support_stiffness_n_per_m * ratio,
    )
    unbalance, clearance = _unbalance_and_clearance(damping)
    return replace(
        preset,
        casing=replace(casing, clearance_m=clearance),
        damping=replace(preset.damping, lateral=damping, tilt=damping),
        unbalance_kg_m=unbalance,
    )


@cache
def _unbalance_and_clearance(damping: float) -> tuple[float, float]:
    preset = load_machine(MACHINE)
    if damping == preset.damping.lateral:
        return preset.unbalance_kg_m, preset.casing.clearance_m
    return fit_unbalance_and_clearance(replace(preset, damping=replace(preset.damping, lateral=damping, tilt=damping)))


def classes(damping: float, mass: float, friction: float) -> Arrays:
    """Motion of `blisk` and `casing` at each of TARGETS, or the status of a run that failed."""
    machine = machine_of(damping, mass)
    found = [outcome_of(run(_scenario(machine, mass, friction, target))) for target in TARGETS]
    return {
        "blisk": np.array([one.motion_blisk if one.ok else one.status for one in found]),
        "casing": np.array([one.motion_casing if one.ok else one.status for one in found]),
    }


def _scenario(machine: Machine, mass: float, friction: float, target: Target) -> Scenario:
    if target.disk_support is not None:
        support = replace(machine.disk_support, lateral_stiffness_n_per_m=target.disk_support)
        machine = replace(machine, disk_support=support)
    if target.casing_support is not None:
        k = mass * target.casing_support
        casing = replace(
            machine.casing, radial_support_stiffness_n_per_m=k, circumferential_support_stiffness_n_per_m=k
        )
        machine = replace(machine, casing=casing)
    operation = Operation(speed_rpm=target.speed_rpm, settle_turns=SETTLE, record_turns=RECORD)
    return Scenario(machine=machine, operation=operation, contact=ContactLaw(friction=friction))


def room(damping: float) -> Arrays:
    """`unbalance` in kg m and `clearance` in m: least and largest that the published facts leave at that damping.

    They are among the four pairs in which the tips just touch at one end of the interval of onset, 6,660 or 6,780
    rev/min, and at one end of that of the end of rub at 10,000 rev/min, 6.70e8 or 6.75e8 N/m.
    """
    machine = machine_of(damping, PRESET_MASS)
    pairs = np.array([_touching(machine, rpm, k) for rpm, k in product(ONSET_RPM, END_OF_RUB)])
    least, largest = pairs.min(axis=0), pairs.max(axis=0)
    return {"unbalance": np.array([least[0], largest[0]]), "clearance": np.array([least[1], largest[1]])}


def _touching(machine: Machine, rpm: float, stiffness: float) -> tuple[float, float]:
    """Unbalance and clearance with which tips just touch at that speed, and on that support at 10,000 rev/min."""
    stiff = replace(machine, disk_support=replace(machine.disk_support, lateral_stiffness_n_per_m=stiffness))

    def apart(unbalance: float) -> float:
        there = tip_growth(replace(machine, unbalance_kg_m=unbalance), rpm)
        return there - tip_growth(replace(stiff, unbalance_kg_m=unbalance), SUPPORT_RPM)

    unbalance = float(brentq(apart, 1e-4, 1.0, xtol=1e-8))
    return unbalance, tip_growth(replace(machine, unbalance_kg_m=unbalance), rpm)


def toml_of(candidate: Candidate) -> str:
    """The preset's TOML with the candidate's values, under the name `zeng2019-fitted`. Friction is no part of it."""
    machine = machine_of(candidate.damping, candidate.mass)
    springs = f"{machine.casing.radial_support_stiffness_n_per_m:.6g}"
    values = {
        "name": '"zeng2019-fitted"',
        "unbalance_kg_m": f"{machine.unbalance_kg_m:.5g}",
        "width_m": f"{machine.casing.width_m:.6g}",
        "clearance_m": f"{machine.casing.clearance_m:.5g}",
        "radial_support_stiffness_n_per_m": springs,
        "circumferential_support_stiffness_n_per_m": springs,
        "lateral": f"{candidate.damping:g}",
        "tilt": f"{candidate.damping:g}",
    }
    preset = (files("rubgen.machine") / "presets" / f"{MACHINE}.toml").read_text(encoding="utf-8")
    text = HEAD + preset[preset.index("name = ") :]
    for key, value in values.items():
        text, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
        if count != 1:
            raise ValueError(f"{MACHINE}.toml: {key} stands there {count} times, once was expected")
    return text
