"""The name of a run, from its number. Names sort as numbers do, as text too."""

import re

_DIGITS = 6
_FORM = re.compile(r"run-(?:(\d{6})|([a-z])([1-9]\d+))")


def run_id_of(index: int) -> str:
    """Return the name of run number `index`, from 0: run-000000 to run-999999, then run-a1000000, run-b10000000.

    The letter grows with the number of digits beyond six, so that names sorted as text are in the order of the numbers.
    """
    digits = f"{index:0{_DIGITS}d}"
    longer = len(digits) - _DIGITS
    return f"run-{chr(ord('a') + longer - 1) if longer else ''}{digits}"


def index_of(run_id: str) -> int:
    """Return the number of the run with the name `run_id`. Raises ValueError for a text that is no name of a run."""
    found = _FORM.fullmatch(run_id)
    index = int(found[1] or found[3]) if found else -1
    if index < 0 or run_id_of(index) != run_id:
        raise ValueError(f"{run_id!r:.100} names no run")
    return index
