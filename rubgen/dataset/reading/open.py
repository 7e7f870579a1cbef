"""Access to a finished data set. Its files are read on demand."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cached_property
from html import escape
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import pyarrow as pa

from rubgen.arrays import FloatArray
from rubgen.brief import counted
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Manifest, read_manifest
from rubgen.dataset.reading.balance import balance_table, balance_weights
from rubgen.dataset.reading.cutting import Cut, cut_of
from rubgen.dataset.reading.folds import Fold, base_runs, folds
from rubgen.dataset.reading.recorded import PULSES, exported_signals, is_signal, parquet_signals, row_signals
from rubgen.dataset.reading.samples import Arrays, Windows, arrays, window_index, windows
from rubgen.dataset.reading.stored_run import StoredRun, stored_run
from rubgen.dataset.reading.tables import check_runs, runs_frame, touches_frame
from rubgen.dataset.rows import RunRows, asked_bytes
from rubgen.dataset.tables import SECTIONS, SIGNALS, TRUTH, SetTable
from rubgen.errors import UserError
from rubgen.io.columns import Column, Role, signal_columns
from rubgen.io.parquet.compact_records import TOUCH_COLUMNS, read_touches
from rubgen.io.parquet.read import damage_named, read_table
from rubgen.io.parquet.words import with_words
from rubgen.io.parquet.write import recipe_columns, recipe_schema
from rubgen.machine.problems import nearest
from rubgen.measurement.channel import Float32Array
from rubgen.scenario import Recipe, Sensing
from rubgen.scenario.run_id import run_id_of
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.sensor_set import SensorSet

if TYPE_CHECKING:
    import pandas as pd

MOST_SHOWN = 5
"""Number of runs of a set that a notebook shows."""


class DataSet:
    """The data set in a directory. Its files are read only when they are needed.

    `len(data)` is the number of its runs, failed runs included. A good run has the status ok. `data[run_id]` is one
    run, and iteration yields the names of the runs. The set consists of the files that its manifest lists; other files
    in the directory are ignored.
    """

    def __init__(self, directory: Path | str) -> None:
        """Read the manifest. Raises UserError where `directory` holds no finished data set."""
        self.layout = Layout(directory)
        self.manifest: Manifest = read_manifest(self.layout)

    def __reduce__(self) -> tuple[type[DataSet], tuple[Path]]:
        """Pickle the directory alone: another process opens the set again."""
        return DataSet, (self.layout.root,)

    def __len__(self) -> int:
        return self.manifest.runs

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __contains__(self, run_id: object) -> bool:
        return isinstance(run_id, str) and run_id in self._numbers

    def __getitem__(self, run_id: str) -> StoredRun:
        """Return the run called `run_id`. Raises UserError where the set has no such run."""
        return stored_run(self, self.row(run_id))

    @cached_property
    def runs(self) -> pd.DataFrame:
        """Parameters and labels of all runs, failed runs included: one row for each run, with the index `run_id`.

        `runs_frame` describes the types of the columns.
        """
        return runs_frame(self._table, self._sensing.set)

    @property
    def ok(self) -> pd.DataFrame:
        """The rows of `runs` with status ok. Only these have labels, signals and touches."""
        return self.runs[self.runs["status"] == "ok"]

    @cached_property
    def units(self) -> dict[str, str]:
        """Unit of each recorded channel by name. Clean channels (without noise) are included if the set has them."""
        columns = signal_columns(self._sensing.set, clean=self._sensing.keep_clean)
        return {column.name: column.unit for column in columns if column.kind == "signal"}

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the recorded channels. Clean channels (without noise) are included where the set has them."""
        return tuple(self.units)

    @property
    def recipe(self) -> Recipe:
        """The recipe of the set."""
        return self._recipe

    @cached_property
    def balance(self) -> pd.DataFrame:
        """The classes of `[balance]` with wanted and natural shares, candidates and weights: see `balance_table`.

        Each source of a merged set has its own rows. Raises UserError for a set without a balance.
        """
        return balance_table(self.runs, self._recipe)

    @property
    def weights(self) -> pd.Series[float]:
        """The importance weight of each run of a balanced set, by name; NaN for a failed run, for a twin its partner's.

        Raises UserError for a set without a balance.
        """
        return balance_weights(self.runs, self.balance)

    @property
    def sensors(self) -> SensorSet:
        """The sensor set of the recipe. A split may have other values of the same sensors."""
        return self._sensing.set

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the channels that a model may see: signals of real sensors, without the true contact force."""
        columns = signal_columns(self._sensing.set, clean=False)
        return tuple(x.name for x in columns if x.kind == "signal" and x.role is Role.INPUT)

    @property
    def run_columns(self) -> tuple[Column, ...]:
        """The columns of `runs`, each with name, unit, role, kind and meaning."""
        return recipe_columns(self._recipe)

    @property
    def fault_kinds(self) -> tuple[str, ...]:
        """Kinds of fault that the runs may have. The columns of the target `faults` in `arrays` have this order."""
        return self._recipe.fault_kinds

    @property
    def signal_seconds(self) -> float:
        """Length of the signals in s."""
        return self._recipe.output.signal_seconds

    @property
    def sample_rate_hz(self) -> float:
        """Samples per second of every channel."""
        return self._sensing.sample_rate_hz

    def row(self, run_id: str) -> dict[str, Any]:
        """Return a run's parameters and labels by column, classes as words. Raises UserError for an unknown run."""
        row: dict[str, Any] = self._table.slice(self._number(run_id), 1).to_pylist()[0]
        return row

    def whole_row(self, run_id: str) -> dict[str, Any]:
        """Return the values of a good run in the tables `runs`, `signals` and `truth` except channels, by column name.

        It is `row` with the event times of the signals and with the table `truth`: touches in the signals, amplitudes
        by window and more. Raises UserError where the run does not exist or failed, and where the set has no Parquet
        files with signals.
        """
        self.check_has_signals(run_id)
        row = self.row(run_id)
        for rows in (self._signals, self._truth):
            names = [field.name for field in rows.types if field.name not in row and not is_signal(field)]
            ((_, table),) = rows.each([run_id], names)
            row |= table.to_pylist()[0]
        return row

    def signals(self, run_id: str, channels: Sequence[str] | None = None) -> dict[str, Float32Array]:
        """Read the recorded channels of a run by name, each (n_samples,), read-only, in its unit of `units`.

        Sample i is at i / sample_rate_hz. `channels` are the names of the channels to read; None reads all. Raises
        UserError where the run or a channel does not exist, the run failed, a file is damaged, or the set has neither
        Parquet data nor MCAP files.
        """
        names = self.known_channels(channels)
        self.check_has_signals(run_id)
        ((_, table),) = self._recorded([run_id], names)
        return row_signals(table, 0)

    def touches(self, run_id: str) -> pd.DataFrame:
        """Read the touches of blades within the whole record of a run, one row for each touch, in order of their start.

        Columns as in `touches_frame`: `start_s` and `end_s` from the first sample (negative before it), `blade`,
        `angle_rad` on the casing, `impulse_n_s`, and the works `friction_work_j` and `normal_work_j`. Raises UserError
        where the run does not exist or failed, or the file is damaged.
        """
        self.check_has_signals(run_id)
        ((_, touches),) = self.each_touches([run_id])
        return touches

    def each_touches(self, run_ids: Sequence[str]) -> Iterator[tuple[str, pd.DataFrame]]:
        """Yield name and touches of each of these good runs, in the order of `run_ids`; columns as in `touches`."""
        for run_id, table in self._sections.each(run_ids, ["run_id", *TOUCH_COLUMNS]):
            record = read_touches(table, 0, self._sections.places[run_id].file)
            yield run_id, touches_frame(record, self._sensing, self.signal_seconds)

    def arrays(
        self,
        channels: Sequence[str] | None = None,
        target: str = "rub",
        split: str | None = None,
        *,
        runs: Sequence[str] | None = None,
        out: Path | str | None = None,
    ) -> Arrays:
        """Read whole runs for learning: `X, y, groups = data.arrays(["proximity_x"], "rub", "train")`.

        X (runs, channels, time) is float32, one row for each good run, each channel in its unit. y (runs,) are the
        answers, the values of the target: a flag as 0 or 1; a class as its number, as in
        `rubgen.labels.MOTION_CLASSES`, -1 where it is undecided or undefined; a number. An undefined flag or number is
        NaN. For the target `faults`, y is (runs, kinds), 1 where the run has the kind of `fault_kinds`. groups (runs,)
        are names from `groups_of`: runs with the same name must be on the same side of a split.

        - channels: names; None takes `inputs`, all channels that a sensor could record.
        - target: a column with one value for each run, of any role but id.
        - split: name of a split; None takes all runs.
        - runs: names of runs, as from `folds`, in place of a split.
        - out: path of a .npy file for X, mapped into memory, so that X may be larger. An existing file is overwritten.

        Raises UserError for an unknown channel, target, split or run, a failed run, split with runs, an `out` without
        .npy or its folder, and where there is no run. Warns where all runs have the same class.
        """
        return arrays(self, channels, target, split, runs, out)

    def windows(
        self,
        channels: Sequence[str] | None = None,
        *,
        seconds: float | None = None,
        turns: int | None = None,
        hop: float | None = None,
        target: str = "rub",
        split: str | None = None,
        runs: Sequence[str] | None = None,
        out: Path | str | None = None,
    ) -> Windows:
        """Cut runs into windows for learning: `X, y, groups, start, run_ids = data.windows(seconds=0.25)`.

        A window has the length `seconds`, or `turns` of the shaft between its recorded pulses, with 256 samples a turn.
        Windows start every `hop`, in the same unit; by default they do not overlap. A shorter rest is left out.
        X (windows, channels, samples) is float32. `start` (windows,) is in s from the first sample of the run.
        For the targets `rub`, `contact_duty`, `contact_impulse_per_turn_n_s` and `motion` the answer belongs to the
        window: in a window before a rub begins, `rub` is 0. `motion` is -1 where the class changes within the window.
        For every other target the answer is the run's. All windows of a run, and of its machine, are one group: put
        them on one side of a split, else the score of a model is worth nothing. All other arguments are as in `arrays`.

        Raises UserError as `arrays` does, and where no length or both are given, windows are longer than every signal,
        or the set has no once_per_rev sensor for `turns`.
        """
        cut = self.cut(seconds, turns, hop)
        return windows(window_index(self, channels, cut, target, split, runs), out)

    def cut(self, seconds: float | None, turns: int | None, hop: float | None) -> Cut:
        """Return how to cut this set into windows of `seconds`, or of `turns`, every `hop`: as for `windows`.

        Raises UserError where not exactly one length is given, a length or hop is not positive, is shorter than a
        sample or is no whole number of turns, or the set has no once_per_rev sensor for `turns`.
        """
        tacho = any(isinstance(sensor, OncePerRev) for sensor in self._sensing.set.sensors)
        return cut_of(seconds, turns, hop, self.sample_rate_hz, tacho=tacho)

    def folds(self, k: int, by: str = "machine_id", split: str | None = None) -> list[Fold]:
        """Divide the good runs into k folds: `for train, test in data.folds(5): data.arrays(runs=train)`.

        The runs with one value of the column `by` are a group; by 'run_id' a run and its twins are one. Each group is
        on the test side of exactly one fold, and never on both sides. The folds are the same each time: groups are
        assigned by size and then by name. A run without a value is left out, with a warning. `split` is the name of a
        split; None takes all runs. Raises UserError for k below 2, fewer groups than folds, an unknown split or column,
        and where `by` would put runs of one machine of several, or a run and its twin, on both sides.
        """
        return folds(self, k, by, split)

    def groups_of(self, run_ids: Sequence[str]) -> npt.NDArray[np.str_]:
        """Return the group of each run (runs,): runs of one group must be on the same side of a split.

        The group is the machine where the good runs of the set have several machines. Else it is the name of the run,
        or of the partner for a twin. Raises KeyError for an unknown run.
        """
        several = self.ok["machine_id"].nunique() > 1
        rows = self.runs.loc[list(run_ids)]
        names = rows["machine_id"] if several else base_runs(rows)
        return names.to_numpy(dtype=np.str_)

    def recorded(
        self, run_ids: Sequence[str], channels: Sequence[str] | None = None
    ) -> Iterator[tuple[str, dict[str, Float32Array], FloatArray]]:
        """Yield name, channels by name and pulse times (s from the first sample) of each of these good runs.

        The arrays are read-only. One run is in memory at a time. `channels` are names; None reads all. Raises UserError
        before the first run for an unknown channel, and at the latest at a run whose signals are missing or damaged.
        """
        names = self.known_channels(channels)
        for run_id, table in self._recorded(run_ids, names):
            yield run_id, row_signals(table, 0), np.asarray(table[PULSES][0].values, dtype=np.float64)

    def each_channel(self, name: str) -> Iterator[tuple[str, Float32Array, FloatArray]]:
        """Yield name, samples of the channel `name` and pulse times of each good run, as `recorded` does.

        One run is in memory at a time. Raises UserError, at the first run, where the set has no such channel.
        """
        for run_id, signals, pulses in self.recorded(list(self.ok.index), [name]):
            yield run_id, signals[name], pulses

    def check_has_signals(self, run_id: str) -> None:
        """Check that the run ended well, as all with signals did. Raises UserError if it failed or does not exist."""
        status, reason = (self._table[name][self._number(run_id)].as_py() for name in ("status", "reason"))
        if status != "ok":
            failed = f"{run_id} failed ({status}: {reason}) and has no signals"
            raise UserError(f"{self.layout.root}: {failed}; choose a run with status ok")

    @cached_property
    def _recipe(self) -> Recipe:
        return self.manifest.identity.recorded()

    @property
    def _sensing(self) -> Sensing:
        return self._recipe.sensing

    @cached_property
    def _table(self) -> pa.Table:
        types = recipe_schema(self._recipe, signals=False)
        table = read_table(self.layout.runs, types.names)
        with damage_named(self.layout.runs):
            table = with_words(table.cast(types))
        check_runs(table, self.manifest, self.layout.runs)
        return table

    @cached_property
    def _numbers(self) -> dict[str, int]:
        """The row of each run."""
        return {run_id: number for number, run_id in enumerate(self._table["run_id"].to_pylist())}

    @cached_property
    def _signals(self) -> RunRows:
        return self._rows(SIGNALS)

    @cached_property
    def _truth(self) -> RunRows:
        return self._rows(TRUTH)

    @cached_property
    def _sections(self) -> RunRows:
        return self._rows(SECTIONS)

    def _rows(self, table: SetTable) -> RunRows:
        files = [self.layout.root / name for name in self.manifest.listed(table.name)]
        return RunRows(files, table.schema(self._recipe), asked_bytes(self._recipe))

    def _recorded(self, run_ids: Sequence[str], names: Sequence[str]) -> Iterator[tuple[str, pa.Table]]:
        """Yield channels and pulses of each run, from Parquet where the set has it, else from files of single runs."""
        if self._signals.files:
            return parquet_signals(self._signals, self._truth, run_ids, [*names, PULSES])
        return exported_signals(self.layout, self.manifest, run_ids, names)

    def known_channels(self, channels: Sequence[str] | None) -> tuple[str, ...]:
        """Return the names in `channels`, each once; None is all. Raises UserError for any other name."""
        if isinstance(channels, str):
            raise UserError(f"channels = {channels!r}: give a list of names, [{channels!r}]")
        try:
            names = self.channels if channels is None else tuple(channels)
        except TypeError:
            raise UserError(f"channels = {channels!r:.200}: give a list of names") from None
        for name in names:
            if name not in self.channels:
                raise UserError(f"{self.layout.root}: no channel {name!r}; {nearest(str(name), list(self.channels))}")
        return tuple(dict.fromkeys(names))

    def _number(self, run_id: str) -> int:
        """Return the row of a run in the table of runs. Raises UserError where there is none."""
        if run_id not in self:
            raise UserError(f"{self.layout.root}: {self._no_such_run(run_id)}")
        return self._numbers[run_id]

    def _no_such_run(self, run_id: object) -> str:
        digits = re.sub(r"[^0-9]", "", str(run_id))[:9]
        meant = run_id_of(int(digits)) if digits else ""
        hint = f"did you mean {meant}? " if meant in self else ""
        return f"no run {run_id!r}; {hint}give one of {', '.join(islice(self, 3))}{', ...' if len(self) > 3 else ''}"

    def __repr__(self) -> str:
        status = ", ".join(f"{count} {name}" for name, count in self.manifest.status.items())
        return (
            f"Data set {self.manifest.name!r} in {self.layout.root}: {counted(len(self), 'run')} ({status}), "
            f"{counted(len(self.channels), 'channel')} at {self.sample_rate_hz:g} Hz"
        )

    def _repr_html_(self) -> str:
        from rubgen.viz.figures.data_set import varied_keys

        shown = [*(varied_keys(self.runs) or ["speed_rpm"]), "rub", "motion", "contact_impulse_per_turn_n_s", "status"]
        table: str = self.runs[shown].head(MOST_SHOWN).to_html()
        return f"<p>{escape(repr(self))}</p>{table}"
