"""A run: a machine, its operation, its contact law, its sensors.

Frozen and validated on creation, like the machine.
"""

import math
from dataclasses import replace
from typing import Annotated, Literal, cast

import numpy as np
from pydantic import Field, TypeAdapter
from pydantic.dataclasses import dataclass

from rubgen.brief import brief, counted
from rubgen.machine import Machine
from rubgen.machine.frame import Frame
from rubgen.machine.quantities import (
    STRICT,
    AdcBits,
    CasingModeCount,
    Duration,
    ModeCount,
    NoiseScale,
    Penetration,
    Rate,
    Seed,
    Speed,
    SpeedSwing,
    StepCount,
    Switch,
    TurnCount,
    about,
)
from rubgen.scenario.contact_laws.contact_law import ContactLaw
from rubgen.scenario.rotation import Rotation
from rubgen.scenario.run_id import run_id_of
from rubgen.scenario.surroundings import Surroundings
from rubgen.sensors.load import default_sensor_set
from rubgen.sensors.sensor_set import SensorSet
from rubgen.units import rad_per_s

ProfileName = Literal["steady", "run-up", "coast-down", "fluctuating"]


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Reduction:
    """Numbers of Craig-Bampton modes: per blade, of the disk, of the coupled blisk, of the casing."""

    blade_modes: Annotated[
        ModeCount,
        about("Modes of each blade, clamped at its root, beside the motion of its tip. Raise it for sharp touches."),
    ] = 4
    disk_modes: Annotated[
        ModeCount, about("Modes of the disk between the blades. Raise it where the disk is thin.")
    ] = 4
    blisk_modes: Annotated[
        ModeCount, about("Modes of the coupled blisk. Raise it to check that a result does not depend on it.")
    ] = 4
    casing_modes: Annotated[
        CasingModeCount,
        about("Modes of the casing ring. Raise it for short contact zones, which bend the ring in many waves."),
    ] = 11


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Operation:
    """The speed over a run. The clearance closes over `closing_turns`, transients decay, then the record begins.

    `settle_turns` are the turns before the record, with the closing; "auto" follows from the slowest decay of the
    model. `steps_per_turn` is the least number of steps; it is doubled until the step is stable and short enough for
    the sensors.

    `profile` "steady": the record has `record_turns`. "run-up" and "coast-down": the speed before the record is
    `speed_rpm`. In the record it is linear to `end_speed_rpm` within `duration_s`, then constant to the end of that
    turn. "fluctuating": the speed is speed_rpm + fluctuation_rpm sin(2 pi t / fluctuation_period_s) in the whole run,
    with t = 0 at the start of the record. The record lasts `duration_s`, and to the end of that turn. `profile_problem`
    checks the combination of keys. The speed must stay out of the bands `forbidden_speed_rpm`, each with a lower and an
    upper end.
    """

    speed_rpm: Speed
    settle_turns: TurnCount | Literal["auto"] = "auto"
    record_turns: TurnCount = 500
    steps_per_turn: StepCount = 1024
    closing_turns: TurnCount = 40
    profile: ProfileName = "steady"
    end_speed_rpm: Speed | None = None
    duration_s: Duration | None = None
    fluctuation_rpm: SpeedSwing = 0.0
    fluctuation_period_s: Duration = 1.0
    forbidden_speed_rpm: tuple[tuple[Speed, Speed], ...] = ()

    @property
    def rotation(self) -> Rotation:
        """Speed and angle as functions of time, with t = 0 at the start of the record."""
        return Rotation(
            start=rad_per_s(self.speed_rpm),
            end=rad_per_s(self.end_speed_rpm or self.speed_rpm),
            seconds=self.duration_s or 1.0,
            swing=rad_per_s(self.fluctuation_rpm),
            period=self.fluctuation_period_s,
        )

    @property
    def recorded_turns(self) -> int:
        """Turns of the record: `record_turns`, or the number of turns that begin within `duration_s`."""
        if self.duration_s is None:
            return self.record_turns
        turns = float(self.rotation.angle(self.duration_s)) / (2 * np.pi)
        return max(1, math.ceil(turns - 1e-9))

    @property
    def title(self) -> str:
        """The profile with its speeds, for a heading, such as "run-up at 5,000 to 9,000 rev/min"."""
        end = f" to {self.end_speed_rpm:,.6g}" if self.end_speed_rpm else ""
        swing = f" ± {self.fluctuation_rpm:,.6g}" if self.fluctuation_rpm else ""
        return f"{self.profile} at {self.speed_rpm:,.6g}{end}{swing} rev/min"

    @property
    def speed_rad_per_s(self) -> float:
        """Spin speed Omega in rad/s, of a changing speed at the start of the record."""
        return rad_per_s(self.speed_rpm)

    @property
    def rotation_frequency_hz(self) -> float:
        """Rotation frequency f_r in Hz."""
        return self.speed_rpm / 60


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Sensing:
    """How the true response becomes recorded channels.

    `set` are the sensors. `noise` scales every sensor's own noise level (0 switches it off). `keep_clean` also records,
    for each channel, the signal of an ideal sensor.
    """

    sample_rate_hz: Rate = 25600.0
    noise: NoiseScale = 1.0
    adc_bits: AdcBits = 16
    keep_clean: Switch = False
    set: SensorSet = Field(default_factory=default_sensor_set)

    __repr__ = brief

    @property
    def fastest_hz(self) -> float:
        """The highest frequency in Hz that the steps must resolve.

        It is the sample rate, or a higher bandwidth or resonance of a sensor.
        """
        return max(self.sample_rate_hz, self.set.front_end_hz)


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Labelling:
    """What is computed only for the labels: the Lyapunov exponent, which needs a second trajectory."""

    lyapunov: Annotated[
        Switch,
        about(
            "Whether the largest Lyapunov exponent of each steady run is computed. It takes about "
            "half as long again; turn it off where no chaos is studied."
        ),
    ] = True


@dataclass(frozen=True, kw_only=True, config=STRICT)
class VirtualMachine:
    """The virtual machine of a run, by its number in the recipe.

    `candidate` is the number of the candidate that is used; the candidates before it were refused. `problem` is the
    reason where no candidate can be used: the run is then refused. It is empty otherwise.
    """

    number: Seed
    candidate: Seed = 0
    problem: str = ""


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Pairing:
    """The partner of a run of a recipe with `[twins]`: its index is `twin_of` if the run is a twin, else None."""

    twin_of: Annotated[Seed | None, about("Index of the run whose twin this is. Without it the run is no twin.")] = None


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Chosen:
    """The candidate that a run of a recipe with `[balance]` is: number `tries` of its candidates, from 1.

    `cell` is the name of the class that the run was to have. `seen` counts the candidates by class: first the cells of
    the balance in their order, then candidates with a rub whose class was not computed because the run was to have no
    rub, then candidates that are not possible. `problem` is the reason where no candidate was in the cell: the run is
    then refused. It is empty otherwise.
    """

    cell: str
    tries: Seed
    seen: tuple[Seed, ...] = ()
    problem: str = ""


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Merged:
    """The source of a run of a merged set: `source` are the digits of a digest that name it.

    `first` is the number of the source's first run in the merged set.
    """

    source: str
    first: Seed


@dataclass(frozen=True, kw_only=True, config=STRICT)
class Scenario:
    """One run, complete. The same scenario always makes the same bytes.

    `fault_kinds` are the kinds of fault that runs of its recipe may have; the run's own faults are in `machine`. With
    `free_penetration_m` the clearance follows from the rub-free motion (`solver.linear.reach.with_clearance`); before
    that the machine's clearance is not the run's. `virtual` is None without `[machines]` in the recipe, `pairing`
    without `[twins]`, `balance` without `[balance]`, and `merged` outside a merged set.
    """

    machine: Machine
    operation: Operation
    contact: ContactLaw = ContactLaw()
    reduction: Reduction = Reduction()
    sensing: Sensing = Field(default_factory=Sensing)
    labelling: Labelling = Labelling()
    surroundings: Surroundings | None = None
    fault_kinds: tuple[str, ...] = ()
    free_penetration_m: Penetration | None = None
    pairing: Pairing | None = None
    balance: Chosen | None = None
    signal_seconds: Duration = 1.0
    seed: Seed = 0
    index: Seed = 0
    machine_id: str = ""
    virtual: VirtualMachine | None = None
    merged: Merged | None = None

    def __repr__(self) -> str:
        friction, sensing = self.contact.friction, self.sensing
        sensors = f"{counted(len(sensing.set.sensors), 'sensor')} {sensing.set.name!r} at {sensing.sample_rate_hz:g} Hz"
        facts = f"{self.operation.title}, friction {friction:g}, {sensors} for {self.signal_seconds:g} s"
        return f"Scenario({self.run_id}: {self.machine.name}, {facts}, seed {self.seed})"

    @property
    def frame(self) -> Frame | None:
        """The machine's frame; None where the machine has none or no sensor feels it."""
        felt = self.sensing.set.on_housing or (self.surroundings and self.surroundings.path_gain)
        return self.machine.frame if felt else None

    @property
    def twin_of(self) -> int | None:
        """Index of the partner of a twin; None for a run that is no twin."""
        return self.pairing.twin_of if self.pairing else None

    @property
    def partner(self) -> str | None:
        """Name of the partner of a twin; None for a run that is no twin."""
        return None if self.twin_of is None else replace(self, index=self.twin_of).run_id

    @property
    def drawn_as(self) -> int:
        """Index from which the run's random numbers follow: its own index, or the partner's index for a twin."""
        return self.index if self.twin_of is None else self.twin_of

    @property
    def number(self) -> int:
        """Number of the run in its set: `index`, in a merged set plus the number of its source's first run."""
        return self.index + (self.merged.first if self.merged else 0)

    @property
    def run_id(self) -> str:
        """Name of the run in files and tables."""
        return run_id_of(self.number)


def scenario_dict(scenario: Scenario) -> dict[str, object]:
    """Return the scenario with its machine as nested plain values for JSON.

    Keys are the names of the dataclasses' fields. `TypeAdapter(Scenario).validate_python(scenario_dict(s)) == s`: every
    float keeps all its bits in JSON. Keys for what the run does not have, such as surroundings, faults or a twin, are
    left out. A run of the first source of a merged set has no key `merged`: its values, name and files are the same as
    in the source, and it is read back as the run of the source.
    """
    values = cast("dict[str, object]", TypeAdapter(Scenario).dump_python(scenario, mode="json"))
    if scenario.surroundings is None:
        del values["surroundings"]
    if not scenario.fault_kinds:
        del values["fault_kinds"]
    for key in ("free_penetration_m", "virtual", "pairing", "balance"):
        if getattr(scenario, key) is None:
            del values[key]
    if not (scenario.merged and scenario.merged.first):
        del values["merged"]
    return values
