"""Parquet: parameters, labels and signals of runs as rows of a table; a data set has shards of many runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from rubgen.formats.format import Format

if TYPE_CHECKING:
    from rubgen.pipeline import Run


def _write(run: Run, path: Path) -> None:
    from rubgen.io.parquet.write import write_parquet

    write_parquet(run, path)


FORMAT = Format(
    name="parquet",
    about="Parquet",
    loading="""\
```python
import rubgen
data = rubgen.open("DIR")                    # data.runs: a DataFrame; data.signals("run-000000"): arrays

import datasets, duckdb, pandas, polars
pandas.read_parquet("DIR/runs.parquet")      # parameters and labels of every run, failed ones too
datasets.load_dataset("DIR", split="SPLIT")  # with signals; offline
polars.scan_parquet("DIR/signals/*.parquet").select("run_id", "motion", "CHANNEL").collect()
duckdb.sql("select motion, count(*) from 'DIR/signals/*.parquet' group by motion")
```""",
    ways={
        "pandas": """import glob
import pandas as pd

files = sorted(glob.glob("DIR/signals/train-*.parquet"))
runs = pd.concat(map(pd.read_parquet, files))
signal = runs["CHANNEL"].iloc[0]""",
        "polars": """import polars as pl

runs = pl.scan_parquet("DIR/signals/train-*.parquet")
signal = runs.select("CHANNEL").head(1).collect()["CHANNEL"][0]""",
        "datasets": """from datasets import load_dataset

runs = load_dataset("parquet", data_files="DIR/signals/train-*.parquet", split="train")
signal = runs[0]["CHANNEL"]""",
        "torch": """import torch
from datasets import load_dataset

runs = load_dataset("parquet", data_files="DIR/signals/train-*.parquet", split="train")
runs = runs.select_columns(["CHANNEL", "motion"]).with_format("torch")
loader = torch.utils.data.DataLoader(runs, batch_size=16)""",
    },
    write=_write,
    one_file_a_run=False,
)
