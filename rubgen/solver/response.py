"""What the integration of one run gives."""

from __future__ import annotations

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
    """Works over the whole integration, in J, as the scheme books them.

    residual = |E_end - E_start - sum of works| / (sum of absolute works); the identity is exact but for rounding, and
    where hardly any work is done (no rub) the largest |E| stands for the works. `contact` is lam^T B^T d;
    `normal_loss` and `friction_loss` are losses of the contact itself, <= 0, and so is `wear_loss`, the work of the
    contact force on a liner's surface as it recedes (0 without one); the drive that keeps the speed constant pays
    drive_contact_work = contact - normal_loss - friction_loss - wear_loss, which tends to drive_contact_limit = -Omega
    times the time integral of the contact torque on the blisk, both positive where contact brakes.
    `anisotropy` is the work of uneven springs and dampers beyond their mean, `film` that of a squeeze film, `gravity`
    that of the weight, all in the turning frame, where the drive's share counts too; `film_loss` is what the film turns
    into heat, <= 0. `speed_change` is what the stiffness, which follows a changing speed, adds to the stored energy.
    """

    start: float
    end: float
    unbalance: float
    damping: float
    circulatory: float
    anisotropy: float
    film: float
    gravity: float
    contact: float
    normal_loss: float
    friction_loss: float
    drive_contact_work: float
    drive_contact_limit: float
    film_loss: float
    speed_change: float
    absolute_work: float
    residual: float
    wear_loss: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Track:
    """The whole motion over the few turns about the hardest touch, and what places it in space.

    `step` (frames,) counts from the first of the record; `q` (frames, n) is the state as in `SpinningSystem`, the blisk
    in its turning frame. `tip_growth` (1, n_blades, 3) is added to the tips; of a changing speed there is one for each
    turn of the record. `casing_modes` (nodes, 2, n_casing) are the X and Y displacements of each casing mode at its
    nodes.
    """

    step: IntArray
    q: FloatArray
    tip_growth: FloatArray
    casing_modes: FloatArray

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class WornLiner:
    """What is left of a liner at the end of a run.

    `angle` (bins,) polar angles in rad, `depth` (bins,) worn there in m; `volume` removed in m3, the mean depth times
    the track's area, and `removed`, the same as the sum of what each contact took.
    """

    angle: FloatArray
    depth: FloatArray
    volume: float
    removed: float

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class ChangingSpeed:
    """A changing speed: `rotation` holds speed (rad/s) and angle over time, t = 0 at the first step of the record.

    Turn k of the record begins at step `turn_steps[k]` (record_turns + 1,), counted from that one: the step nearest to
    theta = 2 pi k. `orders` (record_turns, taps, 20) are complex amplitudes of each tap in each turn, in the order of
    `Response.taps`: 2 / turn times the integral of x exp(-i k theta) over the angle, k = 1 .. 20.
    """

    rotation: Rotation
    turn_steps: IntArray
    orders: ComplexArray

    __repr__ = brief


@dataclass(frozen=True, kw_only=True)
class Response:
    """The true response of one run: never a history of the state.

    `taps` maps a name to the signal at every step of the end of the record, (n_tail,), the last step of the record
    being the last value; the tail covers the asked seconds or 100 turns, whichever is longer, and reaches back into the
    settling where the record is shorter. `section_q`,
    `section_v` (record_turns, n) are state and velocity once a turn at theta = 0 mod 2 pi (blisk coordinates in the
    turning frame, which coincides with the inertial one there). `impulse_per_turn` (record_turns,) in N s.
    `contact_steps_per_turn` (record_turns,) counts the steps of each turn in which any blade touched. `track` is None
    where no signal was asked for. `arrivals` holds what each timing probe saw in the tail, by
    its name. `twin_growth` (record_turns,) is ln of what the distance to a trajectory beside the run grew by in each
    turn, empty where none was asked for. `fractions` (N, 2, n) are q and v after 1/N, 2/N, ... 1 of the last turn, N
    the lobes of the casing, the casing turned back by as much: all equal where the motion is symmetric,
    q(t + T/N) = q(t); none for a changing speed. `worn` is what is left of the liner, None without one.
    `orbit` (turns, 5) are means over each of the last 100 turns, at a changing speed of all, of X, Y (m), X^2 + Y^2,
    V_X^2 + V_Y^2 and X V_Y - Y V_X of the disk centre in the inertial frame. `blisk_mass` in kg and `free_penetration`
    in m, how deep the tips of the rub-free motion would enter the casing at rest (negative: clearance), are NaN where
    they are not known, the latter at a changing speed too. `window_orders` (windows, taps, 20) are the complex
    amplitudes at k f_r of a steady run in windows of 16 turns, for all of `taps` in their order: the last windows of
    the record, those that the taps cover.
    At a changing speed `changing_speed` has speed and angle over time; `speed` is then the record's mean, and
    `steps_per_turn` the number of steps in a turn at the highest speed.
    When `status` is not OK, `reason` says where and by how much, and no array may be used as data.
    """

    status: Status
    reason: str
    speed: float
    dt: float
    steps_per_turn: int
    settle_turns: int
    record_turns: int
    taps: dict[str, FloatArray]
    section_q: FloatArray
    section_v: FloatArray
    impulse_per_turn: FloatArray
    contact_steps_per_turn: IntArray
    events: ContactEvents
    energy: EnergyBalance
    n_blades: int
    n_casing: int
    track: Track | None = None
    worn: WornLiner | None = None
    twin_growth: FloatArray = field(default_factory=lambda: np.zeros(0))
    fractions: FloatArray = field(default_factory=lambda: np.zeros((0, 2, 0)))
    arrivals: dict[str, TipArrivals] = field(default_factory=dict)
    changing_speed: ChangingSpeed | None = None
    orbit: FloatArray = field(default_factory=lambda: np.zeros((0, 5)))
    blisk_mass: float = float("nan")
    free_penetration: float = float("nan")
    window_orders: ComplexArray = field(default_factory=lambda: np.zeros((0, 0, 20), dtype=np.complex128))

    __repr__ = brief

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
        """Number of steps that `taps` hold: the end of the record."""
        return next(iter(self.taps.values())).size
