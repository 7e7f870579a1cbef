"""`python -m validation.adapters DIR PAGE`: one line of each consumer on a data set, and the page of results.

A consumer that is not installed here is listed as not run.
"""

from __future__ import annotations

import importlib.metadata
import importlib.util
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from validation.markdown import table

SECONDS = 300


class Adapter(NamedTuple):
    """A consumer: its package, the line that loads a set, and what must then be true."""

    package: str
    module: str
    line: str
    check: str


ADAPTERS = (
    Adapter("pandas", "pandas", "found = pandas.read_parquet('DIR/signals')", "'rub' in found and len(found) == GOOD"),
    Adapter("polars", "polars", "found = polars.read_parquet('DIR/signals/*.parquet')", "found.height == GOOD"),
    Adapter(
        "duckdb", "duckdb", "found = duckdb.sql(\"from 'DIR/signals/*.parquet'\").fetchall()", "len(found) == GOOD"
    ),
    Adapter(
        "fastparquet",
        "fastparquet",
        "found = fastparquet.ParquetFile('DIR/runs.parquet').to_pandas()",
        "len(found) == RUNS",
    ),
    Adapter(
        "datasets", "datasets", "found = datasets.load_dataset('DIR', 'signals')", "found['train'].num_rows == GOOD"
    ),
    Adapter(
        "datasets",
        "datasets",
        "found = datasets.load_dataset('DIR', 'signals', streaming=True)",
        "'rub' in next(iter(found['train']))",
    ),
    Adapter(
        "mlcroissant",
        "mlcroissant",
        "found = mlcroissant.Dataset('DIR/croissant.json').records('runs')",
        "len(list(found)) == RUNS",
    ),
    Adapter("torch", "torch", "found = torch.from_numpy(rubgen.open('DIR').arrays().X)", "len(found) == GOOD"),
    Adapter(
        "scikit-learn",
        "sklearn",
        "found = sklearn.dummy.DummyClassifier().fit(*rubgen.open('DIR').windows(seconds=0.1)[:2])",
        "found.classes_.size",
    ),
    Adapter(
        "tsfel",
        "tsfel",
        "found = rubgen.features.write.write_features('DIR', 'OUT', sets=['tsfel'], channels=['proximity_x'])",
        "found.columns > 40",
    ),
)
"""DIR is the data set; GOOD and RUNS are its numbers of good runs and of runs; OUT is a new file."""
IMPORTS = {"tsfel": "rubgen.features.write", "scikit-learn": "sklearn.dummy"}


def run(adapter: Adapter, directory: Path) -> str:
    """ok, or why it is not."""
    if importlib.util.find_spec(adapter.module) is None:
        return "not run: not installed"
    with tempfile.TemporaryDirectory() as folder:
        line = adapter.line.replace("DIR", str(directory)).replace("OUT", f"{folder}/out.parquet")
        imports = ", ".join(dict.fromkeys((adapter.module, "pathlib", "rubgen", IMPORTS.get(adapter.package, "sys"))))
        counts = f"data = rubgen.open({str(directory)!r}); GOOD, RUNS = len(data.ok), len(data)"
        program = f"import {imports}\n{counts}\n{line}\nassert {adapter.check}"
        cache = {"HF_HOME": folder, "HF_HUB_OFFLINE": "1"}
        done = subprocess.run(
            [sys.executable, "-c", program],
            capture_output=True, text=True, check=False, timeout=SECONDS, env=os.environ | cache,
        )  # fmt: skip
    return "ok" if done.returncode == 0 else f"fails: {(done.stderr.strip().splitlines() or ['?'])[-1][:120]}"


def page(results: Sequence[tuple[Adapter, str]]) -> str:
    """The page of the results."""
    rows = [
        [each.package, _version(each.package), f"`{each.line.removeprefix('found = ')}`", result]
        for each, result in results
    ]
    return f"""# With other packages

`make adapters` makes this page: it runs one line of each package on a data set in the folder `DIR` and checks that all
runs arrive. Formats of other programs are on the page of [export](export.md), where a reader of each is tested.

{table(["package", "version", "line", "result"], rows)}
"""


def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return ""


if __name__ == "__main__":
    made = [(each, run(each, Path(sys.argv[1]).resolve())) for each in ADAPTERS]
    Path(sys.argv[2]).write_text(page(made), encoding="utf-8")
    sys.exit(any(result.startswith("fails") for _, result in made))
