"""Windows for PyTorch: those of `DataSet.windows`, each once, in one process and in workers."""

import pickle

import numpy as np
import pytest

import rubgen
from rubgen.errors import UserError

torch = pytest.importorskip("torch", reason="torch is not installed: it has 900 MB, more than the rest of the tests")

from torch.utils.data import DataLoader  # noqa: E402

from rubgen.torch import Stream, Windows  # noqa: E402

ARGUMENTS = {"channels": ["proximity_x", "casing_acc_90"], "seconds": 0.05, "hop": 0.04}


@pytest.fixture(scope="module")
def data(small_set):
    return rubgen.open(small_set.directory)


@pytest.fixture(scope="module")
def whole(data):
    return data.windows(**ARGUMENTS)


@pytest.mark.parametrize("target", ["rub", "contact_duty", "blades_touched"])
def test_windows_are_those_of_the_set(data, target):
    whole, windows = data.windows(**ARGUMENTS, target=target), Windows(data, **ARGUMENTS, target=target)
    assert len(windows) == len(whole.y) > 50
    for number in (0, 1, 14, 15, 16, len(windows) - 1, -1):
        window, answer = windows[number]
        assert (window.dtype, answer.dtype) == (
            torch.float32,
            torch.float32 if target == "contact_duty" else torch.int64,
        )
        assert np.array_equal(window.numpy(), whole.X[number])
        assert answer.item() == pytest.approx(whole.y[number], rel=1e-6)
    with pytest.raises(IndexError):
        windows[len(windows)]


def test_windows_of_turns_are_those_of_the_set(data):
    whole, windows = data.windows(["proximity_x"], turns=8), Windows(data, ["proximity_x"], turns=8)
    assert all(np.array_equal(windows[i][0].numpy(), whole.X[i]) for i in (0, 3, len(windows) - 1))


def test_what_is_pickled_has_no_signals(data):
    windows = Windows(data, **ARGUMENTS)
    windows[0]
    again = pickle.dumps(windows)
    assert len(again) < 20_000
    assert torch.equal(pickle.loads(again)[5][0], windows[5][0])  # noqa: S301


@pytest.mark.parametrize("start", ["fork", "spawn"])
def test_workers_read_windows_by_number(data, whole, start):
    loader = DataLoader(Windows(data, **ARGUMENTS), batch_size=16, num_workers=2, multiprocessing_context=start)
    assert np.array_equal(torch.cat([window for window, _ in loader]).numpy(), whole.X)


@pytest.mark.parametrize("workers", [0, 1, 2])
@pytest.mark.parametrize("block", [1, 3, 32])
def test_a_stream_has_every_window_once_whatever_the_number_of_workers(data, whole, workers, block, monkeypatch):
    monkeypatch.setattr("rubgen.torch.RUNS_PER_ROW_GROUP", 1)
    loader = DataLoader(Stream(Windows(data, **ARGUMENTS), block), batch_size=7, num_workers=workers)
    found = torch.cat([window for window, _ in loader]).numpy()
    assert sorted(map(bytes, found)) == sorted(map(bytes, whole.X))
    assert not np.array_equal(found, whole.X)


def test_the_order_follows_the_seed_and_changes_each_epoch(data):
    stream = Stream(Windows(data, **ARGUMENTS))
    loader = DataLoader(stream, batch_size=None, num_workers=1, persistent_workers=True)
    torch.manual_seed(1)
    first, second = ([float(window[0, 0]) for window, _ in loader] for _ in range(2))
    assert first != second
    assert sorted(first) == sorted(second)
    torch.manual_seed(1)
    again = DataLoader(Stream(Windows(data, **ARGUMENTS)), batch_size=None, num_workers=1)
    assert [float(window[0, 0]) for window, _ in again] == first


@pytest.mark.parametrize("block", [0, True, 2.5])
def test_a_block_has_whole_runs(data, block):
    with pytest.raises(UserError, match="must be a whole number of runs"):
        Stream(Windows(data, **ARGUMENTS), block)
