"""Which windows `rubgen.torch` gives in which order, with a stand-in for torch, which most test machines lack."""

import importlib
import pickle
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import rubgen
from rubgen.errors import UserError

SAMPLE = Path(__file__).parents[3] / "datasets" / "sample"
ARGUMENTS = {"channels": ["proximity_x"], "seconds": 0.01, "hop": 0.008}


class Tensor(np.ndarray):
    """An array with the methods of a tensor that rubgen.torch calls."""

    def is_floating_point(self):
        return np.issubdtype(self.dtype, np.floating)

    def float(self):
        return self.astype(np.float32)

    def random_(self):
        return 12345


@pytest.fixture
def of_torch(monkeypatch):
    """The module rubgen.torch on the stand-in. `worker` of the result is what a DataLoader tells its worker."""
    torch, utils, data = ModuleType("torch"), ModuleType("torch.utils"), ModuleType("torch.utils.data")
    torch.int64 = np.int64
    torch.as_tensor = torch.tensor = lambda values: np.asarray(values).view(Tensor)
    torch.empty = lambda shape, dtype: np.empty(shape, dtype).view(Tensor)
    data.Dataset, data.IterableDataset = type("Dataset", (), {}), type("IterableDataset", (), {})
    made = SimpleNamespace(worker=None)
    data.get_worker_info = lambda: made.worker
    for module in (torch, utils, data):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.delitem(sys.modules, "rubgen.torch", raising=False)
    monkeypatch.setattr(rubgen, "torch", None, raising=False)
    module = importlib.import_module("rubgen.torch")
    made.Windows, made.Stream, made.module = module.Windows, module.Stream, module
    yield made
    sys.modules.pop("rubgen.torch", None)


@pytest.fixture(scope="module")
def data():
    return rubgen.open(SAMPLE)


@pytest.mark.parametrize(
    ("target", "kind"), [("rub", np.int64), ("contact_duty", np.float32), ("blades_touched", np.int64)]
)
def test_a_window_by_its_number_is_that_of_the_set(of_torch, data, target, kind):
    whole, windows = data.windows(**ARGUMENTS, target=target), of_torch.Windows(data, **ARGUMENTS, target=target)
    assert len(windows) == len(whole.y) == 4 * 7
    for number in (*range(len(windows)), 3, -1, -len(windows)):  # also backwards, from another run, and from the end
        window, answer = windows[number]
        assert (window.dtype, answer.dtype, answer.shape) == (np.float32, kind, ())
        assert np.array_equal(window, whole.X[number])
        assert answer == kind(whole.y[number])
    for number in (len(windows), -len(windows) - 1):
        with pytest.raises(IndexError, match=f"window {number} of 28"):
            windows[number]


def test_successive_windows_read_each_run_once(of_torch, data, monkeypatch):
    read = []
    true = type(data).recorded

    def recorded(self, run_ids, channels=None):
        read.extend(run_ids)
        return true(self, run_ids, channels)

    windows = of_torch.Windows(data, **ARGUMENTS)
    monkeypatch.setattr(type(data), "recorded", recorded)
    assert len([windows[number] for number in range(len(windows))]) == 28
    assert read == list(data)


def test_what_is_pickled_has_no_signals_and_gives_the_same_windows(of_torch, data):
    windows = of_torch.Windows(data, **ARGUMENTS, runs=["run-000001", "run-000000"])
    expected = [windows[number][0] for number in range(len(windows))]
    packed = pickle.dumps(windows)
    assert len(packed) < 20_000
    again = pickle.loads(packed)  # noqa: S301
    assert all(np.array_equal(again[number][0], window) for number, window in enumerate(expected))


def first_samples(stream):
    return [float(window[0, 0]) for window, _ in stream]


@pytest.mark.parametrize("workers", [1, 2, 3, 5])
@pytest.mark.parametrize("block", [1, 3, 32])
def test_workers_share_the_windows_of_an_epoch(of_torch, data, monkeypatch, workers, block):
    """Every window once, in another order than that of the set and of the epoch before; both with its own answer."""
    monkeypatch.setattr(of_torch.module, "RUNS_PER_ROW_GROUP", 1)
    whole = data.windows(**ARGUMENTS)
    streams = [of_torch.Stream(of_torch.Windows(data, **ARGUMENTS), block) for _ in range(workers)]
    epochs = []
    for _ in range(2):
        found = []
        for number, stream in enumerate(streams):  # a worker that persists has the same seed in each epoch
            of_torch.worker = SimpleNamespace(id=number, num_workers=workers, seed=77 + number)
            found += [(bytes(window), int(answer)) for window, answer in stream]
        assert sorted(found) == sorted(
            (bytes(window), int(answer)) for window, answer in zip(whole.X, whole.y, strict=True)
        )
        assert [window for window, _ in found] != [bytes(window) for window in whole.X]
        epochs.append(found)
    assert epochs[0] != epochs[1]


def test_the_order_follows_the_seed_of_torch(of_torch, data):
    def stream():
        return of_torch.Stream(of_torch.Windows(data, **ARGUMENTS))

    assert first_samples(stream()) == first_samples(stream())
    of_torch.worker = SimpleNamespace(id=0, num_workers=1, seed=12345)
    assert first_samples(stream()) == first_samples(stream())
    persistent = stream()  # its one row group leaves nothing but the order within the block to change
    assert first_samples(persistent) != first_samples(persistent)
    of_torch.worker = SimpleNamespace(id=0, num_workers=1, seed=54321)
    other = first_samples(stream())
    of_torch.worker = None
    assert sorted(other) == sorted(first_samples(stream()))
    assert other != first_samples(stream())


def test_a_block_of_one_run_stays_together(of_torch, data):
    stream = of_torch.Stream(of_torch.Windows(data, **ARGUMENTS), block=1)
    whole = data.windows(**ARGUMENTS)
    runs = dict(zip(map(bytes, whole.X), whole.run_ids, strict=True))
    order = [runs[bytes(window)] for window, _ in stream]
    assert [order[at : at + 7] for at in range(0, 28, 7)] == [[run] * 7 for run in order[::7]]


@pytest.mark.parametrize("block", [0, -1, True, 2.5, "3"])
def test_a_block_is_a_number_of_runs(of_torch, data, block):
    with pytest.raises(UserError, match=r"^block = .+: must be a whole number of runs, at least 1$"):
        of_torch.Stream(of_torch.Windows(data, **ARGUMENTS), block)


def test_without_torch_one_line_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    monkeypatch.delitem(sys.modules, "rubgen.torch", raising=False)
    with pytest.raises(
        UserError, match=r"^rubgen.torch: the package torch is not installed; pip install 'rubgen\[torch\]'$"
    ):
        importlib.import_module("rubgen.torch")
