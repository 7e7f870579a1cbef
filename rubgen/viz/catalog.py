"""Serve the recordings of many runs from Rerun's own catalog, with a table of properties of each run.

A recording is a segment of a dataset in this catalog. The properties of a run are stored in layers beside its
recording, a few properties in each. A property is a column of the table. Files stay where they are.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import pyarrow as pa

from rubgen.errors import UserError
from rubgen.viz.entities.signals import TIMELINE
from rubgen.viz.rerun import APPLICATION
from rubgen.viz.viewer import HOST

if TYPE_CHECKING:
    from rerun.blueprint import View
    from rerun.catalog import DatasetEntry

Values = Mapping[str, Any]
"""Flags, numbers and texts of one run by name. A missing name is an empty cell."""
RECORDING = "base"
"""Layer of the recordings themselves."""
LINK, SEGMENT = "recording link", "rerun_segment_id"
"""Columns of every such table: what opens a recording, and its id."""
SHOWN = "property:{}:{}"
"""How Rerun calls the column of a property, by its group and name."""


@dataclass(frozen=True)
class _Cell:
    """A value as Rerun takes it, with its own type: `rr.AnyValues` gives all columns of one name the same type."""

    value: object

    def as_arrow_array(self) -> pa.Array:
        return pa.array([self.value])


class Catalog:
    """A catalog on this computer only, as a context.

    At its end the server stops and `folder` is deleted with its files.
    """

    def __init__(self, name: str) -> None:
        """Begin a catalog with one dataset called `name`. Raises UserError without the package datafusion."""
        if find_spec("datafusion") is None:
            raise UserError("Rerun's catalog needs the package datafusion; pip install 'rubgen[browse]'")
        from rerun.server import Server

        self._folder = tempfile.TemporaryDirectory(prefix="rubgen-")
        self.folder = Path(self._folder.name)
        self._server = Server(host=HOST)
        self._client = self._server.client()
        self.dataset: DatasetEntry = self._client.create_dataset(name)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.shutdown()
        self._folder.cleanup()

    @property
    def url(self) -> str:
        """Address of the table, for viewers on this computer."""
        return f"{self._server.url()}/entry/{self.dataset.id}"

    def add_recordings(self, paths: Sequence[Path]) -> None:
        """Add the recordings in the files at `paths`. Nothing is done without paths."""
        if paths:
            self.dataset.register([path.absolute().as_uri() for path in paths], layer_name=RECORDING).wait()

    def add_columns(self, group: str, rows: Mapping[str, Values]) -> None:
        """Add columns `property:<group>:<name>` to the table.

        `rows` are the values of each run, by its recording's id. Call it once for each group.
        """
        import rerun as rr

        places = []
        for number, (segment, values) in enumerate(rows.items()):
            stream = rr.RecordingStream(APPLICATION, recording_id=segment, send_properties=False)
            memory = stream.memory_recording()
            cells = [
                rr.DescribedComponentBatch(_Cell(value), rr.ComponentDescriptor(name)) for name, value in values.items()
            ]
            stream.send_property(group, cells)
            path = self.folder / f"{group}-{number}.rrd"
            path.write_bytes(memory.drain_as_bytes())
            stream.disconnect()
            places.append(path.as_uri())
        if places:
            self.dataset.register(places, layer_name=group).wait()

    def arrange(self, columns: Sequence[tuple[str, str]], previews: Sequence[View] = ()) -> None:
        """Show the column that opens a recording, then some columns in this order. The rows are sorted by id.

        Recordings may be added before or later.

        - columns: the group and the name of each column, as in `add_columns`. Its heading is both; of the group `run`
          only the name.
        - previews: views of its recording that each row shows.
        """
        from rerun.blueprint.table import Column, PreviewCell, PreviewsConfig, TableBlueprint, TableLayout

        shown = [Column(SHOWN.format(group, name), name=name if group == "run" else f"{group} {name}")
                 for group, name in columns]  # fmt: skip
        link = Column(LINK, name="open", column_type=PreviewCell(*previews) if previews else None)
        layout = TableLayout(columns=[link, *shown, Column(SEGMENT, visible=False)])
        path = self.folder / f"table-{len(previews)}.rbl"
        TableBlueprint(table_layout=layout, sort_by=SEGMENT, previews_config=PreviewsConfig(timeline=TIMELINE)).save(
            APPLICATION, path
        )
        self.dataset.register_blueprint(path.as_uri(), segment_table=True)
