"""A step of ROSS's rub (PyPI `ross-rotordynamics`) beside one of ours, warm, in CPU time of one thread each.

ROSS runs its own example rotor (34 nodes of six, two disks, two bearings) with its rubbing fault: Newmark's method, one
contact at one node with penalty, damping and friction. It is timed with all its 204 coordinates and reduced to 12 modes
by its pseudo-modal method, the faster of its reductions; each after a warm-up run. Ours: 125 coordinates, 36 tips that
may touch, taps and works booked, in the light rub of `bench_solver`. ROSS lives in an environment of its own,
`out/ross`, made when it is not there; RUBGEN_BENCH_ROSS=0 leaves it out.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from threadpoolctl import threadpool_limits

from benchmarks.bench_solver import CASES, STEPS, settled
from benchmarks.cpu_time import median_time
from benchmarks.rows import rows_of

ENVIRONMENT = Path("out/ross")
REQUIREMENTS = ("ross-rotordynamics", "plotly<7")
SECONDS_TO_INSTALL = 900
OUR_TURNS, OUR_COORDINATES = 300, 125
PROGRAM = """
import json, sys, time
import numpy as np
import ross as rs
from ross.faults.rubbing import Rubbing

rotor = rs.rotor_assembly.rotor_example_with_damping()
nodes = [disk.n for disk in rotor.disk_elements]

def run(steps, **reduced):
    fault = Rubbing(rotor, n=12, distance=7.95e-5, contact_stiffness=1.1e6, contact_damping=40, friction_coeff=0.3)
    times = 1e-4 * np.arange(steps)
    start = time.process_time()
    fault.run(nodes, [5e-4, 0], [-np.pi / 2, 0], 125.66, times, **reduced)
    spent = time.process_time() - start
    touching = np.count_nonzero(np.abs(fault.forces).max(axis=0))
    return {"us": 1e6 * spent / steps, "share": touching / steps}

modal = {"model_reduction": {"method": "pseudomodal", "num_modes": 12}}
run(200), run(200, **modal)
middle = lambda runs: sorted(runs, key=lambda found: found["us"])[len(runs) // 2]
full, reduced = middle([run(1000) for _ in range(3)]), middle([run(5000, **modal) for _ in range(5)])
print(json.dumps({"version": rs.__version__, "dof": rotor.ndof, "full": full, "reduced": reduced}))
"""


def measure() -> list[dict[str, object]]:
    try:
        ross = _ross()
    except (OSError, RuntimeError, subprocess.TimeoutExpired) as error:
        return [{"name": "ROSS", "value": None, "unit": "", "target": ">= 50, goal 150", "note": _line(str(error))}]
    ours = _our_microseconds()
    full, reduced, name = ross["full"], ross["reduced"], f"ROSS {ross['version']}"

    def coordinate(found: dict, coordinates: int) -> float:
        return found["us"] / coordinates / (ours / OUR_COORDINATES)

    rows = (
        ("solver step beside ROSS, CPU", ours, "us", "recorded"),
        (f"{name} step, {ross['dof']} DoFs, one contact", full["us"], "us", "recorded"),
        (f"{name} step, 12 modes, one contact", reduced["us"], "us", "recorded"),
        (f"{name}: steps with contact, 12 modes", reduced["share"], "1", "> 0"),
        (f"{name}, {ross['dof']} DoFs, over solver", full["us"] / ours, "ratio", ">= 50, goal 150"),
        (f"{name}, {ross['dof']} DoFs, over solver, a coordinate", coordinate(full, ross["dof"]), "ratio", "recorded"),
        (f"{name}, 12 modes, over solver", reduced["us"] / ours, "ratio", ">= 50, goal 150"),
        (f"{name}, 12 modes, over solver, a coordinate", coordinate(reduced, 12), "ratio", "recorded"),
    )
    return rows_of(rows)


def _ross() -> dict:
    """What the program prints; RuntimeError with the reason where ROSS cannot be had."""
    if os.environ.get("RUBGEN_BENCH_ROSS") == "0":
        raise RuntimeError("left out by RUBGEN_BENCH_ROSS=0")
    python = ENVIRONMENT / "bin" / "python"
    if not (ENVIRONMENT / "installed").exists():
        _run([sys.executable, "-m", "venv", "--clear", str(ENVIRONMENT)], SECONDS_TO_INSTALL)
        _run([str(python), "-m", "pip", "install", "--quiet", *REQUIREMENTS], SECONDS_TO_INSTALL)
        (ENVIRONMENT / "installed").touch()
    return json.loads(_run([str(python), "-c", PROGRAM], 600).splitlines()[-1])


def _run(command: list[str], seconds: float) -> str:
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=seconds, env={**os.environ, **one_thread}, check=False
    )
    if done.returncode:
        raise RuntimeError(f"{' '.join(command[:6])}: {done.stderr.strip().splitlines()[-1:]}")
    return done.stdout


def _line(text: str) -> str:
    return " ".join(text.split())[:200]


def _our_microseconds() -> float:
    """Median CPU time of a step over whole turns, in us."""
    with threadpool_limits(1):
        stepper, _ = settled(CASES[0])
        return 1e6 * median_time(stepper.run_turn, OUR_TURNS) / STEPS


if __name__ == "__main__":
    for line in measure():
        print(line)
