"""Declare the commands for learning from a data set."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from rubgen.cli.options import Force, Json, Place, here, option, whole_number


def features(
    directory: Place,
    /,
    *,
    out: Annotated[Path, here("File to write: .parquet.")],
    window: Annotated[str | None, option("Length such as 0.25s or 16turns; the whole signal when not given.")] = None,
    channels: Annotated[str | None, option("Names with commas; all that a probe can measure when not given.")] = None,
    set_: Annotated[
        str | None,
        Parameter(name="--set", help="time, order, envelope, orbit, tsfel, with commas; all but tsfel when not given."),
    ] = None,
    workers: Annotated[int | None, whole_number("Number of processes; the number of cores when not given.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Compute features of the recorded channels and pulses, one row a window; the table has no labels."""
    from rubgen.cli.commands.featuring import features_command

    return features_command(directory, out, window, channels, set_, workers, force=force, as_json=json)


def baseline(
    directory: Place,
    /,
    *,
    task: Annotated[
        str | None,
        option("rub, severity, motion, zones, where, faults, onset, with commas; all possible when not given."),
    ] = None,
    out: Annotated[Path | None, here("File for the scores: .json.")] = None,
    force: Force = False,
    json: Json = False,
) -> int:
    """Score simple models on a data set, by machine or run.

    Exit 1 if one threshold solves a task, or if no model learns one.
    """
    from rubgen.cli.commands.scoring import baseline_command

    return baseline_command(directory, task, out, force=force, as_json=json)


def export(
    directory: Place,
    /,
    *,
    format_: Annotated[
        str,
        Parameter(
            name="--format",
            help="uff58, mat, hdf5, csv, wav, ts, webdataset, or parquet, which has no labels, no parameters, and only "
            "channels that a probe measures.",
        ),
    ],
    out: Annotated[Path, here("New or empty folder, or one of the same export, which is then completed.")],
    split: Annotated[str | None, option("Only this split; all when not given.")] = None,
    channels: Annotated[
        str | None, option("Names with commas; all recorded channels but clean ones when not given.")
    ] = None,
    json: Json = False,
) -> int:
    """Write the good runs of a data set in a format of other programs; all but parquet have parameters and labels."""
    from rubgen.cli.commands.exporting import export_command

    return export_command(directory, out, format_, split, channels, as_json=json)
