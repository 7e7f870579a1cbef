"""Merge data sets: the shards of all become the shards of one, with new names of runs."""

from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path

from rubgen.dataset.layout import Layout
from rubgen.dataset.making.claim import begun, claimed, finished, remove_staging
from rubgen.dataset.making.finish import finish_set
from rubgen.dataset.making.generate import Generated, nothing_to_do
from rubgen.dataset.making.outcome import outcome_of
from rubgen.dataset.manifest import Identity
from rubgen.dataset.merging.copying import copy_shard
from rubgen.dataset.merging.sources import SourceSet, check_sources, merged_identity, read_sources
from rubgen.dataset.shards import Shard, shards_of
from rubgen.errors import UserError, write_problems
from rubgen.io.places import check_local
from rubgen.progress import Report, count, shown, step
from rubgen.scenario import Recipe
from rubgen.scenario.merged import MergedRecipe


def merge(
    directories: Sequence[Path | str],
    out: Path | str,
    *,
    progress: Report | bool | None = None,
) -> Generated:
    """Make one data set of several in the directory `out`.

    - directories: two or more finished data sets; they are only read. Their runs follow each other in this order.
    - out: a new or empty directory, or a directory in which the same call was interrupted: the call then completes the
      set. If the set is complete, nothing is changed.
    - progress: as in `generate`.

    Run number i of a set becomes number i plus the number of runs of all sets before it. In `runs.parquet` the column
    `merged_from` contains the run's source and its name there, and `twin_of` the new name of the partner. Splits stay
    the same. Files of the first set keep their bytes; all other files are written with the new names. A set that was
    merged before counts as its sources, so that merging in steps makes the same bytes as merging at once. The manifest
    contains the recipe of each source, from which any run can be made again. No run is simulated, with one exception:
    .rrd files of later sets that have no MCAP files. One shard is copied at a time, with a few runs in memory. An
    interrupted merge leaves no finished set.

    Raises UserError for fewer than two sets, sets of other versions, licence, formats, length of signals, sensors or
    columns, two sets with the same seed, a machine that is in different splits, damaged files, and an `out` that is in
    one of the sets or that `generate` refuses.
    """
    layout = Layout(out)
    check_local(layout.root, "merge")
    sets = read_sources(directories)
    check_sources(sets)
    identity = merged_identity(sets)
    _check_out(layout, sets)
    with write_problems(layout.root, advice="give a directory that you may write to", kept="copied shards are kept"):
        if not finished(layout, identity):
            with claimed(layout, identity):
                if not finished(layout, identity):  # another rubgen may have done it meanwhile
                    return _merge(layout, identity, sets, progress)
        return nothing_to_do(layout, identity)


def _check_out(layout: Layout, sets: Sequence[SourceSet]) -> None:
    for each in sets:
        if layout.root.resolve().is_relative_to(each.layout.root.resolve()):
            raise UserError(f"--out {layout.root}: is in {each.layout.root}, which is to be merged; give another")


def _merge(layout: Layout, identity: Identity, sets: Sequence[SourceSet], progress: Report | bool | None) -> Generated:
    recipe = identity.recorded()
    if not isinstance(recipe, MergedRecipe):
        raise TypeError(f"{layout.root}: the identity is not that of a merged set")
    report = progress if callable(progress) else None
    copied = done = 0
    with begun(layout, identity):
        with shown(progress if not callable(progress) else False), step("copy", "runs"):
            for source, own, shard in _shards(recipe, sets):
                if not layout.closed(shard.name).exists():
                    copy_shard(layout, recipe, source, own, shard)
                    copied += len(shard.indexes)
                done += len(shard.indexes)
                count(done, recipe.runs)
                if report:
                    report(done, recipe.runs)
        status = finish_set(recipe, layout, identity)
    remove_staging(layout)
    return Generated(directory=layout.root, runs=recipe.runs, made=copied, status=status, outcome=outcome_of(layout))


def _shards(recipe: Recipe, sets: Sequence[SourceSet]) -> Iterator[tuple[SourceSet, Shard, Shard]]:
    """Yield each shard of the merged set with the set that it comes from and its own shard there."""
    there = chain.from_iterable(((each, shard) for shard in shards_of(each.recipe)) for each in sets)
    for (source, own), shard in zip(there, shards_of(recipe), strict=True):
        yield source, own, shard
