"""Integrate one run: from the rub-free motion through the closing of the clearance to the record."""

import math
from dataclasses import replace
from itertools import pairwise

from rubgen.errors import UserError
from rubgen.linalg.threads import one_blas_thread
from rubgen.progress import count
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import ContactLaw, Operation
from rubgen.scenario.checks.profiles import profile_problem
from rubgen.solver.exponent import changed_after, lyapunov
from rubgen.solver.linear.admissible import check_system
from rubgen.solver.linear.rub_free import free_penetration, never_touches, rub_free_motion
from rubgen.solver.linear.stability import settle_turns, steps_per_turn
from rubgen.solver.observers.chosen import chosen_observers, tail_turns
from rubgen.solver.observers.companion import check_turns
from rubgen.solver.observers.divergence import ADVICE, Growth, what_diverged
from rubgen.solver.observers.energy import EnergyIdentity
from rubgen.solver.observers.worn_liner import worn_liner
from rubgen.solver.refusal import film_refusal, refused_response, stability
from rubgen.solver.response import Response, Status
from rubgen.solver.scheme.state_kernels import CONTACT_UNSOLVED, DIVERGED, ENERGY, FILM_CLOSED, OK
from rubgen.solver.speed.changing import ChangingSystem
from rubgen.solver.speed.driver import SpeedDriver, SteadyDriver
from rubgen.solver.speed.repeated import RepeatedDriver
from rubgen.solver.speed.start import Closing, rub_free_stepper, start_opening
from rubgen.solver.speed.turn import Turn
from rubgen.solver.wants import SpeedModel, Wants

ENERGY_TOLERANCE = 1e-8
STATUS = {
    OK: Status.OK,
    CONTACT_UNSOLVED: Status.CONTACT_UNSOLVED,
    DIVERGED: Status.DIVERGED,
    ENERGY: Status.ENERGY,
    FILM_CLOSED: Status.FILM_CLOSED,
}
NO_WANTS = Wants()


def integrate(
    model: SpinningSystem | SpeedModel, operation: Operation, contact: ContactLaw, wants: Wants = NO_WANTS
) -> Response:
    """Integrate a spinning system with contact between blade tips and casing, and return its response.

    Central differences with Lagrange multipliers in forward increments (Carpenter, Taylor, Katona 1991), see
    `step_kernels`. The run starts in the exact rub-free motion, with the surface opened so that nothing touches. Laws
    whose motion must settle are left out of this motion; a fluctuating speed starts in the motion of its mean. The
    surface closes smoothly (continuous second derivative) over `operation.closing_turns`, at most the settle turns.

    - model: makes the system at the speeds of the operation. A `SpinningSystem` is run at its own speed.
    - operation: speed over time, settle and record turns, and the least steps a turn. The steps are doubled until they
      are stable and feed `wants.sample_rate_hz`.
    - contact: the contact law.
    - wants: taps, their duration, and other things that the response records.

    All taps of step n belong to one time: displacements q_n, velocities and accelerations from q_n-1, q_n, q_n+1, and
    the contact force lam_n. The last value belongs to the last step of the record. The companion trajectory
    (`observers.companion`) stops once the Lyapunov exponent is settled. If the class of motion changes after that, the
    run is made again with a companion that does not stop. There is no companion where a fault grows within the record:
    its exponent would mix the motions before and after. At a changing speed the time steps are equal and the Poincare
    section lies between steps (`turn_kernels.record_section`). There are then no companion and no symmetry states.

    A run that fails has the status and the reason; its other fields are not valid. A system that is unstable without
    contact is not integrated: its status is unstable. If no rub-free motion fits the laws of its support, the status is
    film-closed. Raises UserError for a system that `check_system` refuses, for a record too short for a wanted
    exponent, for what `profile_problem` finds at a changing speed, and for a turn of more than 4,194,304 steps. Raises
    ValueError where M, C or K couple blisk and casing, and for a tap that the system does not have. Raises TypeError
    for a `SpinningSystem` at a changing speed. Valid for small casing displacements.
    """
    if wants.companion:
        check_turns(operation.record_turns)
    # More BLAS threads split sums otherwise and change the last bits of A^-1, which irregular motion makes large.
    with one_blas_thread():
        system = model if isinstance(model, SpinningSystem) else model.at_speed(operation.speed_rad_per_s)
        check_system(system)
        if operation.profile == "steady":
            return _steady(system, operation, contact, wants)
        problem = profile_problem(operation)
        if problem:
            raise UserError(f"operation.{problem}")
        if isinstance(model, SpinningSystem):
            raise TypeError("a changing speed needs a model with at_speed, not a system")
        return _changing(ChangingSystem(model, operation), operation, contact, wants)


def _steady(system: SpinningSystem, operation: Operation, contact: ContactLaw, wants: Wants) -> Response:
    steps = steps_per_turn(system, operation.steps_per_turn, wants.sample_rate_hz)
    refusal = film_refusal(system, steps)
    if refusal:
        return refused_response(system, operation, steps, refusal)
    refusal, decay = stability(system)
    if refusal:
        return refused_response(system, operation, steps, refusal)
    settle = settle_turns(system, operation, decay)
    grows = any(ramp.start_s < 2 * math.pi / system.speed * operation.record_turns for ramp in system.ramps)
    wants = replace(wants, companion=wants.companion and not grows)
    stepper = rub_free_stepper(system, contact, steps, taps=wants.taps)
    surface = stepper.model.surface
    penetration = math.inf
    if system.starting is system:
        penetration = free_penetration(rub_free_motion(system, steps), surface, stepper.model.tips)
    if wants.repeats_free_turn and never_touches(system, surface, penetration):
        return Integration(RepeatedDriver(stepper, settle, decay), system, operation, wants, penetration).response()
    response = Integration(SteadyDriver(stepper, settle), system, operation, wants, penetration).response()
    response = replace(response, grows=grows)
    if _settled_too_soon(response):
        driver = SteadyDriver(rub_free_stepper(system, contact, steps, taps=wants.taps), settle)
        throughout = replace(wants, companion_stops=False)
        response = Integration(driver, system, operation, throughout, penetration).response()
    return response


def _settled_too_soon(response: Response) -> bool:
    """Return whether the motion has changed since the companion stopped."""
    exponent, turns = lyapunov(response.companion_growth), response.companion_growth.size
    if response.status is not Status.OK or exponent is None or turns == response.record_turns:
        return False
    return changed_after(response.impulse_per_turn, turns, exponent.per_turn)


def _changing(changing: ChangingSystem, operation: Operation, contact: ContactLaw, wants: Wants) -> Response:
    steps = changing.steps(wants.sample_rate_hz)
    refusal = film_refusal(changing.start, steps) or stability(changing.least_stable())[0]
    if refusal:
        return refused_response(changing.systems[-1], operation, steps, refusal)
    driver = changing.driver(contact, steps, wants.taps)
    known = changing.start.starting is changing.start
    return Integration(driver, changing.start, operation, wants, math.nan if known else math.inf).response()


class Integration:
    """One run in progress: speed driver, observers and status.

    `start` is the system in whose rub-free motion the run starts; `free_penetration` is the value for the response, m.
    """

    def __init__(
        self,
        driver: SpeedDriver,
        start: SpinningSystem,
        operation: Operation,
        wants: Wants,
        free_penetration: float = math.nan,
    ) -> None:
        self.free_penetration = free_penetration
        self.driver, self.stepper, self.record = driver, driver.stepper, operation.recorded_turns
        opening = start_opening(start, self.stepper.model.surface.inset)
        self.closing = Closing(opening, min(operation.closing_turns, driver.settle))
        self.growth, self.energy = Growth(self.stepper), EnergyIdentity(self.stepper)
        self.observers = chosen_observers(driver, self.record, wants)
        # Taps are read in the tail; at a changing speed in every turn of the record, for its orders.
        last = self.record if driver.rotation.is_steady else 0
        self.first_recorded = min(last, self.record - tail_turns(driver, self.record, wants))
        self.status, self.reason = Status.OK, ""

    def run(self) -> None:
        """Integrate until the end of the record, or until the status is no longer OK."""
        settle, first = self.driver.settle, self.first_recorded
        places = sorted({-settle, min(max(first, -settle), self.record), 0, self.record})
        for start, end in pairwise(places):
            if start == 0:
                for observer in self.observers:
                    observer.start()
            for turn in self.driver.run_turns(range(start, end), self.closing.after, recording=start >= first):
                if not self._add(turn):
                    return

    def _add(self, turn: Turn) -> bool:
        """Give a turn to the observers. Return whether the status is still OK."""
        settle = self.driver.settle
        count(turn.number + settle, settle + self.record)
        self.growth.add(turn.step)
        code = turn.code
        if code == OK and not self.energy.residual() <= ENERGY_TOLERANCE:
            code = ENERGY
        if code != OK:
            self.status = STATUS[code]
            self.reason = self._reason(turn.number, turn.step)
            return False
        for observer in self.observers:
            observer.turn(turn)
        return True

    def response(self) -> Response:
        """Integrate the whole run by `run`, and return its response. Call it once."""
        self.run()
        stepper, rotation, system = self.stepper, self.driver.rotation, self.stepper.system
        kept = {name: value for observer in self.observers for name, value in observer.result().items()}
        return Response(
            status=self.status,
            reason=self.reason,
            speed=rotation.mean_speed(2 * math.pi * self.record),
            dt=stepper.dt,
            steps_per_turn=stepper.turn_steps,
            settle_turns=self.driver.settle,
            record_turns=self.record,
            n_blades=system.n_blades,
            n_casing=system.n_casing,
            worn=worn_liner(stepper.model.surface.liner, stepper.state.wear),
            blisk_mass=system.recovery.blisk_mass if system.recovery else float("nan"),
            free_penetration=self.free_penetration,
            **kept,
            **self.energy.result(self.driver.times if isinstance(self.driver, RepeatedDriver) else 1.0),
        )

    def _reason(self, number: int, step: int) -> str:
        turns = self.driver.settle + self.record
        where = f"turn {number + self.driver.settle} of {turns}, step {step} of {self.stepper.turn_steps}"
        match self.status:
            case Status.DIVERGED:
                branch, what = what_diverged(self.stepper)
                return f"{what} in {where}; {self.growth.sentence()}; {ADVICE[branch]}"
            case Status.ENERGY:
                return f"residual {self.energy.residual():.3g} above {ENERGY_TOLERANCE:g} after {where}"
            case _:
                return f"in {where}"
