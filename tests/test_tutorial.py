"""Runs the tutorial from its page, block after block, and compares the notebook in the repository with it."""

import importlib.util
import json
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long

DOCS = Path(__file__).parents[1] / "docs"


@pytest.fixture(scope="module")
def notebook():
    spec = importlib.util.spec_from_file_location("docs_notebook", DOCS / "notebook.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # for its dataclass
    spec.loader.exec_module(module)
    return module


def test_the_tutorial_runs_and_prints_what_it_shows(notebook, tmp_path):
    cells = notebook.run(DOCS / "tutorial.md", tmp_path)
    assert (tmp_path / "rub.png").stat().st_size > 10_000
    assert (tmp_path / "wrong.png").stat().st_size > 10_000
    made = notebook.notebook(cells)
    assert any("image/png" in output.get("data", {}) for cell in made["cells"] for output in cell.get("outputs", []))


def test_the_notebook_in_the_repository_is_the_tutorial(notebook):
    stored = json.loads((DOCS / "tutorial.ipynb").read_text(encoding="utf-8"))
    made = notebook.notebook(notebook.cells(DOCS / "tutorial.md"))
    sources = [[cell["source"] for cell in each["cells"]] for each in (stored, made)]
    assert sources[0] == sources[1], "run `make tutorial`"


@pytest.mark.parametrize("page", sorted(DOCS.glob("examples/*.md")), ids=lambda page: page.stem)
def test_worked_examples_run_and_print_what_they_show(notebook, tmp_path, page):
    assert any(cell.language for cell in notebook.run(page, tmp_path))


def test_a_block_that_prints_something_else_is_found(notebook, tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# T\n\n```python\nprint(1 + 1)\n```\n\n```text\n3\n```\n", encoding="utf-8")
    with pytest.raises(RuntimeError, match="expected '3"):
        notebook.run(page, tmp_path)
