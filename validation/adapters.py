"""`python -m validation.adapters`: one line of each consumer on a data set, and the page of results.

A consumer whose versions clash with those of rubgen has an environment of its own in `build/adapters`. A consumer that
cannot be installed there is listed as not run. Exit code 1 where a line fails.
"""

from __future__ import annotations

import importlib.metadata
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import rubgen
from rubgen.export.write import export
from validation.markdown import table

ROOT = Path(__file__).parents[1]
FOLDER, PAGE = ROOT / "build" / "adapters", ROOT / "docs" / "adapters.md"
SECONDS = 300
RECIPE = {
    "name": "adapters",
    "runs": 6,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [9000, 11000]}},
    "sensors": {"set": "rig"},
    "labels": {"lyapunov": False},
    "output": {"formats": ["parquet", "mcap"], "signal_seconds": 0.2},
}
EXPORTS = ("ts", "mat")
HERE: tuple[str, ...] = ()


class Adapter(NamedTuple):
    """A consumer: its package, the line that loads a set, and what must then be true."""

    package: str
    line: str
    check: str
    """An expression of Python that sees `found`. For a program: what its output must have."""
    imports: str
    """Modules that a Python line needs; none for a program."""
    needs: tuple[str, ...] = HERE
    """Requirements of its own environment; none where it runs beside rubgen."""


ADAPTERS = (
    Adapter("pandas", "pandas.read_parquet('DIR/signals')", "'rub' in found and len(found) == GOOD", "pandas"),
    Adapter("polars", "polars.read_parquet('DIR/signals/*.parquet')", "found.height == GOOD", "polars"),
    Adapter("duckdb", "duckdb.sql(\"from 'DIR/signals/*.parquet'\").fetchall()", "len(found) == GOOD", "duckdb"),
    Adapter(
        "fastparquet",
        "fastparquet.ParquetFile('DIR/runs.parquet').to_pandas()",
        "len(found) == RUNS",
        "fastparquet",
        ("fastparquet",),
    ),
    Adapter(
        "datasets",
        "datasets.load_dataset('DIR', 'signals')",
        "found['train'].num_rows == GOOD",
        "datasets",
    ),
    Adapter(
        "datasets",
        "datasets.load_dataset('DIR', 'signals', streaming=True)",
        "'rub' in next(iter(found['train']))",
        "datasets",
    ),
    Adapter(
        "mlcroissant",
        "mlcroissant.Dataset('DIR/croissant.json').records('runs')",
        "len(list(found)) == RUNS",
        "mlcroissant",
    ),
    Adapter(
        "torch",
        "rubgen.torch.Windows(rubgen.open('DIR'), seconds=0.1)",
        "len(found) == 2 * GOOD and found[0][0].shape == found[1][0].shape",
        "rubgen.torch",
        (f"{ROOT}[torch]",),
    ),
    Adapter(
        "scikit-learn",
        "sklearn.dummy.DummyClassifier().fit(*rubgen.open('DIR').windows(seconds=0.1)[:2])",
        "found.classes_.size",
        "rubgen, sklearn.dummy",
    ),
    Adapter(
        "tsfel",
        "rubgen.features.write.write_features('DIR', 'OUT', sets=['tsfel'], channels=['proximity_45'])",
        "found.columns > 40",
        "rubgen.features.write",
        (f"{ROOT}[tsfel]",),
    ),
    Adapter(
        "tsfresh",
        "tsfresh.extract_features(pandas.read_parquet('DIR/signals', columns=['run_id', 'proximity_45'])"
        ".explode('proximity_45').astype({'proximity_45': float}), column_id='run_id', n_jobs=0, "
        "default_fc_parameters=tsfresh.feature_extraction.MinimalFCParameters())",
        "len(found) == GOOD and found['proximity_45__length'].nunique() == 1",
        "pandas, tsfresh",
        ("tsfresh", "pyarrow"),
    ),
    Adapter(
        "aeon",
        "aeon.datasets.load_from_ts_file('TS/train.ts')",
        "found[0].shape[0] == len(found[1]) == GOOD",
        "aeon.datasets",
        ("aeon",),
    ),
    Adapter(
        "sktime",
        "sktime.datasets.load_from_tsfile('TS/train.ts', return_data_type='numpy3d')",
        "found[0].shape[0] == len(found[1]) == GOOD",
        "sktime.datasets",
        ("sktime",),
    ),
    Adapter(
        "bladesight",
        "bladesight.btt.aoa.transform_ToAs_to_AoAs(*map(numpy.asarray, "
        "pandas.read_parquet('DIR/signals')[['once_per_rev_s', 'timing_10_s']].iloc[0]))",
        "found.groupby('n').size().mode()[0] == 36",  # blades a turn
        "bladesight.btt.aoa, numpy, pandas",
        ("bladesight", "duckdb<2"),
    ),
    Adapter("pymcap-cli", "pymcap-cli info DIR/mcap/0000/run-000000.mcap", "/raw/proximity_45", ""),
    Adapter(
        "octave",
        "octave-cli --eval \"x = load('MAT/train/run-000000.mat'); printf('%d', numel(x.proximity_45.values))\"",
        "5120",
        "",
    ),
)
"""DIR is the data set, TS and MAT are its exports; GOOD and RUNS are its good runs and its runs; OUT is a new file."""


def made_set() -> tuple[int, int]:
    """Make the set and its exports, where they are missing. Numbers of good runs and of runs."""
    rubgen.generate(RECIPE, FOLDER / "set", workers=1)
    for name in EXPORTS:
        export(FOLDER / "set", FOLDER / name, name)
    data = rubgen.open(FOLDER / "set")
    return len(data.ok), len(data)


def python_of(adapter: Adapter) -> str:
    """The interpreter that has the consumer. Raises CalledProcessError where it cannot be installed."""
    if not adapter.needs:
        return sys.executable
    folder = FOLDER / "environments" / adapter.package
    python, done = folder / "bin" / "python", folder / "installed"
    if not done.exists():
        for step in (["venv", str(folder)], ["pip", "--upgrade", "pip"], ["pip", *adapter.needs]):
            command = (
                [str(python), "-m", "pip", "install", "--quiet"]
                if step[0] == "pip"
                else [sys.executable, "-m", step[0]]
            )
            subprocess.run([*command, *step[1:]], check=True, capture_output=True)
        done.touch()
    return str(python)


def run(adapter: Adapter, good: int, runs: int) -> tuple[str, str]:
    """The version of the consumer; ok, or why it is not."""
    line = adapter.line
    for word, path in (("DIR", "set"), ("TS", "ts"), ("MAT", "mat"), ("OUT", "out.parquet")):
        line = line.replace(f"'{word}", f"'{FOLDER / path}").replace(f" {word}/", f" {FOLDER / path}/")
    if not adapter.imports:
        return _run_program(adapter, shlex.split(line))
    try:
        python = python_of(adapter)
    except subprocess.CalledProcessError:
        return "", "not run: cannot be installed"
    (FOLDER / "out.parquet").unlink(missing_ok=True)
    program = f"import importlib.metadata, {adapter.imports}\nGOOD, RUNS = {good}, {runs}\nfound = {line}\n"
    program += f"assert {adapter.check}\nprint(importlib.metadata.version({adapter.package!r}))"
    cache = {"HF_HOME": str(FOLDER), "HF_HUB_OFFLINE": "1"}
    done = subprocess.run(
        [python, "-c", program], capture_output=True, text=True, check=False, timeout=SECONDS, env=os.environ | cache
    )
    if done.returncode:
        return "", f"fails: {(done.stderr.strip().splitlines() or ['?'])[-1][:120]}"
    return done.stdout.split()[-1], "ok"


def _run_program(adapter: Adapter, command: list[str]) -> tuple[str, str]:
    found = shutil.which(command[0], path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    if found is None:
        return "", "not run: not installed"
    done = subprocess.run([found, *command[1:]], capture_output=True, text=True, check=False, timeout=SECONDS)
    if done.returncode or adapter.check not in done.stdout:
        return "", f"fails: {(done.stderr.strip().splitlines() or ['?'])[-1][:120]}"
    try:
        return importlib.metadata.version(adapter.package), "ok"
    except importlib.metadata.PackageNotFoundError:
        said = subprocess.run([found, "--version"], capture_output=True, text=True, check=False).stdout
        return next((word for word in said.split() if word[0].isdigit()), ""), "ok"


def page(results: Sequence[tuple[Adapter, str, str]]) -> str:
    """The page of the results."""
    rows = [
        [each.package, version, f"`{each.line}`", "its own" if each.needs else "", result]
        for each, version, result in results
    ]
    return f"""# With other packages

`make adapters` makes this page: it runs one line of each package on a data set in the folder `DIR`, or on its exports
in `TS` and `MAT`, and checks that all runs arrive. A package whose versions clash with those of rubgen has an
environment of its own. Formats of other programs are on the page of [export](export.md), where a reader of each is
tested.

{table(["package", "version", "line", "environment", "result"], rows)}

`bearing-datasets` 0.3 reads folders that its own builders make of public sets, with the columns of bearing faults. It
has no line for another set.
"""


def main() -> int:
    """Run all lines and write the page."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    good, runs = made_set()
    results = []
    for each in ADAPTERS:
        version, result = run(each, good, runs)
        print(f"{each.package} {version}: {result}", flush=True)
        results.append((each, version, result))
    PAGE.write_text(page(results), encoding="utf-8")
    return int(any(result.startswith("fails") for _, _, result in results))


if __name__ == "__main__":
    sys.exit(main())
