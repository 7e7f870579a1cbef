"""What a large data set costs beside the simulation: `make scale` writes docs/scale.md.

One run is simulated and then stands for all, so that keeping, closing, finishing and checking are measured with real
rows alone. CPU seconds are of one process. The costs of 10^5 and 10^6 runs follow from the slope between the two
largest sets that were measured.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from json import dumps, loads
from math import ceil
from pathlib import Path
from uuid import uuid4

from rubgen.dataset.shards import RUNS_PER_SHARD

PAGE = Path(__file__).parents[1] / "docs" / "scale.md"
TEXT = Path(__file__).parent / "scale.md"
SIZES = (100, 300)
PROJECTED = (100_000, 1_000_000)
RECIPE = {
    "name": "scale",
    "machine": "zeng2019",
    "vary": {"speed_rpm": 10_000.0, "disk_support_stiffness_n_per_m": 2e8},
    "output": {"formats": ["parquet"]},
}
MB = 1e6


def measured(runs: int, out: Path) -> dict[str, float]:
    """Make a set of that many copies of one simulated run, in this process. Return its costs by name."""
    import rubgen.pipeline
    from rubgen.dataset.checking.verify import verify
    from rubgen.dataset.layout import Layout
    from rubgen.dataset.making.claim import begun, claimed
    from rubgen.dataset.making.finish import finish_set
    from rubgen.dataset.making.plan import Plan, do
    from rubgen.dataset.manifest import identity_of
    from rubgen.scenario import parse_recipe

    recipe = parse_recipe({**RECIPE, "runs": runs})
    start = time.process_time()
    one = rubgen.pipeline.simulate(recipe.scenario(0))
    simulate_s = time.process_time() - start
    one.save(out.with_name("one.parquet"))
    rubgen.pipeline.simulate = lambda scenario: replace(one, scenario=scenario)
    layout, identity = Layout(out), identity_of(recipe)
    with claimed(layout, identity), begun(layout, identity):
        plan = Plan(recipe, layout, uuid4().hex)
        times = {"keep": 0.0, "close": 0.0}
        for job in plan.jobs(1):
            before = time.process_time()
            shard, made = do(*job)
            times["keep" if made else "close"] += time.process_time() - before
            if made:
                plan.ended(shard)
        before = time.process_time()
        finish_set(recipe, layout, identity)
        times["finish"] = time.process_time() - before
        making_mb = _peak_mb()
    before = time.process_time()
    problems = verify(out)
    times["verify"] = time.process_time() - before
    files = [path for path in out.rglob("*") if path.is_file() and ".staging" not in path.parts]
    return {
        **times,
        "simulate": simulate_s,
        "bytes": float(out.with_name("one.parquet").stat().st_size * runs),
        "files": float(len(files)),
        "making_mb": making_mb,
        "verify_mb": _peak_mb(),
        "problems": float(len(problems)),
    }


def coordinated(runs: int) -> dict[str, float]:
    """Plan the jobs of a set of that many runs, none of them made. Return CPU seconds and peak memory."""
    from rubgen.dataset.layout import Layout
    from rubgen.dataset.making.plan import Plan
    from rubgen.scenario import parse_recipe

    recipe = parse_recipe({**RECIPE, "runs": runs})
    base = _peak_mb()
    start = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        plan = Plan(recipe, Layout(Path(folder)), "session")
        jobs = 0
        for _, _, shard, indexes in plan.jobs(64):
            jobs += 1
            if indexes:
                plan.ended(shard)
    return {"plan": time.process_time() - start, "jobs": float(jobs), "base_mb": base, "plan_mb": _peak_mb()}


def _peak_mb() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def _in_new_process(name: str, runs: int) -> dict[str, float]:
    call = [sys.executable, "-m", "benchmarks.bench_scale", name, str(runs)]
    done = subprocess.run(call, check=True, capture_output=True, text=True)
    costs: dict[str, float] = loads(done.stdout.splitlines()[-1])
    return costs


def page() -> str:
    """Measure everything and compose docs/scale.md."""
    costs = {runs: _in_new_process("measured", runs) for runs in SIZES}
    plans = {runs: _in_new_process("coordinated", runs) for runs in (1000, *PROJECTED)}
    text = TEXT.read_text(encoding="utf-8")
    return (
        text.replace("MEASURED", _measured_table(costs))
        .replace("PROJECTED", _projected_table(costs))
        .replace("COORDINATOR", _plan_table(plans))
    )


def _measured_table(costs: dict[int, dict[str, float]]) -> str:
    lines = ["| runs | keep, ms a run | close | finish | verify | files | peak making | peak verify, MB |"]
    lines.append("|" + "---|" * 8)
    for runs, each in costs.items():
        times = " | ".join(f"{1e3 * each[name] / runs:.1f}" for name in ("keep", "close", "finish", "verify"))
        lines.append(
            f"| {runs:,} | {times} | {each['files']:.0f} | {each['making_mb']:.0f} | {each['verify_mb']:.0f} |"
        )
    return "\n".join(lines)


def _projected_table(costs: dict[int, dict[str, float]]) -> str:
    few, many = SIZES[-2:]

    def at(runs: int, name: str) -> float:
        slope = (costs[many][name] - costs[few][name]) / (many - few)
        return costs[many][name] + slope * (runs - many)

    def files(runs: int) -> float:
        """Number of files: some for the set, and equally many for each shard."""
        shards = {each: ceil(each / RUNS_PER_SHARD) for each in (few, many, runs)}
        per_shard = (costs[many]["files"] - costs[few]["files"]) / (shards[many] - shards[few])
        return costs[many]["files"] + per_shard * (shards[runs] - shards[many])

    simulate = costs[many]["simulate"]
    lines = ["| runs | simulate, core-hours | keep and close | finish | finish, share | verify | TB | files |"]
    lines.append("|" + "---|" * 8)
    for runs in PROJECTED:
        beside = (at(runs, "keep") + at(runs, "close")) / 3600
        finish, verify, all_s = at(runs, "finish"), at(runs, "verify"), simulate * runs
        lines.append(
            f"| {runs:,} | {all_s / 3600:,.0f} | {beside:,.1f} | {finish / 3600:.2f} | {finish / all_s:.2%} | "
            f"{verify / 3600:,.1f} | {at(runs, 'bytes') / MB / MB:.2f} | {files(runs):,.0f} |"
        )
    lines.append("")
    one = costs[many]["bytes"] / many / MB
    lines.append(f"A run has {one:.2f} MB in a file of its own: copies of one run would compress too well.")
    lines.append(f"It takes {simulate:.1f} CPU seconds to simulate here, at 10,000 rev/min with 500 turns.")
    return "\n".join(lines)


def _plan_table(plans: dict[int, dict[str, float]]) -> str:
    lines = ["| runs | jobs | CPU, s | memory before, MB | peak, MB |", "|---|---|---|---|---|"]
    for runs, each in plans.items():
        lines.append(
            f"| {runs:,} | {each['jobs']:,.0f} | {each['plan']:.1f} | {each['base_mb']:.0f} | {each['plan_mb']:.0f} |"
        )
    return "\n".join(lines)


def main() -> None:
    """Write the page, or in a process of its own measure one set."""
    match sys.argv[1:]:
        case ["measured", runs]:
            with tempfile.TemporaryDirectory() as folder:
                print(dumps(measured(int(runs), Path(folder) / "set")))
        case ["coordinated", runs]:
            print(dumps(coordinated(int(runs))))
        case _:
            PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
