"""Many different runs: time of a step of one of them with all that `integrate` does, on one core and on two processes.

The runs are the first of the recipe `laboratory`: without rub, light, irregular, hard rub together. Each is
integrated as for a data set, from the start to the end of its record. The measure is the step of the plain numpy
reference in the light rub of `bench_solver`, the cheapest one with contact; beside it stands the same in the runs' own
states. The reference is timed over whole turns, each from the same state at a section, so that it rubs as the run does.
Then: whether a run has the same bits alone and among others in another process, and how far two of its kind are from
the reference.

Last, the free step of eight runs side by side in vector registers, each with its own matrices, against that of one run:
what a solver in lanes over scenarios would take for the largest part of a step.
"""

from __future__ import annotations

import hashlib
import time
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks.bench_solver import CASES, STEPS, deviation, settled, turn_time
from benchmarks.cpu_time import median_time
from benchmarks.free_step_kernels import run_free
from rubgen.dataset.making.workers import unordered, worker_pool
from rubgen.linalg.blocks import aligned, parts_of
from rubgen.linalg.lanes_kernels import line_kind
from rubgen.linalg.vector_kernels import LANES
from rubgen.measurement import margin_seconds
from rubgen.reduction import reduce
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import Scenario, load_recipe
from rubgen.scenario.load import RECIPES
from rubgen.solver import Response, Status
from rubgen.solver.integrate import integrate
from rubgen.solver.scheme.free_step_kernels import Scheme
from rubgen.solver.scheme.stepper import Stepper
from rubgen.solver.wants import Wants
from validation.reference_step import ReferenceStepper

RECIPE = RECIPES / "laboratory.toml"
RUNS, PROCESSES = 16, 2
ROUNDS = 3
LIGHT = 0.05
"""Below this share of steps with contact a run counts as light."""


@dataclass(frozen=True)
class Timed:
    """One run: CPU seconds of its integration, number of its steps, a digest of what it gave, share of contact.

    The time of the CPU, because a run takes long enough for other work on the machine to come between.
    """

    seconds: float
    steps: int
    digest: str
    contact: float


def scenarios() -> list[Scenario]:
    """The first runs of the recipe without faults; none of them fails."""
    recipe = load_recipe(RECIPE)
    return [recipe.scenario(index) for index in range(RUNS)]


def system_of(scenario: Scenario) -> SpinningSystem:
    """The reduced system of a scenario at its speed."""
    return reduce(scenario.machine, scenario.reduction).at_speed(scenario.operation.speed_rad_per_s)


def integrated(scenario: Scenario, system: SpinningSystem) -> Response:
    """The response of a scenario, as the pipeline integrates it, without a companion."""
    sensing, seconds = scenario.sensing, scenario.signal_seconds
    return integrate(
        system,
        scenario.operation,
        scenario.contact,
        Wants(
            tail_seconds=seconds + margin_seconds(sensing, seconds),
            sample_rate_hz=sensing.fastest_hz,
            taps=sensing.set.taps,
        ),
    )


def digest(response: Response) -> str:
    """A hash of sections, impulses and taps, to the last bit."""
    found = hashlib.sha256(response.status.code.encode())
    for array in (response.section_q, response.section_v, response.impulse_per_turn, *response.taps.values()):
        found.update(np.ascontiguousarray(array).tobytes())
    return found.hexdigest()


def timed(scenario: Scenario) -> Timed:
    """One run with its time; the reduced model is made before."""
    system = system_of(scenario)
    start = time.process_time()
    response = integrated(scenario, system)
    seconds = time.process_time() - start
    if response.status is not Status.OK:
        raise RuntimeError(f"{scenario.run_id} ended as {response.status}")
    turns = response.settle_turns + response.record_turns
    share = float(response.contact_steps_per_turn.mean()) / response.steps_per_turn
    return Timed(seconds, turns * response.steps_per_turn, digest(response), share)


def step_time(runs: list[list[Timed]]) -> float:
    """CPU time of a step in us, mean over the steps of all runs; of a run that was made several times the median."""
    seconds = sum(float(np.median([each.seconds for each in run])) for run in runs)
    return 1e6 * seconds / sum(run[0].steps for run in runs)


def reference_of(scenario: Scenario) -> ReferenceStepper:
    """The numpy reference in the state at the last section of a run."""
    system = system_of(scenario)
    response = integrated(scenario, system)
    reference = ReferenceStepper(system, scenario.contact.friction, response.steps_per_turn)
    q, v = response.section_q[-1], response.section_v[-1]
    reference.set_state(q - response.dt * v, q)
    return reference


def on_one_core(runs: list[Scenario], light: ReferenceStepper) -> tuple[list[list[Timed]], float, float]:
    """All runs one after the other, several times, with whole turns of the reference between them.

    Return the runs and two CPU times of a step of the reference in us: the median in the light rub, and the mean over
    the runs of the median in the run's own state.
    """
    timed(runs[0])  # kernels are compiled
    own = [reference_of(scenario) for scenario in runs]
    found: list[list[Timed]] = [[] for _ in runs]
    plain: list[list[float]] = [[] for _ in runs]
    beside: list[float] = []
    for _ in range(ROUNDS):
        for run, times, scenario, reference in zip(found, plain, runs, own, strict=True):
            run.append(timed(scenario))
            beside.append(turn_time(light))
            times.append(turn_time(reference))
    return found, float(np.median(beside)), float(np.mean([np.median(times) for times in plain]))


def on_processes(runs: list[Scenario]) -> tuple[float, float, set[str]]:
    """Median time in us of a step of all runs on two processes, the same from CPU time, the digests of the runs there.

    The two times are equal where each process has a core of its own and neither waits for the last run.
    """
    wall, busy, digests = list[float](), list[float](), set[str]()
    with worker_pool(PROCESSES) as pool:
        list(unordered(pool, timed, [(runs[0],)] * PROCESSES))  # the processes have loaded their kernels
        for _ in range(ROUNDS):
            start = time.perf_counter()
            found = list(unordered(pool, timed, [(scenario,) for scenario in runs]))
            steps = sum(run.steps for run in found)
            wall.append((time.perf_counter() - start) / steps)
            busy.append(sum(run.seconds for run in found) / steps / PROCESSES)
            digests |= {run.digest for run in found}
    return 1e6 * float(np.median(wall)), 1e6 * float(np.median(busy)), digests


def in_lanes(stepper: Stepper) -> Scheme:
    """A free step of eight runs, a row of z being one coordinate of all; every run has the matrices of this one.

    They are stored eight times, as eight different ones would be.
    """
    blocks = [block[block >= 0] for bundle in stepper.blocks.lanes for block in bundle if (block >= 0).any()]
    lines, entries, row = [], 0, 0
    for size in [len(block) for block in [*blocks, *stepper.blocks.single]]:
        for part in parts_of(size):
            rows = part.stop - part.start
            lines.append((line_kind(rows, scaled=False), row + part.start, entries, row, size))
            entries += rows * size
        row += size
    rng = np.random.default_rng(0)
    now, before = (aligned(1e-3 * rng.normal(size=(entries, LANES))) for _ in range(2))
    return Scheme(np.array(lines), now, before, aligned(rng.normal(size=row * LANES)), now)


def free_step_time(scheme: Scheme) -> float:
    """CPU time of one call in us, mean over a turn's steps, median of many turns."""
    states = [aligned(np.zeros(len(scheme.constant))) for _ in range(3)]
    return 1e6 * median_time(lambda: run_free(scheme, *states, STEPS), rounds=200) / STEPS


def measure() -> list[dict[str, object]]:
    """All rows, on one thread each."""
    with threadpool_limits(1):
        runs = scenarios()
        stepper, reference = settled(CASES[0])
        alone, plain, own = on_one_core(runs, reference)
        mixed, light = step_time(alone), [run for run in alone if run[0].contact < LIGHT]
        together, busy, digests = on_processes(runs)
        worst, unequal = np.max([deviation(*settled(case)) for case in CASES[:2]], axis=0)
        lanes, single = free_step_time(in_lanes(stepper)) / LANES, free_step_time(stepper.model.scheme)
    moved = sum(run[0].digest not in digests for run in alone) + len(digests) - len(runs)
    contact = float(np.mean([run[0].contact for run in alone]))
    rows = (
        ("plain numpy step, light rub", plain, "us", "recorded"),
        ("plain numpy step, mean of the mixed runs' own", own, "us", "recorded"),
        ("steps with contact, mean of the mixed runs", contact, "1", "recorded"),
        ("mixed runs, one core: a step", mixed, "us", "recorded"),
        ("mixed runs, one core: numpy's light step over it", plain / mixed, "ratio", ">= 250, goal 400"),
        ("mixed runs, one core: numpy's own steps over it", own / mixed, "ratio", "recorded"),
        ("mixed runs, two processes: a step", together, "us", "recorded"),
        ("mixed runs, two processes: numpy's light step over it", plain / together, "ratio", "goal 800"),
        ("mixed runs, two processes: the same from CPU time", plain / busy, "ratio", "goal 800"),
        (f"runs with less than {LIGHT:.0%} contact, one core: a step", step_time(light), "us", "recorded"),
        ("the same: numpy's light step over it", plain / step_time(light), "ratio", ">= 250, goal 400"),
        ("runs of 16 with other bits in another process", moved, "runs", "0"),
        ("largest deviation over a turn", worst, "1", "<= 1e-6"),
        ("turns of 50 with other contacts", unequal, "turns", "0"),
        ("free step, eight runs in lanes: of one run", lanes, "us", "recorded"),
        ("free step, one run alone", single, "us", "recorded"),
    )
    return [
        {"name": f"many: {name}", "value": float(value), "unit": unit, "target": target}
        for name, value, unit, target in rows
    ]


if __name__ == "__main__":
    for line in measure():
        print(line)
