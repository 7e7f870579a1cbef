"""The steps from a scenario to a labelled run: reduce, integrate, measure, label."""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rubgen.brief import counted, html_table, number, table
from rubgen.errors import UserError
from rubgen.jit import kernels_are_compiled
from rubgen.labels import Labels, label
from rubgen.labels.headline import headline
from rubgen.labels.to_json import labels_to_json
from rubgen.linalg.threads import one_blas_thread
from rubgen.measurement import Recording, margin_seconds, measure
from rubgen.progress import COMPILING, step
from rubgen.reduction import reduce
from rubgen.scenario import Scenario
from rubgen.solver import Response, Status
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.reach import with_clearance
from rubgen.solver.refusal import no_response
from rubgen.solver.wants import Wants

if TYPE_CHECKING:
    from rubgen.output import Figure


@dataclass(frozen=True, kw_only=True)
class Run:
    """One simulated run. `recording` and `labels` are None where `response.status` is not OK."""

    scenario: Scenario
    response: Response
    recording: Recording | None
    labels: Labels | None

    def __repr__(self) -> str:
        return table(*self._shown())

    def _repr_html_(self) -> str:
        return html_table(*self._shown())

    def _shown(self) -> tuple[str, dict[str, str]]:
        """Return the title of the run and its main facts by name."""
        scenario, response, recording, labels = self.scenario, self.response, self.recording, self.labels
        title = f"{scenario.run_id}: {scenario.machine.name}, {scenario.operation.title}"
        if recording is None or labels is None:
            return title, {"status": f"{response.status.code}: {response.reason}"}
        return title, {
            "headline": headline(labels_to_json(labels), scenario.operation.profile),
            "rub": number(labels.rub),
            "motion": f"{labels.motion.value}, period {number(labels.period)}",
            "contact": f"{number(labels.contact_duty)} of the time, "
            f"{counted(labels.blades_touched, 'blade')}, {counted(labels.contact_zones, 'zone')}",
            "impulse": f"{number(labels.impulse_per_turn)} N s a turn",
            "record": f"{response.record_turns} turns after {response.settle_turns}",
            "recording": f"{len(recording.channels)} channels of {recording.samples} samples at "
            f"{recording.sample_rate_hz:g} Hz",
            "more": "labels, recording.channels[name].values, response; save(path), plot(), replay()",
        }

    def save(self, path: Path | str) -> None:
        """Write the run to a file in the format of its ending: .parquet, .mcap or .rrd. An existing file is replaced.

        Raises UserError as `rubgen.output.save` does.
        """
        from rubgen.output import save

        save(self, Path(path))

    def plot(self) -> Figure:
        """Draw the run as a matplotlib Figure: orbit, waveform, contact by angle, orders. See `rubgen.output.plot`."""
        from rubgen.output import plot

        return plot(self)

    def replay(self, *, web: bool = False) -> None:
        """Show the run in Rerun's viewer until the viewer is closed; with `web` in the browser.

        See `rubgen.output.replay`.
        """
        from rubgen.output import replay

        replay(self, web=web)


def simulate(scenario: Scenario) -> Run:
    """Simulate the run that `scenario` describes: reduce the machine, integrate with contact, measure, label.

    On one computer the same scenario always has the same bits, with any number of BLAS threads (one is used here), and
    with or without the cache of reduced models. A run that fails is returned with its status, without recording and
    labels. Raises UserError for a machine that cannot be modelled or reduced, for values with which no run is possible,
    for a virtual machine or a class of `[balance]` of which no candidate was found, and for what is no Scenario.
    """
    if not isinstance(scenario, Scenario):
        raise UserError(f"{scenario!r:.200}: is no scenario; give rubgen.make_scenario(...) or recipe.scenario(0)")
    if scenario.virtual and scenario.virtual.problem:
        raise UserError(scenario.virtual.problem)
    if scenario.balance and scenario.balance.problem:
        raise UserError(scenario.balance.problem)
    operation, sensing, seconds = scenario.operation, scenario.sensing, scenario.signal_seconds
    with one_blas_thread():
        scenario = with_clearance(scenario)
        model = reduce(scenario.machine, scenario.reduction)
        with _shown_step():
            response = integrate(
                model,
                operation,
                scenario.contact,
                Wants(
                    tail_seconds=seconds + margin_seconds(sensing, seconds, scenario.frame),
                    sample_rate_hz=sensing.fastest_hz,
                    taps=sensing.set.taps,
                    companion=scenario.labelling.lyapunov and operation.profile == "steady",
                    repeats_free_turn=True,
                ),
            )
        if response.status is not Status.OK:
            return Run(scenario=scenario, response=response, recording=None, labels=None)
        rng = np.random.default_rng(np.random.SeedSequence(scenario.seed, spawn_key=(scenario.drawn_as,)))
        recording = measure(
            response, sensing, seconds=seconds, rng=rng, surroundings=scenario.surroundings, frame=scenario.frame,
            faults=scenario.machine.faults, lost=scenario.machine.lost_blades,
        )  # fmt: skip
        return Run(scenario=scenario, response=response, recording=recording, labels=label(response))


def _shown_step() -> AbstractContextManager[None]:
    """Show the progress of a run in turns. The first run also says that it compiles."""
    compiled = kernels_are_compiled()
    return step("simulate" if compiled else COMPILING, "turns", long=not compiled)


def refused(scenario: Scenario, reason: str, status: Status = Status.REFUSED) -> Run:
    """Make the run of a scenario for which `simulate` raised an error, so that it has a row in its data set.

    The run has the status `status` and the reason `reason`. The response is empty; recording and labels are None.
    """
    operation = scenario.operation
    turn = 1 / operation.rotation_frequency_hz
    response = no_response(
        status,
        reason,
        speed=operation.speed_rad_per_s,
        dt=turn / operation.steps_per_turn,
        steps_per_turn=operation.steps_per_turn,
        record_turns=operation.record_turns,
    )
    return Run(scenario=scenario, response=response, recording=None, labels=None)
