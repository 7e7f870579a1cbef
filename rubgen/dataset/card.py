"""Write the card of a data set, README.md: content, loading, and the meaning of every column, as hubs show it."""

import json
from collections.abc import Sequence
from typing import Any

from rubgen.brief import counted
from rubgen.dataset.files import write_text
from rubgen.dataset.layout import SPLIT, Layout
from rubgen.dataset.manifest import Identity
from rubgen.dataset.split_counts import SplitCount, split_counts, split_table
from rubgen.format_names import FORMAT_NAMES
from rubgen.formats import format_of
from rubgen.io.columns import Column, scalar_columns, signal_columns
from rubgen.io.parquet.compact_records import RECORD_COLUMNS


def write_card(layout: Layout, identity: Identity, status: dict[str, int]) -> None:
    """Write README.md of a data set. Its bytes depend only on these inputs.

    - layout: paths of the set.
    - identity: recipe, machine, sensors and versions.
    - status: number of runs by status.
    """
    write_text(layout.card, card(identity, status, counts_of(layout, identity)))


def counts_of(layout: Layout, identity: Identity) -> dict[str, SplitCount]:
    """Count what each split holds, from `runs.parquet`; nothing for a recipe without virtual machines."""
    return split_counts(layout) if "machines" in identity.recipe else {}


def card(identity: Identity, status: dict[str, int], splits: dict[str, SplitCount]) -> str:
    """Compose the text of README.md. Its YAML head names the files of each configuration and the licence, for hubs.

    - identity: recipe, machine, sensors and versions.
    - status: number of runs by status.
    - splits: what each split holds; empty for a recipe without virtual machines.
    """
    recipe = identity.recipe
    formats = recipe["output"]["formats"]
    sensors = identity.sensor_set
    signals = signal_columns(sensors, clean=recipe["sensors"]["keep_clean"])
    columns = scalar_columns(
        sensors,
        surroundings="surroundings" in recipe,
        faults=identity.fault_kinds,
        machines=identity.machine_keys,
        drawing=recipe,
    )
    columns += signals if "parquet" in formats else ()
    channel = next((column.name for column in signals if column.kind == "signal"), "rotation_angle_rad")
    loading = "\n\n".join(format_of(name).loading for name in FORMAT_NAMES if name in formats)
    loading = loading.replace("CHANNEL", channel).replace("SPLIT", next(iter(splits), SPLIT))
    ended = ", ".join(f"{count} {name}" for name, count in status.items())
    record, limits, runs = _record(recipe), _limits(recipe), counted(recipe["runs"], "run")
    return f"""{_head(recipe, list(splits) or [SPLIT])}
# {recipe["name"]}

{runs} of a bladed disk that may rub its flexible oval casing: machine `{recipe["machine"]}`, seed
{recipe["seed"]}. Simulated with rubgen {identity.packages["rubgen"]}: a finite-element blisk and casing, reduced,
integrated through unilateral contact with friction; virtual sensors with noise, range and ADC; labels from the true
motion, never from the noisy channels. Runs by status: {ended}.

{_splits(splits)} {record}

## Loading

{loading}

`sections/*.parquet` holds what labels come from, one row a run: the state once a turn, every touch of the
record, the growths behind the Lyapunov exponent. `rubgen label DIR` makes all labels but those of orders from it again.

`manifest.json` holds the recipe, the machine, the versions and the sha256 of every file; `rubgen verify DIR` checks
all of them, and labels against signals. `rubgen repair DIR` makes again what is not data: this page, `croissant.json`,
.rrd files.

## Columns

{column_table(columns)}

## Columns of sections

Each a list, row after row where it holds rows. A state has 3 n_blades + 4 + 2 n_casing numbers, an orbit five a turn.

| column | type | meaning |
|---|---|---|
| `run_id` | string | name of the run |
{_section_table()}

## Recipe

```json
{json.dumps(recipe, indent=2)}
```

## Limits

{limits} Clearance, unbalance and damping of the
published machine are not known and were chosen. Simulated data: learn from it, do not certify with it.
"""


def _splits(splits: dict[str, SplitCount]) -> str:
    """Say which splits there are, and what each holds."""
    rule = "Splits go by machine: runs of one machine never stand in two splits."
    if not splits:
        return (
            f"{rule} This set has one machine, hence one split,\n`{SPLIT}`; split across data sets of several machines."
        )
    return f"{rule}\n\n{split_table(splits)}\n\n"


def _record(recipe: dict[str, Any]) -> str:
    """Say from which part of a run labels and signals are computed."""
    steady = recipe["operation"]["profile"] == "steady"
    record = f"{recipe['simulation']['record_turns']} turns" if steady else "the whole record, `duration_s`"
    text = f"The labels come from {record}; the signals are\nthe last {recipe['output']['signal_seconds']:g} s of it."
    if "surroundings" in recipe:
        felt = "Accelerometers on casing and bearing housing and proximity probes also feel surroundings"
        text += f"\n{felt}; labels and clean channels do not."
    return text


def _limits(recipe: dict[str, Any]) -> str:
    """Say what the model leaves out."""
    speed = "constant speed" if recipe["operation"]["profile"] == "steady" else "a speed that the rub does not change"
    wear = "no wear but the liner's" if recipe["contact"].get("liner") else "no wear"
    return f"Linear ring, {speed}, no heat, {wear}, one contact point a blade."


def _head(recipe: dict[str, object], splits: list[str]) -> str:
    """Return the YAML head that `datasets.load_dataset` and hubs understand. JSON strings are YAML strings.

    `runs.parquet` holds the runs of all splits: with several, its configuration has the one split `runs`.
    """
    output = recipe["output"]
    together = splits[0] if len(splits) == 1 else "runs"
    configs = [("runs", {together: "runs.parquet"})]
    if isinstance(output, dict) and "parquet" in output["formats"]:
        configs.insert(0, ("signals", {split: f"data/{split}-*.parquet" for split in splits}))
    configs.append(("sections", {split: f"sections/{split}-*.parquet" for split in splits}))
    lines = [
        "---",
        f"license: {json.dumps(str(recipe['license']).lower())}",
        f"pretty_name: {json.dumps(recipe['name'])}",
        "tags: [rotordynamics, blade-rub, condition-monitoring, time-series, simulated]",
        "configs:",
    ]
    for position, (name, files) in enumerate(configs):
        lines += [f"- config_name: {name}", *(["  default: true"] if position == 0 else [])]
        lines.append("  data_files:")
        for split, path in files.items():
            lines += [f"  - split: {split}", f"    path: {json.dumps(path)}"]
    return "\n".join([*lines, "---"])


def column_table(columns: Sequence[Column]) -> str:
    """Write the columns as a table in Markdown: name, role, type, unit, meaning."""
    head = "| column | role | type | unit | meaning |\n|---|---|---|---|---|\n"
    return head + "\n".join(f"| `{c.name}` | {c.role.value} | {c.kind} | {c.unit} | {c.meaning} |" for c in columns)


def _section_table() -> str:
    return "\n".join(f"| `{name}` | {kind} | {meaning} |" for name, (kind, meaning) in RECORD_COLUMNS.items())
