"""`python -m validation.confusion [--every N] [--workers N]`: runs, figure, page.

Runs are kept in `out/confusion/`, so that the command goes on where it was stopped; figure and page go to `docs/`, or
with --every to `out/confusion/`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rubgen.dataset.making.workers import usable_cores
from rubgen.progress import count
from rubgen.viz.figures import save_png
from validation.command import run_command
from validation.confusion.figure import confusion_figure
from validation.confusion.page import page
from validation.confusion.runs import rubs, run_piece, scenarios
from validation.confusion.verdicts import judge
from validation.store import Store


def main(arguments: Sequence[str], folder: Path) -> int:
    """Make what is missing, judge, draw, write; paths start from `folder`."""
    parser = argparse.ArgumentParser(prog="python -m validation.confusion")
    parser.add_argument("--every", type=int, default=1, help="every how many-th speed")
    parser.add_argument("--workers", type=int, default=usable_cores(), help="number of processes")
    given = parser.parse_args(arguments)
    store = Store(folder / "out/confusion")
    target = folder / "docs" if given.every == 1 else store.root

    def work() -> None:
        with store.claimed():
            pieces = {name: run_piece(scenario) for name, scenario in scenarios(every=given.every).items()}
            store.compute(pieces.values(), given.workers, count)
            found = {name: store(piece) for name, piece in pieces.items()}
            cases = [case for name, kept in found.items() if rubs(kept) and (case := judge(name, kept)) is not None]
            save_png(confusion_figure(cases), target / "confusion.png")
            (target / "confusion.md").write_text(page(cases), encoding="utf-8")
            sys.stdout.write(f"{len(cases)} runs that rub, {sum(case.agree for case in cases)} without disagreement\n")

    return run_command("validation.confusion", store.root, work)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
