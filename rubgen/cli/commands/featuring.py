"""The command `rubgen features`: a table of features from the recorded channels of a data set."""

from __future__ import annotations

from pathlib import Path

from rubgen.brief import counted
from rubgen.cli.interrupts import terminable
from rubgen.cli.options import names_in
from rubgen.cli.printing import check_new_file, print_json, say
from rubgen.dataset.making.workers import usable_cores
from rubgen.errors import UserError, write_problems
from rubgen.features.write import write_features
from rubgen.progress import step


def features_command(
    directory: Path,
    out: Path,
    window: str | None,
    channels: str | None,
    sets: str | None,
    workers: int | None,
    *,
    force: bool,
    as_json: bool,
) -> int:
    """Write the table of features to `out` and print what it contains. Returns the exit code 0.

    `channels` and `sets` are names with commas between them, or None. `workers` None is one process for each core. The
    other parameters are as in `write_features`. With `force` an existing `out` is replaced. With `as_json` the summary
    is JSON.
    """
    check_new_file("--out", out, (".parquet",), force=force)
    if workers is not None and workers < 1:
        raise UserError(f"--workers {workers}: must be at least 1")
    with step("features", "windows"), terminable(), write_problems(out, named=f"--out {out}"):
        made = write_features(
            directory,
            out,
            window=window,
            channels=names_in("--channels", channels),
            sets=names_in("--set", sets),
            workers=workers or usable_cores(),
        )
    if as_json:
        print_json({"out": str(out), **vars(made)})
    else:
        kinds = ", ".join(made.sets)
        say(f"{out}: {counted(made.windows, 'window')} of {counted(made.runs, 'run')}")
        say(f"  {made.columns} features ({kinds}) of {counted(len(made.channels), 'channel')}")
        say("  the metadata of each column has its unit and its definition")
    return 0
