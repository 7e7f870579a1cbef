"""The runs of this study and what is read from them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.pipeline import Run
from rubgen.scenario import ContactLaw, Liner, Scenario, make_scenario
from rubgen.scenario.vary import vary
from rubgen.solver import EnergyBalance, Status
from rubgen.solver.response import WornLiner
from validation.contact_options.blade_shortening import draw_in_matrix
from validation.contact_options.draw_in import deflections, draw_in
from validation.contact_options.matched import MATCHED, on_matched_chords
from validation.sensitivity.cases import CASES

LINER = Liner(thickness_m=2e-3, wear_m2_per_n=1e-11, width_m=0.0386)
"""As wide as a blade tip of the preset along the axis, 39.7 mm cos 14.1 degrees."""
OPTIONS: dict[str, ContactLaw] = {
    "none": ContactLaw(),
    "half_thickness": ContactLaw(half_thickness=True),
    MATCHED: ContactLaw(surface="chords"),
    "liner": ContactLaw(liner=LINER),
    "liner, ten times as soft": ContactLaw(liner=replace(LINER, wear_m2_per_n=1e-10)),
}
HEAVY_RPM = tuple(range(8100, 8911, 90))
HEAVY_FRICTION = 0.1


@dataclass(frozen=True, kw_only=True)
class Found:
    """What a run shows: its class or its status with the reason; impulse a turn (record_turns,) in N s.

    `bent` is the largest deflection of a tip from its steady place, less the disk's motion, `shortened` the most that a
    tip draws back with it, both in m, over the record's sections and the eight turns about the hardest touch. `centre`
    (record_turns, 2) is where the disk's centre stands once a turn, in m.
    """

    case: str
    option: str
    speed_rpm: float
    motion: str
    reason: str
    impulse: FloatArray
    bent: float
    shortened: float
    centre: FloatArray
    worn: WornLiner | None
    energy: EnergyBalance


def option_scenario(case: str, option: str) -> Scenario:
    """One of the sensitivity studies' cases with an option of contact."""
    scenario = vary(make_scenario("zeng2019"), CASES[case])
    with_option = replace(scenario, contact=replace(OPTIONS[option], friction=scenario.contact.friction))
    return on_matched_chords(with_option) if option == MATCHED else with_option


def heavy_scenario(speed_rpm: float) -> Scenario:
    """The preset near its critical speed, with friction."""
    return make_scenario("zeng2019", speed_rpm=float(speed_rpm), friction=HEAVY_FRICTION)


def read(case: str, option: str, run: Run) -> Found:
    """What is found in a run."""
    response, ok = run.response, run.response.status is Status.OK
    moved = deflections(response) if ok else np.zeros((1, 2))
    machine = run.scenario.machine
    Q, _ = draw_in_matrix(machine.blades, machine.disk.rim_radius_m)
    return Found(
        case=case,
        option=option,
        speed_rpm=run.scenario.operation.speed_rpm,
        motion=str(run.labels.motion) if run.labels else response.status.code,
        reason=response.reason,
        impulse=response.impulse_per_turn if ok else np.zeros(0),
        bent=float(np.hypot(*moved.T).max()),
        shortened=float(draw_in(Q, moved).max()),
        centre=response.section_q[:, 3 * response.n_blades :][:, :2].copy(),
        worn=response.worn,
        energy=response.energy,
    )
