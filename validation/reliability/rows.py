"""The table of the campaign: out/faults.json and docs/reliability.md."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from validation.markdown import table
from validation.rows import read_rows

PAGE = Path("docs/reliability.md")
COLUMNS = ("fault", "tries", "lost", "differing", "missed", "tracebacks", "seconds", "commit")
BEGIN, END = "<!-- table of faults -->", "<!-- end of table -->"


@dataclass
class Row:
    """How often a fault was tried, and how often it did harm."""

    fault: str
    tries: int = 0
    lost: int = 0
    """Runs that were kept and were made again, and sets that the same command does not complete."""
    differing: int = 0
    """Sets whose bytes are other than those of an undisturbed making; readings that are wrong without a word."""
    missed: int = 0
    """Damage that `rubgen verify` does not find."""
    tracebacks: int = 0
    """Ends that are neither right nor one line for the user: tracebacks, signals, hangs, memory beyond its bound."""
    seconds: float = 0.0
    skipped: str = ""
    """Why nothing was tried."""
    failures: list[str] = field(default_factory=list)
    """What to give to try each failure again."""

    def fail(self, column: str, what: str) -> None:
        """Count a failure, and say at once how it repeats."""
        setattr(self, column, getattr(self, column) + 1)
        self.failures.append(f"{column}: {what}")
        sys.stderr.write(f"{self.fault}: {column}: {what}\n")

    @property
    def good(self) -> bool:
        """Whether nothing was lost, different, missed or ended in a traceback."""
        return not (self.lost or self.differing or self.missed or self.tracebacks)


@contextmanager
def timed(row: Row) -> Iterator[Row]:
    """Count the seconds of the block to the row."""
    start = time.perf_counter()
    yield row
    row.seconds = round(row.seconds + time.perf_counter() - start, 1)


def commit_here() -> str:
    """The commit of the sources that are tried, with "+" where they were changed since; empty without git."""
    git = ["git", "describe", "--always", "--abbrev=7", "--exclude=*", "--dirty=+"]
    try:
        return subprocess.run(
            git, cwd=Path(__file__).parent, capture_output=True, text=True, check=False
        ).stdout.strip()
    except OSError:
        return ""


def write_page(out: Path, page: Path = PAGE) -> None:
    """Put the table of `out` into the page; its other lines stay."""
    text = page.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    page.write_text(f"{before}{BEGIN}\n{table_of(read_rows(out))}{END}{after}", encoding="utf-8")


def table_of(rows: Sequence[dict[str, Any]]) -> str:
    """The rows in Markdown."""
    return table(COLUMNS, [_cells(row) for row in rows], numbers_from=1) + "\n"


def _cells(row: dict[str, Any]) -> list[str]:
    if row["skipped"]:
        return [row["fault"], row["skipped"]]
    return [f"{row[name]:,.0f}" if name == "seconds" else f"{row.get(name, '')}" for name in COLUMNS]
