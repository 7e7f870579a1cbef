"""Write a data set in another format, one run in memory at a time."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from rubgen import __version__
from rubgen.dataset.files import sha256_of
from rubgen.dataset.reading.open import DataSet
from rubgen.errors import UserError
from rubgen.export.formats import FORMATS, ExportFormat
from rubgen.export.run import ExportedRun, exported_runs
from rubgen.io.files import write_durably
from rubgen.io.places import set_around
from rubgen.machine.problems import nearest
from rubgen.progress import count

BEGUN, DONE = ".export.json", "export.json"
"""What an export comes from. The name of the first is that of an unfinished one."""
RUNS, CHANNELS = "runs.csv", "channels.csv"
BYTES = 4
"""Of a sample."""


@dataclass(frozen=True)
class Exported:
    """The numbers of runs and files of an export, and the names of its splits and channels."""

    runs: int
    files: int
    splits: tuple[str, ...]
    channels: tuple[str, ...]


def export(
    directory: Path, out: Path, name: str, *, split: str | None = None, channels: Sequence[str] | None = None
) -> Exported:
    """Write the good runs (status ok) of the set in `directory` to the folder `out` in the format `name`.

    - name: uff58, mat, hdf5, csv, wav, ts, webdataset or parquet.
    - split: name of a split; None takes all runs.
    - channels: names of recorded channels. Clean channels (without noise) cannot be chosen. None, or no name, takes all
      other channels.

    The folder has the files of the runs, `channels.csv`, and `runs.csv` with parameters and labels, lists as JSON. The
    format parquet has no labels, no parameters and no `runs.csv`, and only channels that a probe can measure. A file is
    complete or does not exist, and the same call completes an interrupted export. Raises UserError for an unknown
    format, split or channel, for a missing package, for content that the format cannot contain, for a set without good
    runs, and where `out` lies in a data set or has other content than this export.
    """
    data = DataSet(directory)
    kind = _format(name)
    chosen = _channels(data, channels, answers=kind.answers)
    runs = _runs(data, split)
    _check_holds(data, kind, name, len(chosen))
    origin = {
        "rubgen": __version__,
        "manifest_sha256": sha256_of(data.layout.manifest),
        "format": name,
        "split": split,
        "channels": list(chosen),
    }
    everyone = [run for members in runs.values() for run in members]
    first = next(exported_runs(data, everyone[:1], chosen))  # where it cannot be read, nothing is begun
    _claim(out, origin)
    files = list(_files(kind, runs, out))
    for number, (path, members) in enumerate(files):
        if not path.exists():
            path.parent.mkdir(exist_ok=True)
            write_durably(path, lambda part, members=members: kind.write(exported_runs(data, members, chosen), part))  # type: ignore[misc]
        count(number + 1, len(files))
    write_durably(out / CHANNELS, lambda part: _channel_table(first).to_csv(part, index=False))
    if kind.answers:
        write_durably(out / RUNS, lambda part: _run_table(data, everyone).to_csv(part))
    if (out / BEGUN).exists():
        (out / BEGUN).replace(out / DONE)
    return Exported(len(everyone), len(files), tuple(runs), chosen)


def _format(name: str) -> ExportFormat:
    if name not in FORMATS:
        raise UserError(f"--format {name!r:.60}: unknown format; {nearest(name, list(FORMATS))}")
    kind = FORMATS[name]
    if kind.needs and find_spec(kind.needs) is None:
        raise UserError(f"--format {name}: the package {kind.needs} is not installed; pip install 'rubgen[export]'")
    return kind


def _channels(data: DataSet, channels: Sequence[str] | None, *, answers: bool) -> tuple[str, ...]:
    recorded = [name for name in data.channels if not name.endswith("_clean")]
    if not answers:
        recorded = list(data.inputs)
    for name in channels or ():
        if name not in recorded:
            raise UserError(f"{data.layout.root}: no recorded channel {name!r:.60}; {nearest(name, recorded)}")
    return tuple(dict.fromkeys(channels or recorded))


def _runs(data: DataSet, split: str | None) -> dict[str, list[str]]:
    """Return the good runs of each split."""
    good = data.ok
    names = [str(name) for name in good["split"].unique()]
    if split is not None and split not in names:
        raise UserError(f"--split {split!r:.60}: no good run has this split; {nearest(split, names)}")
    runs = {name: list(good.index[good["split"] == name]) for name in names if split in (None, name)}
    if not runs:
        raise UserError(f"{data.layout.root}: no run of this set ended well; there is nothing to export")
    return runs


def _check_holds(data: DataSet, kind: ExportFormat, name: str, channels: int) -> None:
    rate = data.sample_rate_hz
    if kind.whole_rate and rate != int(rate):
        raise UserError(f"--format {name}: holds whole sample rates, not {rate:g} Hz; choose another format")
    size = BYTES * channels * round(rate * data.recipe.output.signal_seconds)
    if kind.most_bytes and size > kind.most_bytes:
        more = f"a run of {size:,} bytes is more than the {kind.most_bytes:,} of a file"
        raise UserError(f"--format {name}: {more}; choose fewer --channels, or hdf5")


def _claim(out: Path, origin: dict[str, Any]) -> None:
    """Take a new or empty folder, or one of the same export. Raises UserError for any other, and in a data set."""
    text = json.dumps(origin, indent=2) + "\n"
    data_set = set_around(out / "file")
    if data_set:
        raise UserError(f"--out {out}: lies in the data set {data_set}; choose a folder outside of it")
    if out.exists() and not out.is_dir():
        raise UserError(f"--out {out}: is a file; give a new folder")
    here = [each.name for each in out.iterdir()] if out.exists() else []
    found = next((out / name for name in (BEGUN, DONE) if name in here), None)
    if found is not None:
        if found.read_text(encoding="utf-8") != text:
            raise UserError(f"--out {out}: has another export ({found.name}); choose another folder")
        return
    if here:
        raise UserError(f"--out {out}: is not empty ({here[0]}); choose another folder")
    out.mkdir(parents=True, exist_ok=True)
    write_durably(out / BEGUN, lambda part: part.write_text(text, encoding="utf-8"))


def _files(kind: ExportFormat, runs: dict[str, list[str]], out: Path) -> Iterator[tuple[Path, list[str]]]:
    """Yield the path of each file and its runs."""
    for split, members in runs.items():
        if kind.runs_per_file is None:
            yield out / f"{split}{kind.ending}", members
        elif kind.runs_per_file == 1:
            yield from ((out / split / f"{run}{kind.ending}", [run]) for run in members)
        else:
            for number, first in enumerate(range(0, len(members), kind.runs_per_file)):
                yield out / f"{split}-{number:05d}{kind.ending}", members[first : first + kind.runs_per_file]


def _run_table(data: DataSet, run_ids: Sequence[str]) -> Any:
    """Return parameters and labels of these runs, with lists as JSON: a text of numpy would lose digits and values."""
    table = data.runs.loc[list(run_ids)]
    return table.apply(lambda column: column.map(_json) if column.dtype == object else column)


def _json(values: Any) -> str | None:
    return None if values is None else json.dumps([None if each != each else each for each in values.tolist()])


def _channel_table(run: ExportedRun) -> Any:
    import pandas as pd

    rows = [{"name": each.name, "unit": each.unit, **each.facts} for each in run.channels]
    return pd.DataFrame(rows).assign(sample_rate_hz=run.sample_rate_hz)
