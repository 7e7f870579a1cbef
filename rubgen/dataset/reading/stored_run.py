"""One run of a data set on disk, read from its files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from rubgen.brief import html_table, number, table
from rubgen.measurement.channel import Float32Array
from rubgen.scenario.vary import KEYS

if TYPE_CHECKING:
    import pandas as pd

    from rubgen.dataset.reading.open import DataSet

SHOWN = ("rub", "motion", "contact_duty", "contact_impulse_per_turn_n_s", "blades_touched", "contact_zones", "whirl")
"""Labels in the short form of a run."""


@dataclass(frozen=True, kw_only=True)
class StoredRun:
    """A run of a data set: parameters and labels as plain values, classes as words. Signals are read on demand."""

    run_id: str
    status: str
    reason: str
    parameters: dict[str, Any]
    """The keys of `[vary]`."""
    labels: dict[str, Any]
    """What else `runs.parquet` says of the run; a label is None where the run failed or it is undefined."""
    data: DataSet = field(repr=False)

    def signals(self, channels: Sequence[str] | None = None) -> dict[str, Float32Array]:
        """Read the recorded channels by name, each (n_samples,), read-only, in its unit of `data.units`.

        `channels` are the names of the channels to read; None reads all. Raises UserError where the run failed, a
        channel does not exist, a file is damaged, or the set has no files with signals.
        """
        return self.data.signals(self.run_id, channels)

    def touches(self) -> pd.DataFrame:
        """Read the touches of blades within the whole record, as `DataSet.touches` does: one row for each touch.

        Raises UserError where the run failed or the file is damaged.
        """
        return self.data.touches(self.run_id)

    def __repr__(self) -> str:
        return table(f"{self.run_id} of {self.data.layout.root}", self._shown())

    def _repr_html_(self) -> str:
        return html_table(self.run_id, self._shown())

    def _shown(self) -> dict[str, str]:
        if self.status != "ok":
            return {"status": f"{self.status}: {self.reason}"}
        speed = self.parameters["speed_rpm"]
        return {"speed_rpm": f"{speed:,.6g}", **{name: number(self.labels.get(name)) for name in SHOWN}}


def stored_run(data: DataSet, row: dict[str, Any]) -> StoredRun:
    """Return the run of one row of `runs.parquet`. `row` is from `DataSet.row`."""
    own = ("run_id", "status", "reason", *KEYS)
    return StoredRun(
        run_id=row["run_id"],
        status=row["status"],
        reason=row["reason"],
        parameters={key: row[key] for key in KEYS},
        labels={name: value for name, value in row.items() if name not in own},
        data=data,
    )
