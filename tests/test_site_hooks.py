"""Where lines of the site may break."""

import importlib.util
from pathlib import Path


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
