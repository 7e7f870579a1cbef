"""The base class of faults, and the forms in which faults act on a machine."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine.faults.strikes import Strikes
from rubgen.machine.support_laws.law import SupportLaw

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine


@dataclass(frozen=True, kw_only=True)
class Ramp:
    """Growth from 0 to 1 within the record, linear over `duration_s` from `start_s`; a step where that is 0.

    Times count from the start of the record.
    """

    start_s: float
    duration_s: float

    def share(self, time: FloatArray) -> FloatArray:
        """Return the share (any,) that has grown at times (any,) in s from the start of the record, 0 to 1."""
        if self.duration_s == 0:
            return np.where(time >= self.start_s, 1.0, 0.0)
        return np.asarray(np.clip((time - self.start_s) / self.duration_s, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class HarmonicLoad:
    """A force on the disk centre in the inertial frame: F_X = Re(x e^(i order theta)) and F_Y likewise, in N."""

    order: int
    x: complex
    y: complex
    ramp: Ramp | None = None
    """How it grows; None where it is always there."""
    of_springs: bool = False
    """Whether the lateral springs apply it, because they are at rest elsewhere; only for a `rotating` load."""

    @classmethod
    def rotating(cls, force: complex, ramp: Ramp | None = None, *, of_springs: bool = False) -> Self:
        """Make the load that is the constant force `force` = f_x + i f_y (N) in the turning frame: order 1, forward.

        `ramp` and `of_springs` are the fields of that name.
        """
        return cls(order=1, x=force, y=-1j * force, ramp=ramp, of_springs=of_springs)


@dataclass(frozen=True, kw_only=True)
class SurfaceHarmonic:
    """A part of the casing's inner surface: amplitude_m cos(order (theta - phase_rad))."""

    order: int
    amplitude_m: float
    phase_rad: float


@dataclass(frozen=True, kw_only=True)
class Narrowing:
    """A closing of the clearance within the record: by `amount_m` when it is over."""

    amount_m: float
    ramp: Ramp


@dataclass(frozen=True, kw_only=True)
class LostMass:
    """A mass that a blade has lost at its tip."""

    blade: int
    kg: float


@dataclass(frozen=True, kw_only=True)
class Severity:
    """The column of a fault's severity: name, unit and meaning."""

    column: str
    unit: str
    meaning: str


class Fault(ABC):
    """A fault of a machine. A kind of fault overrides only the functions through which it acts.

    The fields of a kind are its keys in a machine or a recipe, the first is `kind`. `speed` is in rad/s.
    """

    SEVERITY: ClassVar[Severity]
    STRIKES: ClassVar[bool] = False
    """Whether it strikes the machine's frame."""

    @property
    @abstractmethod
    def severity(self) -> float:
        """How severe the fault is, in the unit of `SEVERITY`."""

    def problem(self, machine: Machine) -> str | None:
        """Return why this machine cannot have the fault, with the remedy; None where it can."""
        return None

    def doubt(self, machine: Machine, speed: float) -> str | None:
        """Return why the fault is hardly intended at this speed; None without doubt.

        The text begins with a key and its value.
        """
        return None

    def altered(self, machine: Machine) -> Machine:
        """Return the machine that the fault makes of this one. Faults of shape or material override it."""
        return machine

    def surface_harmonics(self, machine: Machine) -> tuple[SurfaceHarmonic, ...]:
        """Return the harmonics that the fault adds to the casing's inner surface."""
        return ()

    def lost_masses(self, machine: Machine) -> tuple[LostMass, ...]:
        """Return the masses that the fault has taken from the tips of blades."""
        return ()

    def lost_blades(self, machine: Machine) -> tuple[int, ...]:
        """Return the numbers of the blades that the fault has taken away as a whole."""
        return ()

    def narrowings(self, machine: Machine) -> tuple[Narrowing, ...]:
        """Return how the fault closes the clearance within the record."""
        return ()

    def loads(self, machine: Machine, speed: float) -> tuple[HarmonicLoad, ...]:
        """Return the forces of the fault on the disk centre that do not depend on the motion."""
        return ()

    def support_laws(self, machine: Machine, speed: float) -> tuple[SupportLaw, ...]:
        """Return the laws of the fault's forces on the disk centre that depend on its motion."""
        return ()

    def strikes(self, turned: FloatArray, speed: FloatArray, rng: np.random.Generator) -> Strikes | None:
        """Draw the blows of the fault on the machine's frame, which move sensors and not the disk; None without any.

        - turned (steps,): angle of the shaft at the steps, rad, rising. Blows are drawn back from the last one.
        - speed (steps,): of the shaft there, rad/s.
        - rng: random numbers.
        """
        return None


def missing_blade(blade: int, machine: Machine) -> str | None:
    """Return the problem of a blade number that the machine does not have; None where it has that blade."""
    last = machine.blades.count - 1
    if blade > last:
        return f"blade = {blade}: there is no such blade; give 0 to {last}"
    if blade in machine.lost_blades:
        return f"blade = {blade}: the fault lost-blade has taken this blade; give another one"
    return None
