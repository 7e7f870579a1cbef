"""`python -m validation.confusion [--every N] [--workers N] [--out DIR]`: runs, figure, page.

Runs are kept in `out/confusion/`, so that the command goes on where it was stopped; figure and page go to `docs/`, or
with --every to `out/confusion/`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rubgen.viz.figures import save_png
from validation.confusion.figure import confusion_figure
from validation.confusion.page import page
from validation.confusion.runs import kept_runs, make_missing, scenarios
from validation.confusion.verdicts import judge


def main(arguments: Sequence[str], folder: Path) -> int:
    """Make what is missing, judge, draw, write; paths start from `folder`."""
    parser = argparse.ArgumentParser(prog="python -m validation.confusion")
    parser.add_argument("--every", type=int, default=1, help="every how many-th speed")
    parser.add_argument("--workers", type=int, default=2, help="number of processes")
    given = parser.parse_args(arguments)
    runs = folder / "out/confusion"
    target = folder / "docs" if given.every == 1 else runs
    asked = scenarios(every=given.every)
    for done in make_missing(runs, asked, given.workers):
        sys.stdout.write(f"{done} of {len(asked)} runs\n")
        sys.stdout.flush()
    cases = [case for name, kept in kept_runs(runs, asked) if (case := judge(name, kept)) is not None]
    save_png(confusion_figure(cases), target / "confusion.png")
    (target / "confusion.md").write_text(page(cases), encoding="utf-8")
    sys.stdout.write(f"{len(cases)} runs that rub, {sum(case.agree for case in cases)} without disagreement\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
