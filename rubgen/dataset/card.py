"""Write the card of a data set, README.md: content, loading, and the meaning of every column, as hubs show it."""

import json
from collections.abc import Sequence
from typing import Any

from rubgen.brief import counted
from rubgen.dataset.files import write_text
from rubgen.dataset.layout import SPLIT, Layout
from rubgen.dataset.manifest import Identity
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
    write_text(layout.card, card(identity, status))


def card(identity: Identity, status: dict[str, int]) -> str:
    """Compose the text of README.md. Its YAML head names the files of each configuration and the licence, for hubs.

    `status` is the number of runs by status.
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
    loading = loading.replace("CHANNEL", channel)
    ended = ", ".join(f"{count} {name}" for name, count in status.items())
    record, limits, runs = _record(recipe), _limits(recipe), counted(recipe["runs"], "run")
    return f"""{_head(recipe)}
# {recipe["name"]}

{runs} of a bladed disk that may rub its flexible oval casing: machine `{recipe["machine"]}`, seed
{recipe["seed"]}. Simulated with rubgen {identity.packages["rubgen"]}: a finite-element blisk and casing, reduced,
integrated through unilateral contact with friction; virtual sensors with noise, range and ADC; labels from the true
motion, never from the noisy channels. Runs by status: {ended}.

Splits go by machine: runs of one machine never stand in two splits. This set has one machine, hence one split,
`{SPLIT}`; split across data sets of several machines. {record}

## Loading

{loading}

`sections/{SPLIT}-*.parquet` holds what labels come from, one row a run: the state once a turn, every touch of the
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


def _head(recipe: dict[str, object]) -> str:
    """Return the YAML head that `datasets.load_dataset` and hubs understand. JSON strings are YAML strings."""
    output = recipe["output"]
    configs = [("runs", "runs.parquet")]
    if isinstance(output, dict) and "parquet" in output["formats"]:
        configs.insert(0, ("signals", f"data/{SPLIT}-*.parquet"))
    configs.append(("sections", f"sections/{SPLIT}-*.parquet"))
    lines = [
        "---",
        f"license: {json.dumps(str(recipe['license']).lower())}",
        f"pretty_name: {json.dumps(recipe['name'])}",
        "tags: [rotordynamics, blade-rub, condition-monitoring, time-series, simulated]",
        "configs:",
    ]
    for position, (name, files) in enumerate(configs):
        lines += [f"- config_name: {name}", *(["  default: true"] if position == 0 else [])]
        lines += ["  data_files:", f"  - split: {SPLIT}", f"    path: {json.dumps(files)}"]
    return "\n".join([*lines, "---"])


def column_table(columns: Sequence[Column]) -> str:
    """Write the columns as a table in Markdown: name, role, type, unit, meaning."""
    head = "| column | role | type | unit | meaning |\n|---|---|---|---|---|\n"
    return head + "\n".join(f"| `{c.name}` | {c.role.value} | {c.kind} | {c.unit} | {c.meaning} |" for c in columns)


def _section_table() -> str:
    return "\n".join(f"| `{name}` | {kind} | {meaning} |" for name, (kind, meaning) in RECORD_COLUMNS.items())
