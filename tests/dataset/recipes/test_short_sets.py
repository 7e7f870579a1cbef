"""A few runs of the study of short signals: no false alarm, wrong labels found."""

from pathlib import Path

import pytest


@pytest.mark.parametrize("sensors", ["default", "rig"])
def test_short_sets_are_whole_and_wrong_labels_are_found(sensors, monkeypatch):
    monkeypatch.syspath_prepend(Path(__file__).parents[3])
    from validation.reliability.short_sets import study

    tables = study((0.05, 0.3), (sensors,), 3)
    assert [table.runs for table in tables] == [3, 3]
    assert [table.false_alarms for table in tables] == [0, 0]
    wrong = sum(table.wrong_labels for table in tables)
    assert (wrong > 0) == (sensors == "default")
    assert sum(table.found for table in tables) == sum(table.found_by_channel for table in tables) == wrong
