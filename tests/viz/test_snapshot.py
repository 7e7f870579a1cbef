"""Frames of an animation lie about the hardest touch."""

from types import SimpleNamespace

import numpy as np
import pytest

from rubgen.viz.figures.snapshot import GIF_FRAMES, frames_about


def frames(dense):
    return SimpleNamespace(time=0.1 * np.arange(len(dense)), dense=np.array(dense))


@pytest.mark.parametrize(("time", "first"), [(0.0, 50), (17.0, 138), (30.0, 236), (40.0, 236)])
def test_dense_frames_with_the_time_in_the_middle_are_chosen(time, first):
    few = frames([0] * 50 + [1] * 250 + [0] * 40)
    assert frames_about(few, time).tolist() == list(range(first, first + GIF_FRAMES))


def test_without_dense_frames_all_count_and_few_are_all_taken():
    assert frames_about(frames([0] * 100), 5.0).tolist() == list(range(18, 18 + GIF_FRAMES))
    assert frames_about(frames([1] * 3), 9.0).tolist() == [0, 1, 2]
