"""The verification table: its fast groups hold, it has enough rows, and it would flag a wrong value."""

import json
import math

import pytest
from threadpoolctl import threadpool_limits

from validation.verification import GROUPS, check
from validation.verification import __main__ as command
from validation.verification.report import Group, page, pages, shown
from validation.verification.row import relative, within

pytestmark = pytest.mark.long

# The others take seconds each; `make verification` runs them all.
SLOW = {"plates", "impact_oscillator", "turning_frame", "exponent_errors"}


@pytest.fixture(scope="module")
def table():
    with threadpool_limits(1):
        return {name: check(name) for name in GROUPS if name not in SLOW}


@pytest.mark.parametrize("name", [name for name in GROUPS if name not in SLOW])
def test_rows_of_the_group_are_ok(table, name):
    assert table[name].rows
    assert [row for row in table[name].rows if not row.ok] == []


def test_there_are_enough_rows_and_each_has_its_own_name_and_source(table):
    rows = [row for group in table.values() for row in group.rows]
    assert len(rows) >= 60
    assert len({row.quantity for row in rows}) == len(rows)
    assert all(row.source for row in rows)
    assert all(math.isfinite(row.expected) and row.tolerance >= 0 for row in rows)


def test_tolerances_are_tight(table):
    # Published ranges, a fitted preset and scatter of records apart, no row lets more than 1 % of its value pass.
    loose = [
        row.quantity
        for name, group in table.items()
        for row in group.rows
        if name not in {"preset", "chaos_indicators", "exponent_errors"}
        and row.expected
        and row.tolerance > 0.01 * abs(row.expected)
    ]
    assert all("order" in quantity for quantity in loose), loose


def test_a_value_beyond_its_tolerance_or_not_a_number_is_flagged():
    assert relative("f", "s", 100.0, 100.9, 0.01).ok
    assert not relative("f", "s", 100.0, 101.1, 0.01).ok
    assert not relative("f", "s", -100.0, 100.0, 0.01).ok
    assert not within("f", "s", 0.0, 1.0, 0.5).ok
    assert not within("f", "s", 1.0, math.nan, 10.0).ok


def test_a_wrong_element_is_flagged(monkeypatch):
    from validation.verification.elements import beams

    true = beams.blade_matrices

    def without_spin_softening(*arguments):
        matrices = true(*arguments)
        matrices.S[:] = 0
        return matrices

    monkeypatch.setattr(beams, "blade_matrices", without_spin_softening)
    wrong = {row.quantity for row in beams.rows() if not row.ok}
    assert "lagwise frequency 1 at Omega = 2" in wrong
    assert "Timoshenko flapwise frequency 1 at Omega = 4" in wrong
    assert "flapwise frequency 1 at Omega = 0" not in wrong


@pytest.mark.parametrize(("found", "code"), [(1.0, 0), (1.2, 1)])
def test_the_command_writes_table_and_page_and_fails_on_a_wrong_row(tmp_path, monkeypatch, capsys, found, code):
    (tmp_path / "docs").mkdir()
    group = Group("Title", "Why.", [within("a | b", "source", 1.0, found, 0.1)])
    monkeypatch.setattr(command, "GROUPS", {"one": "chaos.one"})
    monkeypatch.setattr(command, "check", lambda _: group)
    assert command.main([], tmp_path) == code
    (row,) = json.loads((tmp_path / "out" / "verification.json").read_text())
    assert row == {
        "quantity": "a | b",
        "source": "source",
        "expected": 1.0,
        "found": found,
        "tolerance": 0.1,
        "ok": code == 0,
    }
    assert "a \\| b" in (tmp_path / "docs" / "verification" / "chaos.md").read_text()
    first = (tmp_path / "docs" / "verification.md").read_text()
    assert f"(verification/chaos.md) | 1 | {1 - code} | {code} |" in first
    printed = capsys.readouterr().out
    assert f"1 values, {code} not ok" in printed
    assert ("NOT OK" in printed) is (code == 1)


def test_named_groups_write_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(command, "check", lambda _: Group("Title", "Why.", []))
    assert command.main(["rings"], tmp_path) == 0
    assert list(tmp_path.iterdir()) == []


def test_the_page_shows_found_values_to_a_hundredth_of_their_tolerance():
    assert shown(1.23456789, 1e-3) == "1.23457"
    assert shown(-3e-17, 1e-8) == "0"
    assert shown(204.0, 0) == "204"
    group = Group("Beams", "Because.", [within("f", "s", 2.0, 3.0, 0.1)])
    text = page("Part", [group])
    assert "## Beams\n\nBecause.\n" in text
    assert "| f | s | 2 | 3 | 0.1 | **no** |" in text
    made = pages({"beams": group}, {"beams": "elements.beams"})
    assert list(made) == ["verification.md", "verification/elements.md"]
    assert made["verification/elements.md"].endswith(text.partition("\n")[2])
    assert made["verification.md"].endswith("| 1 | 0 | 1 |\n| all | 1 | 0 | 1 |\n")
