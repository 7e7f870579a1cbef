"""Every format of FORMAT_NAMES is whole: it writes a run, finds nothing wrong in it, and finds what is wrong."""

import numpy as np
import pytest

from rubgen import UserError
from rubgen.dataset.layout import Layout
from rubgen.format_names import ENDINGS, FORMAT_NAMES
from rubgen.formats import format_of, run_formats
from rubgen.output import save


@pytest.mark.parametrize("name", FORMAT_NAMES)
def test_a_format_writes_a_run_in_which_it_finds_nothing_wrong(rub_run, tmp_path, name):
    found = format_of(name)
    path = tmp_path / f"{rub_run.scenario.run_id}.{name}"
    save(rub_run, path)
    assert found.name == name
    assert path.stat().st_size > 0
    assert list(found.problems(path, path.stem, True)) == []
    assert [each.name for each in tmp_path.iterdir()] == [path.name], "nothing half written is left"


@pytest.mark.parametrize("each", run_formats(), ids=lambda each: each.name)
def test_a_file_of_another_run_and_a_cut_one_are_found(rub_run, tmp_path, each):
    path = tmp_path / f"run-000009{each.suffix}"
    save(rub_run, path)
    assert list(each.problems(path, path.stem, True)) == [f"holds {rub_run.scenario.run_id}"]
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    assert list(each.problems(path, path.stem, False)) != []


@pytest.mark.parametrize("each", [each for each in run_formats() if each.signals], ids=lambda each: each.name)
def test_signals_of_a_file_are_those_of_its_run(rub_run, tmp_path, each):
    path, recording = tmp_path / f"run{each.suffix}", rub_run.recording
    save(rub_run, path)
    name = next(iter(recording.channels))
    found = each.signals(path, [name])
    assert (found.number, list(found.channels)) == (rub_run.scenario.number, [name])
    np.testing.assert_array_equal(found.channels[name], recording.channels[name].values)
    np.testing.assert_allclose(found.once_per_rev, recording.once_per_rev, rtol=0, atol=1e-9)


def test_the_folder_of_a_format_is_its_name_but_signals_for_parquet(tmp_path):
    assert [folder.name for folder in Layout(tmp_path).folders(FORMAT_NAMES)] == [
        "signals",
        *(each.name for each in run_formats()),
    ]


def test_an_unknown_ending_is_refused_with_the_known_ones(rub_run, tmp_path):
    with pytest.raises(UserError, match=f"end the name in {ENDINGS.replace('.', '[.]')}"):
        save(rub_run, tmp_path / "run.wav")
