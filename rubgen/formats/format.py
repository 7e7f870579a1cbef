"""The declaration of a file format, and the lookup of formats by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.format_names import FORMAT_NAMES

if TYPE_CHECKING:
    from rubgen.pipeline import Run
    from rubgen.viz.replay import Replay


@dataclass(frozen=True, kw_only=True)
class RunSignals:
    """The signals in a file of one run: number of the run, samples by column name, arrival times of the pulses in s."""

    number: int
    channels: dict[str, npt.NDArray[np.float32]]
    once_per_rev: FloatArray


def _no_problem(_path: Path, _run_id: str, _proven: bool) -> Sequence[str]:
    return ()


@dataclass(frozen=True, kw_only=True)
class Format:
    """One file format of runs: how a file is written, checked, read and described to users.

    Its module imports libraries only inside functions, so that commands that do not need them stay fast.
    """

    name: str
    """Name in a recipe, and the ending of its files after the dot."""
    about: str
    """What one does with a file, in a few words."""
    loading: str
    """How to load it, Markdown for the card of a data set; CHANNEL stands for the name of a channel."""
    ways: dict[str, str] = field(default_factory=dict)
    """Lines of Python by title for the report; DIR, RUN and CHANNEL stand for the set, a run and a channel."""
    look: str = ""
    """One line after `rubgen generate`, of {folder}, the {first} file and the command {rerun}."""
    write: Callable[[Run, Path], None]
    """Writes one run to a file, complete or not at all; raises OSError where it cannot be written."""
    problems: Callable[[Path, str, bool], Iterable[str]] = _no_problem
    """(path, run_id, proven): what is wrong in a file of that run; `proven` if its sha256 in derived.json is right."""
    signals: Callable[[Path, Sequence[str]], RunSignals] | None = None
    """(path, names): signals of a file with the channels of these names, where a data set can be read from such files.
    Raises UserError for a file that cannot be read."""
    remake: Callable[[Replay, Path], None] | None = None
    """Writes the file again from a replay. A format with it is a derived view: its bytes may differ between writings,
    its digests stand in derived.json, and `rubgen repair` makes it again."""
    one_file_a_run: bool = True
    """Whether a data set has one file of it for each good run; Parquet has shards of many runs."""

    @property
    def suffix(self) -> str:
        """Ending of the files, with the dot."""
        return f".{self.name}"


def format_of(name: str) -> Format:
    """Return the format called `name`, which is one of FORMAT_NAMES."""
    found: Format = import_module(f"rubgen.formats.{name}").FORMAT
    return found


def run_formats(names: Iterable[str] = FORMAT_NAMES) -> list[Format]:
    """Return the named formats that have one file for each run, in the order of FORMAT_NAMES."""
    chosen = set(names)
    found = [format_of(name) for name in FORMAT_NAMES if name in chosen]
    return [each for each in found if each.one_file_a_run]
