"""Simulate one run of a data set and write its files, completely or not at all."""

from contextlib import AbstractContextManager, suppress
from dataclasses import replace
from pathlib import Path

from rubgen.cache_root import pending_warnings
from rubgen.dataset.layout import SPLIT, Layout
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.progress import COMPILING, step
from rubgen.scenario import Scenario

WARM_UP_TURNS = 40


def stage_run(scenario: Scenario, root: Path, formats: tuple[str, ...]) -> str:
    """Simulate one run and write its files. Return its status. A worker process calls it for each run.

    The staged row is written last: it proves that the other files are complete. A run that is not possible with the
    drawn values is recorded as refused, with the reason.

    - scenario: the run.
    - root: directory of the set.
    - formats: names of the formats in which runs are written.
    """
    from rubgen.io.parquet.write import write_table
    from rubgen.pipeline import refused, simulate

    layout = Layout(root)
    try:
        run = simulate(scenario)
    except UserError as error:
        run = refused(scenario, str(error))
    if run.labels is not None:
        for each in run_formats(formats):
            each.write(run, layout.export(each.name, scenario.run_id))
        for table in tables_of(formats):
            row = table.row(run, SPLIT)
            write_table([row], row.schema, layout.staged_row(table.name, scenario.run_id))
    row = RUNS.row(run, SPLIT)
    write_table([row], row.schema, layout.staged(scenario.run_id))
    return run.response.status.code


def is_staged(layout: Layout, index: int, formats: tuple[str, ...], asked_bytes: float) -> bool:
    """Return whether a run was finished before: all its files are there and its row can be read.

    - layout: paths of the set.
    - index: number of the run.
    - formats: names of the formats in which runs are written.
    - asked_bytes: the largest unpacked size of its row, from the function of that name.
    """
    from rubgen.io.parquet.read import read_table

    run_id = f"run-{index:06d}"
    if not layout.staged(run_id).exists():
        return False
    try:
        status = read_table(layout.staged(run_id), ["status"], asked_bytes)["status"].to_pylist()
    except UserError:
        return False
    files = [layout.export(each.name, run_id) for each in run_formats(formats)]
    files += [layout.staged_row(table.name, run_id) for table in tables_of(formats)]
    return status != ["ok"] or all(file.exists() for file in files)


def warm_up(scenario: Scenario, corners: tuple[Scenario, ...], first_runs: tuple[Scenario, ...]) -> list[str]:
    """Find out before the first run whether a recipe is possible, compile the kernels and cache the reduced model.

    The machine is reduced at the extremes of `[vary]`, where an impossible recipe raises UserError, and so does a first
    virtual machine that cannot be drawn. Then a few turns of `scenario` are run. Returns warnings: problems of a worker
    with caches, and that none of the first runs can be made or can rub.

    - scenario: its machine is reduced and run.
    - corners: scenarios at the extremes of `[vary]`; none where each machine of a recipe is checked on its own.
    - first_runs: the first runs of the recipe.
    """
    from rubgen.pipeline import simulate
    from rubgen.reduction import reduce
    from rubgen.solver.linear.reach import no_rub_warning
    from rubgen.solver.refusal import no_run_warning

    if scenario.virtual and scenario.virtual.problem:
        raise UserError(scenario.virtual.problem)
    for corner in corners:
        reduce(corner.machine, corner.reduction)
    operation = replace(scenario.operation, settle_turns=2 * WARM_UP_TURNS, record_turns=WARM_UP_TURNS)
    operation = replace(operation, closing_turns=WARM_UP_TURNS)
    with suppress(UserError):  # this run's own values, not the recipe's ends: it will be recorded as refused
        simulate(replace(scenario, operation=operation, signal_seconds=5 / operation.rotation_frequency_hz))
    text = no_run_warning(first_runs) or no_rub_warning(first_runs)
    return [*pending_warnings, text] if text else pending_warnings


def warming_up() -> AbstractContextManager[None]:
    """Show the progress of `warm_up`, which runs here or in a worker, during the block."""
    from rubgen.jit import kernels_are_compiled

    compiled = kernels_are_compiled()
    return step("reduce the machine" if compiled else COMPILING, long=not compiled)
