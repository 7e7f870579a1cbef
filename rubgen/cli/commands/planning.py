"""The command `rubgen plan`, and `rubgen generate --dry-run`."""

import math
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from statistics import median

from rubgen.brief import counted
from rubgen.cli.printing import check_new_file, print_json, say, write_file
from rubgen.dataset.making.cluster import job_script
from rubgen.dataset.making.workers import usable_cores
from rubgen.errors import UserError
from rubgen.planning.plan import Plan, plan
from rubgen.progress import step
from rubgen.scenario import load_recipe

ENDINGS = (".png", ".svg", ".pdf")
LONGEST_HOW = 44
MOST_SHOWN = 3
"""Reasons of refusal that are shown."""


def plan_command(
    recipe: Path | None,
    runs: int | None,
    tries: int,
    out: Path | None,
    *,
    force: bool,
    as_json: bool,
    slurm: bool = False,
) -> int:
    """Print what a recipe draws and what its data set costs, and draw a picture of it.

    - recipe: path or name of the recipe; None is the default recipe.
    - runs: number of runs in place of the recipe's; None keeps it.
    - tries: number of runs to simulate.
    - out: picture to write (.png, .svg, .pdf), or None.
    - force: replace an existing picture.
    - as_json: print the plan as JSON.
    - slurm: also print the script of a job of SLURM.

    Up to 64 runs are looked at (`rubgen.planning.plan.plan`). Returns the exit code 1 where one of them, or a scenario
    at extreme values of the recipe, is refused; else 0.
    """
    if tries < 0:
        raise UserError(f"--try {tries}: must be at least 0; give a number of runs")
    if out:
        check_new_file("--out", out, ENDINGS, force=force)
    script = job_script() if slurm else ""
    made = plan(load_recipe(recipe, runs=runs), tries=tries)
    if as_json:
        print_json(_for_programs(made) | ({"job_script": script} if script else {}))
    else:
        for line in (*plan_lines(made), *script.splitlines()):
            say(line)
    if out:
        from rubgen.planning.picture import plan_figure
        from rubgen.viz.figures import save_figure

        with step("draw the plan"):
            figure = plan_figure(made)
            write_file("--out", out, lambda part: save_figure(figure, part))
        if not as_json:
            say(f"picture   {out}")
    return 1 if made.refused_corners or any(each.refused for each in made.reach) else 0


def plan_lines(made: Plan) -> Iterator[str]:
    """Yield the lines of a plan as text."""
    machines = f"{made.machines:,} machines from {made.machine}" if made.machines > 1 else made.machine
    yield f"{made.name}: {made.runs:,} {'run' if made.runs == 1 else 'runs'} of {machines}"
    if len(made.splits) > 1:
        yield f"splits    {', '.join(f'{name} {runs:,}' for name, runs in made.splits.items())}"
    if made.balanced:
        yield "balance   looked at are first candidates, of which the quotas choose; screening more takes further time"
    yield from _table(made)
    yield from _rub(made)
    yield from _costs(made)


def _table(made: Plan) -> Iterator[str]:
    """Yield the keys in columns, with the values among the runs looked at."""
    if not made.drawn:
        yield "drawn     nothing: all runs are alike except for noise"
        return
    rows = [["drawn", "how", "least", "median", "largest"]]
    for each in made.drawn:
        values = each.values
        found = [f"{value:.4g}" for value in (min(values), median(values), max(values))] if values else [""] * 3
        how = each.how if len(each.how) <= LONGEST_HOW else f"{each.how[: LONGEST_HOW - 3]}..."
        rows.append([each.key, how, *found])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (f"{cell:<{width}}" if place < 2 else f"{cell:>{width}}" for place, (cell, width)
                 in enumerate(zip(row, widths, strict=True)))  # fmt: skip
        yield "  ".join(cells).rstrip()


def _rub(made: Plan) -> Iterator[str]:
    possible = [each for each in made.reach if not each.refused]
    looked, of = len(made.reach), f"of {counted(len(possible), 'run')} looked at"
    depths = [each.depth_m for each in possible if math.isfinite(each.depth_m)]
    if possible:
        can = sum(each.can_rub for each in possible)
        span = f"; free penetration {1e3 * min(depths):.3g} to {1e3 * max(depths):.3g} mm" if depths else ""
        yield f"can rub   {can} {of} ({100 * made.share_that_can_rub:.0f} %){span}"
    if len(depths) < len(possible):
        yield f"unknown   {len(possible) - len(depths)} {of}: only the run itself shows whether it rubs"
    reasons = [each.refused for each in made.reach if each.refused]
    if reasons:
        yield f"refused   {len(reasons)} of {counted(looked, 'run')} looked at"
        yield from (f"  {reason}" for reason in list(dict.fromkeys(reasons))[:MOST_SHOWN])
    if made.refused_corners:
        yield f"extremes  {len(made.refused_corners)} of {made.corners} scenarios at the extremes are refused"
        yield from (f"  {reason}" for reason in made.refused_corners[:MOST_SHOWN])
    elif made.corners:
        yield f"extremes  none of {counted(made.corners, 'scenario')} at the extremes is refused"


def _costs(made: Plan) -> Iterator[str]:
    cores = usable_cores()
    known = f"measured in {counted(made.tried.runs, 'run')}" if made.tried else "estimated; --try 4 measures it here"
    if made.tried:
        yield f"classes   {', '.join(f'{count} {name}' for name, count in made.tried.classes.items())}"
    one, all_cores = _minutes(made.cpu_seconds), _minutes(made.cpu_seconds / cores)
    yield f"time      {one} on one core, {all_cores} on {cores} ({known})"
    sizes = ", ".join(f"{name} {size:,.3g} MB" for name, size in made.megabytes.items())
    yield f"disk      {sizes}; {sum(made.megabytes.values()):,.3g} MB in all"


def _minutes(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.2g} s"
    return f"{seconds / 60:.3g} min" if seconds < 5400 else f"{seconds / 3600:.3g} h"


def _for_programs(made: Plan) -> dict[str, object]:
    drawn = [
        {"key": each.key, "how": each.how, "least": min(each.values, default=None),
         "largest": max(each.values, default=None), "runs": len(each.values)}
        for each in made.drawn
    ]  # fmt: skip
    share = made.share_that_can_rub
    return {**asdict(made), "drawn": drawn, "reach": [asdict(each) for each in made.reach], "share_that_can_rub": share}
