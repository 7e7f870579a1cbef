"""Counts of a finished set: rub, classes, and the shortest reason of each way to fail."""

import errno
import json
from pathlib import Path

import pyarrow as pa
import pytest

from rubgen.cli import main
from rubgen.dataset.layout import Layout
from rubgen.dataset.making import outcome
from rubgen.dataset.making.close import read_closed
from rubgen.dataset.making.outcome import Failure, outcome_of, unfinished
from rubgen.errors import RubgenError, UserError


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


def test_a_record_that_the_system_refuses_is_not_called_damaged_and_stays(tmp_path, monkeypatch):
    layout = Layout(tmp_path)
    layout.closed("").parent.mkdir(parents=True)
    layout.closed("train-00000").write_text("{}")

    def refuse(path):
        raise PermissionError(errno.EACCES, "of the system", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_bytes", refuse)
        with pytest.raises(PermissionError):
            read_closed(layout, "train-00000")
    assert layout.closed("train-00000").exists()
    with pytest.raises(RubgenError, match=r"train-00000\.json: damaged"):
        read_closed(layout, "train-00000")
    assert not layout.closed("train-00000").exists()


def test_info_counts_no_run_of_a_damaged_record_and_changes_nothing(tmp_path, capsys):
    layout = Layout(tmp_path)
    layout.closed("").parent.mkdir(parents=True)
    layout.identity.write_text('{"recipe": {"name": "a", "runs": 9}}')
    record = {"runs": 4, "status": {"ok": 4}, "tables": [], "exports": [], "derived": []}
    layout.closed("train-00000").write_text(json.dumps(record))
    for content in ("{}", "", "[1]", json.dumps(record | {"runs": -4})):
        layout.closed("train-00001").write_text(content)
        assert unfinished(tmp_path).kept == 4
        with pytest.raises(SystemExit) as ended:
            main(["info", str(tmp_path)])
        assert ended.value.code == 0
        assert f"{tmp_path}: unfinished, 4 of 9 runs of the recipe 'a' are kept" in capsys.readouterr().out
        assert layout.closed("train-00001").read_text() == content


def test_an_identity_that_cannot_be_read_says_why(tmp_path, monkeypatch):
    layout = Layout(tmp_path)
    layout.staging.mkdir()
    layout.identity.write_text("[]")
    with pytest.raises(UserError, match=r"identity\.json: cannot be read \(TypeError: list indices"):
        unfinished(tmp_path)
    layout.identity.write_text('{"recipe": {"name": "a", "runs": 2}}')

    def bug(_directory):
        raise LookupError("of ours")

    monkeypatch.setattr(outcome, "finished_runs", bug)
    with pytest.raises(LookupError, match="of ours"):
        unfinished(tmp_path)
