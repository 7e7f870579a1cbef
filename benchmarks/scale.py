"""What large data sets cost: `make scale` writes docs/scale.md from benchmarks/scale.md.

Sets of short runs are made by two workers, each in a process of its own, so that its memory and CPU time are its alone.
No run rubs, and signals last 0.1 s: a run takes the least time that a run can take, and what the set costs besides
has its largest share. The costs of 10^5 and 10^6 runs follow from the slope between the two largest sets. CPU seconds
count, since other work on the computer changes them little.

Results are kept in out/scale, one file a measurement: `make scale SIZES="100 1000 10000"` measures what is missing.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from json import dumps, loads
from math import ceil
from pathlib import Path
from statistics import median

from rubgen.dataset.shards import RUNS_PER_SHARD
from validation.markdown import table

ROOT = Path(__file__).parents[1]
PAGE, TEXT, KEPT = ROOT / "docs" / "scale.md", Path(__file__).parent / "scale.md", ROOT / "out" / "scale"
PROJECTED = (100_000, 1_000_000)
PAIRS, RUNS_A_PAIR = 7, 240
RECIPE = {
    "name": "scale",
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [9000.0, 11000.0]}, "free_penetration_m": -5e-5},
    "labels": {"lyapunov": False},
    "output": {"formats": ["parquet"], "signal_seconds": 0.1},
}
USUAL = {**RECIPE, "vary": {"speed_rpm": 10_000.0, "disk_support_stiffness_n_per_m": 2e8}}
MB, HOUR = 1e6, 3600.0


def made(runs: int) -> dict[str, float]:
    """Make and verify a set of that many short runs with two workers. Return its costs by name."""
    from rubgen.dataset.making import generate

    spent = {"finish": 0.0}
    true = generate.finish_set

    def timed(*arguments: object, **options: object) -> object:
        before = time.process_time()
        try:
            return true(*arguments, **options)  # type: ignore[arg-type]
        finally:
            spent["finish"] = time.process_time() - before

    generate.finish_set = timed  # type: ignore[assignment]
    with tempfile.TemporaryDirectory(dir=KEPT) as folder:
        out = Path(folder) / "set"
        before = time.process_time()
        generate.generate({**RECIPE, "runs": runs}, out, workers=2, progress=False)
        costs = {
            "parent": time.process_time() - before,
            "parent_mb": _peak_mb(),
            "workers": _cpu_of_children(),
            "worker_mb": _peak_of_children_mb(),
        }
        files = [path for path in out.rglob("*") if path.is_file()]
        checked = _in_new_process("verified", out)
        return {
            **spent,
            **costs,
            **checked,
            "bytes": float(sum(path.stat().st_size for path in files)),
            "files": float(len(files)),
        }


def verified(out: Path) -> dict[str, float]:
    """Verify a set. Return CPU seconds, peak memory and the number of problems."""
    from rubgen.dataset.checking.verify import verify

    before = time.process_time()
    problems = verify(out)
    spent = time.process_time() - before
    return {"verify": spent, "verify_mb": _peak_mb(), "problems": float(len(problems))}


def usual() -> dict[str, float]:
    """Simulate runs of one second that rub. Return CPU seconds and the bytes of a set, each a run."""
    from rubgen.output import save
    from rubgen.pipeline import simulate
    from rubgen.scenario import parse_recipe

    recipe = parse_recipe({**USUAL, "output": {"formats": ["parquet"]}, "runs": 4})
    simulate(recipe.scenario(0))
    with tempfile.TemporaryDirectory() as folder:
        before = time.process_time()
        for index in range(1, 4):
            save(simulate(recipe.scenario(index)), Path(folder) / f"{index}.parquet")
        spent = time.process_time() - before
        size = sum(path.stat().st_size for path in Path(folder).iterdir())
    return {"seconds": spent / 3, "bytes": size / 3}


def coordinated(runs: int) -> dict[str, float]:
    """Plan the jobs of a set of that many runs, none of them made. Return CPU seconds and peak memory."""
    from rubgen.dataset.layout import Layout
    from rubgen.dataset.making.plan import PartOfSet, Plan
    from rubgen.scenario import parse_recipe

    recipe = parse_recipe({**RECIPE, "runs": runs})
    base = _peak_mb()
    start = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        plan = Plan(PartOfSet(recipe, Layout(Path(folder))), "session")
        jobs = 0
        for _, _, shard, indexes in plan.jobs(64):
            jobs += 1
            if indexes:
                plan.ended(shard)
    spent = time.process_time() - start
    return {"plan": spent, "jobs": float(jobs), "base_mb": base, "plan_mb": _peak_mb()}


def pair() -> dict[str, float]:
    """Make the same short runs with one worker and with two, and call a pure kernel with one and with two processes.

    Return the ratios of the rates, and the CPU seconds a run with one and with two.
    """
    costs = {str(workers): _in_new_process("rate", workers) for workers in (1, 2)}
    kernel = {workers: _kernel_rate(workers) for workers in (1, 2)}
    return {
        "runs": costs["2"]["rate"] / costs["1"]["rate"],
        "kernel": kernel[2] / kernel[1],
        "cpu_1": costs["1"]["cpu"],
        "cpu_2": costs["2"]["cpu"],
    }


def rate(workers: int) -> dict[str, float]:
    """Make RUNS_A_PAIR short runs. Return runs a second between the first result and the last, CPU seconds a run."""
    from rubgen.dataset.making.generate import generate

    seen: list[tuple[float, float, int]] = []
    with tempfile.TemporaryDirectory(dir=KEPT) as folder:
        generate(
            {**RECIPE, "runs": RUNS_A_PAIR},
            Path(folder) / "set",
            workers=workers,
            progress=lambda done, _all: seen.append((time.perf_counter(), time.process_time(), done)),
        )
    first = next(each for each in seen if each[2])
    last = seen[-1]
    ended = _cpu_of_children() + time.process_time()
    return {"rate": (last[2] - first[2]) / (last[0] - first[0]), "cpu": ended}


def _kernel_rate(processes: int) -> float:
    """Return calls a second of a loop of pure arithmetic, in that many processes."""
    from benchmarks.scale import arithmetic  # by its module, which workers know
    from rubgen.dataset.making.workers import unordered, worker_pool

    calls = 12
    with worker_pool(processes) as pool:
        list(unordered(pool, arithmetic, [()] * processes))
        start = time.perf_counter()
        list(unordered(pool, arithmetic, [()] * calls))
        return calls / (time.perf_counter() - start)


def arithmetic() -> int:
    """Add some integers, about a fifth of a second."""
    return sum(range(8_000_000))


def _cpu_of_children() -> float:
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def _peak_mb() -> float:
    """Return the peak memory of this process. `ru_maxrss` would begin with the peak of the process that started it."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    return int(status.partition("VmHWM:")[2].split()[0]) * 1024 / MB


def _peak_of_children_mb() -> float:
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024 / MB


def _in_new_process(name: str, *arguments: object) -> dict[str, float]:
    call = [sys.executable, "-m", "benchmarks.scale", name, *map(str, arguments)]
    done = subprocess.run(call, check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    costs: dict[str, float] = loads(done.stdout.splitlines()[-1])
    return costs


def _kept(name: str, *arguments: object, label: str = "") -> dict[str, float]:
    """Return a measurement, read where it was made before."""
    path = KEPT / f"{'-'.join([name, *map(str, arguments), *filter(None, [label])])}.json"
    if not path.exists():
        print(path.stem, flush=True)
        costs = _in_new_process(name, *arguments) | {"load": os.getloadavg()[0]}
        path.write_text(dumps(costs), encoding="utf-8")
    return dict(loads(path.read_text(encoding="utf-8")))


def page(sizes: list[int]) -> str:
    """Measure what is missing and compose docs/scale.md."""
    plans = {runs: _kept("coordinated", runs) for runs in (1000, *PROJECTED)}
    one = _kept("usual")
    costs = {runs: _kept("made", runs) for runs in sizes}
    pairs = [_kept("pair", label=str(number)) for number in range(PAIRS)]
    text = TEXT.read_text(encoding="utf-8")
    parts: dict[str, Callable[[], str]] = {
        "MEASURED": lambda: _measured_table(costs),
        "SHARES": lambda: _shares(costs, one),
        "PROJECTED": lambda: _projected_table(costs, one),
        "PAIRS": lambda: _pairs_text(pairs),
        "COORDINATOR": lambda: _plan_table(plans),
        "STUDY": _old_study,
    }
    for name, part in parts.items():
        text = text.replace(f"{name}\n", f"{part()}\n")
    return text


def _old_study() -> str:
    """Return the table of `make cluster`, which stands on the page."""
    _, _, rest = PAGE.read_text(encoding="utf-8").partition("<!-- study -->\n")
    return rest.partition("\n<!-- end -->")[0] or "Not made yet: `make cluster`."


def _measured_table(costs: dict[int, dict[str, float]]) -> str:
    header = ["runs", "workers, CPU s", "parent, CPU s", "of it finish", "verify", "MB", "files"]
    header += ["parent, peak MB", "worker", "verify"]
    rows = [
        [
            f"{runs:,}",
            *(f"{each[name]:,.1f}" for name in ("workers", "parent", "finish", "verify")),
            f"{each['bytes'] / MB:,.0f}",
            f"{each['files']:.0f}",
            *(f"{each[name]:.0f}" for name in ("parent_mb", "worker_mb", "verify_mb")),
        ]
        for runs, each in costs.items()
    ]
    return table(header, rows, numbers_from=0)


def _slope(costs: dict[int, dict[str, float]], name: str) -> float:
    few, many = sorted(costs)[-2:]
    return (costs[many][name] - costs[few][name]) / (many - few)


def _shares(costs: dict[int, dict[str, float]], one: dict[str, float]) -> str:
    most = max(costs)
    short, finish = _slope(costs, "workers"), _slope(costs, "finish")
    start = costs[most]["workers"] - short * most
    whole = costs[most]["parent"] / (costs[most]["parent"] + costs[most]["workers"])
    memory = {runs: each["parent_mb"] for runs, each in costs.items()}
    return (
        f"A further run costs {1e3 * short:.0f} ms of the workers; their start took {start:.0f} s. Assembling and the "
        f"manifest cost {1e3 * finish:.2f} ms a run, {finish / (short + finish):.2%} of the work of these short runs "
        f"and {finish / (one['seconds'] + finish):.2%} where a run rubs for {one['seconds']:.1f} CPU seconds. All that "
        f"the parent did, imports included, was {whole:.1%} of the work of {most:,} runs. Its peak memory went from "
        f"{memory[min(memory)]:.0f} to {memory[most]:.0f} MB: rows of `runs.parquet` pass through it 4,096 at a time, "
        "so it grows up to that number of runs."
    )


def _projected_table(costs: dict[int, dict[str, float]], one: dict[str, float]) -> str:
    many = max(costs)
    header = ["runs", "short: core-hours", "TB", "files", "usual: core-hours", "TB", "finish, h", "verify, h"]
    few, shards = min(costs), {runs: ceil(runs / RUNS_PER_SHARD) for runs in (*costs, *PROJECTED)}
    per_shard = (costs[many]["files"] - costs[few]["files"]) / (shards[many] - shards[few])
    rows = [
        [
            f"{runs:,}",
            f"{(_slope(costs, 'workers') + _slope(costs, 'parent')) * runs / HOUR:,.0f}",
            f"{_slope(costs, 'bytes') * runs / MB / MB:.3f}",
            f"{costs[many]['files'] + per_shard * (shards[runs] - shards[many]):,.0f}",
            f"{one['seconds'] * runs / HOUR:,.0f}",
            f"{one['bytes'] * runs / MB / MB:.2f}",
            f"{_slope(costs, 'finish') * runs / HOUR:.2f}",
            f"{_slope(costs, 'verify') * runs / HOUR:,.1f}",
        ]
        for runs in PROJECTED
    ]
    text = (
        f"A usual run rubs, has signals of one second, takes {one['seconds']:.1f} CPU seconds with its file, and "
        f"has {one['bytes'] / MB:.2f} MB. Shipped as a manifest alone, a million such runs are kilobytes in place of "
        f"{one['bytes'] / MB:.2f} TB; each run then costs its {one['seconds']:.1f} CPU seconds when it is asked for, "
        "and all of them the core-hours of the table once more for each user who asks for all."
    )
    return f"{table(header, rows, numbers_from=0)}\n\n{text}"


def _pairs_text(pairs: list[dict[str, float]]) -> str:
    def middle(name: str) -> float:
        return median(each[name] for each in pairs)

    return (
        f"Interleaved pairs: {len(pairs)}; a whole page has seven. Two workers make {middle('runs'):.2f} times as "
        "many runs a second as one (median). Two processes with a loop of pure arithmetic do "
        f"{middle('kernel'):.2f} times as much as one. The load "
        f"of the computer with two cores was {min(each['load'] for each in pairs):.0f} to "
        f"{max(each['load'] for each in pairs):.0f}, so both ratios tell of other work too. With start and end, "
        f"{RUNS_A_PAIR} runs took {middle('cpu_1'):.1f} CPU seconds with one worker and {middle('cpu_2'):.1f} with two."
    )


def _plan_table(plans: dict[int, dict[str, float]]) -> str:
    header = ["runs", "jobs", "CPU, s", "memory before, MB", "peak, MB"]
    rows = [
        [
            f"{runs:,}",
            f"{each['jobs']:,.0f}",
            f"{each['plan']:.1f}",
            f"{each['base_mb']:.0f}",
            f"{each['plan_mb']:.0f}",
        ]
        for runs, each in plans.items()
    ]
    return table(header, rows, numbers_from=0)


def main() -> None:
    """Write the page, or in a process of its own measure one thing."""
    match sys.argv[1:]:
        case [("made" | "coordinated" | "rate") as name, number]:
            print(dumps(globals()[name](int(number))))
        case ["verified", out]:
            print(dumps(verified(Path(out))))
        case [("usual" | "pair") as name]:
            print(dumps(globals()[name]()))
        case sizes:
            KEPT.mkdir(parents=True, exist_ok=True)
            PAGE.write_text(page([int(each) for each in sizes]), encoding="utf-8")


if __name__ == "__main__":
    main()
