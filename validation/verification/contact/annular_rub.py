"""A Jeffcott rotor in full annular rub.

A rotor with unbalance, below its critical speed, touches a ring on springs and dampers all the way round. The
friction coefficient is 0.1. The solver integrates the motion. The force of step n has the direction of the geometry
at step n + 1, which is ahead by the angle Omega dt. So all errors are of first order in dt: with 1,024 steps a turn
the force is 2e-4 too large, and the stator is 5e-3 rad ahead. 1,024 and 2,048 steps are extrapolated to dt = 0. The
remaining second-order error is (Omega dt)^2 = 4e-5. Transients have fallen by a factor of 1e-9.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.integrate import integrate
from rubgen.units import rev_per_min
from validation.verification.rotors.jeffcott import (
    CLEARANCE,
    FRICTION,
    SPEED,
    STATOR_MASS,
    annular_rub,
    jeffcott_system,
)
from validation.verification.row import Row, relative, within

TITLE = "Full annular rub"
STEPS, SETTLE, RECORD = 1024, 150, 100


@dataclass(frozen=True)
class Steady:
    """What a run settles to: share of steps with contact, force in N, displacements in m, loss a turn in J."""

    touching: float
    force: float
    rotor: complex
    stator: complex
    friction_loss: float
    energy_residual: float


def steady(steps: int) -> Steady:
    """The settled rub from the solver's integration."""
    operation = Operation(speed_rpm=rev_per_min(SPEED), steps_per_turn=steps, settle_turns=SETTLE, record_turns=RECORD)
    response = integrate(jeffcott_system(), operation, ContactLaw(friction=FRICTION))
    return Steady(
        touching=float(response.contact_steps_per_turn.min() / steps),
        force=float(response.impulse_per_turn.mean() / response.turn_seconds),
        rotor=complex(*response.section_q[-1, :2]),
        stator=complex(*response.section_q[-1, -2:]) / STATOR_MASS**0.5,
        friction_loss=float(response.events.friction_loss.sum() / RECORD),
        energy_residual=response.energy.residual,
    )


def rows() -> Iterator[Row]:
    """Contact, force, rotor, stator, losses."""
    coarse, fine, exact = steady(STEPS), steady(2 * STEPS), annular_rub()
    source = "Jeffcott rotor in closed form"
    yield within("annular rub: share of steps with contact", source, 1.0, coarse.touching, 0.0)
    force = 2 * fine.force - coarse.force
    yield relative("annular rub: normal force, N", source, exact.force, force, 4e-5)
    for name in ("rotor", "stator"):
        expected, found = getattr(exact, name), 2 * getattr(fine, name) - getattr(coarse, name)
        yield relative(f"annular rub: amplitude of the {name}, m", source, abs(expected), abs(found), 4e-5)
        quantity = f"annular rub: phase of the {name}, rad"
        yield within(quantity, source, float(np.angle(expected)), float(np.angle(found)), 4e-5)
    loss = -2 * np.pi * FRICTION * exact.force * CLEARANCE
    found_loss = 2 * fine.friction_loss - coarse.friction_loss
    yield relative("annular rub: friction loss a turn, J", "2 pi mu N c", loss, found_loss, 4e-5)
    quantity = "annular rub: residual of the energy balance"
    yield within(quantity, "exact except for rounding", 0.0, coarse.energy_residual, 1e-8)
