"""`python -m benchmarks.page`: `docs/performance.md` from `benchmarks/performance.md` and figures of `out/bench.json`.

A figure stands in the text as `{{name|format}}`: the name of a row or its unique beginning, and how Python formats it.
`{{name|format?}}` is a figure that may be missing: then a dash stands there.
"""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Sequence
from pathlib import Path

from rubgen.dataset.files import write_text
from validation.rows import Row, read_rows

TEXT, ROWS, PAGE = Path(__file__).with_name("performance.md"), Path("out/bench.json"), Path("docs/performance.md")
FIGURE = re.compile(r"\{\{(.+?)\|(.*?)(\??)\}\}")


def page(text: str, rows: Sequence[Row], facts: dict[str, str]) -> str:
    """The text with figures from `rows`, or from `facts` by name. Raises LookupError that names what is missing."""
    missing = []

    def figure(found: re.Match[str]) -> str:
        name, how, optional = found.groups()
        if name in facts:
            return facts[name]
        row = row_of(name, rows)
        if row is None and not optional:
            missing.append(name)
        if row is None or row["value"] is None:
            return "-"
        return format(row["value"], how).replace("%", " %")

    filled = FIGURE.sub(figure, text)
    if missing:
        raise LookupError("\n".join(missing))
    return filled


def row_of(name: str, rows: Sequence[Row]) -> Row | None:
    """The row of that name, else the only one whose name begins with it, else None."""
    alike = [row for row in rows if row["name"] == name] or [row for row in rows if str(row["name"]).startswith(name)]
    return alike[0] if len(alike) == 1 else None


def main() -> int:
    """Write the page; say what is missing and return 1 where not every figure is there."""
    rows = read_rows(ROWS)
    made = time.localtime(ROWS.stat().st_mtime) if rows else time.localtime()
    facts = {"date": time.strftime("%Y-%m-%d", made), "cores": str(os.cpu_count())}
    thousand = row_of("1,000 runs of 600 turns, two workers", rows)
    if thousand:
        facts["thousand"] = str(thousand["name"]).partition("(")[2].rstrip(")")
    try:
        filled = page(TEXT.read_text(encoding="utf-8"), rows, facts)
    except LookupError as error:
        print(f"{ROWS} lacks these figures; run `python -m benchmarks`:\n{error}", file=sys.stderr)
        return 1
    write_text(PAGE, filled)
    return 0


if __name__ == "__main__":
    sys.exit(main())
