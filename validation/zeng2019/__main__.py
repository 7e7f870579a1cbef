"""`python -m validation.zeng2019 [--figure N] [--quick] [--fit] [--out DIR]`: the paper's figures and statements.

What is interrupted goes on with the same command. Ends with 2 after a mistake of the user, with 130 after Ctrl-C.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rubgen.cli.printing import print_json, print_pairs
from rubgen.errors import UserError
from rubgen.progress import count
from validation.command import run_command
from validation.zeng2019 import fit, reproduce


def main(arguments: Sequence[str]) -> int:
    """Compute, judge, write, or search; say in one line what is wrong or how to go on."""
    given = _parser().parse_args(arguments)
    folder = given.out or Path("out") / ("zeng2019-quick" if given.quick else "zeng2019")

    def work() -> None:
        _check(given)
        result = _fit(given, folder) if given.fit else _reproduce(given, folder)
        (print_json if given.json else print_pairs)(result)

    return run_command("validation.zeng2019", folder, work, show=not given.json)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m validation.zeng2019")
    parser.add_argument("--figure", help="one figure, 6 to 21, or a group of statements, by its name")
    parser.add_argument("--out", type=Path, help="directory for the page; out/zeng2019 when not given")
    parser.add_argument("--quick", action="store_true", help="few values and short runs, in two minutes")
    parser.add_argument("--every", type=int, default=1, help="every how many-th speed: 1 by 30 rev/min, 4 by 120")
    parser.add_argument("--fit", action="store_true", help="search what is not published, instead of the page")
    parser.add_argument("--workers", type=int, help="number of processes; the number of cores when not given")
    parser.add_argument("--json", action="store_true", help="print JSON, for programs")
    return parser


def _check(given: argparse.Namespace) -> None:
    if given.workers is not None and given.workers < 1:
        raise UserError(f"--workers {given.workers}: must be at least 1; give a number of processes")
    if given.every < 1:
        raise UserError(f"--every {given.every}: must be at least 1; 4 gives steps of 120 rev/min")
    if given.fit and given.figure is not None:
        raise UserError(f"--fit --figure {given.figure}: the search is one whole; leave --figure out")


def _reproduce(given: argparse.Namespace, folder: Path) -> dict[str, object]:
    made = reproduce(
        folder,
        figure=given.figure,
        quick=given.quick,
        every=given.every,
        workers=given.workers,
        progress=count,
    )
    html = made.page.with_suffix(".html")
    return {"page": str(made.page), "html": str(html), "made": made.made, "verdicts": made.verdicts}


def _fit(given: argparse.Namespace, folder: Path) -> dict[str, object]:
    made = fit(folder, quick=given.quick, workers=given.workers, progress=count)
    accuracy = {"fitted": made.best.accuracy, "held_out": made.best.held_out}
    return {"page": str(made.page), "machine": str(made.machine), "made": made.made, "balanced_accuracy": accuracy}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
