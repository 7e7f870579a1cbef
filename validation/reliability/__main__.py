"""Every fault, tried by command: `python -m validation.reliability [--quick] [--only NAME] [--out FILE]`.

Writes out/faults.json and the table of docs/reliability.md; ends with 1 where anything was lost, differed, was missed
or ended in a traceback. Rows of before stay where they are not made again: NAME is a row of generation, such as kill-1,
`damage`, `fuzz` or one kind of it, such as fuzz-recipe. `--seed N` repeats one hostile input. --quick is what CI runs.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path

from validation.reliability.damage import damage_rows
from validation.reliability.disks import full_disk_row, read_only_row, shut_out_row
from validation.reliability.fuzz import fuzz_rows, repeat
from validation.reliability.hostile.inputs import SHARES, kind_of
from validation.reliability.kills import signal_row
from validation.reliability.rows import Row, commit_here, write_page
from validation.reliability.sets import Truth, undisturbed
from validation.reliability.stops import error_row, stop_row
from validation.reliability.together import together_row
from validation.rows import replace_rows

OUT = Path("out/faults.json")


def fault_rows(truth: Truth, *, quick: bool) -> dict[str, Callable[[], Row]]:
    """The rows about generation by name, each made when it is called."""
    return {
        "kill-1": lambda: signal_row(truth, "SIGKILL", 1, 4 if quick else 100),
        "kill-2": lambda: signal_row(truth, "SIGKILL", 2, 1 if quick else 100),
        "interrupt": lambda: signal_row(truth, "SIGINT", 1, 2 if quick else 40),
        "terminate": lambda: signal_row(truth, "SIGTERM", 1, 2 if quick else 40),
        "interrupt-2": lambda: signal_row(truth, "SIGINT", 2, 1 if quick else 20),
        "stop": lambda: stop_row(truth, 4 if quick else 1000),
        "error": lambda: error_row(truth, 3 if quick else 1000),
        "full-disk": lambda: full_disk_row(truth, 2 if quick else 24),
        "read-only": lambda: read_only_row(truth, 2 if quick else 8),
        "shut-out": lambda: shut_out_row(truth, whole=not quick),
        "two": lambda: together_row(truth, 2, 1 if quick else 20),
        "three": lambda: together_row(truth, 3, 1 if quick else 20),
    }


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m validation.reliability")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--out", type=Path, default=OUT)
    parser.add_argument("--seed", type=int)
    given = parser.parse_args()
    if given.seed is not None:
        print(f"{kind_of(given.seed)}: {repeat(given.seed)}")
        return 0
    good, commit = True, commit_here()
    for row in rows(quick=given.quick, only=given.only):
        print(f"{'ok  ' if row.good else 'FAIL'} {row.fault}: {row.skipped or row.tries}, {row.seconds} s", flush=True)
        replace_rows(given.out, [asdict(row) | {"commit": commit}], by="fault")
        good = good and row.good
    if given.out == OUT and not given.quick:
        write_page(OUT)
    return 0 if good else 1


def rows(*, quick: bool, only: list[str]) -> Iterator[Row]:
    """The rows that are asked for, one after the other."""
    with undisturbed() as truth:
        for name, make in fault_rows(truth, quick=quick).items():
            if not only or name in only:
                yield make()
    if not only or "damage" in only:
        yield from damage_rows(11 if quick else 1000)
    kinds = [kind for kind in SHARES if not only or "fuzz" in only or f"fuzz-{kind}" in only]
    if kinds:
        yield from fuzz_rows(150 if quick else 100_000, kinds)


if __name__ == "__main__":
    sys.exit(main())
