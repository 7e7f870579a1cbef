"""Find out before the first run whether a recipe is possible, and compile the kernels."""

from contextlib import AbstractContextManager, suppress
from dataclasses import replace

from rubgen.cache_root import pending_warnings
from rubgen.errors import UserError
from rubgen.progress import COMPILING, step
from rubgen.scenario import Scenario

WARM_UP_TURNS = 40


def warm_up(scenario: Scenario, corners: tuple[Scenario, ...], first_runs: tuple[Scenario, ...]) -> list[str]:
    """Check before the first run whether a recipe is possible, compile the kernels and cache the reduced model.

    - scenario: its machine is reduced, and a few turns of it are simulated.
    - corners: scenarios at the extreme values of `[vary]`, whose machines are reduced. Empty if each machine of a
      recipe is checked on its own.
    - first_runs: the first runs of the recipe.

    Returns warnings: problems of a worker with the caches, and that none of the first runs can be made or can rub.
    Raises UserError where the machine of a corner cannot be reduced, or the virtual machine of `scenario` cannot be
    drawn. A UserError of reducing or simulating `scenario` itself is ignored: that run will be recorded as refused.
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
    """Show the progress of `warm_up` during the block. `warm_up` may run in this process or in a worker."""
    from rubgen.jit import kernels_are_compiled

    compiled = kernels_are_compiled()
    return step("reduce the machine" if compiled else COMPILING, long=not compiled)
