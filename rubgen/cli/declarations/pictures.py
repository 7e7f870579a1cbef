"""Declare the commands that show a data set, a run or a machine."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rubgen.cli.options import Directory, Force, here, option


def figure(
    name: Annotated[
        str,
        option(
            "Of a machine campbell, critical, unbalance, modes; of a run orbit, contact, waveform, waterfall, bode; "
            "of a data set bifurcation, cascade, exponent, overview."
        ),
    ],
    source: Annotated[Path | None, here("A machine, a data set's directory, or for one run an MCAP file.")] = None,
    run: Annotated[str | None, option("Name of a run of the data set.")] = None,
    /,
    *,
    out: Annotated[Path, here("File to write: .png, .svg or .pdf.")],
    where: Annotated[str | None, option("The first run that meets this condition.")] = None,
    over: Annotated[str | None, option("Parameter of a sweep; the first that varies when not given.")] = None,
    channel: Annotated[str | None, option("Recorded channel to draw.")] = None,
    speeds_rpm: Annotated[
        str | None,
        option("Range LOW:HIGH of the speed in rev/min; of campbell, critical, unbalance, waterfall and bode."),
    ] = None,
    frequencies_hz: Annotated[str | None, option("Range LOW:HIGH of the frequency in Hz; of campbell.")] = None,
    modes: Annotated[
        str | None,
        option("Modes to draw, with commas, as rubgen modes lists them: 7, casing 3, blade 1, ND 2, blade 1 ND 2."),
    ] = None,
    force: Force = False,
) -> int:
    """Draw a figure of a machine, a run or a data set."""
    from rubgen.cli.commands.drawing import figure_command
    from rubgen.report.figures import Choice

    choice = Choice(
        run_id=run, where=where, parameter=over, channel=channel, speeds_rpm=speeds_rpm,
        frequencies_hz=frequencies_hz, modes=modes,
    )  # fmt: skip
    return figure_command(name, source, out, choice, force=force)


def report(
    directory: Directory,
    /,
    *,
    out: Annotated[Path | None, here("File to write; DIR/report.html when not given.")] = None,
    force: Force = False,
) -> int:
    """Write one page that shows a data set: classes, coverage, failures, examples, channels, how to load it."""
    from rubgen.cli.commands.drawing import report_command

    return report_command(directory, out, force=force)


def browse(
    directory: Directory,
    /,
    *,
    where: Annotated[
        str | None, option("Only the good runs that meet this condition on the columns of runs.parquet.")
    ] = None,
    predictions: Annotated[
        Path | None, here("Answers of a model: .csv or .parquet with the column run_id, shown beside the truth.")
    ] = None,
    web: Annotated[bool, Parameter(negative=(), help="Open it in the browser, on this machine alone.")] = False,
    serve: Annotated[bool, Parameter(negative=(), help="Open no viewer; print the address and serve it.")] = False,
) -> int:
    """Show a whole data set in Rerun: a table of its runs with parameters and labels, from which each run opens."""
    from rubgen.cli.commands.browsing import browse_command

    return browse_command(directory, where, predictions, web=web, serve=serve)
