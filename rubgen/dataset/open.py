"""A finished data set, read when it is asked for."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyarrow as pa

from rubgen.arrays import FloatArray
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Manifest, read_manifest
from rubgen.errors import UserError
from rubgen.io.columns import signal_columns
from rubgen.io.parquet import open_parquet, read_table
from rubgen.sensors.channel import Float32Array

if TYPE_CHECKING:
    import pandas as pd


class DataSet:
    """The data set in a directory: `runs` is read once, signals one row group at a time."""

    def __init__(self, directory: Path) -> None:
        """Raise UserError where `directory` holds no finished data set; read the manifest alone."""
        self.layout = Layout(directory)
        self.manifest: Manifest = read_manifest(self.layout)

    @cached_property
    def runs(self) -> pd.DataFrame:
        """One row a run, failed ones too: parameters and labels, by `run_id`."""
        frame: pd.DataFrame = read_table(self.layout.runs).to_pandas()
        return frame.set_index("run_id", drop=False)

    @cached_property
    def units(self) -> dict[str, str]:
        """The unit of each recorded channel by its name, of the clean ones too where the set keeps them."""
        sensing = self.manifest.identity.recorded().sensing
        columns = signal_columns(sensing.set, clean=sensing.keep_clean)
        return {column.name: column.unit for column in columns if column.kind == "signal"}

    def row(self, run_id: str) -> dict[str, Any]:
        """One run's parameters and labels by column."""
        return {str(key): value for key, value in self.runs.loc[run_id].to_dict().items()}

    def signals(self, run_id: str) -> dict[str, Float32Array]:
        """The recorded channels of a run, each (n_samples,) in its column's unit, sample i at i / sample_rate_hz.

        Raises UserError where there is no such run, it failed, or the set has neither Parquet data nor MCAP files.
        """
        if run_id in self._places:
            return self._signals_from_parquet(run_id)
        path = self.layout.export("mcap", run_id)
        if path.exists():
            from rubgen.io.mcap import read_mcap

            run = read_mcap(path)
            return run.signals | {f"{name}_clean": values for name, values in run.clean.items()}
        raise UserError(f"{self.layout.root}: {self._why_no_signals(run_id)}")

    def each_channel(self, name: str) -> Iterator[tuple[str, Float32Array, FloatArray]]:
        """Name of the run, samples of one channel and arrival times (s) of the pulses, run by run.

        Only what is asked for is read. Raises UserError where that channel was not recorded.
        """
        if not self._places:
            yield from self._each_from_mcap(name)
        for path in self.layout.shards():
            with open_parquet(path) as file:
                names = [field.name for field in file.schema_arrow if is_signal(field)]
                if name not in names:
                    raise UserError(f"{self.layout.root}: no channel {name!r}; give one of {', '.join(names)}")
                for group in range(file.num_row_groups):
                    table = file.read_row_group(group, columns=["run_id", name, "once_per_rev_s"])
                    for row, run_id in enumerate(table["run_id"].to_pylist()):
                        pulses = np.asarray(table["once_per_rev_s"][row].values, dtype=np.float64)
                        yield run_id, np.asarray(table[name][row].values, dtype=np.float32), pulses

    def _each_from_mcap(self, name: str) -> Iterator[tuple[str, Float32Array, FloatArray]]:
        from rubgen.io.mcap import read_mcap

        good = self.runs.index[self.runs["status"] == "ok"]
        if not self.layout.export("mcap", str(good[0])).exists():
            raise UserError(f"{self.layout.root}: {self._why_no_signals(str(good[0]))}")
        for run_id in good:
            run = read_mcap(self.layout.export("mcap", run_id))
            if name not in run.signals:
                raise UserError(f"{self.layout.root}: no channel {name!r}; give one of {', '.join(run.signals)}")
            yield run_id, run.signals[name], run.once_per_rev

    def check_has_signals(self, run_id: str) -> None:
        """Raise UserError where there is no such run, or it failed."""
        if run_id not in self.runs.index or self.runs.loc[run_id, "status"] != "ok":
            raise UserError(f"{self.layout.root}: {self._why_no_signals(run_id)}")

    @cached_property
    def _places(self) -> dict[str, tuple[Path, int, int]]:
        """File, row group and row of every run with signals."""
        places: dict[str, tuple[Path, int, int]] = {}
        for path in self.layout.shards():
            with open_parquet(path) as file:
                for group in range(file.num_row_groups):
                    names = file.read_row_group(group, columns=["run_id"])["run_id"].to_pylist()
                    places |= {name: (path, group, row) for row, name in enumerate(names)}
        return places

    def _signals_from_parquet(self, run_id: str) -> dict[str, Float32Array]:
        path, group, row = self._places[run_id]
        with open_parquet(path) as file:
            names = [field.name for field in file.schema_arrow if is_signal(field)]
            table = file.read_row_group(group, columns=names)
        return row_signals(table, row)

    def _why_no_signals(self, run_id: str) -> str:
        if run_id not in self.runs.index:
            return f"no run {run_id!r}; give one of runs.run_id, like {self.runs.index[0]!r}"
        status, reason = self.runs.loc[run_id, ["status", "reason"]]
        if status != "ok":
            return f"{run_id} failed ({status}: {reason}) and has no signals; choose a run with status ok"
        return "has no files with signals; generate it with formats parquet or mcap"


def is_signal(field: Any) -> bool:
    """Whether this Arrow field holds a recorded channel."""
    return bool(pa.types.is_list(field.type) and field.type.value_type == pa.float32())


def row_signals(table: pa.Table, row: int) -> dict[str, Float32Array]:
    """The channels of one row of a data table."""
    names = [field.name for field in table.schema if is_signal(field)]
    return {name: np.asarray(table[name][row].values, dtype=np.float32) for name in names}
