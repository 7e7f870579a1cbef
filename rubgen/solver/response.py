"""The result of the integration of one run."""

import math
from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from rubgen.arrays import ComplexArray, FloatArray, IntArray
from rubgen.brief import brief
from rubgen.scenario.rotation import Rotation

ORDERS = 20
"""Orders of rotation of which a response holds the amplitudes: 1 to this number."""
WINDOW_TURNS = 16
"""Turns of a window of `Response.window_orders`."""


class Status(StrEnum):
    """How an integration ended; each value is a sentence for the user."""

    OK = "ok"
    DIVERGED = "diverged: displacements left the range in which linear casing and blades mean anything"
    UNSTABLE = "unstable: the linear system without contact grows by itself, or never forgets"
    CONTACT_UNSOLVED = "contact-unsolved: no unique contact force was found in a step"
    ENERGY = "energy: the energy identity of the scheme was not kept"
    REFUSED = "refused: these values make no run"
    FILM_CLOSED = "film-closed: the disk centre reached the clearance of its squeeze film damper"
    DIED = "died: the process that made this run ended without a result, twice"

    @property
    def code(self) -> str:
        """The word before the colon: `ok`, `diverged`, ... as it stands in tables."""
        return self.value.split(":")[0]


@dataclass(frozen=True, kw_only=True)
class ContactEvents:
    """One row per uninterrupted touch of one blade within the record, in order of its end; all arrays (n_events,)."""

    blade: IntArray
    start_step: IntArray
    """First step of the touch, counted from the start of the record."""
    steps: IntArray
    """Number of steps with a positive contact force."""
    angle: FloatArray
    """Polar angle on the casing in [0, 2 pi), mean weighted by impulse, rad."""
    impulse: FloatArray
    """Normal impulse, integral of the contact force, N s."""
    friction_loss: FloatArray
    """Work of friction at the contact, J, <= 0."""
    normal_loss: FloatArray
    """Work lost in the normal direction, J, <= 0 for restitution 0."""

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class TipArrivals:
    """Passages of blades under one timing probe in the tail, in order of time; all arrays (n_arrivals,)."""

    blade: IntArray
    step: FloatArray
    """Time in steps from the start of the record, with its fraction; negative in the settling."""
    displacement: FloatArray
    """How far the tip's chord stands along the rotation, in m, from its place on the undeformed machine at rest."""

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class EnergyBalance:
    """Energies and works over the whole integration, in J, computed as the scheme computes them.

    end - start is the sum of unbalance, damping, circulatory, anisotropy, support_laws, gravity, contact, speed_change
    and faults except for rounding. A work is positive where it adds energy. These works are taken in the turning frame.
    """

    start: float
    """Energy E half a step before the first step."""
    end: float
    """Energy E half a step before the end."""
    unbalance: float
    """Work of the forces that are constant in the turning frame: unbalance, bow."""
    damping: float
    """Work of the damping."""
    circulatory: float
    """Work of the circulatory stiffness."""
    anisotropy: float
    """Work of uneven springs and dampers beyond their mean."""
    support_laws: float
    """Work of the squeeze film and of other laws of the support."""
    gravity: float
    """Work of the weight."""
    contact: float
    """Work of the contact forces, the sum of lam^T B^T d.

    The drive that keeps the speed supplies contact - normal_loss - friction_loss - wear_loss."""
    normal_loss: float
    """Energy that contacts dissipate along the normal, <= 0."""
    friction_loss: float
    """Energy that contacts dissipate by friction, <= 0."""
    support_laws_loss: float
    """Work of these laws in the inertial frame: minus the heat of a squeeze film, above 0 where it feeds a whirl."""
    speed_change: float
    """Energy added by the stiffness as it follows a changing speed."""
    absolute_work: float
    """Sum of the absolute works."""
    residual: float
    """|end - start - sum of works| over the largest of `absolute_work`, the largest |E| and the rounding error of E."""
    faults: float = 0.0
    """Work of the other loads of faults."""
    wear_loss: float = 0.0
    """Work of the contact forces on a liner's surface as it recedes, <= 0; 0 without a liner."""


@dataclass(frozen=True, kw_only=True)
class Track:
    """The whole motion over the few turns about the hardest touch, with the data that a replay needs to draw it."""

    step: IntArray
    """Steps of the frames (frames,), counted from the first step of the record."""
    q: FloatArray
    """States (frames, n) as in `SpinningSystem`, the blisk in its turning frame."""
    tip_growth: FloatArray
    """Steady displacement of the tips (1, n_blades, 3), m; (record_turns, n_blades, 3) where the speed changes."""
    casing_modes: FloatArray
    """X and Y displacements of each casing mode at the casing's nodes (nodes, 2, n_casing)."""

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class WornLiner:
    """A liner at the end of a run."""

    angle: FloatArray
    """Polar angles of the bins (bins,), rad."""
    depth: FloatArray
    """Depth worn at these angles (bins,), m."""
    volume: float
    """Volume removed in m3: the mean depth times the area of the track."""
    removed: float
    """Volume removed in m3: the sum of what each contact removed. Equal to `volume` except for rounding."""

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class ChangingSpeed:
    """Speed, turns and orders of a run at a changing speed.

    Turn k of the record begins at the step nearest theta = 2 pi k.
    """

    rotation: Rotation
    """Speed (rad/s) and angle (rad) over time in s; t = 0 at the first step of the record."""
    turn_steps: IntArray
    """First step of each turn, counted from the first step of the record (record_turns + 1,)."""
    orders: ComplexArray
    """Complex amplitudes of each tap in each turn (record_turns, taps, 20), taps in the order of `Response.taps`.

    2 / turn times the integral of x exp(-i k theta) over the angle, k = 1 .. 20."""

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class Response:
    """The true response of one run. It does not contain the history of the state.

    Where `status` is not OK, no array may be used as data. States are q and v as in `SpinningSystem`: n coordinates,
    the blisk in its turning frame. The turning frame coincides with the inertial frame where theta = 0 mod 2 pi.
    """

    status: Status
    """How the integration ended."""
    reason: str
    """Where it failed and by how much; empty where `status` is OK."""
    speed: float
    """Spin speed in rad/s; the mean of the record where the speed changes."""
    dt: float
    """Time step in s."""
    steps_per_turn: int
    """Number of steps in a turn; at the highest speed where the speed changes."""
    settle_turns: int
    """Number of turns before the record."""
    record_turns: int
    """Number of turns of the record."""
    taps: dict[str, FloatArray]
    """True signals by name, one value for each step (n_tail,). The last value belongs to the last step of the record.

    The tail covers the seconds asked for or 100 turns, whichever is longer. It reaches back into the settling where
    the record is shorter."""
    section_q: FloatArray
    """Poincare section (record_turns, n): q once a turn, at theta = 0 mod 2 pi."""
    section_v: FloatArray
    """Its velocities (record_turns, n)."""
    impulse_per_turn: FloatArray
    """Normal impulse of all blades in each turn (record_turns,), N s."""
    contact_steps_per_turn: IntArray
    """Number of steps of each turn in which any blade touched (record_turns,)."""
    events: ContactEvents
    """The touches of the record."""
    energy: EnergyBalance
    """Works over the whole integration, settling included."""
    n_blades: int
    """Number of blades."""
    n_casing: int
    """Number of casing modes."""
    track: Track | None = None
    """The motion about the hardest touch; None where signals of less than a turn were asked for."""
    worn: WornLiner | None = None
    """The liner at the end of the run; None without a liner."""
    companion_growth: FloatArray = field(default_factory=lambda: np.zeros(0))
    """Ln of the growth of the companion trajectory's distance in each of its turns (turns,); (0,) without a companion.

    Its turns are the first of the record, until they settle the exponent. NaN in a turn that it could not follow."""
    symmetry_states: FloatArray = field(default_factory=lambda: np.zeros((0, 2, 0)))
    """q and v (N, 2, n) after 1/N, 2/N, ... 1 of the last turn, the casing turned back by the same share.

    N is the number of the casing's lobes. All N states are equal where q(t + T/N) = q(t). (0, 2, 0) for a changing
    speed."""
    arrivals: dict[str, TipArrivals] = field(default_factory=dict)
    """Passages of blades under each timing probe in the tail, by the probe's name."""
    changing_speed: ChangingSpeed | None = None
    """Speed and angle over time; None for a steady speed."""
    orbit: FloatArray = field(default_factory=lambda: np.zeros((0, 5)))
    """Means over a turn of X, Y (m), X^2 + Y^2, V_X^2 + V_Y^2 and X V_Y - Y V_X of the disk centre (turns, 5).

    X and Y are inertial. The turns are the last 100; all turns of the record where the speed changes."""
    blisk_mass: float = float("nan")
    """Mass of the blisk in kg; NaN where it is not known."""
    free_penetration: float = float("nan")
    """How deep the tips of the rub-free motion would enter the casing at rest, m; negative is a clearance.

    Infinite where laws of the support leave that motion unknown, else NaN at a changing speed."""
    window_orders: ComplexArray = field(default_factory=lambda: np.zeros((0, 0, 20), dtype=np.complex128))
    """Complex amplitudes of each tap at k f_r, k = 1 .. 20, in windows of 16 turns (windows, taps, 20).

    The windows are the last of the record that the taps cover. None (0, ..) where the speed changes."""

    grows: bool = False
    """Whether a fault grows within the record, at a steady speed. A rub then has no single class of motion."""

    __repr__ = brief

    @property
    def knows_free_motion(self) -> bool:
        """Whether the motion without rub is known.

        It is not where `free_penetration` is infinite: it may then be chaotic.
        """
        return self.free_penetration != math.inf

    @property
    def turn_seconds(self) -> float:
        """Duration of one turn at the highest speed in s."""
        return self.dt * self.steps_per_turn

    @property
    def record_steps(self) -> int:
        """Number of steps of the record."""
        if self.changing_speed is not None:
            return int(self.changing_speed.turn_steps[-1])
        return self.record_turns * self.steps_per_turn

    @property
    def tail_steps(self) -> int:
        """Number of steps that `taps` cover: the end of the record."""
        return next(iter(self.taps.values())).size
