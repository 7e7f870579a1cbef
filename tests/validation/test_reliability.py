"""A short campaign of faults, and that it can see what it looks for."""

import faulthandler
import json
import os
import subprocess
import sys
import time

import pytest

from rubgen.errors import UserError
from validation.reliability.guarded import one_outcome, outcomes
from validation.reliability.hostile import inputs as hostile
from validation.reliability.hostile.documents import json_bytes, mutated, toml_text
from validation.reliability.rows import Row, table_of
from validation.reliability.sets import Truth

pytestmark = pytest.mark.long

HARM = ("lost", "differing", "missed", "tracebacks")
PATIENCE_S = 600


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    out = tmp_path_factory.mktemp("faults") / "faults.json"
    command = [sys.executable, "-m", "validation.reliability", "--quick", "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert out.exists(), done.stderr
    return json.loads(out.read_text())


def test_every_fault_is_tried_and_does_no_harm(rows):
    failures = [failure for row in rows for failure in row["failures"]]
    assert failures == []
    assert all(row[name] == 0 for row in rows for name in HARM)
    assert all(row["tries"] or row["skipped"] for row in rows)
    assert len(rows) == 20


def test_only_who_may_not_mount_a_disk_skips(rows):
    assert {row["fault"] for row in rows if row["skipped"]} <= {
        "full disk",
        "read-only disk",
        "no rights, no home, no cache",
    }


def test_the_table_has_a_line_for_each_fault(rows):
    assert table_of(rows).count("\n") == len(rows) + 2


def _case(number):
    if number == 1:
        raise UserError("one line")
    if number == 2:
        raise UserError("two\nlines")
    if number == 3:
        raise KeyError("x")
    if number == 4:
        os._exit(7)
    if number == 5:
        faulthandler.disable()  # its trace would fill the log of the tests
        os.kill(os.getpid(), 11)
    if number == 6:
        bytearray(8 * 1024**3)
    return "right"


def test_whatever_a_case_does_is_an_outcome_and_the_next_is_tried():
    found = dict(outcomes(_case, range(8)))
    assert list(found) == list(range(8))
    assert [found[number] for number in (0, 1, 7)] == ["right", "one line", "right"]
    assert found[2].startswith("long message")
    assert found[3].startswith("KeyError in test_reliability.py")
    assert (found[4], found[5]) == ("died with 7", "died with -11")
    assert found[6].startswith("MemoryError")


def test_a_case_without_end_is_stopped(monkeypatch):
    monkeypatch.setattr("validation.reliability.guarded.SECONDS", 1)
    assert dict(outcomes(lambda number: _spin() if number == 0 else "right", range(2))) == {
        0: "more than 1 s",
        1: "right",
    }


def test_the_time_of_cases_before_is_not_counted(monkeypatch):
    """As many cases as take three times the limit, and a clock that says less than the system's own."""
    monkeypatch.setattr("validation.reliability.guarded.SECONDS", 1)
    ticks = time.process_time
    monkeypatch.setattr("validation.reliability.guarded.time.process_time", lambda: 0.1 * ticks())
    assert set(dict(outcomes(lambda _: _spin(0.02) or "right", range(9))).values()) == {"right"}


def _spin(seconds=60.0):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def test_the_same_seed_makes_the_same_input(small_generator):
    document = {"a": 1, "b": {"c": [1.0, "x"]}, "d": True}
    for seed in range(50):
        first, again = (toml_text(mutated(document, small_generator(seed))) for _ in range(2))
        assert first == again
        assert json_bytes(mutated(document, small_generator(seed))) == json_bytes(
            mutated(document, small_generator(seed))
        )
    assert document == {"a": 1, "b": {"c": [1.0, "x"]}, "d": True}


@pytest.fixture
def small_generator():
    import numpy as np

    return np.random.default_rng


def test_every_stretch_of_seeds_has_all_kinds():
    for start in (0, 777, 99_900):
        kinds = [hostile.kind_of(seed) for seed in range(start, start + 100)]
        assert {kind: kinds.count(kind) for kind in hostile.SHARES} == hostile.SHARES


def test_a_wrong_completion_is_counted(tmp_path, monkeypatch):
    """The comparison can fail: a set that is not completed is lost, one of other bytes differs."""

    class Ended:
        output = "Traceback"

        def __init__(self, code):
            self.code = code

        def end(self):
            return self.code

    truth = Truth(folder=tmp_path, recipe=tmp_path, directory=tmp_path, digests={"a": "x"})
    row = Row("x")
    for code in (2, 0):
        monkeypatch.setattr(Truth, "generate", lambda *_, code=code, **__: Ended(code))
        truth.complete(tmp_path / "none", row, "x")
    assert (row.lost, row.differing, row.tracebacks) == (1, 1, 2)
    assert not row.good


def test_one_outcome_is_short():
    assert "\n" not in one_outcome(lambda _: {}["a\nb"], 0)
