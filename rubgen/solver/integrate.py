"""One run: from the rub-free motion through the closing of the clearance to the record."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from threadpoolctl import threadpool_limits

from rubgen.arrays import ComplexArray, FloatArray
from rubgen.contact.liner_kernels import REMOVED, WORK
from rubgen.errors import UserError
from rubgen.progress import count
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw, Operation
from rubgen.scenario.profiles import profile_problem
from rubgen.scenario.rotation import Rotation
from rubgen.solver.linear.admissible import check_system
from rubgen.solver.linear.rub_free import free_penetration, rub_free_motion
from rubgen.solver.linear.stability import settle_turns, steps_per_turn
from rubgen.solver.observers.companion import Companion, check_turns, piece_ends
from rubgen.solver.observers.divergence import ADVICE, Growth
from rubgen.solver.observers.orders import WindowOrders, turn_orders
from rubgen.solver.observers.symmetry import Fractions
from rubgen.solver.observers.touches import contact_events, tip_arrivals
from rubgen.solver.observers.track import TrackKeeper
from rubgen.solver.observers.worn_liner import worn_liner
from rubgen.solver.refusal import film_refusal, no_response, stability
from rubgen.solver.response import Course, EnergyBook, Response, Status
from rubgen.solver.scheme.energy_kernels import (
    ABSOLUTE,
    CIRCULATORY,
    CONTACT,
    DAMPING,
    DRIVE_LIMIT,
    FRICTION,
    NORMAL,
    SPEED_CHANGE,
    UNBALANCE,
)
from rubgen.solver.scheme.step_kernels import CONTACT_UNSOLVED, DIVERGED, ENERGY, FILM_CLOSED, OK
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.scheme.support_kernels import ANISOTROPY, FILM, FILM_LOSS, GRAVITY
from rubgen.solver.scheme.taps import sampled_taps, timing_taps
from rubgen.solver.scheme.turn_kernels import STEPS, close_touches
from rubgen.solver.speed.changing import ChangingSystem
from rubgen.solver.speed.driver import Spin, SteadySpin
from rubgen.solver.speed.interpolation import SystemAt
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper, start_opening
from rubgen.taps import DEFAULT_TAPS, Tap

LEAST_TAIL_TURNS = 100
ENERGY_TOLERANCE = 1e-8
ROUNDING_SHARE = 1e-6
"""Energies below this share of their summed absolute terms are rounding to eight digits."""
STATUS = {
    OK: Status.OK,
    CONTACT_UNSOLVED: Status.CONTACT_UNSOLVED,
    DIVERGED: Status.DIVERGED,
    ENERGY: Status.ENERGY,
    FILM_CLOSED: Status.FILM_CLOSED,
}


class Integration:
    """One run under way: the stepper, what is kept of the turns so far, and how it stands.

    Kept are the taps of the last turns in a ring, the replay track of the last `signal_turns`, and per turn of the
    record one section, one impulse, one count and its touches: memory does not grow with the number of steps.
    """

    def __init__(
        self,
        spin: Spin,
        start: SpinningSystem,
        operation: Operation,
        tail_turns: int,
        signal_turns: int = 0,
        *,
        twin: bool = False,
    ) -> None:
        stepper, settle = spin.stepper, spin.settle
        self.spin, self.stepper, self.settle = spin, stepper, settle
        self.record, self.rotation = operation.recorded_turns, spin.rotation
        self.closing = min(operation.closing_turns, settle)
        self.opening = start_opening(start, stepper.model.surface.inset)
        self.tail_turns = min(tail_turns, settle + self.record)
        self.tail: deque[FloatArray] = deque(maxlen=self.tail_turns)
        self.arrivals: deque[FloatArray] = deque(maxlen=self.tail_turns)
        n = stepper.system.M.shape[0]
        self.section = np.zeros((self.record, 2, n))
        self.twin: Companion | None = None
        self.twin_growth = np.zeros(self.record if twin else 0)
        self.fractions = Fractions(stepper.system, stepper.steps) if self.rotation.is_steady else None
        if self.fractions:
            pieces = piece_ends(stepper.steps) if twin else ()
            stepper.take_snapshots(sorted({*self.fractions.steps, *pieces}))
        self.impulse = np.zeros(self.record)
        self.contact_steps = np.zeros(self.record, dtype=np.int64)
        self.orbit: deque[FloatArray] = deque(maxlen=LEAST_TAIL_TURNS if self.rotation.is_steady else None)
        self.free_penetration = float("nan")
        if self.rotation.is_steady:
            self.free_penetration = free_penetration(
                rub_free_motion(stepper.system, stepper.steps), stepper.model.surface, stepper.model.tips
            )
        self.window_orders = WindowOrders(*stepper.result.taps.shape)
        self.touches: list[FloatArray] = []
        self.orders: list[ComplexArray] = []
        self.track = TrackKeeper(settle + self.record - signal_turns)
        self.growth = Growth(stepper)
        self.start_energy = stepper.energy()
        self.largest_energy = abs(self.start_energy)
        self.rounding_energy = ROUNDING_SHARE * _gross_energy(stepper)
        self.status, self.reason = Status.OK, ""

    def run(self) -> None:
        """Integrate until the end of the record, or until the status is no longer OK."""
        turns = self.settle + self.record
        for turn in range(turns):
            count(turn, turns)
            if turn == self.settle:
                self.stepper.touches.open[:, STEPS] = 0.0  # a touch that began before is counted from here
                self.twin = Companion(self.stepper) if self.twin_growth.size else None
            self._run_turn(turn)
            if self.status is not Status.OK:
                return
        touches = self.stepper.touches
        self.track.finish()
        still_open = close_touches(touches, self.spin.first_step(self.settle + self.record), 0)
        self.touches.append(touches.ended[:still_open].copy())

    def _run_turn(self, turn: int) -> None:
        wear = self.stepper.state.wear
        removed = wear.sums[REMOVED]
        recording = self._is_recorded(turn)
        code, step = self.spin.run_turn(turn, self._opening_after, recording=recording)
        result = self.spin.result
        self.growth.add(step)
        if code == OK and not self.energy_residual() <= ENERGY_TOLERANCE:
            code = ENERGY
        if code != OK:
            self.status = STATUS[code]
            self.reason = self._reason(turn, step)
            return
        if recording:
            self.tail.append(result.taps.copy())
            self.arrivals.append(self.spin.arrivals)
        self.track.add(turn, self.spin)
        row = turn - self.settle
        if row >= 0:
            self.section[row] = result.section
            self.impulse[row], self.contact_steps[row] = result.summary[0], int(result.summary[1])
            self.touches += self.spin.touches
            if recording:
                self.orbit.append(result.orbit / result.taps.shape[1])
            if not self.rotation.is_steady:
                steps = np.arange(self.spin.first_step(turn), self.spin.first_step(turn + 1) + 1)
                self.orders.append(turn_orders(result.taps, self.rotation.angle(steps * self.stepper.dt)))
            elif recording:
                self.window_orders.add(row, result.taps)
            if self.twin is not None:
                # Beside a surface that has worn within the turn no trajectory is near the run's own.
                same_surface = wear.sums[REMOVED] == removed
                self.twin_growth[row] = self.twin.run_turn(self.spin.opening).sum() if same_surface else np.nan

    def _is_recorded(self, turn: int) -> bool:
        """Whether the taps of a turn are read: those of the tail, and for orders those of each turn of a run-up."""
        first = self.settle if not self.rotation.is_steady else self.settle + self.record
        return turn >= min(first, self.settle + self.record - self.tail_turns)

    def _opening_after(self, turns: FloatArray) -> FloatArray:
        """Opening of the surface so many turns, which rise, after the start."""
        if turns[0] >= self.closing:
            return np.zeros(len(turns))
        return self.opening * closing_ramp(turns / self.closing)

    def course(self) -> Course:
        """How the speed went over the record."""
        turns = range(self.settle, self.settle + self.record + 1)
        return Course(
            rotation=self.rotation,
            turn_steps=np.array([self.spin.first_step(turn) for turn in turns]),
            orders=np.array(self.orders),
        )

    def energy_residual(self) -> float:
        """|E - E_start - works| over the summed absolute works, or over the largest |E| where no work is done.

        At a critical speed the rub-free motion has no energy in the turning frame: there its rounding stands for it.
        """
        works, energy = self.stepper.state.works, self.stepper.energy()
        self.largest_energy = max(self.largest_energy, abs(energy))
        done = works[UNBALANCE] + works[DAMPING] + works[CIRCULATORY] + works[CONTACT] + works[SPEED_CHANGE]
        done += self.stepper.state.support.works[:FILM_LOSS].sum()
        scale = max(float(works[ABSOLUTE]), self.largest_energy, self.rounding_energy)
        return abs(energy - self.start_energy - float(done)) / scale if scale > 0 else 0.0

    def _reason(self, turn: int, step: int) -> str:
        where = f"turn {turn} of {self.settle + self.record}, step {step} of {self.stepper.turn_steps}"
        match self.status:
            case Status.DIVERGED:
                branch, what = self._what_diverged()
                return f"{what} in {where}; {self.growth.told()}; {ADVICE[branch]}"
            case Status.ENERGY:
                return f"residual {self.energy_residual():.3g} above {ENERGY_TOLERANCE:g} after {where}"
            case _:
                return f"in {where}"

    def _what_diverged(self) -> tuple[str, str]:
        """Which of the two branches ended the run, "blade" or "casing", and how."""
        system, laws = self.stepper.system, self.stepper.model.laws
        tips = np.abs(self.stepper.coordinates.after[: 3 * system.n_blades])
        if not np.all(tips <= laws.tip_limit):
            blade = int(np.argmax(~(tips <= laws.tip_limit))) // 3
            return "blade", f"blade {blade} bent beyond {1e3 * laws.tip_limit:.3g} mm"
        return "casing", f"the casing left {1e3 * laws.casing_limit:.3g} mm"


def integrate(
    system: SpinningSystem,
    operation: Operation,
    contact: ContactLaw,
    *,
    tail_seconds: float = 0.0,
    sample_rate_hz: float = 0.0,
    twin: bool = False,
    taps: tuple[Tap, ...] = DEFAULT_TAPS,
    system_at: SystemAt | None = None,
) -> Response:
    """The response of a spinning system with contact between blade tips and casing.

    Central differences with Lagrange multipliers in forward increments (Carpenter, Taylor, Katona 1991), see
    `step_kernels`; started from the exact rub-free motion with the surface opened so that nothing touches, closed
    smoothly (continuous second derivative) over `operation.closing_turns`, at most the settle turns.

    `tail_seconds` is what the taps must cover (100 turns at least; they may reach back before the record, but not
    before the start); `sample_rate_hz` the sensors' rate that the steps must feed, 2.56 times. Taps stand at step n
    together: displacements q_n, velocities and accelerations from q_n-1, q_n, q_n+1, and the contact force lam_n that
    acts at that time; the record's last step is the last value. `taps` says which there are (`rubgen.taps`): the
    response holds each by its name, and what timing probes saw among its arrivals. They change nothing in the motion.

    With `twin` a second trajectory runs beside the record for the Lyapunov exponent (`solver.twin`), which takes half
    as long again and leaves the first as it is.

    A changing speed (`operation.profile`) needs `system_at`, the system at a speed and acceleration; time steps are
    equal then, and sections lie between steps (`turn_kernels.record_section`). See `spin.ChangingSpin`. It has no twin
    and no fractions.

    A run that fails has the status and the reason; nothing else in it is data. Raises UserError for a system that
    `check_system` refuses, for a record too short for an exponent that is asked for, for a profile that lacks a key,
    and for a speed so low that a turn would need more than 4,194,304 steps; ValueError where anything but contact
    couples blisk and casing. Holds for small casing displacements.
    """
    if twin:
        check_turns(operation.record_turns)
    # More BLAS threads split sums otherwise and change the last bits of A^-1, which irregular motion makes large.
    with threadpool_limits(1, user_api="blas"):
        check_system(system)
        if operation.profile != "steady":
            changing = _changing(system_at, operation)
            steps = changing.steps(sample_rate_hz)
            refusal = film_refusal(changing.start, steps) or stability(changing.least_stable())[0]
            if refusal:
                return _not_integrated(changing.systems[-1], operation, steps, *refusal)
            return _run(changing.spin(contact, steps, taps), changing.start, operation, tail_seconds, taps)
        steps = steps_per_turn(system, operation.steps_per_turn, sample_rate_hz)
        refusal, decay = film_refusal(system, steps), None
        if not refusal:
            refusal, decay = stability(system)
        if refusal:
            return _not_integrated(system, operation, steps, *refusal)
        settle = settle_turns(system, operation, decay)
        spin = SteadySpin(rub_free_stepper(system, contact, steps, taps=taps), settle)
        return _run(spin, system, operation, tail_seconds, taps, twin=twin)


def _changing(system_at: SystemAt | None, operation: Operation) -> ChangingSystem:
    """The system over all speeds of an operation."""
    problem = profile_problem(operation)
    if problem:
        raise UserError(f"operation.{problem}")
    if system_at is None:
        raise ValueError("a changing speed needs system_at")
    return ChangingSystem(system_at, operation)


def _run(
    spin: Spin,
    start: SpinningSystem,
    operation: Operation,
    tail_seconds: float,
    taps: tuple[Tap, ...],
    *,
    twin: bool = False,
) -> Response:
    """Integrate to the end; `start` is the system at the first instant."""
    signal_turns = tail_seconds * spin.rotation.fastest / (2 * math.pi)
    tail = max(LEAST_TAIL_TURNS, math.ceil(signal_turns))
    if not spin.rotation.is_steady:
        signal_turns = _last_turns(spin.rotation, operation.recorded_turns, tail_seconds)
    integration = Integration(spin, start, operation, tail, math.floor(signal_turns), twin=twin)
    integration.run()
    return _response(integration, taps)


def _last_turns(rotation: Rotation, record: int, seconds: float) -> float:
    """How many turns the last `seconds` of a record of so many turns hold."""
    end = rotation.time_of(2 * math.pi * record)
    return record - float(rotation.angle(max(end - seconds, 0.0))) / (2 * math.pi)


def _gross_energy(stepper: Stepper) -> float:
    """Sum of |q_i K_ij q_j| / 2 at the start, J."""
    q = np.abs(stepper.coordinates.now)
    return 0.5 * float(q @ np.abs(stepper.system.K) @ q)


def _response(integration: Integration, taps: tuple[Tap, ...]) -> Response:
    stepper, sampled = integration.stepper, sampled_taps(taps)
    tail = np.concatenate([np.zeros((len(sampled), 0)), *integration.tail], axis=1)
    return Response(
        status=integration.status,
        reason=integration.reason,
        speed=integration.rotation.mean_speed(2 * math.pi * integration.record),
        dt=float(stepper.dt),
        steps_per_turn=stepper.turn_steps,
        settle_turns=integration.settle,
        record_turns=integration.record,
        taps={tap.name: np.ascontiguousarray(tail[i]) for i, tap in enumerate(sampled)},
        section_q=np.ascontiguousarray(integration.section[:, 0]),
        section_v=np.ascontiguousarray(integration.section[:, 1]),
        impulse_per_turn=integration.impulse,
        contact_steps_per_turn=integration.contact_steps,
        events=contact_events(integration.touches),
        twin_growth=integration.twin_growth,
        fractions=integration.fractions.of(stepper) if integration.fractions else np.zeros((0, 2, 0)),
        energy=_energy(integration),
        n_blades=stepper.system.n_blades,
        n_casing=stepper.system.n_casing,
        worn=worn_liner(stepper.model.surface.liner, stepper.state.wear),
        track=integration.track.track(integration.spin) if integration.track.kept else None,
        arrivals=tip_arrivals(list(integration.arrivals), [probe.name for probe in timing_taps(taps)]),
        course=None if integration.rotation.is_steady else integration.course(),
        orbit=np.array(integration.orbit).reshape(-1, 5),
        blisk_mass=stepper.system.recovery.blisk_mass if stepper.system.recovery else float("nan"),
        free_penetration=integration.free_penetration,
        window_orders=integration.window_orders.all(),
    )


def _energy(integration: Integration) -> EnergyBook:
    works = [float(work) for work in integration.stepper.state.works]
    support = [float(work) for work in integration.stepper.state.support.works]
    wear = 0.0 - float(integration.stepper.state.wear.sums[WORK])
    return EnergyBook(
        start=integration.start_energy,
        end=integration.stepper.energy(),
        unbalance=works[UNBALANCE],
        damping=works[DAMPING],
        circulatory=works[CIRCULATORY],
        anisotropy=support[ANISOTROPY],
        film=support[FILM],
        gravity=support[GRAVITY],
        contact=works[CONTACT],
        normal_loss=works[NORMAL],
        friction_loss=works[FRICTION],
        wear_loss=wear,
        drive_contact_work=works[CONTACT] - works[NORMAL] - works[FRICTION] - wear,
        drive_contact_limit=works[DRIVE_LIMIT],
        film_loss=support[FILM_LOSS],
        speed_change=works[SPEED_CHANGE],
        absolute_work=works[ABSOLUTE],
        residual=integration.energy_residual(),
    )


def _not_integrated(system: SpinningSystem, operation: Operation, steps: int, status: Status, reason: str) -> Response:
    """What is given for a system that makes no run."""
    return no_response(
        status,
        reason,
        speed=float(system.speed),
        dt=2 * math.pi / system.speed / steps,
        steps_per_turn=steps,
        record_turns=operation.recorded_turns,
        n_blades=system.n_blades,
        n_casing=system.n_casing,
        size=len(system.M),
    )
