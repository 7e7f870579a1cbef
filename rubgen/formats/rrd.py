"""Rerun recordings (.rrd): a view of one run, which can be made again. Its bytes differ each time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rubgen.formats.format import Format
from rubgen.io.files import write_durably

if TYPE_CHECKING:
    from rubgen.pipeline import Run
    from rubgen.viz.replay import Replay


def _write(run: Run, path: Path) -> None:
    from rubgen.viz.rerun import write_rrd

    write_durably(path, lambda part: write_rrd(run, part))


def _remake(replay: Replay, path: Path) -> None:
    from rubgen.viz.rerun import write_replay

    write_durably(path, lambda part: write_replay(replay, part))


def _problems(path: Path, run_id: str, proven: bool) -> list[str]:
    """Return the problems of the file. A file with the recorded digest was written by rubgen and is safe to read."""
    from rubgen.viz.rerun import check_rrd, content_problems

    return content_problems(path, run_id) if proven else check_rrd(path, run_id)


FORMAT = Format(
    name="rrd",
    about="for the Rerun viewer",
    loading="""\
`rrd/0000/<run_id>.rrd`: the same run to look at, `rerun rrd/0000/run-000000.rrd`. A derived view, whose
bytes differ from writing to writing: their sha256 stands in `derived.json`, not in the manifest.""",
    look="see a run:      {rerun} {first}",
    write=_write,
    problems=_problems,
    remake=_remake,
)
