"""Integration of a spinning system in time, with contact."""

from rubgen.solver.integrate import integrate
from rubgen.solver.refusal import no_response
from rubgen.solver.response import ContactEvents, EnergyBook, Response, Status
from rubgen.solver.stability import automatic_settle_turns, eigenvalues, slowest_decay, stable_step, steps_per_turn
from rubgen.solver.stepper import Stepper

__all__ = [
    "ContactEvents",
    "EnergyBook",
    "Response",
    "Status",
    "Stepper",
    "automatic_settle_turns",
    "eigenvalues",
    "integrate",
    "no_response",
    "slowest_decay",
    "stable_step",
    "steps_per_turn",
]
