"""The page of computing times: figures stand where the text names them, and a missing one is named."""

import importlib
import re

import pytest

from benchmarks.__main__ import NAMES
from benchmarks.page import FIGURE, TEXT, page, row_of

ROWS = [
    {"name": "light: step", "value": 0.934},
    {"name": "light: step, dense", "value": 7.4},
    {"name": "share", "value": 0.0364},
    {"name": "viewer", "value": None},
    {"name": "sweep of 105 speeds, two workers", "value": 8.51},
    {"name": "runs, two workers (from 40)", "value": 1234.5},
    {"name": "runs, CPU", "value": 2.0},
]


def test_figures_stand_in_the_text():
    text = "{{date|}}: {{light: step|.2f}} us, {{share|.1%}}, {{sweep|.1f}} s, {{runs, two|,.0f}}, {{viewer|.2f}} s"
    assert page(text, ROWS, {"date": "today"}) == "today: 0.93 us, 3.6 %, 8.5 s, 1,234, - s"


def test_every_missing_figure_is_named_and_an_optional_one_is_a_dash():
    with pytest.raises(LookupError, match=r"^runs\nnowhere$"):  # two rows begin with "runs"
        page("{{runs|.1f}} {{share|.1f}} {{nowhere|.1f}} {{no driver|.1f?}}", ROWS, {})
    assert page("{{no driver|.1f?}}", ROWS, {}) == "-"
    assert row_of("light: step", ROWS) == ROWS[0]  # a whole name comes before beginnings


def test_every_figure_of_the_page_has_a_name_of_a_row_and_a_format():
    """Names are texts of a benchmark: their last part after a colon or comma stands in its source."""
    sources = "".join(path.read_text(encoding="utf-8") for path in TEXT.parent.glob("bench_*.py"))
    found = FIGURE.findall(TEXT.read_text(encoding="utf-8"))
    assert len(found) > 90
    for name, how, _ in found:
        if name in ("date", "cores", "thousand"):
            continue
        format(0.5, how)
        assert re.split(r"[:,] ", name)[-1] in sources, name


@pytest.mark.parametrize("name", NAMES)
def test_every_benchmark_of_the_table_has_rows_to_measure(name):
    assert callable(importlib.import_module(f"benchmarks.bench_{name}").measure)
