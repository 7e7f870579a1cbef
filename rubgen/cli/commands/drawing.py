"""The commands `rubgen figure` and `rubgen report`: pictures, and the page of a data set."""

from pathlib import Path

from rubgen.cli.printing import REPORT, check_new_file, say, write_file
from rubgen.progress import step
from rubgen.report.figures import Choice, make_figure

ENDINGS = (".png", ".svg", ".pdf")


def figure_command(name: str, source: Path | None, out: Path, choice: Choice, *, force: bool) -> int:
    """Draw the figure called `name` and write it to `out`. Returns the exit code 0.

    `source` and `choice` are as in `make_figure`. `out` ends in .png, .svg or .pdf. With `force` an existing file is
    replaced. Raises UserError as `make_figure` and `check_new_file` do.
    """
    from rubgen.viz.figures import save_figure

    check_new_file("--out", out, ENDINGS, force=force)
    with step(f"draw {name}"):
        figure = make_figure(name, source, choice)
        write_file("--out", out, lambda part: save_figure(figure, part))
    say(str(out))
    return 0


def report_command(directory: Path, out: Path | None, *, force: bool) -> int:
    """Write the page of the data set in `directory` to `out`, for None to its report.html. Returns the exit code 0.

    With `force` an existing file is replaced. Raises UserError as `write_report` and `check_new_file` do.
    """
    from rubgen.report.page import write_report

    path = out or directory / REPORT
    if directory.is_dir():
        check_new_file("--out", path, (".html",), force=force)
    with step("draw the page", "examples"):
        write_report(directory, path)
    say(f"{path}: open it in any browser")
    return 0
