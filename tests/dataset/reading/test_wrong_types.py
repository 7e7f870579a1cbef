"""Python functions given what is of another type: one line, and never a wrong result."""

from pathlib import Path

import numpy as np
import pytest

import rubgen
from rubgen.errors import UserError

MINIMAL = {"name": "a", "runs": 1, "machine": "zeng2019"}


@pytest.fixture(scope="module")
def data(shown_set):
    return rubgen.open(shown_set)


@pytest.mark.parametrize("key", [0, None, slice(0, 1), ["run-000000"], {"run-000000"}, float("nan")])
def test_what_is_no_name_of_a_run(data, key):
    assert key not in data
    for refused in (lambda: data[key], lambda: data.signals(key), lambda: data.touches(key)):
        with pytest.raises(UserError, match="give one of run-000000"):
            refused()


@pytest.mark.parametrize("channels", [3, [3], [["proximity_x"]], "proximity_x", [None]])
def test_what_is_no_list_of_channels(data, channels):
    with pytest.raises(UserError, match=r"give a list of names|no channel"):
        data.signals("run-000000", channels)


def test_channels_come_in_any_collection_and_each_once(data):
    wanted = data.signals("run-000000", ["proximity_x", "casing_acc_0"])
    twice = ["proximity_x", "casing_acc_0", "proximity_x"]
    for channels in ((each for each in twice), twice, np.array(twice)):
        found = data.signals("run-000000", channels)
        assert list(found) == list(wanted)
        assert all(np.array_equal(found[name], wanted[name]) for name in wanted)


@pytest.mark.parametrize("runs", [3, True, "run-000000", [3], [["run-000000"]], [None], (each for each in ())])
def test_what_is_no_list_of_runs(data, runs):
    with pytest.raises(UserError, match=r"give a list of names|no run |give the name of at least one run"):
        data.arrays(runs=runs)


def test_runs_come_in_any_collection_and_each_once(data):
    wanted = data.arrays(["proximity_x"], "speed_rpm", runs=["run-000001", "run-000000"])
    twice = ["run-000001", "run-000000", "run-000001"]
    for runs in ((each for each in twice), tuple(twice), np.array(twice), data.runs.loc[twice].index):
        found = data.arrays(["proximity_x"], "speed_rpm", runs=runs)
        assert all(np.array_equal(one, other) for one, other in zip(found, wanted, strict=True))


@pytest.mark.parametrize("name", [None, 3, ["rub"], {"rub"}, np.array(["rub", "motion"])])
def test_what_is_no_name_of_a_column(data, name):
    with pytest.raises(UserError, match=r"^.+: no target .+; "):
        data.arrays(target=name)
    with pytest.raises(UserError, match=r"^by = .+: the set has no such column; use 'machine_id'$"):
        data.folds(2, by=name)
    if not isinstance(name, np.ndarray | None):
        with pytest.raises(UserError, match=r"no split .+; it has train$"):
            data.arrays(split=name)


@pytest.mark.parametrize("directory", [3, None, b"out", ["out"]])
def test_what_is_no_path(directory):
    for refused in (rubgen.open, rubgen.verify, lambda out: rubgen.generate(MINIMAL, out)):
        with pytest.raises(UserError, match="is no path; give the directory of a data set"):
            refused(directory)


@pytest.mark.parametrize("workers", ["2", 1.5, True, float("nan"), 0])
def test_what_is_no_number_of_workers(tmp_path, workers):
    with pytest.raises(UserError, match=f"--workers {workers}: must be at least 1; give a number of processes"):
        rubgen.generate(MINIMAL, tmp_path / "set", workers=workers)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("shard", [3, 1.5, True, "", "1/0", "0/2", "3/2", "-1/2", "a/b", "1/2/3", "1/1.5"])
def test_what_is_no_part_of_a_set(tmp_path, shard):
    with pytest.raises(UserError, match=f"^--shard {shard}: give number/count, the number from 1 to the count, "):
        rubgen.generate(MINIMAL, tmp_path / "set", shard=shard)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("directories", ["sets", None, 3, Path("sets")])
def test_what_is_no_list_of_sets_to_merge(tmp_path, directories):
    with pytest.raises(UserError, match=r"^merge: .+: is no list of directories; give two or more$"):
        rubgen.merge(directories, tmp_path / "set")


@pytest.mark.parametrize("scenario", [None, "zeng2019", MINIMAL, rubgen.load_recipe()])
def test_what_is_no_scenario(scenario):
    with pytest.raises(UserError, match=r"is no scenario; give rubgen.make_scenario\(...\) or recipe.scenario\(0\)"):
        rubgen.simulate(scenario)
