"""Windows of a data set for PyTorch (the extra `rubgen[torch]`): by number, or as a shuffled stream."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from rubgen.dataset.layout import RUNS_PER_ROW_GROUP
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.reading.samples import window_index
from rubgen.errors import UserError

try:
    import torch
    from torch.utils.data import Dataset, IterableDataset, get_worker_info
except ImportError:
    raise UserError("rubgen.torch: the package torch is not installed; pip install 'rubgen[torch]'") from None


class Windows(Dataset):  # type: ignore[misc]
    """Windows of a data set by number, each with its answer: `DataLoader(Windows(data, seconds=0.25), batch_size=32)`.

    `windows[i]` is the window number i of `DataSet.windows` with the same arguments, and its answer, the value of the
    target. The window is a float32 tensor (channels, time). The answer is a tensor without dimension, an integer or
    float32, and for the target `faults` a tensor (kinds,). `y` are the answers of all windows, for weights and
    samplers. `windows[i]` reads the signals of its run; the last run that was read stays in memory. A shuffled order
    reads a row group of four runs for each window: `Stream` shuffles at less cost.

    Raises UserError as `DataSet.windows` does.
    """

    def __init__(
        self,
        data: DataSet,
        channels: Sequence[str] | None = None,
        *,
        seconds: float | None = None,
        turns: int | None = None,
        hop: float | None = None,
        target: str = "rub",
        split: str | None = None,
        runs: Sequence[str] | None = None,
    ) -> None:
        """Find the windows; see `DataSet.windows` for the arguments."""
        self._index = window_index(data, channels, data.cut(seconds, turns, hop), target, split, runs)
        self._firsts = np.concatenate([[0], np.cumsum(self._index.lengths)])
        self._last: tuple[int, Callable[[float], Any]] | None = None
        self.channels, self.y = self._index.channels, self._index.y

    def __len__(self) -> int:
        return len(self.y)

    def __getitem__(self, number: int) -> tuple[torch.Tensor, torch.Tensor]:
        """Return window and answer. Raises IndexError beyond the last window."""
        if not -len(self) <= number < len(self):
            raise IndexError(f"window {number} of {len(self)}")
        number %= len(self)
        run = int(np.searchsorted(self._firsts, number, side="right")) - 1
        if self._last is None or self._last[0] != run:
            self._last = next(self._index.cutters([run]))
        return self._sample(number, self._last[1](self._index.starts[run][number - self._firsts[run]]))

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"_last": None}

    def each(self, runs: Sequence[int]) -> Iterator[tuple[torch.Tensor, torch.Tensor]]:
        """Yield all windows of the runs with these positions in the index, one run in memory at a time."""
        for run, cutter in self._index.cutters(runs):
            for number, start in enumerate(self._index.starts[run], start=int(self._firsts[run])):
                yield self._sample(number, cutter(start))

    def _sample(self, number: int, window: Any) -> tuple[torch.Tensor, torch.Tensor]:
        answer = torch.as_tensor(self.y[number])
        return torch.tensor(window), answer.float() if answer.is_floating_point() else answer


class Stream(IterableDataset):  # type: ignore[misc]
    """All windows of a data set in a random order, each once an epoch: `DataLoader(Stream(Windows(data, turns=16)))`.

    Row groups of runs are shuffled, and the windows of `block` runs at a time are in memory and shuffled. Each run is
    read once an epoch. The workers of a DataLoader divide the row groups among them, so that no window comes twice. The
    order follows `torch.manual_seed` and differs from epoch to epoch. Processes of distributed training do not divide
    them.
    """

    def __init__(self, windows: Windows, block: int = 32) -> None:
        """Take the windows and the number of runs to shuffle together. Raises UserError for a block below one run."""
        if isinstance(block, bool) or not isinstance(block, int) or block < 1:
            raise UserError(f"block = {block!r:.60}: must be a whole number of runs, at least 1")
        self._windows, self._block, self._epoch = windows, block, 0

    def __iter__(self) -> Iterator[tuple[torch.Tensor, torch.Tensor]]:
        """Yield the windows of this worker, or all without workers."""
        worker = get_worker_info()
        part, parts = (worker.id, worker.num_workers) if worker else (0, 1)
        seed = worker.seed - worker.id if worker else int(torch.empty((), dtype=torch.int64).random_())
        common = np.random.default_rng([seed, self._epoch])  # a worker that persists has one seed for all epochs
        own = np.random.default_rng([seed, self._epoch, part])
        self._epoch += 1
        count = len(self._windows._index.runs)
        groups = [range(first, min(first + RUNS_PER_ROW_GROUP, count)) for first in range(0, count, RUNS_PER_ROW_GROUP)]
        order = [run for group in common.permutation(len(groups))[part::parts] for run in groups[group]]
        for first in range(0, len(order), self._block):
            block = list(self._windows.each(order[first : first + self._block]))
            yield from (block[place] for place in own.permutation(len(block)))
