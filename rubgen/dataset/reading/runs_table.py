"""`runs.parquet` as it must be: its runs are the manifest's, and good runs have the labels that every view needs."""

from collections import Counter
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc

from rubgen.dataset.manifest import Manifest
from rubgen.errors import UserError
from rubgen.labels.labels import Motion

FLAGS_AND_COUNTS = ("rub", "blades_touched", "contact_touches")
NUMBERS = ("contact_duty", "contact_impulse_per_turn_n_s", "speed_rpm", "sample_rate_hz")
MOTIONS = ("motion", "motion_blisk", "motion_casing")


def check_runs(table: pa.Table, manifest: Manifest, path: Path) -> None:
    """Raise UserError, one line with file and run, where the table's values are not those of the set."""
    names = table["run_id"].to_pylist()
    if names != [f"run-{index:06d}" for index in range(manifest.runs)]:
        raise UserError(f"{path}: its runs are not the {manifest.runs} of the manifest; generate the set again")
    if Counter(table["status"].to_pylist()) != Counter(manifest.status):
        raise UserError(f"{path}: its status counts are not those of the manifest; generate the set again")
    good = table.filter(pc.equal(table["status"], "ok"))
    for name in (*FLAGS_AND_COUNTS, *NUMBERS, *MOTIONS):
        wrong = pc.is_null(good[name])
        if name in NUMBERS:
            wrong = pc.invert(pc.fill_null(pc.is_finite(good[name]), False))
        elif name in MOTIONS:
            wrong = pc.invert(pc.is_in(good[name], pa.array([motion.value for motion in Motion])))
        where = pc.index(wrong, True).as_py()
        if where >= 0:
            run_id, value = good["run_id"][where].as_py(), good[name][where].as_py()
            raise UserError(f"{path}: {run_id}: {name} = {value!r:.60} of a good run; generate the set again")
