"""Checks of a whole data set: it is what its manifest says, readable to the last page, and consistent in itself."""

import random
from collections.abc import Iterator
from pathlib import Path

from rubgen.brief import in_shell
from rubgen.dataset.checking.inventory import Finding, Kind, derived_digests, file_findings, unlisted_files
from rubgen.dataset.checking.table_check import table_problems
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import Manifest, read_manifest
from rubgen.dataset.shards import Shard, shards_of
from rubgen.errors import UserError
from rubgen.formats import run_formats
from rubgen.io.places import check_local
from rubgen.scenario.run_id import run_id_of


def verify(directory: Path | str, *, sample: int | None = None) -> list[str]:
    """Check the data set in `directory` and return every problem, one line each. The list is empty for a good set.

    Checked are: format and digest of the manifest; presence, size and sha256 of every listed file, for .rrd files by
    derived.json; that there is no other file and no link out of the directory; pages of every Parquet file, with the
    runs of a damaged row group; CRCs of every MCAP file; that MCAP and .rrd files belong to the run in their name;
    schemas and row counts; labels against each other; labels against the recorded channels. Only regular files are
    opened.

    With `sample` the content of only that many shards is checked, drawn anew at each call. Presence and size are
    checked for all. Memory does not grow with the number of runs. Raises UserError where `directory` holds no finished
    data set or is a URL, where its manifest is damaged, and for a `sample` below 1.
    """
    return [finding.text for finding in findings(directory, sample=sample)]


def findings(directory: Path | str, *, sample: int | None = None) -> list[Finding]:
    """Check the data set in `directory` as `verify` does, and return each problem as a `Finding`.

    The finding's `kind` is data, derived file or unlisted file. `repair` and `advice` choose the remedy by the kind.
    Raises UserError as `verify` does.
    """
    layout = Layout(directory)
    check_local(layout.root, "verify")
    manifest = read_manifest(layout)
    chosen = _Chosen(layout, manifest, sample)
    found = list(file_findings(layout, manifest, chosen.path))
    found += unlisted_files(layout, manifest)
    closed = {finding.path for finding in found if finding.closed}
    found += (Finding(text=text) for text in table_problems(layout, manifest, closed, chosen.shard))
    return [*found, *_format_findings(layout, manifest, closed, {finding.path for finding in found}, chosen)]


class _Chosen:
    """The shards whose content is checked: all, or a number of them drawn anew."""

    def __init__(self, layout: Layout, manifest: Manifest, sample: int | None) -> None:
        self._all = sample is None
        self._names: set[str] = set()
        self._runs: set[str] = set()
        if sample is None:
            return
        if isinstance(sample, bool) or not isinstance(sample, int) or sample < 1:
            raise UserError(f"--sample {sample}: must be at least 1; give a number of shards")
        recipe = manifest.identity.recorded(str(layout.manifest))
        names = [shard.name for shard in shards_of(recipe)]
        self._names = set(random.sample(names, min(sample, len(names))))
        for shard in shards_of(recipe):
            self._runs |= set(map(run_id_of, shard.indexes)) if shard.name in self._names else set()

    def shard(self, shard: Shard) -> bool:
        """Return whether the content of the shard is checked."""
        return self._all or shard.name in self._names

    def path(self, name: str) -> bool:
        """Return whether the content of the file with this path in the set is checked."""
        return self._all or "/" not in name or Path(name).stem in self._names | self._runs


def _format_findings(
    layout: Layout, manifest: Manifest, closed: set[str], wrong: set[str], chosen: _Chosen
) -> Iterator[Finding]:
    """Yield problems inside the files of single runs. A derived file is read only where it is not `wrong` already."""
    proven = set(derived_digests(layout, manifest)[0])
    for each in run_formats():
        kind = Kind.DERIVED if each.remake else Kind.DATA
        for name in manifest.listed(each.name):
            if name in (wrong if each.remake else closed) or not chosen.path(name):
                continue
            path = layout.root / name
            problems = each.problems(path, path.stem, name in proven)
            yield from (
                Finding(text=f"{name}: {text}", kind=kind, path=name if each.remake else "") for text in problems
            )


def advice(directory: Path, found: list[Finding]) -> str:
    """Return one sentence with the remedy for these findings on the set in `directory`.

    No remedy deletes a good file.
    """
    kinds = {finding.kind for finding in found}
    sentences = {
        Kind.DATA: (
            f"data are damaged: with the versions that made the set, damaged shards are made again by: rubgen repair "
            f"{in_shell(directory)}; else make the set again in a new directory (rubgen generate RECIPE --out NEW; its "
            f"recipe stands in {directory / 'manifest.json'} at identity.recipe)"
        ),
        Kind.DERIVED: f"what is made from the data files is made again by: rubgen repair {in_shell(directory)}",
        Kind.UNLISTED: "files that are not listed are no part of the set: move them elsewhere",
    }
    whole = [] if Kind.DATA in kinds else ["the data files are whole"]
    return "; ".join([*whole, *(text for kind, text in sentences.items() if kind in kinds)])
