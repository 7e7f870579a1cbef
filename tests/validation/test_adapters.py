"""The table of consumers says what was seen: a version where the line held, the reason where it did not."""

import importlib.metadata

from validation.adapters import Adapter, page, run


def test_a_line_that_holds_has_the_version_and_one_that_does_not_its_reason():
    held = Adapter("numpy", "numpy.ones(3).sum()", "found == GOOD", "numpy")
    assert run(held, 3, 4) == (importlib.metadata.version("numpy"), "ok")
    assert run(held, 2, 4) == ("", "fails: AssertionError")
    missing = Adapter("missing", "missing.read('DIR')", "found", "missing")
    assert run(missing, 3, 4) == ("", "fails: ModuleNotFoundError: No module named 'missing'")


def test_a_program_must_print_what_is_expected_and_one_that_is_missing_is_not_run():
    echo = Adapter("echo", "echo DIR/signals", "adapters/set/signals", "")
    assert run(echo, 3, 4)[1] == "ok"
    assert run(echo._replace(check="other"), 3, 4)[1].startswith("fails")
    assert run(echo._replace(line="no-such-program DIR"), 3, 4) == ("", "not run: not installed")


def test_the_page_has_a_row_for_each_line():
    own = Adapter("numpy", "numpy.load('DIR')", "found", "numpy", ("numpy",))
    assert "| numpy | 2.0 | `numpy.load('DIR')` | its own | ok |" in page([(own, "2.0", "ok")])
