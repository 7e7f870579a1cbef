"""`rubgen figure` and `rubgen report`: pictures and the page of a data set."""

from __future__ import annotations

from pathlib import Path

from rubgen.cli.printing import say
from rubgen.cli.replaying import check_new_file
from rubgen.errors import UserError
from rubgen.studies.figures import Choice, make_figure

ENDINGS = (".png", ".svg", ".pdf")


def figure_command(name: str, source: Path | None, out: Path, choice: Choice) -> int:
    """Draw and write."""
    from rubgen.viz.figures import save_figure

    check_new_file("--out", out, ENDINGS)
    figure = make_figure(name, source, choice)
    try:
        save_figure(figure, out)
    except OSError as error:
        raise UserError(f"--out {out}: cannot be written ({error.strerror or error}); choose another place") from None
    say(str(out))
    return 0


def report_command(directory: Path, out: Path | None) -> int:
    """Write the page."""
    from rubgen.studies.report import write_report

    path = out or directory / "report.html"
    check_new_file("--out", path, (".html",))
    write_report(directory, path)
    say(f"{path}: open it in any browser")
    return 0
