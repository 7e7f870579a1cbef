"""Mode shapes by number, family and nodal diameters."""

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from rubgen.viz.figures import mode_shapes


@pytest.fixture(scope="module")
def model():
    return reduce(load_machine("zeng2019"), Reduction())


def titles(figure):
    return [axes.get_title() for axes in figure.axes if axes.get_title()]


@pytest.mark.parametrize(
    ("modes", "count", "words"),
    [
        ("7", 1, "7: "),
        ("casing 3", 1, "casing 3: "),
        ("lateral", 2, "lateral"),
        ("ND 4", 6, "ND 4"),
        ("blade 1 nd 2", 2, "blade 1"),
        ("casing ND 2", 2, "casing"),
    ],
)
def test_modes_are_chosen(model, modes, count, words):
    found = titles(mode_shapes(model, modes))
    assert len(found) == count
    assert all(words in title for title in found)
    assert all("ND " in title for title in found)


def test_the_drawn_wave_has_the_diameters_of_its_title(model):
    figure = mode_shapes(model, "blade 1 ND 3, blade 2 ND 3")
    for axes in figure.axes:
        if axes.get_title():
            ring, drawn = (line.get_xydata()[:-1] for line in axes.lines)
            outward = np.sum(ring * (drawn - ring), axis=1)
            assert np.argmax(np.abs(np.fft.rfft(outward))) == 3


def test_choices_add_up_once_each_and_many_are_cut(model):
    assert [title.split(":")[0] for title in titles(mode_shapes(model, "9, 2,casing 1, 9"))] == ["9", "2", "casing 1"]
    figure = mode_shapes(model, "casing, blade 1")
    assert len(titles(figure)) == 24
    assert figure.get_suptitle().endswith("the first 24 of 47")


@pytest.mark.parametrize("modes", ["0", "115", "casing 99", "blade 9", "ND", "", "7,,8", "ND 2 blade 1"])
def test_a_mode_that_does_not_exist_is_named(model, modes):
    with pytest.raises(ValueError, match="no such mode; give a number from 1 to 114, a family"):
        mode_shapes(model, modes)
