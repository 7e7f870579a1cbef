"""One run of a data set: simulated, and its files written so that they are complete or not there."""

from __future__ import annotations

from contextlib import AbstractContextManager, suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from rubgen.cache_root import untold
from rubgen.dataset.layout import FOLDERS, Layout
from rubgen.errors import UserError
from rubgen.io.durable import write_durably
from rubgen.progress import COMPILING, step
from rubgen.scenario import Scenario

if TYPE_CHECKING:
    from rubgen.pipeline import Run

WARM_UP_TURNS = 40


def stage_run(scenario: Scenario, root: Path, formats: tuple[str, ...]) -> str:
    """Simulate one run and write its files; gives its status. The staged row comes last: it proves the others.

    A run that cannot be made of the values that were drawn is recorded as refused, with the reason.
    """
    from rubgen.io.parquet.sections import write_section
    from rubgen.io.parquet.write import run_table, write_table
    from rubgen.pipeline import refused, simulate

    layout = Layout(root)
    try:
        run = simulate(scenario)
    except UserError as error:
        run = refused(scenario, str(error))
    if run.labels is not None:
        _write_exports(run, layout, formats)
        write_section(scenario.run_id, run.response, layout.staged_section(scenario.run_id))
    table = run_table(run, signals="parquet" in formats)
    write_table([table], table.schema, layout.staged(scenario.run_id))
    return run.response.status.code


def is_staged(layout: Layout, index: int, formats: tuple[str, ...], asked_bytes: float) -> bool:
    """Whether the run and all its files are there; a row that cannot be read, or whose files are lost, is not.

    `asked_bytes` is what the recipe lets its row unpack to.
    """
    from rubgen.io.parquet.read import read_table

    run_id = f"run-{index:06d}"
    if not layout.staged(run_id).exists():
        return False
    try:
        status = read_table(layout.staged(run_id), ["status"], asked_bytes)["status"].to_pylist()
    except UserError:
        return False
    files = [layout.export(kind, run_id) for kind in FOLDERS if kind in formats]
    return status != ["ok"] or all(file.exists() for file in (layout.staged_section(run_id), *files))


def warm_up(scenario: Scenario, corners: tuple[Scenario, ...], first_runs: tuple[Scenario, ...]) -> list[str]:
    """Reduce the machine at the extremes of `[vary]`, then run a few turns.

    Gives what to warn of: what a worker found wrong in caches, and that none of the first runs can rub.

    What cannot be done fails before any run; kernels are compiled and the reduced model cached before workers start.
    """
    from rubgen.pipeline import simulate
    from rubgen.reduction import reduce
    from rubgen.solver.linear.reach import no_rub

    for corner in corners:
        reduce(corner.machine, corner.reduction)
    operation = replace(scenario.operation, settle_turns=2 * WARM_UP_TURNS, record_turns=WARM_UP_TURNS)
    operation = replace(operation, closing_turns=WARM_UP_TURNS)
    with suppress(UserError):  # this run's own values, not the recipe's ends: it will be recorded as refused
        simulate(replace(scenario, operation=operation, signal_seconds=5 / operation.rotation_frequency_hz))
    text = no_rub(first_runs)
    return [*untold, text] if text else untold


def warming_up() -> AbstractContextManager[None]:
    """The step to show while `warm_up` works here or in a worker."""
    from rubgen.jit import kernels_are_compiled

    compiled = kernels_are_compiled()
    return step("reduce the machine" if compiled else COMPILING, long=not compiled)


def _write_exports(run: Run, layout: Layout, formats: tuple[str, ...]) -> None:
    if "mcap" in formats:
        from rubgen.io.mcap import write_mcap

        write_mcap(run, layout.export("mcap", run.scenario.run_id))
    if "rrd" in formats:
        from rubgen.viz.rerun import write_rrd

        write_durably(layout.export("rrd", run.scenario.run_id), lambda part: write_rrd(run, part))
