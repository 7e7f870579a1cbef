"""The command `rubgen browse`: a whole data set in Rerun's viewer, as a table of runs to open."""

import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

from rubgen.brief import counted, in_shell
from rubgen.cli.printing import say
from rubgen.dataset.reading.browsing import Rows, rows_of
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.reading.replaying import find_replay, find_runs
from rubgen.errors import UserError
from rubgen.progress import count, step
from rubgen.viz.catalog import Catalog
from rubgen.viz.rerun import id_in, write_replay
from rubgen.viz.viewer import has_screen, start_viewer
from rubgen.viz.views import previews


def browse_command(directory: Path, where: str | None, predictions: Path | None, *, web: bool, serve: bool) -> int:
    """Serve the runs of a set from a catalog and open the viewer on its table, until it is closed or Ctrl-C.

    - where: SQL condition on the columns of runs.parquet: only the good runs that meet it; None takes all runs.
    - predictions: predictions of a model, as CSV or Parquet with a column run_id, or None.
    - web: open the viewer in the browser.
    - serve: open no viewer.

    Missing recordings are made while the viewer is open, in the order of the table, in a temporary folder. The viewer
    does not read a recording again, so rows have previews only when all recordings exist. Returns the exit code 0.
    Raises UserError for `web` with `serve`, if no run meets the condition, and if there is no screen and neither `web`
    nor `serve` is given.
    """
    if web and serve:
        raise UserError("--web and --serve: one opens a viewer and the other none; give one of them")
    if not (web or serve) and not has_screen():
        raise UserError("there is no screen for the viewer (DISPLAY is not set); give --web or --serve")
    data = DataSet(directory)
    run_ids = find_runs(data, where) if where else [str(run_id) for run_id in data.runs.index]
    if not run_ids:
        raise UserError(f"--where {where!r}: no good run meets it; see `rubgen info {in_shell(directory)}`")
    with step("read the table"):
        rows = rows_of(data, run_ids, predictions)
    with Catalog(data.manifest.name) as catalog:
        missing = _fill(catalog, data, run_ids, rows)
        say(f"{counted(len(run_ids), 'run')} at {catalog.url}")
        viewer = None if serve else start_viewer(catalog.url, web=web)
        try:
            if _make(catalog, directory, missing, viewer):
                catalog.arrange(rows.columns, previews(data.recipe.sensing.set.sampled))
                say(f"all recordings are there; for previews reload the page, or: rerun {catalog.url}")
            while viewer is None or viewer.poll() is None:
                time.sleep(0.2)
        except KeyboardInterrupt:
            pass
        finally:
            if viewer is not None and viewer.poll() is None:
                viewer.terminate()
                viewer.wait()
    return 0


def _fill(catalog: Catalog, data: DataSet, run_ids: Sequence[str], rows: Rows) -> list[str]:
    """Add rows and recordings to the catalog. Return the good runs that have no recording yet."""
    paths = {run_id: data.layout.export("rrd", run_id) for run_id in run_ids}
    with step("fill the catalog"):
        ids = {run_id: id_in(path) for run_id, path in paths.items()}
        for group, values in rows.groups.items():
            catalog.add_columns(group, {ids[run_id] or run_id: each for run_id, each in values.items()})
        catalog.add_recordings([paths[run_id] for run_id, found in ids.items() if found])
        missing = [run_id for run_id in data.ok.index if run_id in ids and not ids[run_id]]
        catalog.arrange(rows.columns, () if missing else previews(data.recipe.sensing.set.sampled))
    return missing


def _make(catalog: Catalog, directory: Path, run_ids: Sequence[str], viewer: subprocess.Popen[bytes] | None) -> bool:
    """Make these recordings and add each to the catalog, until the viewer is closed. Return whether all were made."""
    with step("make recordings", "runs"):
        for number, run_id in enumerate(run_ids):
            if viewer is not None and viewer.poll() is not None:
                return False
            path = catalog.folder / f"{run_id}.rrd"
            write_replay(find_replay(directory, run_id).replay, path, named=run_id)
            catalog.add_recordings([path])
            count(number + 1, len(run_ids))
    return bool(run_ids)
