"""`rubgen reproduce`: progress, the page, what the verdicts are."""

from __future__ import annotations

import sys
from pathlib import Path

from rubgen.cli.generating import terminable
from rubgen.cli.printing import print_json, print_pairs
from rubgen.errors import UserError
from rubgen.progress import count, shown, step
from rubgen.studies.zeng2019 import fit, reproduce
from rubgen.studies.zeng2019.computing import Progress

PAPERS = ("zeng2019",)


def reproduce_command(
    paper: str,
    figure: str | None,
    out: Path | None,
    workers: int | None,
    every: int,
    machine: str,
    *,
    quick: bool,
    fitting: bool,
    as_json: bool,
) -> int:
    """Compute, judge, write, or search; a Ctrl-C says how to go on."""
    _check(paper, figure, workers, every, machine, fitting=fitting)
    folder = out or Path("out") / (f"{machine}-quick" if quick else machine)
    try:
        with terminable(), shown(not as_json), step("simulate", "pieces"):
            if fitting:
                result = _fit(folder, quick, workers, count)
            else:
                result = _reproduce(folder, figure, machine, workers, count, quick=quick, every=every)
    except KeyboardInterrupt:
        sys.stderr.write(
            f"rubgen: interrupted; finished pieces are kept in {folder}: the same command makes the rest\n"
        )
        return 130
    if as_json:
        print_json(result)
    else:
        print_pairs(result)
    return 0


def _check(paper: str, figure: str | None, workers: int | None, every: int, machine: str, *, fitting: bool) -> None:
    if paper not in PAPERS:
        raise UserError(f"{paper}: unknown paper; choose from {', '.join(PAPERS)}")
    if workers is not None and workers < 1:
        raise UserError(f"--workers {workers}: must be at least 1; give a number of processes")
    if every < 1:
        raise UserError(f"--every {every}: must be at least 1; 4 gives steps of 120 rev/min")
    if fitting and figure is not None:
        raise UserError(f"--fit --figure {figure}: the search is one whole; leave --figure out")
    if fitting and machine != paper:
        raise UserError(
            f"--fit --machine {machine}: the search starts from the paper's own preset; leave --machine out"
        )


def _reproduce(
    folder: Path, figure: str | None, machine: str, workers: int | None, progress: Progress, *, quick: bool, every: int
) -> dict[str, object]:
    made = reproduce(
        folder, figure=figure, quick=quick, every=every, machine=machine, workers=workers, progress=progress
    )
    html = made.page.with_suffix(".html")
    return {"page": str(made.page), "html": str(html), "made": made.made, "verdicts": made.verdicts}


def _fit(folder: Path, quick: bool, workers: int | None, progress: Progress) -> dict[str, object]:
    made = fit(folder, quick=quick, workers=workers, progress=progress)
    counts = {"fitted": made.best.fitted, "predicted": made.best.predicted}
    return {"page": str(made.page), "machine": str(made.machine), "made": made.made, "words_borne_out": counts}
