"""Whether a data set is what its manifest says, readable to the last page, and consistent in itself."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from rubgen.dataset.consistency import label_problems, signal_problems
from rubgen.dataset.files import sha256_of
from rubgen.dataset.impulse_check import Row
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Manifest, derived_files, hashed_files, read_manifest
from rubgen.dataset.open import is_signal, row_signals
from rubgen.errors import UserError
from rubgen.io.parquet import row_groups, schema
from rubgen.io.sections import SCHEMA
from rubgen.scenario import Sensing


def verify(directory: Path) -> list[str]:
    """Every problem of the data set in `directory`, one line each; empty when there is none.

    Checked: digest of the manifest; presence and sha256 of every file; pages of every Parquet file and CRCs of every
    MCAP and .rrd file; schemas and row counts; labels against each other; labels against the recorded channels.
    Raises UserError where `directory` holds no finished data set, or its manifest is damaged.
    """
    layout = Layout(directory)
    manifest = read_manifest(layout)
    problems = list(_file_problems(layout, manifest))
    try:
        problems += _table_problems(layout, manifest)
    except UserError as error:
        problems.append(str(error))
    return problems + list(_export_problems(layout))


def _file_problems(layout: Layout, manifest: Manifest) -> Iterator[str]:
    for entry in manifest.files:
        path = layout.root / entry.path
        if not path.is_file():
            yield f"{entry.path}: listed in the manifest, but not there"
        elif sha256_of(path) != entry.sha256:
            yield f"{entry.path}: its sha256 is not the one in the manifest"
    listed = {entry.path for entry in manifest.files}
    for path in hashed_files(layout):
        if path.relative_to(layout.root).as_posix() not in listed:
            yield f"{path.relative_to(layout.root)}: not listed in the manifest"
    there = {path.relative_to(layout.root).as_posix() for path in derived_files(layout)}
    for name in sorted(there ^ set(manifest.derived)):
        yield f"{name}: {'not listed in the manifest' if name in there else 'listed in the manifest, but not there'}"


def _table_problems(layout: Layout, manifest: Manifest) -> Iterator[str]:
    recipe, sensors = manifest.identity.recipe, manifest.identity.sensor_set
    rows: dict[str, Row] = {}
    for table in row_groups(layout.runs):
        if not table.schema.equals(schema(signals=False, sensors=sensors)):
            yield f"{layout.runs.name}: its columns are not those of this rubgen"
            return
        rows |= {row["run_id"]: row for row in table.to_pylist()}
    if sorted(rows) != [f"run-{index:06d}" for index in range(manifest.runs)]:
        yield f"{layout.runs.name}: {len(rows)} runs, the manifest has {manifest.runs}"
    if Counter(row["status"] for row in rows.values()) != Counter(manifest.status):
        yield f"{layout.runs.name}: status counts differ from the manifest"
    valid = {name: row for name, row in rows.items() if row["status"] == "ok"}
    for name, row in valid.items():
        yield from (f"{name}: {problem}" for problem in label_problems(row))
    yield from _expected_exports(layout, recipe["output"]["formats"], set(valid))
    yield from _section_problems(layout, set(valid))
    if "parquet" in recipe["output"]["formats"]:
        yield from _data_problems(layout, Sensing(**{**recipe["sensors"], "set": sensors}), valid)


def _expected_exports(layout: Layout, formats: list[str], valid: set[str]) -> Iterator[str]:
    for kind in (kind for kind in formats if kind != "parquet"):
        there = {path.stem for path in (layout.root / kind).glob(f"*.{kind}")}
        for name in sorted(there ^ valid):
            yield f"{kind}/{name}.{kind}: {'run is not ok or unknown' if name in there else 'missing'}"


def _section_problems(layout: Layout, valid: set[str]) -> Iterator[str]:
    seen: set[str] = set()
    for path in layout.section_shards():
        for table in row_groups(path):
            if not table.schema.equals(SCHEMA):
                yield f"sections/{path.name}: its columns are not those of this rubgen"
                return
            seen |= set(table["run_id"].to_pylist())
    for name in sorted(seen ^ valid):
        yield f"{name}: {'has a section, but is not ok' if name in seen else 'is ok, but has no section'}"


def _data_problems(layout: Layout, sensing: Sensing, valid: dict[str, Row]) -> Iterator[str]:
    types = schema(signals=True, clean=sensing.keep_clean, sensors=sensing.set)
    seen: set[str] = set()
    for path in layout.shards():
        for table in row_groups(path):
            if not table.schema.equals(types):
                yield f"data/{path.name}: its columns are not those of this rubgen"
                return
            scalars = table.select([field.name for field in types if not is_signal(field)]).to_pylist()
            for number, row in enumerate(scalars):
                seen.add(row["run_id"])
                if {key: row[key] for key in valid.get(row["run_id"], {})} != valid.get(row["run_id"]):
                    yield f"{row['run_id']}: data/{path.name} and runs.parquet differ"
                signals = row_signals(table, number)
                found = signal_problems(row, signals, sensing)
                yield from (f"{row['run_id']}: {problem}" for problem in found)
    for name in sorted(seen ^ set(valid)):
        yield f"{name}: {'has signals, but is not ok' if name in seen else 'is ok, but has no signals'}"


def _export_problems(layout: Layout) -> Iterator[str]:
    for path in sorted((layout.root / "mcap").glob("*.mcap")):
        from rubgen.io.mcap import check_mcap

        yield from (f"mcap/{path.name}: {problem}" for problem in check_mcap(path))
    for path in derived_files(layout):
        from rubgen.viz.rerun import check_rrd

        yield from (f"rrd/{path.name}: {problem}" for problem in check_rrd(path))
