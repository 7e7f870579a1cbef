"""Arrays and windows for learning: the samples that the files have, the answers of their own stretch, groups apart."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import rubgen
from rubgen.dataset.reading.answers import Answers
from rubgen.dataset.reading.cutting import SAMPLES_PER_TURN, cut_of
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.reading.samples import WindowIndex
from rubgen.errors import RubgenWarning, UserError
from rubgen.io.columns import Column, Role
from rubgen.io.parquet.write import recipe_schema
from rubgen.labels import MOTION_CLASSES
from rubgen.scenario import load_recipe


@pytest.fixture(scope="module")
def data(small_set):
    return rubgen.open(small_set.directory)


@pytest.fixture(scope="module")
def edges(data):
    """Start and end of the windows of 16 turns of each run, from its first sample on."""
    cuts = []
    for run_id in data:
        starts = np.asarray(data.row(run_id)["window_starts_s"])
        turn = 60 / data.row(run_id)["speed_rpm"]
        ends = np.append(starts[1:], 110 * turn)
        cuts.append(np.column_stack([starts, ends]) - data.touches(run_id).attrs["first_sample_s"])
    return cuts


def test_arrays_are_the_signals(data, tmp_path):
    X, y, groups = data.arrays(["casing_acc_90", "proximity_x"], "rub")
    assert (X.shape, X.dtype, y.dtype) == ((4, 2, 15872), np.float32, np.int64)
    for run_id, row in zip(data, X, strict=True):
        signals = data.signals(run_id)
        np.testing.assert_array_equal(row, [signals["casing_acc_90"], signals["proximity_x"]])
    assert y.tolist() == data.runs["rub"].astype(int).tolist()
    assert groups.tolist() == list(data)  # one machine: runs stay whole
    mapped = data.arrays(["casing_acc_90", "proximity_x"], out=tmp_path / "X.npy").X
    assert isinstance(mapped, np.memmap)
    np.testing.assert_array_equal(np.load(tmp_path / "X.npy"), X)


def test_the_default_channels_are_what_a_sensor_could_record(data):
    assert set(data.channels) - set(data.inputs) == {"contact_force"}
    assert data.arrays(runs=["run-000001", "run-000000"]).X.shape == (2, len(data.inputs), 15872)


def test_windows_of_time_are_pieces_of_the_signals(data):
    found = data.windows(["proximity_y"], seconds=0.1, runs=["run-000002", "run-000000"])
    assert found.X.shape == (12, 1, 2560)
    assert found.run_ids.tolist() == ["run-000002"] * 6 + ["run-000000"] * 6
    np.testing.assert_allclose(found.start[:6], 0.1 * np.arange(6))
    for run_id in ("run-000002", "run-000000"):
        joined = found.X[found.run_ids == run_id].ravel()
        np.testing.assert_array_equal(joined, data.signals(run_id)["proximity_y"][:15360])
    near = data.windows(["proximity_y"], seconds=0.1, hop=0.05)
    assert len(near.X) == 4 * 11
    np.testing.assert_array_equal(near.X[:11:2], found.X[6:])


def test_answers_of_windows_are_the_labels_by_window(data, edges):
    """The labels by window count steps of the integration; the answers cut touches."""
    runs = list(data)
    rows = [data.row(run_id) for run_id in runs]
    duty = Answers(data, "contact_duty").of_windows(runs, edges)
    np.testing.assert_allclose(duty, np.concatenate([row["window_contact_duty"] for row in rows]), rtol=0, atol=1e-9)
    assert duty.max() > 0.01
    impulse = Answers(data, "contact_impulse_per_turn_n_s").of_windows(runs, edges)
    expected = np.concatenate([row["window_impulse_per_turn_n_s"] for row in rows])
    np.testing.assert_allclose(impulse, expected, rtol=1e-3, atol=1e-3 * expected.max())
    rub = Answers(data, "rub").of_windows(runs, edges)
    np.testing.assert_array_equal(rub, np.concatenate([row["window_rub"] for row in rows]))
    assert set(rub) == {0, 1}


def test_the_motion_of_a_window_is_that_of_its_stretch(data, monkeypatch):
    run_id = data.ok.index[0]
    row = data.row(run_id) | {
        "window_starts_s": [0.0, 0.1, 0.2, 0.3, 0.4],
        "window_motion_classes": [1, -1, 3, 3, 0],
    }
    monkeypatch.setattr(data, "row", lambda _: row)
    edges = np.array([[0.0, 0.1], [0.25, 0.4], [0.41, 0.5], [0.05, 0.3]]) - data.touches(run_id).attrs["first_sample_s"]
    found = Answers(data, "motion").of_windows([run_id], [edges])  # the last begins in one class and ends in another
    assert found.tolist() == [MOTION_CLASSES[word] for word in ("period-k", "chaotic", "period-1", "undecided")]


def test_windows_of_turns_have_equal_angles_whatever_the_speed():
    """A run-up from 50 to 150 turns a second: cos(3 theta) is the same in every turn."""
    rate, seconds = 25600.0, 1.0
    time = np.arange(rate * seconds) / rate
    signal = np.cos(3 * 2 * np.pi * (50 * time + 50 * time**2) + 0.4)[None].astype(np.float32)
    turns = np.arange(1, 100)
    pulses = (-50 + np.sqrt(2500 + 200 * turns)) / 100
    cut = cut_of(None, 4, 2, rate, tacho=True)
    edges = cut.pieces(pulses, time.size)
    found = np.array([*map(cut.cutter(signal, pulses), edges[:, 0])])
    assert found.shape == (len(edges), 1, 4 * SAMPLES_PER_TURN)
    assert len(edges) == 48
    expected = np.cos(3 * 2 * np.pi * np.arange(4 * SAMPLES_PER_TURN) / SAMPLES_PER_TURN + 0.4)
    inner = edges[:, 0] > 0.1
    assert np.abs(found[inner, 0] - expected).max() < 0.005


def test_windows_of_turns_are_read(data):
    found = data.windows(["proximity_x"], turns=16)
    assert found.X.shape[1:] == (1, 16 * SAMPLES_PER_TURN)
    assert set(found.run_ids) == set(data)
    assert (np.diff(found.start[found.run_ids == "run-000000"]) > 0).all()


def test_a_run_too_slow_for_a_window_is_left_out():
    """Its one pulse allows no window of turns; it is neither read nor cut."""
    pulses = {"fast": np.arange(9) / 80, "slow": np.array([0.05])}

    def recorded(runs, channels):
        yield from ((run, {name: np.zeros(100, np.float32) for name in channels}, pulses[run]) for run in runs)

    cut = cut_of(None, 4, None, 1000.0, tacho=True)
    starts = tuple(cut.pieces(each, 100)[:, 0] for each in pulses.values())
    data = SimpleNamespace(signal_seconds=0.1, sample_rate_hz=1000.0, recorded=recorded)
    index = WindowIndex(data, tuple(pulses), ("a",), cut, starts, np.zeros(1))
    (found,) = index.cutters([1, 0])
    assert (found[0], index.lengths) == (0, [1, 0])
    assert found[1](starts[0][0]).shape == (1, 4 * SAMPLES_PER_TURN)


@pytest.mark.parametrize("name", ["machines", "twins", "balanced", "rig", "surroundings"])
def test_every_column_of_the_runs_is_described(name):
    recipe = load_recipe(name)
    data = DataSet.__new__(DataSet)
    data.__dict__["_recipe"] = recipe
    assert [column.name for column in data.run_columns] == recipe_schema(recipe, signals=False).names


def test_folds_never_part_a_group(data):
    folds = data.folds(2, by="run_id")
    assert sorted(name for fold in folds for name in fold.test) == list(data)
    for train, test in folds:
        assert set(train) | set(test) == set(data)
        assert not set(train) & set(test)


def test_folds_by_machine_are_balanced_and_refuse_to_part_machines(data, monkeypatch):
    frame = data.runs.copy()
    frame["machine_id"] = pd.array(["a", "a", "b", "c"], dtype="string")
    frame["half"] = pd.array(["x", "y", "x", "y"], dtype="string")
    monkeypatch.setattr(data, "runs", frame)
    (first, second) = data.folds(2)
    assert (first.test, second.test) == (("run-000000", "run-000001"), ("run-000002", "run-000003"))
    assert data.groups_of(list(data)).tolist() == ["a", "a", "b", "c"]
    for by in ("run_id", "half"):
        with pytest.raises(UserError, match="machine a would be on both sides"):
            data.folds(2, by=by)
    frame["machine_id"] = "a"
    frame["twin_of"] = pd.array([None, "run-000000", None, None], dtype="string")
    assert data.groups_of(list(data)).tolist() == ["run-000000", "run-000000", "run-000002", "run-000003"]
    assert {"run-000000", "run-000001"} <= set(data.folds(3, by="run_id")[0].test)
    with pytest.raises(UserError, match="run and its twins run-000000 would be on both sides"):
        data.folds(2, by="half")


@pytest.mark.parametrize("storage", ["pyarrow", "python"])
def test_a_run_without_a_value_is_in_no_fold_and_a_warning_names_it(data, monkeypatch, storage):
    frame = data.runs.copy()
    frame["rig"] = pd.array(["a", None, "b", "b"], dtype=pd.StringDtype(storage))
    monkeypatch.setattr(data, "runs", frame)
    warned = pytest.warns(RubgenWarning, match="'rig': no fold has 1 run without a value, such as run-000001$")
    with pd.option_context("mode.string_storage", storage), warned:
        first, second = data.folds(2, by="rig")
    assert (first.train, first.test) == (second.test, second.train) == (("run-000000",), ("run-000002", "run-000003"))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda data: data.arrays(["proximity_z"]), "no channel 'proximity_z'; did you mean proximity_"),
        (lambda data: data.arrays([]), "no channel; give at least one"),
        (lambda data: data.arrays(target="rubs"), "no target 'rubs'; did you mean rub"),
        (lambda data: data.arrays(target="run_id"), "no target 'run_id'"),
        (lambda data: data.arrays(target="contact_zone_centres_rad"), "is a list of another length in each run"),
        (lambda data: data.arrays(split="test"), "no split 'test'; it has train"),
        (lambda data: data.arrays(split="train", runs=["run-000000"]), "give one of the two"),
        (lambda data: data.arrays(runs=[]), r"runs = \[\]: give the name of at least one run"),
        (lambda data: data.arrays(runs="run-000000"), r"give a list of names, \['run-000000'\]"),
        (lambda data: data.arrays(runs=["run-9"]), "no run 'run-9'"),
        (lambda data: data.arrays(out="X.bin"), "must end with .npy"),
        (lambda data: data.arrays(out="none/X.npy"), "the folder none does not exist; make it"),
        (lambda data: data.windows(seconds=0.1, out="none/X.npy"), "the folder none does not exist; make it"),
        (lambda data: data.windows(), "either in seconds or in turns"),
        (lambda data: data.windows(seconds=0.1, turns=4), "either in seconds or in turns"),
        (lambda data: data.windows(seconds=-1), "seconds = -1: must be a number above 0"),
        (lambda data: data.windows(seconds=True), "seconds = True: must be a number above 0"),
        (lambda data: data.windows(seconds=0.1, hop=0), "hop = 0: must be a number above 0"),
        (lambda data: data.windows(seconds=1e-9), "shorter than a sample"),
        (lambda data: data.windows(turns=2.5), "whole numbers; give 2"),
        (lambda data: data.windows(seconds=1.0), "longer than every signal; signals last 0.62 s"),
        (lambda data: data.windows(turns=200), "longer than every signal"),
        (lambda data: data.folds(1), "k = 1: must be a whole number of at least 2"),
        (lambda data: data.folds(2), "k = 2: the runs have 1 group by 'machine_id'; with one machine, by='run_id'"),
        (lambda data: data.folds(len(data.ok) + 1, by="run_id"), "groups by 'run_id'; take k = [0-9]+ or less$"),
        (lambda data: data.folds(2, by="engine"), "no such column; use 'machine_id'"),
    ],
)
def test_mistakes_are_one_line(call, message, data):
    with pytest.raises(UserError, match=message) as caught:
        call(data)
    assert "\n" not in str(caught.value)


def test_failed_runs_are_left_out_and_cannot_be_asked_for(small_set, monkeypatch):
    data = rubgen.open(small_set.directory)
    frame = data.runs.copy()
    frame["split"] = pd.array(["train", "train", "train", "test"], dtype="string")
    frame.loc[["run-000001", "run-000003"], "status"] = "diverged"
    monkeypatch.setattr(data, "runs", frame)
    assert data.groups_of(data.ok.index).tolist() == ["run-000000", "run-000002"]
    assert sorted(name for fold in data.folds(2, by="run_id") for name in fold.test) == ["run-000000", "run-000002"]
    assert set(data.windows(["proximity_x"], seconds=0.1, target="speed_rpm").run_ids) == {"run-000000", "run-000002"}
    with pytest.raises(UserError, match=r"split 'test' has no good run; see `rubgen info .+small`$"):
        data.arrays(split="test")
    frame["status"] = "diverged"
    with pytest.raises(UserError, match=r"the set has no good run; see `rubgen info"):
        data.windows(seconds=0.1)


def test_a_signal_of_another_length_is_no_sample(data, monkeypatch):
    def recorded(self, run_ids, channels=None):
        yield from ((run, {name: np.zeros(7, np.float32) for name in channels}, np.zeros(0)) for run in run_ids)

    monkeypatch.setattr(DataSet, "recorded", recorded)
    for read in (lambda: data.arrays(["proximity_x"]), lambda: data.windows(["proximity_x"], seconds=0.1)):
        with pytest.raises(UserError, match=r"^run-000000: proximity_x has 7 of 15872 samples; run rubgen verify$"):
            read()


def test_turns_need_a_tacho():
    with pytest.raises(UserError, match="no once_per_rev sensor, whose pulses turns need; give seconds"):
        cut_of(None, 16, None, 25600.0, tacho=False)


def test_one_class_alone_is_a_warning(data):
    alone = data.runs.index[data.runs["rub"]][0]
    with pytest.warns(RubgenWarning, match="all runs chosen have rub = True"):
        data.arrays(["proximity_x"], runs=[alone])


@pytest.mark.parametrize(
    ("kind", "name", "y", "said"),
    [
        ("class", "whirl", [-1], "undefined"),
        ("class", "motion", [-1], "undecided"),
        ("flag", "even", [np.nan], "undefined"),
    ],
)
def test_a_label_that_is_undefined_in_every_run_is_a_warning(kind, name, y, said):
    column = Column(name, kind, "", "", role=Role.TARGET)
    data = SimpleNamespace(run_columns=(column,), layout=SimpleNamespace(root="set"))
    with pytest.warns(RubgenWarning, match=f"all runs chosen have {name} = {said}"):
        Answers(data, name).warn_of_missing(np.array(y), None)
