"""The tables of docs/features.md, made from the vocabulary of features.

`python -m schemas.features_page PAGE` writes them into the page.
"""

import re
import sys
from collections.abc import Sequence
from pathlib import Path

from rubgen.dataset.files import write_text
from rubgen.features import vocabulary
from rubgen.features.vocabulary import Feature


def with_features(page: str) -> str:
    """The page with a table of each set of features, from `<!-- set -->` to `<!-- end -->`."""
    bands = vocabulary.envelope(sample_rate_hz=1e6)
    tables = {"time": vocabulary.TIME, "order": vocabulary.ORDER, "envelope": bands, "orbit": vocabulary.ORBIT}
    for name, features in tables.items():
        table = f"<!-- {name} -->\n{_table(features)}\n<!-- end -->"
        page = re.sub(rf"<!-- {name} -->\n.*?<!-- end -->", lambda _, table=table: table, page, flags=re.DOTALL)  # type: ignore[misc]
    return page


def _table(features: Sequence[Feature]) -> str:
    rows = [f"| `{each.name}` | {each.unit} | {each.meaning} |" for each in features]
    return "\n".join(["| feature | unit | definition |", "|---|---|---|", *rows])


if __name__ == "__main__":
    for path in map(Path, sys.argv[1:]):
        write_text(path, with_features(path.read_text(encoding="utf-8")))
