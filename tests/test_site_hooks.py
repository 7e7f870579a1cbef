"""Where lines of the site may break, which tables stack on a phone, and pictures that open alone."""

import importlib.util
import re
from pathlib import Path

import pytest


def hooks():
    spec = importlib.util.spec_from_file_location("site_hooks", Path(__file__).parents[1] / "docs" / "site_hooks.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_number_in_a_table_stays_with_its_error():
    page = hooks().on_page_markdown("a ± 1\n| rub | 0.50 ± 0.02 | 1.9 +- 0.1 |\n")
    assert page == "a ± 1\n| rub | 0.50\u00a0±\u00a00.02 | 1.9\u00a0+-\u00a00.1 |\n"


def test_a_long_name_in_a_table_breaks_and_a_number_does_not():
    html = "<p><code>a_b</code></p><td><code>contact_duty</code> a_b <code>1.5</code></td>"
    made = hooks().on_page_content(html)
    assert made == "<p><code>a_b</code></p><td><code>contact_<wbr>duty</code> a_b <code>1.5</code></td>"


def table(names, cells):
    head = "".join(f"<th>{name}</th>" for name in names)
    return f"<table><tr>{head}</tr><tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr></table>"


def test_a_table_with_a_column_of_text_names_the_column_in_each_cell():
    made = hooks().on_page_content(table(["key", "<code>unit</code>", "meaning", "default"], "abcd"))
    assert made.startswith("<table data-stack>")
    assert re.findall(r'<td data-column="(\w+)">(\w)</td>', made) == [
        ("key", "a"),
        ("unit", "b"),
        ("meaning", "c"),
        ("default", "d"),
    ]


def test_the_arguments_of_a_command_stack_too():
    assert "<table data-stack>" in hooks().on_page_content(table(["argument", "meaning", "default"], "abc"))


@pytest.mark.parametrize("names", [["key", "unit", "meaning"], ["run", "K", "stray", "zones"]])
def test_a_small_table_and_a_table_of_numbers_stay(names):
    html = table(names, "abcd"[: len(names)])
    assert hooks().on_page_content(html) == html


def test_a_click_opens_a_picture_that_is_no_link_yet():
    made = hooks().on_page_content('<p><img alt="Orbit" src="orbit.png" /></p>')
    assert made == '<p><a href="orbit.png" title="Open the picture"><img alt="Orbit" src="orbit.png" /></a></p>'
    assert hooks().on_page_content(made) == made
