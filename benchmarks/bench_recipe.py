"""A data set of runs of 600 turns as users make it: `rubgen generate`, two workers, Parquet alone, default labels.

settle_turns is fixed at 100, 500 turns are recorded with the exponent beside them, speed and support stiffness are
drawn. By default 40 runs are made and the time of 1,000 follows by proportion, start-up and all;
RUBGEN_BENCH_RUNS=1000 makes them all. Where other work shares the cores the CPU time of all processes over two says
what two idle cores would take.

The share of the kernels is measured in this process with one worker. It is the CPU time in the compiled loops of the
run and its companion over the CPU time of all of `generate`. The fixed costs of a set (warm-up, card) are removed: both
times are the difference between a set of ten runs and a set of two.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import rubgen
from benchmarks.cpu_time import cpu_time
from benchmarks.rows import rows_of
from rubgen import pipeline
from rubgen.scenario import load_recipe
from rubgen.solver import integrate
from rubgen.solver.observers.companion_kernels import run_companion
from rubgen.solver.scheme.turn_kernels import run_turns
from rubgen.solver.wants import Wants

RUBGEN = str(Path(sys.executable).with_name("rubgen"))
RECIPE = """
name = "thousand"
seed = 1
runs = {runs}
machine = "zeng2019"
license = "CC-BY-4.0"
[vary]
speed_rpm = {{ uniform = [6000, 13000] }}
disk_support_stiffness_n_per_m = {{ log_uniform = [5e7, 4e8] }}
[simulation]
settle_turns = 100
record_turns = 500
[output]
formats = ["parquet"]
"""
ALL_RUNS, RUNS = 1000, 40
SHORTENED_RUNS, ROUNDS = 12, 3
FEW_RUNS, COUNTED_RUNS = 2, 12


def measure() -> list[dict[str, object]]:
    runs = int(os.environ.get("RUBGEN_BENCH_RUNS", RUNS))
    with tempfile.TemporaryDirectory() as folder:
        _generate(Path(folder) / "warm", 2)  # compiles, and fills the cache of machines
        seconds, spent = _generate(Path(folder) / "set", runs)
        share, each = _kernel_share(Path(folder))
        shortened = _shortened(Path(folder))
    factor = ALL_RUNS / runs
    how = "made" if runs == ALL_RUNS else f"from {runs}"
    rows = (
        (f"1,000 runs of 600 turns, two workers ({how})", factor * seconds / 60, "min", "<= 10, goal 5"),
        ("1,000 runs: CPU time of all processes / 2", factor * spent / 2 / 60, "min", "recorded"),
        ("a run of 600 turns with all that follows, CPU", each, "s", "recorded"),
        ("share of CPU time in the kernels", share, "1", ">= 0.8"),
    )
    every = [*rows, *((f"{name}, CPU", value, "s", target) for name, value, target in shortened)]
    return rows_of(every)


def _shortened(folder: Path) -> list[tuple[str, float, str]]:
    """Mean CPU time a run of `simulate`, as it is and with all integrated: of rubs, of other runs, of all."""
    path = folder / "shortened.toml"
    path.write_text(RECIPE.format(runs=SHORTENED_RUNS), encoding="utf-8")
    recipe = load_recipe(path)
    integrated = patch.object(pipeline, "Wants", partial(Wants, companion_stops=False))
    repeated = patch.object(integrate, "never_touches", return_value=False)
    times: dict[str, list[tuple[float, float]]] = {"rubs": [], "no contact": []}
    for number in range(SHORTENED_RUNS):
        scenario, pairs = recipe.scenario(number), []
        for _ in range(ROUNDS):
            short = cpu_time(partial(rubgen.simulate, scenario))
            with integrated, repeated:
                pairs.append((short, cpu_time(partial(rubgen.simulate, scenario))))
        rub = rubgen.simulate(scenario).response.contact_steps_per_turn.any()
        times["rubs" if rub else "no contact"].append(tuple(np.median(pairs, axis=0)))
    every = [pair for pairs in times.values() for pair in pairs]
    means = {f"{len(pairs)} runs, {name}": np.mean(pairs, axis=0) for name, pairs in [*times.items(), ("all", every)]}
    found = [(f"{name}: simulate", float(short), "recorded") for name, (short, _) in means.items()]
    return found + [(f"{name}: all integrated", float(full), "recorded") for name, (_, full) in means.items()]


def _generate(out: Path, runs: int) -> tuple[float, float]:
    """Wall time and CPU time of all processes, in s."""
    recipe = out.with_suffix(".toml")
    recipe.write_text(RECIPE.format(runs=runs), encoding="utf-8")
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [RUBGEN, "generate", str(recipe), "--out", str(out), "--workers", "2"]
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.perf_counter() - begun, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def _kernel_share(folder: Path) -> tuple[float, float]:
    """CPU time in the kernels over all, and all a run in s."""
    few, many = FEW_RUNS, COUNTED_RUNS
    _counted(folder / "first", 1)  # loads the kernels
    (few_within, few_spent), (within, spent) = (_counted(folder / f"counted-{runs}", runs) for runs in (few, many))
    return (within - few_within) / (spent - few_spent), (spent - few_spent) / (many - few)


def _counted(out: Path, runs: int) -> tuple[float, float]:
    """CPU time in the kernels and of all, of a set made in this process."""
    within = 0.0

    def timed(kernel: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            nonlocal within
            begun = time.process_time()
            result = kernel(*arguments)
            within += time.process_time() - begun
            return result

        return call

    recipe = out.with_suffix(".toml")
    recipe.write_text(RECIPE.format(runs=runs), encoding="utf-8")
    with (
        patch("rubgen.solver.scheme.stepper.run_turns", timed(run_turns)),
        patch("rubgen.solver.observers.companion.run_companion", timed(run_companion)),
    ):
        begun = time.process_time()
        rubgen.generate(recipe, out, workers=1)
        spent = time.process_time() - begun
    if not within:
        raise RuntimeError("no kernel was counted")
    return within, spent
