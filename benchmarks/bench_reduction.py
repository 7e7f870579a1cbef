"""A new machine: full finite-element model and both reductions, nothing cached, imports done; and the cache.

Machines: the preset, and its blisk with other numbers of blades, meshes and shapes; each is made through the disk's
symmetry and by the full sparse path, and both must agree in their frequencies and in the tips' compliance. Mistuned:
every blade of the preset of its own stiffness. CPU time of one thread, least of two; the cache as whole processes.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace

import numpy as np
from scipy.linalg import eigh
from threadpoolctl import threadpool_limits

from benchmarks.rows import rows_of
from rubgen.fem.constraints import support_stiffness
from rubgen.machine import BladeRow, Disk, DiskSupport, Mistuning, load_machine
from rubgen.reduction.blisk import ReducedBlisk, reduce_blisk
from rubgen.reduction.casing import reduce_casing
from rubgen.scenario import Reduction

PROGRAM = """
import time
from rubgen.machine import load_machine
from rubgen.scenario import Reduction
from rubgen.reduction import reduce
start = time.process_time()
model = reduce(load_machine("zeng2019"), Reduction())
model.at_speed(1000.0)
print(time.process_time() - start)
"""
ROUNDS = 2


def machines() -> dict[str, tuple[Disk, BladeRow, DiskSupport]]:
    """By a name: disk, blades, support."""
    preset = load_machine("zeng2019")
    disk, blades, support = preset.disk, preset.blades, preset.disk_support
    return {
        f"preset, {blades.count} blades": (disk, blades, support),
        "24 long blades": (disk, replace(blades, count=24, length_m=1.2 * blades.length_m), support),
        "48 blades, 96 x 6 shells": (
            replace(disk, circumferential_elements=96, radial_elements=6),
            replace(blades, count=48),
            support,
        ),
        "17 blades, 68 x 8 shells": (
            replace(disk, circumferential_elements=68, radial_elements=8),
            replace(blades, count=17),
            support,
        ),
        "mistuned preset": (disk, replace(blades, mistuning=Mistuning(relative_std=0.02, seed=0)), support),
    }


def measure() -> list[dict[str, object]]:
    with tempfile.TemporaryDirectory() as cache:
        cold, warm = _seconds(cache), _seconds(cache)
    rows: list[tuple[str, float, str, str]] = [
        ("full model and reduction, new process, cold, CPU", cold, "s", "recorded"),
        ("full model and reduction, from cache, CPU", warm, "s", "recorded"),
    ]
    with threadpool_limits(1):
        for name, parts in machines().items():
            rows += _rows(name, *parts)
    return rows_of(rows)


def _rows(name: str, disk: Disk, blades: BladeRow, support: DiskSupport) -> list[tuple[str, float, str, str]]:
    target = "<= 3" if blades.mistuning else "<= 1"
    preset = load_machine("zeng2019")
    spent, models = {}, {}
    for cyclic in (True, False):
        for _ in range(ROUNDS):
            begun = time.process_time()
            models[cyclic] = reduce_blisk(disk, blades, support, Reduction(), cyclic=cyclic)
            reduce_casing(preset, Reduction().casing_modes)
            spent[cyclic] = min(spent.get(cyclic, np.inf), time.process_time() - begun)
    return [
        (f"new machine, {name}, CPU", spent[True], "s", target),
        (f"new machine, {name}, full sparse path, CPU", spent[False], "s", "recorded"),
        (f"new machine, {name}: deviation", deviation(models[True], models[False], support), "1", "<= 1e-6"),
    ]


def deviation(one: ReducedBlisk, other: ReducedBlisk, support: DiskSupport) -> float:
    """Largest relative difference of frequencies, of the masters' compliance and of the tips' growth at 10,000 rev/min.

    All on the supports. Modes of one frequency may be turned among themselves, so matrices are not compared.
    """
    springs = support_stiffness(support)
    masters = one.growth.tips.shape[0] * 3 + 2
    found = []
    for blisk in (one, other):
        K = blisk.K + blisk.centre.T @ (springs[:, None] * blisk.centre)
        squares = eigh(K, blisk.M, eigvals_only=True)
        found.append((np.sqrt(squares), np.linalg.inv(K)[:masters, :masters], blisk.growth.at(1000 * np.pi / 3)))
    frequencies = np.abs(found[0][0] / found[1][0] - 1).max()
    fields = [np.abs(a - b).max() / np.abs(b).max() for a, b in zip(found[0][1:], found[1][1:], strict=True)]
    return float(max(frequencies, *fields))


def _seconds(cache: str) -> float:
    environment = {**os.environ, "RUBGEN_CACHE_DIR": cache, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, "-c", PROGRAM], check=True, capture_output=True, text=True, env=environment)
    return float(done.stdout)
