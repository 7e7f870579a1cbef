"""A step says what it does: on a terminal, without one, in a notebook; worker processes and --json stay silent."""

import io
import os
import pty
import subprocess
import sys
import threading
from types import SimpleNamespace

import pytest

from rubgen import progress
from rubgen.progress import count, shown, step


class Stream(io.StringIO):
    def __init__(self):
        super().__init__()
        self.told = threading.Event()

    def write(self, text):
        super().write(text)
        self.told.set()
        return len(text)


@pytest.fixture
def stderr(monkeypatch):
    stream = Stream()
    monkeypatch.setattr(progress, "sys", SimpleNamespace(stderr=stream, modules=sys.modules))
    return stream


def test_nothing_is_shown_unless_asked(stderr):
    with step("simulate", "runs", long=True):
        count(1, 2)
    with shown(), step("simulate", long=True):  # no terminal and no notebook
        count(1, 2)
    with shown(False), step("simulate", long=True):
        count(1, 2)
    count(1, 2)
    assert stderr.getvalue() == ""


def test_a_long_step_says_so_at_once_and_a_short_one_never(stderr):
    with shown(True):
        with step("compile", long=True):
            assert stderr.getvalue() == "rubgen: compile\n"
        with step("reduce"):
            pass
    assert stderr.getvalue() == "rubgen: compile\n"


def test_a_step_that_reports_nothing_still_gives_a_line_a_minute(stderr, monkeypatch):
    assert progress.EVERY_S == 60
    monkeypatch.setattr(progress, "EVERY_S", 0.01)
    with shown(True), step("reduce"):
        assert stderr.told.wait(60)
    assert stderr.getvalue().startswith("rubgen: reduce")


def test_the_line_has_count_and_rest(stderr, monkeypatch):
    monkeypatch.setattr(progress, "EVERY_S", 0.01)
    monkeypatch.setattr(progress.time, "monotonic", iter([0.0, *[120.0] * 10_000]).__next__)
    with shown(True), step("simulate", "runs"):
        count(10, 40)  # were there before
        count(20, 40)
        stderr.told.clear()
        assert stderr.told.wait(60)
    assert "rubgen: simulate: 20 of 40 runs, about 4 min left, 2 min so far\n" in stderr.getvalue()


def test_a_step_within_another_is_part_of_it(stderr, monkeypatch):
    monkeypatch.setattr(progress, "EVERY_S", 0.01)
    with shown(True), step("simulate", "runs", long=True):
        count(1, 4)
        with step("integrate", "turns", long=True):
            count(77, 500)
        stderr.told.clear()
        assert stderr.told.wait(60)
    assert "integrate" not in stderr.getvalue()
    assert "77" not in stderr.getvalue()
    assert "1 of 4 runs" in stderr.getvalue()


def test_an_error_in_a_step_passes_and_ends_it(stderr):
    def fail():
        with step("one", long=True):
            raise ZeroDivisionError

    with shown(True):
        with pytest.raises(ZeroDivisionError):
            fail()
        with step("two", long=True):
            pass
    assert stderr.getvalue() == "rubgen: one\nrubgen: two\n"


def test_a_notebook_has_one_line_that_is_written_anew(stderr, monkeypatch):
    monkeypatch.setitem(sys.modules, "ipykernel", object())
    with shown(), step("simulate", "turns", long=True):
        count(1, 2)
    assert stderr.getvalue().startswith("\rsimulate ")
    assert stderr.getvalue().endswith("\r")
    assert "\n" not in stderr.getvalue()


def on_a_terminal(code):
    """What a program writes to a terminal of its own."""
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        [sys.executable, "-c", code], stderr=theirs, stdout=theirs, env=os.environ | {"TERM": "xterm"}
    ):
        os.close(theirs)
        shown = b""
        while True:
            try:
                piece = os.read(ours, 4096)
            except OSError:  # the other end is closed
                break
            if not piece:
                break
            shown += piece
    os.close(ours)
    return shown.decode()


def test_a_terminal_has_a_bar_that_goes_when_the_step_ends():
    text = on_a_terminal(
        "import time\nfrom rubgen.progress import *\n"
        "with shown(), step('simulate', 'runs', long=True):\n    count(3, 8); time.sleep(0.5)\nprint('done')"
    )
    assert "3 of 8 runs" in text
    assert text.rstrip().endswith("done")
    assert "\x1b[2K" in text  # the bar's line is cleared


def test_rich_is_imported_only_for_a_bar():
    code = "import sys, rubgen\nfrom rubgen.progress import *\nwith shown(True), step('x', long=True): pass\n"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}print('rich' in sys.modules)"], capture_output=True, text=True, check=True
    )
    assert (done.stdout, done.stderr) == ("False\n", "rubgen: x\n")
