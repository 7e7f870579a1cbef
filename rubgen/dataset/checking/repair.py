"""Make files of a data set again that can be made from its data files, where they are lost or damaged."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from rubgen.dataset.card import card
from rubgen.dataset.checking.inventory import Finding
from rubgen.dataset.checking.verify import findings
from rubgen.dataset.croissant import croissant
from rubgen.dataset.files import json_text, sha256_of, write_text
from rubgen.dataset.layout import Layout
from rubgen.dataset.making.finish import write_sensors
from rubgen.dataset.manifest import Manifest, read_manifest, write_derived
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.reading.replaying import replay_of_mcap, scenario_of
from rubgen.dataset.remaking.remake import other_versions, remake
from rubgen.dataset.tally import tally_of
from rubgen.errors import UserError, write_problems
from rubgen.formats import format_of
from rubgen.io.files import write_durably


@dataclass(frozen=True, kw_only=True)
class Repaired:
    """The result of `repair`: the findings before it, the paths of the files it made, and the remaining findings."""

    found: tuple[Finding, ...]
    made: tuple[str, ...]
    left: tuple[Finding, ...]
    versions: dict[str, tuple[str, str]]
    """Packages with another version than made the set, then and now. Data are made again only without any."""


def repair(directory: Path) -> Repaired:
    """Make damaged or missing files of a set again, so that each file has the bytes that the manifest lists.

    - A damaged Parquet or MCAP file: all runs of its shard are simulated again from the manifest. This needs the
      versions of the packages that made the set.
    - A damaged `runs.parquet`: the runs of the shards whose rows cannot be read are simulated again. If this does not
      restore its bytes, all runs of the set are.
    - sensors.parquet, README.md and croissant.json are written again.
    - An .rrd file is made from its MCAP file if that is good. Else its run is simulated again, with the same versions.

    What cannot be made again stays as it is, and is in `left` of the result. If all .rrd files are good then,
    derived.json is written with their digests. No other file is changed and none is deleted. Raises UserError where
    `directory` holds no finished data set, its manifest is damaged, or it cannot be written.
    """
    layout = Layout(directory)
    manifest = read_manifest(layout)
    before = findings(directory)
    wrong = {finding.path for finding in before if finding.path}
    versions = other_versions(manifest) if before else {}
    with write_problems(directory, advice="make it writable"):
        made = [] if versions else remake(layout, manifest, wrong)
        made += _sensors(layout, manifest, wrong)
        made += _texts(layout, manifest, wrong - set(made))
        made += _recordings(layout, manifest, wrong - set(made))
    left = tuple(findings(directory) if made else before)
    return Repaired(found=tuple(before), made=tuple(made), left=left, versions=versions)


def _sensors(layout: Layout, manifest: Manifest, wrong: set[str]) -> list[str]:
    """Write sensors.parquet again if its bytes are those of the manifest. Return its name."""
    (entry,) = [each for each in manifest.files if each.path == layout.sensors.name]
    if entry.path not in wrong:
        return []
    with TemporaryDirectory() as folder:
        new = Path(folder) / entry.path
        write_sensors(manifest.identity.recorded(str(layout.manifest)), new)
        if sha256_of(new) != entry.sha256:
            return []
        write_durably(layout.sensors, lambda part: part.write_bytes(new.read_bytes()))
    return [entry.path]


def _texts(layout: Layout, manifest: Manifest, wrong: set[str]) -> Iterator[str]:
    """Write README.md and croissant.json, each only where its bytes agree with the manifest. Yields their names."""
    listed = {entry.path: entry.sha256 for entry in manifest.files}
    texts = {}
    whole = wrong.isdisjoint((layout.runs.name, layout.sensors.name))
    if layout.card.name in wrong and whole:
        texts[layout.card] = card(manifest.identity, manifest.status, tally_of(layout.runs))
    if layout.croissant.name in wrong and whole:
        texts[layout.croissant] = json_text(croissant(layout, manifest.identity))
    for path, text in texts.items():
        if hashlib.sha256(text.encode()).hexdigest() == listed[path.name]:
            write_text(path, text)
            yield path.name


def _recordings(layout: Layout, manifest: Manifest, wrong: set[str]) -> Iterator[str]:
    """Write the .rrd files that are not proven good, then their digests. Yields their names."""
    data, left = DataSet(layout.root), False
    for name in manifest.derived:
        if name in wrong or layout.derived.name in wrong:
            done = _make_recording(data, name, wrong)
            left |= not done
            yield from [name] if done else []
    if not left and write_derived(layout, manifest.derived):
        yield layout.derived.name


def _make_recording(data: DataSet, name: str, wrong: set[str]) -> bool:
    """Make one .rrd file again. Return whether that was possible."""
    from rubgen.viz.replay import replay_of

    remake = format_of(Path(name).parts[0]).remake
    path = data.layout.root / name
    mcap = data.layout.export("mcap", path.stem)
    source = mcap.relative_to(data.layout.root).as_posix()
    if source in data.manifest.listed("mcap") and source not in wrong:
        replay = replay_of_mcap(mcap).replay
    elif not other_versions(data.manifest):
        from rubgen.pipeline import simulate

        replay = replay_of(simulate(scenario_of(data, path.stem)))
    else:
        return False
    if remake is None:
        raise ValueError(f"{name} is data, no derived file")
    if not path.parent.resolve().is_relative_to(data.layout.root.resolve()):
        raise UserError(f"{path.parent}: is a link out of the set; remove the link")
    path.parent.mkdir(parents=True, exist_ok=True)
    remake(replay, path)
    return True
