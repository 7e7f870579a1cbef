"""The base class of faults, and the forms in which faults act on a machine."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.machine.support_laws.law import SupportLaw

if TYPE_CHECKING:
    from rubgen.machine.machine import Machine


@dataclass(frozen=True, kw_only=True)
class Ramp:
    """Growth from 0 to 1 within the record, linear over `duration_s` from `start_s`; sudden for a duration of 0.

    Times count from the start of the record.
    """

    start_s: float
    duration_s: float

    def share(self, time: FloatArray) -> FloatArray:
        """Return the grown share (any,), 0 to 1, at times (any,) in s from the start of the record."""
        if self.duration_s == 0:
            return np.where(time >= self.start_s, 1.0, 0.0)
        return np.asarray(np.clip((time - self.start_s) / self.duration_s, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class HarmonicLoad:
    """A force on the disk centre in the inertial frame, in N.

    F_X = Re(x e^(i order theta)) and F_Y = Re(y e^(i order theta)), with theta the blisk's angle.
    """

    order: int
    x: complex
    y: complex
    ramp: Ramp | None = None
    """How it grows; None where it is always there."""
    of_springs: bool = False
    """Whether the lateral springs apply it, because they are at rest elsewhere; only for a `rotating` load."""

    @classmethod
    def rotating(cls, force: complex, ramp: Ramp | None = None, *, of_springs: bool = False) -> Self:
        """Make the load of a force f_x + i f_y (N) that is constant in the turning frame: order 1, forward.

        `ramp` and `of_springs` are the fields of the same name.
        """
        return cls(order=1, x=force, y=-1j * force, ramp=ramp, of_springs=of_springs)


@dataclass(frozen=True, kw_only=True)
class SurfaceHarmonic:
    """A change of the radius of the casing's inner surface: amplitude_m cos(order (theta - phase_rad))."""

    order: int
    amplitude_m: float
    phase_rad: float


@dataclass(frozen=True, kw_only=True)
class Narrowing:
    """A closing of the clearance within the record, by `amount_m` in all. `ramp` is its course in time."""

    amount_m: float
    ramp: Ramp


@dataclass(frozen=True, kw_only=True)
class LostMass:
    """A mass `kg` that blade number `blade` has lost at its tip."""

    blade: int
    kg: float


@dataclass(frozen=True, kw_only=True)
class Strikes:
    """Blows on the bearing housing. Each blow is so short that only its impulse counts."""

    turned: FloatArray
    """Angle of the shaft at each (any,), in rad, on the scale of the angles that were asked for."""
    impulse_n_s: FloatArray
    direction_rad: FloatArray
    """Direction of each in the inertial frame, from +X."""


@dataclass(frozen=True, kw_only=True)
class Severity:
    """The column of a data set with a fault's severity: name, unit and meaning."""

    column: str
    unit: str
    meaning: str


class Fault(ABC):
    """A fault of a machine. A kind of fault overrides only the functions through which it acts.

    The fields of a kind are its keys in a machine or a recipe; the first field is `kind`. `speed` is in rad/s.
    """

    SEVERITY: ClassVar[Severity]
    STRIKES: ClassVar[bool] = False
    """Whether it strikes the machine's frame."""

    @property
    @abstractmethod
    def severity(self) -> float:
        """The severity of the fault, in the unit of `SEVERITY`."""

    def problem(self, machine: Machine) -> str | None:
        """Return why this machine cannot have the fault, with the remedy; None where it can have it."""
        return None

    def doubt(self, machine: Machine, speed: float) -> str | None:
        """Return why the fault is hardly intended at this speed (rad/s); None without doubt.

        The text begins with a key and its value.
        """
        return None

    def altered(self, machine: Machine) -> Machine:
        """Return the machine with the fault. Faults of shape or material override it; by default nothing is changed."""
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
        """Return the closings of the clearance within the record that the fault causes."""
        return ()

    def loads(self, machine: Machine, speed: float) -> tuple[HarmonicLoad, ...]:
        """Return the forces of the fault on the disk centre that do not depend on the motion, at `speed` in rad/s."""
        return ()

    def support_laws(self, machine: Machine, speed: float) -> tuple[SupportLaw, ...]:
        """Return the laws of the fault's forces on the disk centre that depend on its motion, at `speed` in rad/s."""
        return ()

    def strikes(self, turned: FloatArray, speed: FloatArray, rng: np.random.Generator) -> Strikes | None:
        """Draw the blows of the fault on the machine's frame; None for a fault without blows.

        They do not move the disk.

        - turned (steps,): angle of the shaft at the steps, rad, rising. Blows are drawn backward from the last angle.
        - speed (steps,): speed of the shaft at the steps, rad/s.
        - rng: random numbers.

        The result has the angle of the shaft, the impulse (N s) and the direction (rad from +X, inertial) of each blow.
        """
        return None


def missing_blade(blade: int, machine: Machine) -> str | None:
    """Return a problem if the machine has no blade of this number, or has lost it as a whole; else None."""
    last = machine.blades.count - 1
    if blade > last:
        return f"blade = {blade}: there is no such blade; give 0 to {last}"
    if blade in machine.lost_blades:
        return f"blade = {blade}: the fault lost-blade has taken this blade; give another one"
    return None
