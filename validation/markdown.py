"""The one writer of Markdown tables, and of made parts of a page."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence


def table(header: Sequence[str], rows: Sequence[Sequence[str]], *, numbers_from: int | None = None) -> str:
    """A table in Markdown, without a line end after its last row; a `|` in a cell is escaped.

    Columns from `numbers_from` on are aligned to the right. A row may have fewer cells than the header.
    """
    rules = ["---:" if numbers_from is not None and column >= numbers_from else "---" for column in range(len(header))]
    lines = ([cell.replace("|", r"\|") for cell in line] for line in (header, rules, *rows))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def folded(title: str, text: str) -> str:
    """A part of a page of which only the title shows until a click opens it."""
    return f'<details markdown="1">\n<summary>{title}</summary>\n\n{text}\n\n</details>'


def with_tables(page: str, tables: Mapping[str, str]) -> str:
    """The page with these texts, each from `<!-- name -->` to the next `<!-- end -->`."""
    for name, text in tables.items():
        part = f"<!-- {name} -->\n{text}\n<!-- end -->"
        page = re.sub(rf"<!-- {name} -->\n.*?<!-- end -->", lambda _, part=part: part, page, flags=re.DOTALL)  # type: ignore[misc]
    return page
