"""A data set in Rerun's catalog: served without a viewer, and read with the client of Rerun's SDK."""

import re

import pandas as pd
import pytest
from rerun.chunk import RrdReader

import rubgen
from rubgen.dataset.reading.browsing import rows_of
from rubgen.errors import RubgenWarning
from rubgen.sensors.kinds.proximity import Proximity
from rubgen.sensors.load import load_sensor_set
from rubgen.viz.catalog import Catalog
from rubgen.viz.views import previews


def test_each_run_is_a_row_with_its_parameters_labels_and_recording(copied_shown_set, table_of):
    """The set has two runs; the recording of one is missing and made from its MCAP file, outside the set."""
    (missing, *_) = sorted(copied_shown_set.glob("rrd/*/*.rrd"))
    missing.unlink()
    before = sorted(copied_shown_set.rglob("*"))
    runs = rubgen.open(copied_shown_set).runs
    table = table_of(copied_shown_set).set_index("property:run:run_id").sort_index()
    assert list(table.index) == list(runs.index)
    for name in ("speed_rpm", "friction", "motion", "contact_duty", "rub"):
        assert list(table[f"property:run:{name}"]) == list(runs[name]), name
    for name in ("disk_support_stiffness_n_per_m", "machine_id"):  # one value in all runs
        assert f"property:run:{name}" not in table
    assert all("rub" in text for text in table["property:run:headline"])
    assert list(table["property:labels:motion"]) == list(runs["motion"])  # from the recordings themselves
    assert table["time:end"].notna().all()
    assert sorted(copied_shown_set.rglob("*")) == before


def test_rows_have_previews_once_all_recordings_are_there(copied_shown_set, table_of, monkeypatch):
    """The viewer keeps an empty preview for ever, so a table that lacks a recording has none until it is made."""
    asked, arrange = [], Catalog.arrange

    def noted(catalog, columns, previews=()):
        asked.append([view.origin for view in previews])
        arrange(catalog, columns, previews)

    monkeypatch.setattr(Catalog, "arrange", noted)
    table_of(copied_shown_set)
    (path, *_) = sorted(copied_shown_set.glob("rrd/*/*.rrd"))
    found = {chunk.entity_path for chunk in RrdReader(path).stream().to_chunks()}
    assert asked == [["/orbit", "/preview/acceleration"]]
    assert all(any(f"{entity}/".startswith(f"{origin}/") for entity in found) for origin in asked[0])
    path.unlink()
    table_of(copied_shown_set)
    assert asked[1:] == [[], asked[0]]


def test_previews_are_of_what_the_sensors_record():
    sensors = load_sensor_set("default").sampled
    probes = [each for each in sensors if isinstance(each, Proximity)]
    assert [view.origin for view in previews(sensors)] == ["/orbit", "/preview/acceleration"]
    assert [view.origin for view in previews(probes[:1])] == ["/preview/displacement"]


def test_answers_of_a_model_stand_beside_the_truth(shown_set, table_of, tmp_path):
    runs = rubgen.open(shown_set).runs
    answers = pd.DataFrame({"run_id": [*runs.index, "run-000077"], "motion": [0, 3, 0], "score": [0.25, 0.75, 0.5]})
    answers["rub"] = [bool(runs["rub"].iloc[0]), not runs["rub"].iloc[1], True]
    answers.to_parquet(tmp_path / "answers.parquet")
    table = table_of(shown_set, "--predictions", tmp_path / "answers.parquet").set_index("property:run:run_id")
    table = table.loc[list(runs.index)]
    assert list(table["property:prediction:motion"]) == ["period-1", "chaotic"]
    right = [word == truth for word, truth in zip(["period-1", "chaotic"], runs["motion"], strict=True)]
    assert list(table["property:prediction:motion_right"]) == right
    assert list(table["property:prediction:rub_right"]) == [True, False]
    assert list(table["property:prediction:score"]) == [0.25, 0.75]
    assert "property:prediction:score_right" not in table


def test_answers_in_the_index_of_a_frame_are_found(shown_set, table_of, tmp_path):
    """A frame with the index of `data.runs`, as pandas writes it."""
    runs = rubgen.open(shown_set).runs
    pd.DataFrame({"rub": [1, 1]}, index=runs.index).to_parquet(tmp_path / "answers.parquet")
    table = table_of(shown_set, "--predictions", tmp_path / "answers.parquet").set_index("property:run:run_id")
    assert list(table.loc[runs.index, "property:prediction:rub_right"]) == list(runs["rub"])


def test_a_condition_chooses_the_runs_and_a_probability_stays_a_number(shown_set, table_of, tmp_path):
    path = tmp_path / "answers.csv"
    path.write_text("run_id,rub,motion,my note\nrun-000001,0.5,chaotic,a b\nrun-000000,0.25,chaotic,\n")
    table = table_of(shown_set, "--where", "run_id = 'run-000001'", "--predictions", path)
    assert list(table["property:run:run_id"]) == ["run-000001"]
    assert list(table["property:prediction:rub"]) == [0.5]
    assert "property:prediction:rub_right" not in table
    assert list(table["property:prediction:motion"]) == ["chaotic"]
    assert list(table["property:prediction:my_note"]) == ["a b"]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("run,motion\nrun-000000,0\n", "has no column run_id; name the runs there"),
        ("run_id\nrun-000000\n", "has no column beside run_id"),
        ("run_id,rub\nrun-000000,1\nrun-000000,0\n", "run-000000 stands there twice"),
        ("run_id,rub\na,1\n", "none of its runs is in"),
        ("run_id,a b,a_b\nrun-000000,1,2\n", "two columns are called a_b"),
        ("", "cannot be read as csv"),
        (None, "there is no such file"),
    ],
)
def test_a_mistake_in_the_answers_is_one_line(shown_set, tmp_path, browse, text, said):
    path = tmp_path / "answers.csv"
    if text is not None:
        path.write_text(text)
    code, error = browse(shown_set, "--serve", "--predictions", path)
    assert code == 2
    assert said in error
    assert len(error.splitlines()) == 1


@pytest.mark.parametrize(
    ("column", "answer", "said"),
    [
        ("rubs", "1", "no column is called like a label, so none is compared; did you mean rub?"),
        ("motion", "chaotik", "motion = 'chaotik': no such class; did you mean chaotic?"),
    ],
)
def test_a_misspelt_label_or_class_is_warned_of(shown_set, tmp_path, column, answer, said):
    path = tmp_path / "answers.csv"
    path.write_text(f"run_id,{column}\nrun-000000,{answer}\n")
    data = rubgen.open(shown_set)
    with pytest.warns(RubgenWarning, match=re.escape(said)):
        rows = rows_of(data, list(data.runs.index), path)
    assert ("prediction", column) in rows.columns


def test_a_catalog_needs_a_package_and_the_viewer_a_screen(shown_set, monkeypatch, browse):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("rubgen.viz.viewer.sys.platform", "linux")
    code, error = browse(shown_set)
    assert (code, "give --web or --serve" in error) == (2, True)
    monkeypatch.setattr("rubgen.viz.catalog.find_spec", lambda _name: None)
    code, error = browse(shown_set, "--serve")
    assert (code, "pip install 'rubgen[browse]'" in error) == (2, True)
