"""Counts of a finished set: rub, classes, and the shortest reason of each way to fail."""

import pyarrow as pa
import pytest

from rubgen.dataset.layout import Layout
from rubgen.dataset.making import outcome
from rubgen.dataset.making.outcome import Failure, outcome_of


@pytest.fixture
def counted(monkeypatch, tmp_path):
    def counted(*rows):
        groups = [pa.table(list(zip(*each, strict=True)), outcome.COLUMNS) for each in (rows[:2], rows[2:]) if each]
        monkeypatch.setattr(outcome, "row_groups", lambda _path, **_: groups)
        return outcome_of(Layout(tmp_path))

    return counted


def test_counts_are_of_good_runs_and_each_status_has_its_shortest_reason(counted):
    found = counted(
        ("run-000000", "ok", "", True, "chaotic"),
        ("run-000001", "diverged", "in turn 300: blade 2", None, None),
        ("run-000002", "refused", "too thick", None, None),
        ("run-000003", "diverged", "in turn 7", None, None),
        ("run-000004", "ok", "", False, "period-1"),
        ("run-000005", "ok", "", True, "chaotic"),
    )
    assert (found.rub, found.no_rub, found.motion) == (2, 1, {"chaotic": 2, "period-1": 1})
    assert found.failures == (
        Failure(status="diverged", count=2, run_id="run-000003", reason="in turn 7"),
        Failure(status="refused", count=1, run_id="run-000002", reason="too thick"),
    )


def test_a_set_in_which_every_run_failed_has_no_motion(counted):
    found = counted(("run-000000", "energy", "lost", None, None))
    assert (found.rub, found.no_rub, found.motion) == (0, 0, {})
    assert [failure.count for failure in found.failures] == [1]
