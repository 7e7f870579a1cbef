"""Where rubbing begins in run-ups and coast-downs of several rates, beside the steady onset and its predicted delay.

`python -m validation.run_up` prints the table and draws docs/run-up-onset.png.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from rubgen.machine import Machine, load_machine
from rubgen.reduction import ReducedModel, reduce
from rubgen.scenario import ContactLaw, Operation, Reduction
from rubgen.solver.integrate import integrate
from rubgen.units import rad_per_s, rev_per_min

START_RPM, END_RPM = 6400.0, 6950.0
RATES_RPM_PER_S = (250.0, 500.0, 1000.0, 2000.0, 4000.0)
SETTLE_TURNS = 100
PICTURE = Path("docs/run-up-onset.png")


@dataclass(frozen=True, kw_only=True)
class Onset:
    """Of one rate (rev/min/s): measured onset, predicted one of the tips' reach, and the latest touch it allows."""

    rate: float
    measured: float
    predicted: float
    latest: float


def reach(model: ReducedModel, speed: float, acceleration: float) -> float:
    """Largest outward displacement of a tip without rub, m, at `speed` passed with `acceleration` (rad/s, rad/s2).

    The motion follows its steady one with a lag: K(Omega, Omega') q = force(Omega, Omega') - C q_0', where
    q_0' = Omega' dq_0/dOmega of the steady motion; right to first order in Omega'.
    """
    system = model.at_speed(speed, acceleration)
    step = 1e-4 * speed
    above, below = (model.at_speed(speed + side * step) for side in (1, -1))
    slope = (np.linalg.solve(above.K, above.force) - np.linalg.solve(below.K, below.force)) / (2 * step)
    q = np.linalg.solve(system.K, system.force - acceleration * system.C @ slope)
    u = system.tip_static + q[: system.centre].reshape(-1, 3)
    return float(np.hypot(system.tip_radius + u[:, 0], u[:, 1]).max()) - system.tip_radius


def predicted_onset(model: ReducedModel, rate: float) -> float:
    """Speed in rev/min at which the tips reach the smallest gap at a `rate` in rev/min/s; 0 is the steady onset."""
    clearance = model.machine.casing.clearance_m
    return float(
        brentq(lambda rpm: reach(model, rad_per_s(rpm), rad_per_s(rate)) - clearance, START_RPM, END_RPM, xtol=1e-6)
    )


def run_up_onset(model: ReducedModel, rate: float) -> Onset:
    """A run-up through the onset; the first touch may wait for the tip that reaches farthest to pass the narrow place.

    With N lobes that is 1/N of a turn.
    """
    operation = Operation(
        profile="run-up",
        speed_rpm=START_RPM,
        end_speed_rpm=END_RPM,
        duration_s=(END_RPM - START_RPM) / rate,
        settle_turns=SETTLE_TURNS,
    )
    response = integrate(model, operation, ContactLaw())
    if response.changing_speed is None:
        raise ValueError(f"no run: {response.reason}")
    first = response.events.start_step.min() * response.dt
    predicted = predicted_onset(model, rate)
    wait = 60 / predicted / model.machine.casing.lobes
    return Onset(
        rate=rate,
        measured=rev_per_min(float(response.changing_speed.rotation.speed(first))),
        predicted=predicted,
        latest=predicted + rate * wait,
    )


def onsets(machine: Machine) -> tuple[float, list[Onset]]:
    """The steady onset in rev/min, and those of all rates."""
    model = reduce(machine, Reduction())
    return predicted_onset(model, 0.0), [run_up_onset(model, rate) for rate in RATES_RPM_PER_S]


def draw(steady: float, found: list[Onset], path: Path) -> None:
    """The onset over the rate: measured points, and the band from the prediction to the latest touch."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    rates = [each.rate for each in found]
    band = [each.predicted for each in found], [each.latest for each in found]
    axes.fill_between(rates, *band, alpha=0.3, label="predicted, to 1/N of a turn later")
    axes.plot(rates, [each.measured for each in found], "o", color="black", label="first touch in the run")
    axes.axhline(steady, color="tab:red", linewidth=1, label="steady onset")
    axes.set_xscale("log")
    axes.set_xticks(rates, [f"{rate:,.0f}" for rate in rates])
    axes.minorticks_off()
    axes.set_title("Preset zeng2019: onset of rub in a run-up", fontsize=10)
    axes.set_xlabel("Rate, rev/min/s")
    axes.set_ylabel("Speed at the first touch, rev/min")
    axes.legend()
    figure.savefig(path, dpi=120, metadata={"Software": None})


def main() -> None:
    """Print the table, draw the picture."""
    steady, found = onsets(load_machine("zeng2019"))
    print(f"steady onset {steady:.2f} rev/min")
    for each in found:
        print(
            f"{each.rate:6.0f} rev/min/s: first touch {each.measured:.2f}, predicted {each.predicted:.2f} "
            f"to {each.latest:.2f} rev/min"
        )
    draw(steady, found, PICTURE)


if __name__ == "__main__":
    main()
