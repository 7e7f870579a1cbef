"""Checks of a set's Parquet files: readable to the last page, and consistent with each other and the manifest."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import pyarrow as pa

from rubgen.dataset.checking.channel_check import Row
from rubgen.dataset.checking.consistency import label_problems, signal_problems
from rubgen.dataset.layout import RUNS_PER_SHARD, Layout
from rubgen.dataset.manifest import Manifest
from rubgen.dataset.reading.open import is_signal, row_signals
from rubgen.dataset.rows import asked_bytes
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.io.parquet.compact_records import SCHEMA
from rubgen.io.parquet.read import ParquetSource
from rubgen.io.parquet.words import with_words
from rubgen.io.parquet.write import recipe_schema
from rubgen.scenario import Recipe, Sensing

NO_PARQUET = "damaged or no Parquet file of rubgen"
MOST_NAMED = 4
"""Number of runs or columns that a line lists one by one."""
CLOSED: list[tuple[pa.Table | None, list[str]]] = [(None, [])]
"""The result of reading a file that must not be opened: no table, so its content is unknown, and no further problem."""
UNCOMPARABLE = (TypeError, ValueError, LookupError, AttributeError, ArithmeticError)
"""Errors from comparing values of a wrong type or number."""


def table_problems(layout: Layout, manifest: Manifest, closed: set[str]) -> Iterator[str]:
    """Read every Parquet file of a data set and yield their problems, one sentence each.

    The files are `runs.parquet`, `sections/` and, where the recipe has the format parquet, the data files. Labels are
    compared with each other and with the channels.

    - layout: the paths of the set.
    - manifest: its manifest.
    - closed: names of files that must not be opened; for them nothing is reported.
    """
    identity = manifest.identity
    recorded = identity.recorded(str(layout.manifest))
    asked = asked_bytes(recorded)
    rows: dict[str, Row] = {}
    if layout.runs.name not in closed:
        types = recipe_schema(recorded, signals=False)
        for table, problem in _groups(layout, layout.runs.name, types, "run-{:06d}".format, asked):
            yield from problem
            rows |= {row["run_id"]: row for row in (with_words(table).to_pylist() if table is not None else ())}
        yield from _run_problems(layout.runs.name, rows, manifest)
    good = {name: row for name, row in rows.items() if row["status"] == "ok"}
    for name, row in good.items():
        yield from _compared(name, lambda row=row: list(label_problems(row)))  # type: ignore[misc]
    yield from _list_problems(manifest, recorded.output.formats, set(good))
    yield from _section_problems(layout, manifest.listed("sections"), closed, list(good), asked)
    if "parquet" in recorded.output.formats:
        yield from _data_problems(layout, manifest.listed("data"), closed, recorded, good, asked)


def _run_problems(name: str, rows: dict[str, Row], manifest: Manifest) -> Iterator[str]:
    """Yield differences between `runs.parquet` and the manifest."""
    expected = (f"run-{index:06d}" for index in range(len(rows)))
    if len(rows) != manifest.runs or any(run_id != next(expected) for run_id in rows):
        yield f"{name}: {len(rows)} runs, the manifest has {manifest.runs}"
    if Counter(row["status"] for row in rows.values()) != Counter(manifest.status):
        yield f"{name}: status counts differ from the manifest"


def _list_problems(manifest: Manifest, formats: Sequence[str], good: set[str]) -> Iterator[str]:
    """Yield files of single runs that the manifest lists without a good run, or does not list for a good run."""
    for kind in (each.name for each in run_formats()):
        listed = set(manifest.listed(kind))
        expected = {f"{kind}/{name}.{kind}" for name in good} if kind in formats else set()
        for name in sorted(listed ^ expected):
            yield f"{name}: {'run is not ok or unknown' if name in listed else 'missing in the manifest'}"


def _section_problems(
    layout: Layout, names: list[str], closed: set[str], good: list[str], asked: float
) -> Iterator[str]:
    seen: set[str] = set()
    whole = bool(names)
    for shard, name in enumerate(names):
        for table, problem in (
            _groups(layout, name, SCHEMA, _namer(good, shard), asked) if name not in closed else CLOSED
        ):
            yield from problem
            whole &= table is not None
            seen |= set(table["run_id"].to_pylist()) if table is not None else set()
    yield from _difference(seen, set(good), "a section", "no section", whole=whole)


def _data_problems(
    layout: Layout, names: list[str], closed: set[str], recipe: Recipe, good: dict[str, Row], asked: float
) -> Iterator[str]:
    types, sensing = recipe_schema(recipe, signals=True), recipe.sensing
    scalars = [field.name for field in types if not is_signal(field)]
    seen: set[str] = set()
    whole = bool(names)
    for shard, name in enumerate(names):
        groups = _groups(layout, name, types, _namer(list(good), shard), asked)
        for table, problem in groups if name not in closed else CLOSED:
            yield from problem
            whole &= table is not None
            for number, row in enumerate(with_words(table.select(scalars)).to_pylist() if table is not None else ()):
                seen.add(row["run_id"])
                yield from _row_problems(name, row, good.get(row["run_id"]), table, number, sensing)
    yield from _difference(seen, set(good), "signals", "no signals", whole=whole)


def _row_problems(
    name: str, row: Row, run: Row | None, table: pa.Table, number: int, sensing: Sensing
) -> Iterator[str]:
    if run is not None and {key: row[key] for key in run} != run:
        yield f"{row['run_id']}: {name} and runs.parquet differ"
    yield from _compared(row["run_id"], lambda: list(signal_problems(row, row_signals(table, number), sensing)))


def _difference(seen: set[str], good: set[str], has: str, lacks: str, *, whole: bool) -> Iterator[str]:
    """Yield runs that have something without being good, and good runs that lack it; only for files read to the end."""
    for name in sorted(seen ^ good if whole else set(), key=str):
        yield f"{name}: {f'has {has}, but is not ok' if name in seen else f'is ok, but has {lacks}'}"


def _compared(run_id: str, problems: Callable[[], list[str]]) -> Iterator[str]:
    """Yield the problems of a run. Values that cannot be compared are a problem too."""
    try:
        yield from (f"{run_id}: {problem}" for problem in problems())
    except UNCOMPARABLE as error:
        yield f"{run_id}: its values do not fit each other ({type(error).__name__}: {error})"


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
                    yield None, [f"{name}: damaged: {where} ({_reason(error, path)})"]
    except UserError as error:
        yield None, [f"{name}: damaged ({_reason(error, path)})"]


def _namer(good: list[str], shard: int) -> Callable[[int], str]:
    """Return a function from a row of a file to the name of its run: files have the good runs in their order."""

    def name_of(row: int) -> str:
        place = shard * RUNS_PER_SHARD + row
        return good[place] if place < len(good) else f"row {row}"

    return name_of


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


def _reason(error: UserError, path: object) -> str:
    """Return why a file cannot be read, without its name and without advice."""
    text = str(error).removeprefix(f"{path}: ").removesuffix("; generate it again")
    return text.removeprefix(f"{NO_PARQUET} (").removesuffix(")") if text.startswith(f"{NO_PARQUET} (") else text
