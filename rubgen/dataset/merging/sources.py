"""Which data sets can be one: same versions, formats, channels and columns; other seeds; no machine in two splits."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pyarrow as pa

from rubgen.dataset.checking.inventory import size_findings
from rubgen.dataset.files import sha256_of
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Identity, Manifest, Source, read_manifest
from rubgen.dataset.tables import RUNS, tables_of
from rubgen.errors import UserError
from rubgen.io.parquet.read import row_groups
from rubgen.io.places import check_local
from rubgen.machine.quantities import MOST_RUNS
from rubgen.scenario import Recipe

ADVICE = "rubgen repair"


@dataclass(frozen=True, kw_only=True)
class SourceSet:
    """A finished data set that is to be merged into another set."""

    layout: Layout
    manifest: Manifest
    recipe: Recipe
    first: int
    """The number that its first run gets."""

    @property
    def sources(self) -> tuple[Source, ...]:
        """The sources of the set: the set itself, or the sets from which it was merged."""
        own = Source(sha256=sha256_of(self.layout.manifest), identity=self.manifest.identity)
        return self.manifest.identity.sources or (own,)


def read_sources(directories: Sequence[Path | str]) -> list[SourceSet]:
    """Read the manifests of the data sets in these directories, in this order.

    Raises UserError where `directories` is no list, a directory is a URL or holds no finished set, a file is missing or
    has another size, or the content of `runs.parquet` does not have the listed sha256.
    """
    if isinstance(directories, str | Path) or not isinstance(directories, Iterable):
        raise UserError(f"merge: {directories!r:.200}: is no list of directories; give two or more")
    sets: list[SourceSet] = []
    for directory in directories:
        layout = Layout(directory)
        check_local(layout.root, "merge")
        manifest = read_manifest(layout)
        found = list(size_findings(layout, manifest))
        if found:
            raise UserError(f"{layout.root}: {found[0].text} ({len(found)} problems); {ADVICE} {layout.root}")
        (runs,) = [entry for entry in manifest.files if entry.path == layout.runs.name]
        if sha256_of(layout.runs) != runs.sha256:
            raise UserError(
                f"{layout.runs}: damaged, its sha256 is not the one in the manifest; {ADVICE} {layout.root}"
            )
        recipe = manifest.identity.recorded(str(layout.manifest))
        first = sum(each.manifest.runs for each in sets)
        sets.append(SourceSet(layout=layout, manifest=manifest, recipe=recipe, first=first))
    return sets


def merged_identity(sets: Sequence[SourceSet]) -> Identity:
    """Return the identity of the merged set of these sets, in this order. It depends only on their sources.

    A set that was merged before counts as its sources. Recipe, machine, sensors and versions are those of the first
    source. The name in the recipe gets the ending -merged, and the number of runs is that of all sets.
    """
    sources = tuple(source for each in sets for source in each.sources)
    first = sources[0].identity
    runs = sum(each.manifest.runs for each in sets)
    recipe = {**first.recipe, "name": f"{first.recipe['name']}-merged", "runs": runs}
    return first.model_copy(update={"recipe": recipe, "sources": sources})


def check_sources(sets: Sequence[SourceSet]) -> None:
    """Check that these sets can be merged. Raises UserError, one line with both sets, at the first difference.

    It is also raised for fewer than two sets, and for more than MOST_RUNS runs in all.
    """
    if len(sets) < 2:
        raise UserError("merge: give two or more data sets")
    runs = sum(each.manifest.runs for each in sets)
    if runs > MOST_RUNS:
        raise UserError(f"merge: {runs:,} runs in all; a set has at most {MOST_RUNS:,}")
    for other in sets[1:]:
        for what, one, two in _compared(sets[0], other):
            if one != two:
                raise _differ(sets[0], other, what, one, two)
        _check_columns(sets[0], other)
    _check_seeds(sets)
    _check_machines(sets)


def _compared(one: SourceSet, other: SourceSet) -> Iterator[tuple[str, object, object]]:
    """Yield what must be equal: its name, and the values of both sets."""
    first, second = one.manifest.identity, other.manifest.identity
    for name in sorted(first.packages.keys() | second.packages.keys()):
        yield f"the version of {name}", first.packages.get(name), second.packages.get(name)
    yield "license", first.recipe["license"], second.recipe["license"]
    outputs = [each.recipe["output"] for each in (first, second)]
    yield "output.formats", sorted(outputs[0]["formats"]), sorted(outputs[1]["formats"])
    yield "output.signal_seconds", outputs[0]["signal_seconds"], outputs[1]["signal_seconds"]
    for key in sorted(first.recipe["sensors"].keys() - {"set"}):
        yield f"sensors.{key}", first.recipe["sensors"][key], second.recipe["sensors"].get(key)
    yield "channels", _names(first.sensors), _names(second.sensors)
    yield "sensors", first.sensors, second.sensors


def _names(sensors: dict[str, Any]) -> list[str]:
    return [each.get("name", each.get("kind", "")) for each in sensors.get("sensors", ())]


def _differ(one: SourceSet, other: SourceSet, what: str, first: object, second: object) -> UserError:
    values = f"{second!r:.80} in {other.layout.root}, {first!r:.80} in {one.layout.root}"
    if isinstance(first, dict):
        values = f"other values in {other.layout.root} than in {one.layout.root}"
    remedy = "make one of them again with the same: rubgen generate, or for sensors rubgen resense"
    return UserError(f"merge: {what}: {values}; {remedy}")


def _check_columns(one: SourceSet, other: SourceSet) -> None:
    for table in (RUNS, *tables_of(one.recipe.output.formats)):
        first, second = (_columns(table.schema(each.recipe)) for each in (one, other))
        for name in [*first, *second]:
            if first.get(name) != second.get(name):
                there, lacks = (one, other) if name in first else (other, one)
                what = "another type or meaning" if name in first and name in second else "no such column"
                raise UserError(
                    f"merge: {there.layout.root} has the column {name} in {table.name}, {lacks.layout.root} has "
                    f"{what}: only recipes with the same tables, such as [faults] or [twins], can be merged"
                )


def _columns(types: pa.Schema) -> dict[str, tuple[object, object]]:
    return {field.name: (field.type, field.metadata) for field in types if field.name != "merged_from"}


def _check_seeds(sets: Sequence[SourceSet]) -> None:
    """Raise UserError where two sources have the same seed: their runs have the same random numbers."""
    seen: dict[int, tuple[Source, Path]] = {}
    for each in sets:
        for source in each.sources:
            seed = source.identity.recipe["seed"]
            known, where = seen.setdefault(seed, (source, each.layout.root))
            if known is source:
                continue
            same = {**known.identity.recipe, "runs": 0} == {**source.identity.recipe, "runs": 0}
            what = "has runs of" if same else f"has the seed {seed} of"
            raise UserError(
                f"merge: {each.layout.root} {what} {where}: every run must have random numbers of its own; "
                f"{'leave one of them out' if same else 'make one of them with another seed'}"
            )


def _check_machines(sets: Sequence[SourceSet]) -> None:
    """Raise UserError where a machine is in two splits: a score on one of them would not be of an unseen machine.

    Of each machine a number is in memory.
    """
    seen: dict[int, str] = {}
    for each in sets:
        last: tuple[str, str] | None = None
        for group in row_groups(each.layout.runs, columns=["machine_id", "split"]):
            for pair in zip(group["machine_id"].to_pylist(), group["split"].to_pylist(), strict=True):
                if pair == last or not pair[0]:  # a machine that could not be drawn has no digits
                    continue
                last = machine, split = pair
                known = seen.setdefault(int(machine, 16), split)
                if known != split:
                    raise UserError(
                        f"merge: {each.layout.root}: machine {machine} is in split {split!r}, in another set in "
                        f"{known!r}: a machine may be in one split alone; make one set with other machines or splits"
                    )
