"""`rubgen reproduce`: progress, the page, what the verdicts are."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from rubgen.cli.generating import shown_progress, terminable
from rubgen.cli.printing import print_json, say
from rubgen.errors import UserError
from rubgen.studies.zeng2019 import reproduce

PAPERS = ("zeng2019",)


def reproduce_command(
    paper: str, figure: str | None, out: Path | None, workers: int | None, *, quick: bool, as_json: bool
) -> int:
    """Compute, judge, write; a Ctrl-C says how to go on."""
    if paper not in PAPERS:
        raise UserError(f"{paper}: unknown paper; choose from {', '.join(PAPERS)}")
    if workers is not None and workers < 1:
        raise UserError(f"--workers {workers}: must be at least 1; give a number of processes")
    folder = out or Path("out") / (f"{paper}-quick" if quick else paper)
    console = Console(stderr=True, quiet=as_json)
    try:
        with terminable(), shown_progress(console, "pieces") as progress:
            made = reproduce(folder, figure=figure, quick=quick, workers=workers, progress=progress)
    except KeyboardInterrupt:
        Console(stderr=True, soft_wrap=True).print(
            f"rubgen: interrupted; finished pieces are kept in {folder}: the same command makes the rest",
            highlight=False,
        )
        return 130
    if as_json:
        print_json({"page": str(made.page), "made": made.made, "verdicts": made.verdicts})
    else:
        say(f"{made.page}: {', '.join(f'{count} {verdict}' for verdict, count in made.verdicts.items())}")
        say(f"  {made.page.with_suffix('.html')}: the same in one file; statements.json beside it")
    return 0
