"""`python -m validation.verification [GROUP ...]`: the table, `out/verification.json`, the pages in `docs/`.

With groups named, the table alone. Ends with 1 when a row is not ok.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from pathlib import Path

from threadpoolctl import threadpool_limits

from rubgen.cache_root import CACHE_VARIABLE
from validation.rows import write_rows
from validation.verification import GROUPS, check
from validation.verification.report import Group, line, pages, summary


def main(names: list[str], folder: Path) -> int:
    """Run the groups of those names, all by default; 0 when every row is ok."""
    groups: dict[str, Group] = {}
    seconds: dict[str, float] = {}
    for name in names or GROUPS:
        start = time.perf_counter()
        groups[name] = check(name)
        seconds[name] = time.perf_counter() - start
        sys.stdout.write(f"\n{groups[name].title}\n" + "".join(line(row) + "\n" for row in groups[name].rows))
        sys.stdout.flush()
    sys.stdout.write(f"\n{summary(groups, seconds)}\n")
    rows = [row for group in groups.values() for row in group.rows]
    if not names:
        write_rows(folder / "out" / "verification.json", [row.as_dict() for row in rows])
        (folder / "docs" / "verification").mkdir(exist_ok=True)
        for name, text in pages(groups, GROUPS).items():
            (folder / "docs" / name).write_text(text, encoding="utf-8")
    return 0 if all(row.ok for row in rows) else 1


if __name__ == "__main__":
    # Reduced models are made anew: a cache proves nothing. One BLAS thread, as in every run, repeats the bits.
    with tempfile.TemporaryDirectory() as cache, threadpool_limits(1):
        os.environ[CACHE_VARIABLE] = cache
        sys.exit(main(sys.argv[1:], Path()))
