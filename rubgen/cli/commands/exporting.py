"""The command `rubgen export`: a data set in the file format of other programs."""

from __future__ import annotations

from pathlib import Path

from rubgen.brief import counted
from rubgen.cli.interrupts import terminable
from rubgen.cli.options import names_in
from rubgen.cli.printing import print_json, say
from rubgen.errors import write_problems
from rubgen.export.formats import FORMATS
from rubgen.export.write import export
from rubgen.progress import step


def export_command(
    directory: Path, out: Path, name: str, split: str | None, channels: str | None, *, as_json: bool
) -> int:
    """Write the data set in the format `name` to the folder `out` and print what it contains. Returns the exit code 0.

    `channels` are names with commas between them; None takes all but the clean ones. `directory`, `out`, `name` and
    `split` are as in `export`. With `as_json` the summary is JSON.
    """
    with step("export", "files"), terminable(), write_problems(out, named=f"--out {out}", kept="files so far are kept"):
        made = export(directory, out, name, split=split, channels=names_in("--channels", channels))
    if as_json:
        print_json({"out": str(out), **vars(made)})
    else:
        say(f"{out}: {counted(made.runs, 'run')} in {counted(made.files, 'file')} of {name}, {', '.join(made.splits)}")
        labels = ", runs.csv parameters and labels" if FORMATS[name].answers else "; no file has a label or parameter"
        say(f"  channels.csv has the sensors{labels}")
    return 0
