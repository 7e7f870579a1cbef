"""MCAP: every sample, contacts, labels and scenario of one run in one file, for Foxglove and `rubgen replay`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rubgen.formats.format import Format, RunSignals

if TYPE_CHECKING:
    from rubgen.pipeline import Run


def _write(run: Run, path: Path) -> None:
    from rubgen.io.mcap import write_mcap

    write_mcap(run, path)


def _signals(path: Path, names: Sequence[str]) -> RunSignals:
    from rubgen.io.mcap import read_mcap
    from rubgen.io.mcap.content import run_number

    run = read_mcap(path, channels=names)
    clean = {f"{name}_clean": values for name, values in run.clean.items()}
    number = run_number(run.scenario) or 0
    return RunSignals(number=number, channels=run.signals | clean, once_per_rev=run.once_per_rev)


def _problems(path: Path, run_id: str, _proven: bool) -> list[str]:
    from rubgen.io.mcap import check_mcap

    return check_mcap(path, run_id)


FORMAT = Format(
    name="mcap",
    about="MCAP, for Foxglove and rubgen replay",
    loading="""\
`mcap/0000/<run_id>.mcap`: one file a run, a folder for a thousand runs; `rubgen.io.mcap.read_mcap(path)`, the `mcap`
package, or Foxglove. Blocks of 1024 samples on `/raw/<channel>`, contacts on `/contact`, labels and
scenario as metadata.""",
    ways={
        "MCAP": """from pathlib import Path
from rubgen.io.mcap import read_mcap

run = read_mcap(Path("DIR/mcap/0000/RUN.mcap"))
signal = run.signals["CHANNEL"]
labels = run.labels"""
    },
    look="for Foxglove:   {folder}/",
    write=_write,
    problems=_problems,
    signals=_signals,
)
