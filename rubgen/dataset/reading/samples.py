"""Arrays for learning: recorded channels of whole runs, or of windows of them, each with its answer and its group."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from rubgen.arrays import FloatArray
from rubgen.brief import in_shell
from rubgen.dataset.reading.answers import Answers
from rubgen.dataset.reading.cutting import Cut
from rubgen.errors import UserError
from rubgen.measurement.channel import Float32Array

if TYPE_CHECKING:
    from rubgen.dataset.reading.open import DataSet


class Arrays(NamedTuple):
    """Channels of whole runs, one row for each good run, in the order of the set, or of the given names of runs."""

    X: Float32Array
    """Samples (runs, channels, time), each channel in its unit of `DataSet.units`."""
    y: npt.NDArray[Any]
    """Answer of each run: see `DataSet.arrays`."""
    groups: npt.NDArray[np.str_]
    """What must stay on one side of a split (runs,)."""


class Windows(NamedTuple):
    """Windows of channels, in the order of the runs and of time."""

    X: Float32Array
    """Samples (windows, channels, time)."""
    y: npt.NDArray[Any]
    """Answer of each window: see `DataSet.windows`."""
    groups: npt.NDArray[np.str_]
    """What must stay on one side of a split (windows,): windows of one run have one group."""
    start: FloatArray
    """Start of each window in s from the first sample of its run (windows,)."""
    run_ids: npt.NDArray[np.str_]
    """Run of each window (windows,)."""


def arrays(
    data: DataSet,
    channels: Sequence[str] | None,
    target: str,
    split: str | None,
    runs: Sequence[str] | None,
    out: Path | str | None,
) -> Arrays:
    """Read whole runs as arrays. Arguments and errors are as in `DataSet.arrays`."""
    chosen, names = chosen_runs(data, split, runs), chosen_channels(data, channels)
    answers = Answers(data, target)
    y = answers.of_runs(chosen)
    answers.warn_of_missing(y, split)
    samples = _space(out, (len(chosen), len(names), _samples(data)))
    for row, (run_id, signals, _) in enumerate(data.recorded(chosen, names)):
        samples[row] = _stacked(run_id, signals, names, samples.shape[-1])
    return Arrays(samples, y, data.groups_of(chosen))


@dataclass(frozen=True)
class WindowIndex:
    """The positions of the windows of a data set, and their answers. It contains no samples."""

    data: DataSet
    runs: tuple[str, ...]
    channels: tuple[str, ...]
    cut: Cut
    starts: tuple[FloatArray, ...]
    """Starts in s from the first sample of the windows of each run."""
    y: npt.NDArray[Any]
    """Answer of each window."""

    @property
    def lengths(self) -> list[int]:
        """Number of windows of each run."""
        return [each.size for each in self.starts]

    def cutters(self, numbers: Iterable[int]) -> Iterator[tuple[int, Callable[[float], Float32Array]]]:
        """Yield for each run its position in `runs`, and the function that cuts its windows (`Cut.cutter`).

        `numbers` are the positions in `runs` of the runs to read. A run without windows is left out. One run is in
        memory at a time.
        """
        numbers = [number for number in numbers if self.starts[number].size]
        count = _samples(self.data)
        chosen = [self.runs[number] for number in numbers]
        for number, (run_id, signals, pulses) in zip(numbers, self.data.recorded(chosen, self.channels), strict=True):
            yield number, self.cut.cutter(_stacked(run_id, signals, self.channels, count), pulses)


def window_index(
    data: DataSet, channels: Sequence[str] | None, cut: Cut, target: str, split: str | None, runs: Sequence[str] | None
) -> WindowIndex:
    """Find the windows of runs and their answers.

    The arguments are as in `DataSet.windows`; `cut` is from `DataSet.cut`. Raises UserError as `DataSet.windows` does.
    """
    chosen, names = chosen_runs(data, split, runs), chosen_channels(data, channels)
    answers = Answers(data, target)
    count = _samples(data)
    pieces = [cut.pieces(pulses, count) for pulses in _pulses(data, chosen, cut)]
    if not any(map(len, pieces)):
        raise UserError(f"{data.layout.root}: {cut.text}: longer than every signal; {cut.advice(count)}")
    y = answers.of_windows(chosen, pieces)
    answers.warn_of_missing(y, split)
    return WindowIndex(data, tuple(chosen), names, cut, tuple(edges[:, 0] for edges in pieces), y)


def windows(index: WindowIndex, out: Path | str | None) -> Windows:
    """Read all windows of an index.

    `out` is the path of a .npy file for the samples, or None, as in `DataSet.windows`. An existing file is overwritten.
    Raises UserError for another ending, and for a folder that does not exist.
    """
    samples = _space(out, (len(index.y), len(index.channels), index.cut.samples))
    row = 0
    for number, cutter in index.cutters(range(len(index.runs))):
        for start in index.starts[number]:
            samples[row] = cutter(start)
            row += 1
    return Windows(
        samples,
        index.y,
        np.repeat(index.data.groups_of(index.runs), index.lengths),
        np.concatenate(index.starts),
        np.repeat(np.array(index.runs, dtype=np.str_), index.lengths),
    )


def chosen_runs(data: DataSet, split: str | None, runs: Sequence[str] | None) -> list[str]:
    """Return the names of the good runs (status ok) of `split`, or of the list `runs`, each once.

    If both are None, return all good runs of the set. The order is that of the set, or of the list. Raises UserError
    where both are given, a split or run is unknown, `runs` is no list, the list is empty, a run of it failed, or the
    split or the set has no good run.
    """
    good = data.ok
    if split is not None and runs is not None:
        raise UserError(f"split = {split!r} and runs: give one of the two")
    if split is not None:
        known = list(dict.fromkeys(data.runs["split"]))
        if split not in known:
            raise UserError(f"{data.layout.root}: no split {split!r}; it has {', '.join(map(str, known))}")
        good = good[good["split"] == split]
    if runs is not None:
        if isinstance(runs, str):
            raise UserError(f"runs = {runs!r}: give a list of names, [{runs!r}]")
        try:
            wanted = list(runs)
        except TypeError:
            raise UserError(f"runs = {runs!r:.200}: give a list of names") from None
        if not wanted:
            raise UserError("runs = []: give the name of at least one run")
        for run_id in wanted:
            data.check_has_signals(run_id)
        return list(dict.fromkeys(wanted))
    if good.empty:
        where = f"split {split!r}" if split else "the set"
        raise UserError(f"{data.layout.root}: {where} has no good run; see `rubgen info {in_shell(data.layout.root)}`")
    return [str(run_id) for run_id in good.index]


def chosen_channels(data: DataSet, channels: Sequence[str] | None) -> tuple[str, ...]:
    """Return the names of the channels, each once, in the order of `channels`; for None all `data.inputs`.

    Raises UserError for an unknown name, and where no channel is chosen.
    """
    names = data.known_channels(data.inputs if channels is None else channels)
    if not names:
        raise UserError(f"{data.layout.root}: no channel; give at least one of {', '.join(data.channels)}")
    return names


def _pulses(data: DataSet, runs: Sequence[str], cut: Cut) -> Iterator[FloatArray]:
    """Yield the pulses of each run, read only where windows are counted in turns."""
    if not cut.turns:
        yield from (np.zeros(0) for _ in runs)
        return
    yield from (pulses for _, _, pulses in data.recorded(runs, ()))


def _samples(data: DataSet) -> int:
    """Return the number of samples of every channel of every run of a set."""
    return round(data.signal_seconds * data.sample_rate_hz)


def _space(out: Path | str | None, shape: tuple[int, int, int]) -> Float32Array:
    """Return an empty array in memory, or of a .npy file that is mapped into memory."""
    if out is None:
        return np.empty(shape, dtype=np.float32)
    path = Path(out)
    if path.suffix != ".npy":
        raise UserError(f"out = {str(out)!r}: must end with .npy; give the path of a file for numpy")
    if not path.parent.is_dir():
        raise UserError(f"out = {str(out)!r}: the folder {path.parent} does not exist; make it")
    return np.lib.format.open_memmap(path, mode="w+", dtype=np.float32, shape=shape)


def _stacked(run_id: str, signals: dict[str, Float32Array], names: Sequence[str], count: int) -> Float32Array:
    for name in names:
        if signals[name].size != count:
            raise UserError(f"{run_id}: {name} has {signals[name].size} of {count} samples; run rubgen verify")
    return np.stack([signals[name] for name in names])
