"""Count machines, runs and classes of each split of a data set, for its card."""

from collections import Counter
from dataclasses import dataclass, field

from rubgen.dataset.layout import Layout
from rubgen.io.parquet.read import row_groups
from rubgen.io.parquet.words import with_words

COLUMNS = ["split", "machine_number", "status", "rub", "motion"]


@dataclass
class SplitCount:
    """What one split holds."""

    machines: int = 0
    runs: int = 0
    """Runs with any status."""
    ok: int = 0
    rub: int = 0
    motion: Counter[str] = field(default_factory=Counter)
    """Runs by their class of motion."""


def split_counts(layout: Layout) -> dict[str, SplitCount]:
    """Count the runs of each split in `runs.parquet` of a set with virtual machines. A few thousand rows are in memory.

    Runs of a machine follow each other. Raises UserError where the file is damaged.
    """
    counts: dict[str, SplitCount] = {}
    machine = -1
    for group in row_groups(layout.runs, columns=COLUMNS):
        for row in with_words(group).to_pylist():
            count = counts.setdefault(row["split"], SplitCount())
            count.machines += row["machine_number"] != machine
            machine = row["machine_number"]
            count.runs += 1
            if row["status"] == "ok":
                count.ok += 1
                count.rub += bool(row["rub"])
                count.motion[row["motion"]] += 1
    return counts


def split_table(counts: dict[str, SplitCount]) -> str:
    """Write the counts as a table in Markdown, one row a split."""
    motions = sorted({word for count in counts.values() for word in count.motion})
    head = "| split | machines | runs | ok | with rub |" + "".join(f" {word} |" for word in motions)
    lines = [head, "|---" * (5 + len(motions)) + "|"]
    for name, count in counts.items():
        numbers = [count.machines, count.runs, count.ok, count.rub, *(count.motion[word] for word in motions)]
        lines.append(f"| `{name}` | " + " | ".join(map(str, numbers)) + " |")
    return "\n".join(lines)
