"""A run as a file, as a figure and in the viewer: the work of `Run.save`, `Run.plot` and `Run.replay`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from rubgen.errors import UserError, write_problems
from rubgen.format_names import ENDINGS, FORMAT_NAMES
from rubgen.formats import format_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Figure

    from rubgen.pipeline import Run

Write = Callable[["Run", Path], None]


def save(run: Run, path: Path, *, named: str = "") -> None:
    """Write a run to a file in the format of its ending: .parquet, .mcap or .rrd. A Parquet file has one row.

    An existing file is replaced. The file is complete or not written at all. `named` is its name in messages; the path
    if empty. Raises UserError for a failed run, an unknown ending, a folder that does not exist, and a file that cannot
    be written.
    """
    named = named or str(path)
    write = writer_of(path, named)
    _check_good(run, "save")
    with write_problems(path, named=named):
        write(run, path)


def writer_of(path: Path, named: str) -> Write:
    """Return the function that writes one run to a file with the ending of `path`. Nothing is written here.

    `named` is the file's name in messages. Raises UserError where the ending is unknown or the folder does not exist.
    """
    if not path.parent.is_dir():
        raise UserError(f"{named}: there is no directory {path.parent}; make it first")
    if path.suffix.removeprefix(".") not in FORMAT_NAMES:
        raise UserError(f"{named}: unknown kind of file; end the name in {ENDINGS}")
    return format_of(path.suffix.removeprefix(".")).write


def plot(run: Run) -> Figure:
    """Draw a run in four panels: orbit with Poincare section, a recorded channel, contact by angle, orders.

    The channel is `casing_acc_0`, or the first of a sensor set without it. The orders belong to the contact force.
    Raises UserError for a failed run.
    """
    from rubgen.viz.figures import overview

    _check_good(run, "plot")
    return overview(run)


def replay(run: Run, *, web: bool = False) -> None:
    """Show a run in Rerun's viewer and return when the viewer is closed.

    With `web` the viewer is a page in the browser, served to this computer alone until Ctrl-C. Raises UserError for a
    failed run, without `web` where there is no screen, and where the viewer cannot be started or ends with an error.
    """
    from rubgen.viz.replay import replay_of
    from rubgen.viz.viewer import has_screen, open_viewer

    _check_good(run, "replay")
    if not web and not has_screen():
        raise UserError('there is no screen for the viewer (DISPLAY is not set); use save("run.rrd") or web=True')
    open_viewer(replay_of(run), web=web)


def _check_good(run: Run, what: str) -> None:
    if run.recording is None:
        status = f"{run.response.status.code}: {run.response.reason}"
        raise UserError(f"{run.scenario.run_id} failed ({status}); there is nothing to {what}")
