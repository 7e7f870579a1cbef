"""Edges: a window as long as the signal, touches that overlap or are stored in any order, files of swapped runs."""

import numpy as np
import pandas as pd
import pytest

import rubgen
from rubgen.dataset.reading import open as opening
from rubgen.dataset.reading.answers import _duty
from rubgen.dataset.reading.cutting import cut_of
from rubgen.dataset.reading.recorded import exported_signals
from rubgen.errors import UserError


@pytest.fixture(scope="module")
def data(small_set):
    return rubgen.open(small_set.directory)


@pytest.mark.parametrize(
    ("seconds", "hop", "starts"),
    [
        (1.0, None, [0]),
        (0.5, None, [0, 50]),
        (0.5, 0.25, [0, 25, 50]),
        (0.51, None, [0]),
        (0.01, 0.99, [0, 99]),
        (1.01, None, []),
    ],
)
def test_windows_reach_the_last_sample_and_not_beyond(seconds, hop, starts):
    cut = cut_of(seconds, None, hop, 100.0, tacho=False)
    edges = cut.pieces(np.zeros(0), 100)
    assert np.round(edges[:, 0] * 100).tolist() == starts
    assert (edges[:, 1] <= 1.0).all()
    take = cut.cutter(np.arange(100, dtype=np.float32)[None], np.zeros(0))
    assert [take(start)[0].tolist() for start in edges[:, 0]] == [
        list(range(first, first + round(seconds * 100))) for first in starts
    ]


def test_a_window_may_be_the_whole_signal(data):
    found = data.windows(["proximity_x"], seconds=data.signal_seconds)
    np.testing.assert_array_equal(found.X, data.arrays(["proximity_x"]).X)


@pytest.mark.parametrize(
    ("touches", "share"),
    [
        ([(1, 3), (2, 4)], 0.3),  # two blades at once count once
        ([(0, 8), (1, 2), (3, 4)], 0.8),  # one within another
        ([(1, 2), (1, 2)], 0.1),
        ([(-5, 1), (9, 20)], 0.2),  # beyond both ends
        ([(1, 2), (2, 3)], 0.2),
        ([(-5, -1), (11, 12)], 0.0),
    ],
)
def test_time_in_which_several_blades_touch_counts_once(touches, share):
    frame = pd.DataFrame(touches, columns=["start_s", "end_s"])
    assert _duty({}, frame, np.array([[0.0, 10.0]])) == pytest.approx([share])
    halves = _duty({}, frame, np.array([[0.0, 5.0], [5.0, 10.0]]))
    assert halves.mean() == pytest.approx(share)


def test_touches_are_in_the_order_of_their_start_however_they_are_stored(data, monkeypatch):
    run_id = data.ok.index[data.ok["rub"]][0]
    expected, true = data.touches(run_id), opening.read_touches

    def reversed_touches(*arguments):
        record = true(*arguments)
        names = ("start_step", "steps", "blade", "angle", "impulse", "friction_loss", "normal_loss")
        return {**record, **{name: record[name][::-1] for name in names}}

    monkeypatch.setattr(opening, "read_touches", reversed_touches)
    found = data.touches(run_id)
    assert found["start_s"].is_monotonic_increasing
    key = ["start_s", "blade"]
    pd.testing.assert_frame_equal(
        found.sort_values(key, ignore_index=True), expected.sort_values(key, ignore_index=True)
    )


def test_a_file_of_another_run_is_not_read_as_this_one(copied_set):
    first, second = (copied_set / f"mcap/0000/run-00000{number}.mcap" for number in (0, 1))
    first.write_bytes(second.read_bytes())
    data = rubgen.open(copied_set)
    signals = exported_signals(data.layout, data.manifest, ["run-000001", "run-000000"], ["proximity_x"])
    run_id, table = next(signals)
    assert run_id == "run-000001"
    np.testing.assert_array_equal(table["proximity_x"][0].values, data.signals("run-000001")["proximity_x"])
    with pytest.raises(UserError, match=r"run-000000\.mcap: holds run-000001; run rubgen verify$"):
        next(signals)
