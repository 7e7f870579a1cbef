"""Runs as MCAP files, one file for each run."""

from rubgen.io.mcap.check import check_mcap
from rubgen.io.mcap.read import McapRun, read_mcap
from rubgen.io.mcap.write import write_mcap

__all__ = ["McapRun", "check_mcap", "read_mcap", "write_mcap"]
