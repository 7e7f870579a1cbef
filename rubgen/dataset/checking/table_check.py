"""Checks of a set's Parquet files: readable to the last page, and consistent with each other and the manifest."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import pyarrow as pa

from rubgen.dataset.checking.channel_check import Row
from rubgen.dataset.checking.consistency import label_problems, signal_problems
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Manifest
from rubgen.dataset.reading.recorded import is_signal, row_signals
from rubgen.dataset.rows import RunTable, asked_bytes
from rubgen.dataset.shards import Shard, shards_of
from rubgen.dataset.tables import RUNS, SIGNALS, TABLES, TRUTH, WINDOWS, SetTable, tables_of
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.io.parquet.read import NO_PARQUET, ParquetSource
from rubgen.io.parquet.words import with_words
from rubgen.labels import MOTION_CLASSES
from rubgen.scenario import Recipe, Sensing
from rubgen.scenario.run_id import run_id_of

MOST_NAMED = 4
"""Number of runs or columns that a line lists one by one."""
OF_WINDOW = {
    "rub": "window_rub",
    "contact_duty": "window_contact_duty",
    "contact_impulse_per_turn_n_s": "window_impulse_per_turn_n_s",
    "motion": "window_motion_classes",
    "motion_confidence": "window_motion_confidence",
}
"""Columns of `windows`, with the list of `runs` that each is an entry of."""
UNCOMPARABLE = (TypeError, ValueError, LookupError, AttributeError, ArithmeticError)
"""Errors from comparing values of a wrong type or number."""


def table_problems(
    layout: Layout, manifest: Manifest, closed: set[str], chosen: Callable[[Shard], bool]
) -> Iterator[str]:
    """Read the Parquet files of a data set, shard by shard, and yield their problems, one sentence each.

    The files are `runs.parquet` and the files of the tables. Labels are compared with each other and with the channels.
    The rows of one shard are in memory.

    - layout: the paths of the set.
    - manifest: its manifest.
    - closed: paths of files that must not be opened; nothing is reported for them.
    - chosen: returns whether the content of a shard is checked. `runs.parquet` is always read.
    """
    recorded = manifest.identity.recorded(str(layout.manifest))
    runs: RunTable | None = None
    if layout.runs.name not in closed:
        yield from _run_problems(layout, manifest, recorded)
        with suppress(UserError):  # which the lines above name
            runs = RunTable(layout.runs)
    listed = {entry.path for entry in manifest.files} | set(manifest.derived)
    expected: set[str] = set()
    for shard in shards_of(recorded):
        names = {table.name: _file_name(table, shard) for table in tables_of(recorded.output.formats)}
        expected |= set(names.values())
        if chosen(shard):
            yield from (f"{name}: missing in the manifest" for name in names.values() if name not in listed)
            yield from _shard_problems(layout, recorded, shard, runs, closed | (set(names.values()) - listed), listed)
    folders = tuple(f"{table.name}/" for table in TABLES)
    for name in sorted(name for name in listed if name.startswith(folders) and name not in expected):
        yield f"{name}: is no file of this recipe's set"


def _file_name(table: SetTable, shard: Shard) -> str:
    return f"{table.name}/{shard.name}.parquet"


def _run_problems(layout: Layout, manifest: Manifest, recipe: Recipe) -> Iterator[str]:
    """Read `runs.parquet` and yield its damages, and differences to the manifest."""
    name = layout.runs.name
    status: Counter[str] = Counter()
    runs, in_order = 0, True
    for table, problems in _groups(layout, name, RUNS.schema(recipe), run_id_of, 0.0):
        yield from problems
        if table is not None:
            in_order &= table["run_id"].to_pylist() == [run_id_of(runs + row) for row in range(table.num_rows)]
            status.update(table["status"].to_pylist())
            runs += table.num_rows
    if runs != manifest.runs or not in_order:
        yield f"{name}: {runs} runs, the manifest has {manifest.runs}"
    if status != Counter(manifest.status):
        yield f"{name}: status counts differ from the manifest"


def _shard_problems(
    layout: Layout, recipe: Recipe, shard: Shard, runs: RunTable | None, closed: set[str], listed: set[str]
) -> Iterator[str]:
    """Yield the problems of one shard: its runs, its files, and the list of files of its single runs."""
    rows: dict[str, Row] | None = None
    with suppress(UserError):  # already named
        rows = {row["run_id"]: row for row in with_words(runs.rows(shard.indexes)).to_pylist()} if runs else None
    good = {name: row for name, row in (rows or {}).items() if row["status"] == "ok"}
    for name, row in good.items():
        yield from _compared(name, lambda row=row: list(label_problems(row)))  # type: ignore[misc]
    if rows is not None:
        yield from _list_problems(listed, recipe.output.formats, shard, set(good))
    for table in tables_of(recipe.output.formats):
        if _file_name(table, shard) not in closed:
            yield from _file_problems(layout, recipe, table, shard, None if rows is None else good, closed)


def _list_problems(listed: set[str], formats: Sequence[str], shard: Shard, good: set[str]) -> Iterator[str]:
    """Yield files of single runs that the manifest lists without a good run, or does not list for a good run."""
    paths = Layout("")
    for kind in (each.name for each in run_formats()):
        for run_id in map(run_id_of, shard.indexes):
            name = paths.export(kind, run_id).as_posix()
            if name in listed and not (run_id in good and kind in formats):
                yield f"{name}: run is not ok or unknown"
            elif name not in listed and run_id in good and kind in formats:
                yield f"{name}: missing in the manifest"


def _file_problems(
    layout: Layout, recipe: Recipe, table: SetTable, shard: Shard, good: dict[str, Row] | None, closed: set[str]
) -> Iterator[str]:
    """Yield the problems of a shard's file of one table. `good` has its good runs, None where they are not known.

    Files named in `closed` must not be opened.
    """
    name, whole, seen = _file_name(table, shard), True, set[str]()
    types = table.schema(recipe)
    checked = good if table is SIGNALS and _file_name(TRUTH, shard) not in closed else None
    namer = _namer(list(good) if good is not None else [run_id_of(index) for index in shard.indexes])
    for group, (rows, problems) in enumerate(_groups(layout, name, types, namer, asked_bytes(recipe))):
        yield from problems
        whole &= rows is not None
        if rows is None:
            continue
        seen |= set(rows["run_id"].to_pylist())
        if checked:
            truth = _group_of(layout.root / _file_name(TRUTH, shard), group, asked_bytes(recipe))
            yield from _rows_problems(name, rows, truth, checked, recipe.sensing)
        if table is WINDOWS and good:
            yield from (
                f"{row['run_id']}: {name} and runs.parquet differ in window {row['window']}"
                for row in with_words(rows).to_pylist()
                if row["run_id"] in good and _differs(row, good[row["run_id"]])
            )
    if whole and good is not None:
        what = "signals" if table is SIGNALS else f"a row in {table.name}"
        yield from (f"{run_id}: has {what}, but is not ok" for run_id in sorted(seen - set(good), key=str))
        lacking = sorted(set(good) - seen) if not table.several else []
        yield from (f"{run_id}: is ok, but has no {what.removeprefix('a ')}" for run_id in lacking)


def _group_of(path: Path, group: int, asked: float) -> pa.Table | None:
    """Return a row group of a file; None where it cannot be read, which is named where that file is checked."""
    with suppress(UserError), ParquetSource(path, asked) as file:
        return file.read_row_group(group) if group < file.num_row_groups else None
    return None


def _rows_problems(
    name: str, seen: pa.Table, truth: pa.Table | None, good: dict[str, Row], sensing: Sensing
) -> Iterator[str]:
    """Yield the problems of a row group of `signals`, with the same runs of `truth` where they can be read."""
    if truth is not None and truth["run_id"] != seen["run_id"]:
        truth = None
    for number, row in enumerate(_values(seen)):
        run = good.get(row["run_id"])
        if run is None:
            continue
        if any(row[key] != run[key] for key in row if key in run):
            yield f"{row['run_id']}: {name} and runs.parquet differ"
        if truth is not None:
            signals = row_signals(seen, number) | row_signals(truth, number)
            whole = run | row | _values(truth.slice(number, 1))[0]
            yield from _compared(row["run_id"], lambda w=whole, s=signals: list(signal_problems(w, s, sensing)))  # type: ignore[misc]


def _differs(window: Row, run: Row) -> bool:
    """Return whether a row of `windows` differs from the labels by window of its run."""
    if not 0 <= window["window"] < len(run["window_starts_s"]):
        return True
    expected = {name: run[labels][window["window"]] for name, labels in OF_WINDOW.items()}
    found = window | {"rub": int(window["rub"]), "motion": MOTION_CLASSES.get(window["motion"])}
    return any(found[name] != value for name, value in expected.items())


def _values(table: pa.Table) -> list[Row]:
    """Return the rows of a table without its channels."""
    rows: list[Row] = with_words(table.select([x.name for x in table.schema if not is_signal(x)])).to_pylist()
    return rows


def _compared(run_id: str, problems: Callable[[], list[str]]) -> Iterator[str]:
    """Yield the problems of a run. Values that cannot be compared are a problem too."""
    try:
        yield from (f"{run_id}: {problem}" for problem in problems())
    except UNCOMPARABLE as error:
        yield f"{run_id}: its values cannot be compared ({type(error).__name__}: {error})"


def _groups(
    layout: Layout, name: str, types: pa.Schema, name_of: Callable[[int], str], asked: float
) -> Iterator[tuple[pa.Table | None, list[str]]]:
    """Yield each row group of a file, or None with its problems. `name_of` returns the run of a row."""
    path, first = layout.root / name, 0
    try:
        with ParquetSource(path, asked) as file:
            if not file.schema_arrow.equals(types):
                yield None, [f"{name}: its columns are not those of this rubgen"]
                return
            for group in range(file.num_row_groups):
                rows = range(first, first := first + file.rows_of(group))
                try:
                    yield file.read_row_group(group), []
                except UserError as error:
                    names = _runs_of(file, group) or [name_of(row) for row in rows]
                    columns = [column for column in types.names if not _reads(file, group, column)]
                    where = f"row group {group} with {_few(names)}, column {_few(columns)}"
                    what, reason = _what_and_why(error, path)
                    yield None, [f"{name}: {what}: {where} ({reason})"]
    except UserError as error:
        what, reason = _what_and_why(error, path)
        yield None, [f"{name}: {what} ({reason})"]


def _namer(runs: list[str]) -> Callable[[int], str]:
    """Return a function from a row of a file to the name of its run: files have the good runs in their order."""
    return lambda row: runs[row] if row < len(runs) else f"row {row}"


def _runs_of(file: ParquetSource, group: int) -> list[str]:
    """Return the runs of a row group, where their names can be read."""
    try:
        return [str(name) for name in file.read_row_group(group, ["run_id"])["run_id"].to_pylist()]
    except UserError:
        return []


def _few(names: Sequence[str]) -> str:
    """Join the names; of many names only the first and the last."""
    return ", ".join(names) if len(names) <= MOST_NAMED else f"{names[0]} to {names[-1]}"


def _reads(file: ParquetSource, group: int, column: str) -> bool:
    try:
        file.read_row_group(group, [column])
    except UserError:
        return False
    return True


def _what_and_why(error: UserError, path: object) -> tuple[str, str]:
    """Return whether a file is damaged or was not read, and why, without its name and without advice."""
    text = str(error).removeprefix(f"{path}: ").removesuffix("; generate it again")
    if text.startswith(f"{NO_PARQUET} ("):
        return "damaged", text.removeprefix(f"{NO_PARQUET} (").removesuffix(")")
    return "not read", text
