"""The command `rubgen baseline`: what simple models score on a data set."""

from __future__ import annotations

import json
from pathlib import Path

from rubgen.baseline.baseline import baselines
from rubgen.baseline.table import document, table
from rubgen.cli.options import names_in
from rubgen.cli.printing import check_new_file, print_json, say, write_file
from rubgen.dataset.files import sha256_of
from rubgen.dataset.making.workers import usable_cores
from rubgen.dataset.reading.open import DataSet
from rubgen.progress import step


def baseline_command(directory: Path, task: str | None, out: Path | None, *, force: bool, as_json: bool) -> int:
    """Score simple models on a data set, print a table, and write it as JSON to `out` if given.

    `task` are names of tasks with commas between them; None takes all that are possible. `force` replaces an existing
    `out`. `as_json` prints JSON in place of the table. Returns the exit code 1 if a task is marked: one threshold
    solves it, or no model learns it (`mark_of`). Else returns 0.
    """
    if out:
        check_new_file("--out", out, (".json",), force=force)
    with step("baselines", "windows"):
        found, reasons = baselines(directory, names_in("--task", task), workers=usable_cores())
    data = DataSet(directory)
    content = document(data.manifest.name, sha256_of(data.layout.manifest), found, reasons)
    if out:
        text = json.dumps(content, indent=2) + "\n"
        write_file("--out", out, lambda part: part.write_text(text, encoding="utf-8"))
    if as_json:
        print_json(content)
    else:
        for line in (*table(found).splitlines(), *(f"- {name}: not possible: {why}" for name, why in reasons.items())):
            say(line)
    return 1 if any(each.mark for each in found) else 0
