"""Hostile recipes, machines, sensor sets, manifests, MCAP and Parquet files: each is read, or refused in one line."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path

from rubgen.errors import UserError
from validation.reliability.guarded import GOOD, outcomes
from validation.reliability.hostile.inputs import Inputs, kind_of
from validation.reliability.rows import Row, timed
from validation.reliability.sets import undisturbed


def fuzz_rows(tries: int, kinds: list[str]) -> Iterator[Row]:
    """A row for each of these kinds of input, seeds 0 to `tries`."""
    with undisturbed() as truth, tempfile.TemporaryDirectory(prefix="rubgen-fuzz-") as folder:
        inputs = Inputs(truth.directory, Path(folder))
        for kind in kinds:
            row = Row(f"hostile {kind}")
            with timed(row):
                for seed, outcome in outcomes(inputs.tried, [seed for seed in range(tries) if kind_of(seed) == kind]):
                    row.tries += 1
                    if outcome not in GOOD:
                        row.fail("tracebacks", f"--seed {seed}: {outcome}")
            yield row


def repeat(seed: int) -> str:
    """The outcome of one input, made and read in this process."""
    with undisturbed() as truth, tempfile.TemporaryDirectory(prefix="rubgen-fuzz-") as folder:
        inputs = Inputs(truth.directory, Path(folder))
        try:
            return inputs.tried(seed)
        except UserError as error:
            return str(error)
