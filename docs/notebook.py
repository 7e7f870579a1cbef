"""`python docs/notebook.py`: run the tutorial from its Markdown and write it as docs/tutorial.ipynb, with outputs.

A python block is run in one name space, a sh block in the shell; a toml block is the file that its title names. A text
block is what the block before it prints.
"""

import ast
import base64
import contextlib
import io
import json
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

DOCS = Path(__file__).parent
BLOCK = re.compile(r'^```(python|toml|sh|text)(?: title="([^"]+)")?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
DECIMAL = re.compile(r"\d+\.\d+")
LAST_PLACES = 1
"""Most by which a printed decimal may differ from the page, in units of its last place."""


@dataclass
class Cell:
    """A paragraph or a block of a page; `language` is "" for text."""

    language: str
    source: str
    title: str | None = None
    expected: str | None = None
    outputs: list[dict[str, Any]] = field(default_factory=list)

    @property
    def code(self) -> str:
        """The source as a cell of a notebook."""
        if self.language == "toml":
            return f"%%writefile {self.title}\n{self.source}"
        return "".join(f"!{line}\n" for line in self.source.splitlines()) if self.language == "sh" else self.source


def cells(page: Path) -> list[Cell]:
    """Return the text and the blocks of a page in their order. A text block becomes what its block must print."""
    text, found, end = page.read_text(encoding="utf-8"), [], 0
    for block in BLOCK.finditer(text):
        language, title, source = block.groups()
        found.append(Cell("", text[end : block.start()].strip()))
        if language == "text":
            next(cell for cell in reversed(found) if cell.language).expected = source
        else:
            found.append(Cell(language, source, title))
        end = block.end()
    found.append(Cell("", text[end:].strip()))
    return [cell for cell in found if cell.source]


def run(page: Path, directory: Path) -> list[Cell]:
    """Run the blocks of a page in `directory` and return its cells with what they print and draw.

    Raises RuntimeError where a block fails or does not print what the page shows.
    """
    found, names = cells(page), {"__name__": "__main__"}
    os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"  # where rubgen is
    with contextlib.chdir(directory):
        for cell in found:
            printed = _run(cell, names)
            if cell.expected is not None and not _shows(cell.expected, printed):
                raise RuntimeError(f"{page.name}: expected {cell.expected!r} of\n{cell.source}but saw {printed!r}")
    return found


def _shows(expected: str, printed: str) -> bool:
    """Return whether the expected lines are among the printed ones; decimals may differ by 1 in their last place.

    Scores of a classifier differ so much between processors, whose rounding is not the same.
    """
    if DECIMAL.sub("#", expected) not in DECIMAL.sub("#", printed):
        return False
    wanted, found = DECIMAL.findall(expected), DECIMAL.findall(printed)
    starts = range(len(found) - len(wanted) + 1)
    return any(all(map(_near, wanted, found[start : start + len(wanted)])) for start in starts)


def _near(one: str, other: str) -> bool:
    places = len(one.partition(".")[2])
    return round(abs(float(one) - float(other)) * 10**places) <= LAST_PLACES


def _run(cell: Cell, names: dict[str, Any]) -> str:
    """Run one cell, add its outputs and return what it printed."""
    printed = ""
    if cell.language == "toml":
        Path(str(cell.title)).write_text(cell.source, encoding="utf-8")
    elif cell.language == "sh":
        done = subprocess.run(["sh", "-ec", cell.source], text=True, capture_output=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{cell.source}{done.stdout}{done.stderr}")
        printed = done.stdout
    elif cell.language == "python":
        printed = _run_python(cell, names)
    if printed:
        cell.outputs.insert(0, {"output_type": "stream", "name": "stdout", "text": printed})
    return printed


def _run_python(cell: Cell, names: dict[str, Any]) -> str:
    """Run python; the value of a last expression is an output, as in a notebook."""
    tree, value = ast.parse(cell.source), None
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    with contextlib.redirect_stdout(io.StringIO()) as out:
        exec(compile(tree, "<block>", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "<block>", "eval"), names)
    if value is not None:
        data = {"text/plain": repr(value)}
        if hasattr(value, "savefig"):
            picture = io.BytesIO()
            value.savefig(picture, dpi=70)
            data["image/png"] = base64.b64encode(picture.getvalue()).decode()
        elif hasattr(value, "to_html"):
            data["text/html"] = value.to_html()
        cell.outputs.append({"output_type": "execute_result", "data": data, "metadata": {}, "execution_count": None})
    return out.getvalue()


def notebook(found: list[Cell]) -> dict[str, Any]:
    """Return the cells as a notebook of Jupyter's format 4.5."""
    made = []
    for number, cell in enumerate(found):
        common = {"id": f"cell-{number}", "metadata": {}}
        if cell.language:
            made.append(
                {"cell_type": "code", "source": cell.code, "outputs": cell.outputs, "execution_count": None, **common}
            )
        else:
            made.append({"cell_type": "markdown", "source": cell.source, **common})
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def write(found: list[Cell], path: Path) -> None:
    """Write the cells as a notebook file."""
    path.write_text(json.dumps(notebook(found), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        write(run(DOCS / "tutorial.md", Path(directory)), DOCS / "tutorial.ipynb")
