"""Choose the candidate of a run that is in the run's cell of `[balance]`."""

from dataclasses import replace

from rubgen.balancing.screen import Verdict, screen
from rubgen.scenario import Recipe, Scenario
from rubgen.scenario.tables.balance import NO_CANDIDATE, Balance, Cell

UNCLASSED, IMPOSSIBLE = "rub, class not asked", "not possible"
"""The last two counts of `Chosen.seen`, after the counts of the cells."""


def choose(recipe: Recipe, balance: Balance, index: int) -> Scenario:
    """Return run number `index` of a balanced recipe: its first candidate that is in the run's cell (wanted class).

    Cell and candidates follow only from the seed and the number of the run, so runs are independent of each other. If
    none of `balance.tries` candidates is in the cell, the last candidate is returned with the problem, and `simulate`
    refuses it. A candidate whose virtual machine has a problem is returned at once, and refused too.
    """
    cell, cells = balance.place(recipe.seed, index)[0], balance.cells
    seen = [0] * (len(cells) + 2)
    for attempt in range(balance.tries):
        candidate = recipe.candidate(index, attempt)
        if candidate.virtual and candidate.virtual.problem:
            return candidate
        number = _place(balance, cell, screen(candidate, motion=balance.needs_run and cell.rub))
        seen[number] += 1
        if number < len(cells) and cells[number] == cell:
            return _with(candidate, seen)
    names = (*(each.name for each in cells), UNCLASSED, IMPOSSIBLE)
    found = ", ".join(f"{count} {each}" for each, count in zip(names, seen, strict=True) if count)
    problem = f"{NO_CANDIDATE}{balance.tries} candidates is in the class {cell.name!r}; found: {found}"
    return _with(candidate, seen, problem)


def _with(candidate: Scenario, seen: list[int], problem: str = "") -> Scenario:
    return replace(candidate, balance=replace(candidate.balance, seen=tuple(seen), problem=problem))  # type: ignore[type-var]


def _place(balance: Balance, wanted: Cell, verdict: Verdict | None) -> int:
    """Return the index of a candidate in `Chosen.seen`."""
    unclassed = len(balance.cells)
    if verdict is None:
        return unclassed + 1
    if balance.needs_run and verdict.rub and not wanted.rub:
        return unclassed
    return balance.cell_of(rub=verdict.rub, motion=verdict.motion, severity=verdict.severity)
