"""False alarms of `rubgen verify` on short signals, and how many labels of impulse that are 2 % off it finds.

`python -m validation.reliability.short_sets` makes 300 fresh runs: signals of 0.05 to 2 s, 1,500 to 12,000 rev/min,
both sensor sets. It prints the counts and writes them to out/short_sets.json. About ten minutes.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import rubgen
from rubgen.dataset.checking.channel_check import Row, resolved_impulse, samples_per_turn, whole_turn_weights
from rubgen.dataset.checking.consistency import label_problems, signal_problems
from rubgen.labels.labels import Motion
from rubgen.measurement.channel import Float32Array
from rubgen.scenario import Sensing
from rubgen.sensors.load import load_sensor_set

SECONDS = (0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0, 2.0)
SENSOR_SETS = ("default", "rig")
RUNS_PER_SET = 15
OFF = 1.02
"""What a wrong label is multiplied with."""


@dataclass
class Counts:
    """Of one length of signals."""

    seconds: float
    runs: int = 0
    rubbing: int = 0
    false_alarms: int = 0
    wrong_labels: int = 0
    """Runs of period-1 in contact whose force channel resolves half of the 2 %."""
    found: int = 0
    """Wrong labels that are found where nothing else is wrong."""
    found_by_channel: int = 0
    """Found where the impulses of blades and windows are wrong by the same factor: the channel alone can tell."""


def main() -> None:
    """Make the sets, print the table, write the file."""
    table = study(SECONDS, SENSOR_SETS, RUNS_PER_SET)
    for each in table:
        sys.stdout.write(f"{json.dumps(asdict(each))}\n")
    Path("out").mkdir(exist_ok=True)
    Path("out/short_sets.json").write_text(json.dumps([asdict(each) for each in table], indent=2) + "\n")


def study(seconds: Sequence[float], sensor_sets: Sequence[str], runs: int) -> list[Counts]:
    """Counts for each length of signals, over a set of `runs` runs for each sensor set."""
    table = []
    for number, length in enumerate(seconds):
        counts = Counts(seconds=length)
        for sensors in sensor_sets:
            with tempfile.TemporaryDirectory(prefix="rubgen-") as folder:
                recipe = recipe_of(length, sensors, runs, seed=1000 + number)
                _count(Path(folder) / "set", recipe, counts)
        table.append(counts)
        sys.stderr.write(f"{counts}\n")
    return table


def recipe_of(seconds: float, sensors: str, runs: int, seed: int) -> dict[str, object]:
    """A recipe of short records: few turns to settle, so that transients are recorded too."""
    return {
        "name": "short",
        "seed": seed,
        "runs": runs,
        "machine": "zeng2019",
        "vary": {
            "speed_rpm": {"uniform": [1500.0, 12000.0]},
            "clearance_m": {"uniform": [2e-5, 3e-4]},
            "friction": {"uniform": [0.0, 0.02]},
        },
        "simulation": {"settle_turns": 60, "record_turns": 500},
        "sensors": {"set": sensors},
        "output": {"formats": ["parquet"], "signal_seconds": seconds},
    }


def _count(directory: Path, recipe: dict[str, object], counts: Counts) -> None:
    rubgen.generate(recipe, directory, workers=1)
    problems = rubgen.verify(directory)
    counts.false_alarms += len(problems)
    for problem in problems:
        sys.stderr.write(f"{problem}\n")
    sensors = recipe["sensors"]
    sensing = Sensing(set=load_sensor_set(sensors["set"] if isinstance(sensors, dict) else "default"))
    data = rubgen.open(directory)
    for run_id in data.ok.index:
        counts.runs += 1
        counts.rubbing += data.row(run_id)["rub"]
        _count_wrong(data.whole_row(run_id), data.signals(run_id), sensing, counts)


def _count_wrong(row: Row, signals: dict[str, Float32Array], sensing: Sensing, counts: Counts) -> None:
    if not row["rub"] or row["motion"] != Motion.PERIOD_1.value or not _resolved(row, signals, sensing):
        return
    counts.wrong_labels += 1
    alone = row | {"contact_impulse_per_turn_n_s": OFF * row["contact_impulse_per_turn_n_s"]}
    counts.found += any("contact_impulse" in problem for problem in label_problems(alone))
    lists = ("blade_impulses_per_turn_n_s", "window_impulse_per_turn_n_s")
    together = alone | {name: [OFF * value for value in row[name]] for name in lists}
    found = [*label_problems(together), *signal_problems(together, signals, sensing)]
    counts.found_by_channel += any("contact_impulse" in problem for problem in found)


def _resolved(row: Row, signals: dict[str, Float32Array], sensing: Sensing) -> bool:
    """Whether the run has a force channel, enough turns and little enough noise for half of what a label is off."""
    if "contact_force" not in signals:
        return False
    sensor = next(each for each in sensing.set.sampled if each.name == "contact_force")
    low, high = sensor.range or (0.0, 0.0)
    weights = whole_turn_weights(signals["contact_force"].size, samples_per_turn(row))
    if weights is None:
        return False
    limit = resolved_impulse(row, weights, sensing.noise * sensor.noise_rms, (high - low) / 2**sensing.adc_bits)
    return bool(limit < (OFF - 1) / 2 * row["contact_impulse_per_turn_n_s"])


if __name__ == "__main__":
    main()
