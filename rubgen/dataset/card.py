"""Write the card of a data set, README.md: content, loading, and the meaning of every column, as hubs show it."""

import json
from collections import Counter
from collections.abc import Sequence
from typing import Any

from rubgen.brief import counted
from rubgen.dataset.files import write_text
from rubgen.dataset.layout import SPLIT, Layout
from rubgen.dataset.manifest import Identity
from rubgen.dataset.tables import files_of, tables_of
from rubgen.dataset.tally import Tally, tally_of
from rubgen.format_names import FORMAT_NAMES
from rubgen.formats import format_of
from rubgen.io.columns import Column, Role, scalar_columns, signal_columns
from rubgen.io.parquet.compact_records import RECORD_COLUMNS
from rubgen.io.parquet.set_tables import WINDOW_COLUMNS
from rubgen.labels import Motion
from rubgen.labels.classes import class_numbers
from rubgen.labels.registry import LABELS


def write_card(layout: Layout, identity: Identity, status: dict[str, int]) -> None:
    """Write README.md of a data set. Its bytes depend only on these inputs and `runs.parquet`, which must exist.

    - layout: paths of the set.
    - identity: recipe, machine, sensors and versions.
    - status: number of runs by status, such as ok or refused.
    """
    write_text(layout.card, card(identity, status, tally_of(layout.runs)))


def card(identity: Identity, status: dict[str, int], tally: Tally) -> str:
    """Compose the text of README.md. Its YAML head names the files of each configuration and the licence, for hubs.

    - identity: recipe, machine, sensors and versions.
    - status: number of runs by status, such as ok or refused.
    - tally: counts of runs, machines and classes by split.
    """
    recipe, recipes = identity.recipe, identity.recipes
    formats = recipe["output"]["formats"]
    signals = signal_columns(identity.sensor_set, clean=recipe["sensors"]["keep_clean"])
    limits = " ".join(dict.fromkeys(map(_limits, recipes)))
    return f"""{_head(recipe, tally)}
# {recipe["name"]}

{_introduction(identity, status)}

{_tables(formats)}

## Splits and classes

{_class_table(tally)}

{_leakage(tally)}

## Biases

{_biases(tally)}

## Loading

{_loading(formats, signals, tally)}

{_columns(identity, signals)}

{"## Recipes" if identity.sources else "## Recipe"}

```json
{json.dumps(recipes if identity.sources else recipe, indent=2)}
```

## Limits

{limits} Clearance, unbalance and damping of the
published machine are not known and were chosen. Simulated data: learn from it, do not certify with it.
"""


def _introduction(identity: Identity, status: dict[str, int]) -> str:
    """Say what the runs are, where they come from and how they ended."""
    recipe = identity.recipe
    origin = _merged_from(identity) or f"{_machines(recipe['machine'])}, seed\n{recipe['seed']}"
    ended = ", ".join(f"{count} {name}" for name, count in status.items())
    record = " ".join(dict.fromkeys(map(_record, identity.recipes)))
    return f"""{counted(recipe["runs"], "run")} of a bladed disk that may rub its flexible oval casing: {origin}.
Simulated with rubgen {identity.packages["rubgen"]}: a finite-element blisk and casing, reduced,
integrated through unilateral contact with friction; virtual sensors with noise, range and ADC; labels from the true
motion, never from the noisy channels. Runs by status: {ended}. {record}"""


def _loading(formats: Sequence[str], signals: Sequence[Column], tally: Tally) -> str:
    """Say how to read the set, and what its other files are for."""
    channel = next((x.name for x in signals if x.kind == "signal" and x.role is Role.INPUT), "contact_force")
    loading = "\n\n".join(format_of(name).loading for name in FORMAT_NAMES if name in formats)
    loading = loading.replace("CHANNEL", channel).replace("SPLIT", next(iter(tally.splits), SPLIT))
    return f"""{loading}

`sections/` holds what labels come from, one row a run: the state once a turn, every touch of the
record, the growths behind the Lyapunov exponent. `rubgen label DIR` makes all labels but those of orders from it again.

`manifest.json` holds the recipe, the machine, the versions and the sha256 of every file; `rubgen verify DIR` checks
all of them, and labels against signals. `rubgen repair DIR` makes again what is not data: this page, `croissant.json`,
.rrd files."""


def _columns(identity: Identity, signals: Sequence[Column]) -> str:
    """Write the columns of every table, with their meaning."""
    recipe = identity.recipe
    columns = scalar_columns(
        identity.sensor_set,
        surroundings="surroundings" in recipe,
        faults=identity.fault_kinds,
        machines=identity.machine_keys,
        drawing=[*recipe, *(["merged"] if identity.sources else [])],
    )
    return f"""## Columns of runs

A column of the type class is an integer; its numbers are the same in every set:
{_numbers()}.

{column_table(columns)}
{_signal_tables(signals) if "parquet" in recipe["output"]["formats"] else ""}
## Columns of windows

One row for each window of 16 turns that the signals hold whole.

{column_table(WINDOW_COLUMNS)}

## Columns of sections

Each a list, row after row where it holds rows. A state has 3 n_blades + 4 + 2 n_casing numbers, an orbit five a turn.

| column | type | meaning |
|---|---|---|
| `run_id` | string | name of the run |
{_section_table()}"""


def _machines(names: str | list[str]) -> str:
    """Name the machines that a recipe begins from."""
    if isinstance(names, str):
        return f"machine `{names}`"
    return f"machines {', '.join(f'`{name}`' for name in names)}"


def _merged_from(identity: Identity) -> str:
    """Say of a merged set which sets it was made from; nothing of any other."""
    if not identity.sources:
        return ""
    rows = []
    for each in identity.sources:
        recipe = each.identity.recipe
        rows.append(f"| `{each.digits}` | {recipe['name']} | {recipe['seed']} | {recipe['runs']} |")
    table = "\n".join(["| source | name | seed | runs |", "|---|---|---|---|", *rows])
    about = "`merged_from` has the source of a run and its name there.\nBelow are the recipes of the sources, in order"
    return f"merged from {counted(len(rows), 'set')}, in this order:\n\n{table}\n\n{about}"


def _tables(formats: Sequence[str]) -> str:
    """Say which table has what."""
    lines = [
        "| configuration | one row | content |",
        "|---|---|---|",
        "| `runs` | a run, failed ones too | names, parameters, labels |",
        "| `windows` | a window of 16 turns | its place in the signals, rub, duty, impulse, motion |",
        "| `sections` | a good run | what labels are made from |",
    ]
    if "parquet" in formats:
        lines[2:2] = [
            "| `signals` | a good run | names, recorded channels and events (`input`), answers (`target`) |",
            "| `truth` | a good run | touches, orders by window, what no sensor could record |",
        ]
    return "\n".join([*lines, "", "`sensors.parquet` has place, range, resolution and noise of each channel."])


def _class_table(tally: Tally) -> str:
    """Count the classes of each split, as a table in Markdown."""
    motions = [motion.value for motion in Motion if any(each.motion[motion.value] for each in tally.splits.values())]
    lines = [
        f"| split | machines | runs | ok | with rub | {' | '.join(motions)} |",
        "|---|" + "---|" * (4 + len(motions)),
    ]
    for name, each in tally.splits.items():
        counts = [each.machines, each.runs, each.status["ok"], each.rub]
        lines.append(f"| `{name}` | {' | '.join(map(str, [*counts, *(each.motion[word] for word in motions)]))} |")
    return "\n".join(lines)


def _leakage(tally: Tally) -> str:
    """Warn of splits that leak."""
    machines = sum(each.machines for each in tally.splits.values())
    own = (
        "This set has one machine: a score on other runs of it says nothing about other machines."
        if machines == 1
        else "A machine is in one split alone; `machine_id` names it."
    )
    return f"""{own} Never cut runs into windows and divide
those at random: windows of one run are nearly equal, and the score is too good. `data.folds` and the groups of
`data.windows` keep together what belongs together. Only the role `input` may be learned from: `parameter`, `truth` and
`diagnostic` give answers away, some by being null alone."""


def _biases(tally: Tally) -> str:
    """Say which runs are missing and where, and what else is not as in the field."""
    failed = sum(each.runs - each.status["ok"] for each in tally.splits.values())
    texts = [
        "The field has no such sure labels, sensors that are known less well, and other conditions: scores are lower."
    ]
    if failed:
        codes = Counter[str]()
        for each in tally.splits.values():
            codes.update({code: count for code, count in each.status.items() if code != "ok"})
        ended = ", ".join(f"{count} {code}" for code, count in codes.most_common())
        texts.insert(0, f"{counted(failed, 'run')} failed ({ended}) and cannot be learned from.")
        if tally.shifts:
            texts.insert(1, "So these conditions are rarer in the set than in the recipe (means):\n")
            rows = [f"| `{x.key}` | {x.unit} | {x.good:.4g} | {x.failed:.4g} |" for x in tally.shifts]
            texts.insert(
                2, "\n".join(["| parameter | unit | good runs | failed runs |", "|---|---|---|---|", *rows, ""])
            )
    return "\n".join(texts)


def _numbers() -> str:
    found = {label.name: class_numbers(label.words) for label in LABELS if label.words and label.kind == "text"}
    kinds = {name: ", ".join(f"{word} {number}" for word, number in words.items()) for name, words in found.items()}
    return ";\n".join(f"`{name}` {kinds[name]}" for name in ("motion", "rub_extent", "whirl"))


def _signal_tables(signals: Sequence[Column]) -> str:
    seen = [column for column in signals if column.role in (Role.INPUT, Role.TIME)]
    return f"""
## Columns of signals

Beside the columns of `runs` whose role is `id`, `time` or `target`:

{column_table(seen)}

## Columns of truth

Beside the names of the run:

{column_table([column for column in signals if column not in seen])}
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


def _head(recipe: dict[str, Any], tally: Tally) -> str:
    """Return the YAML head that `datasets.load_dataset` and hubs understand. JSON strings are YAML strings."""
    names = [table.name for table in tables_of(recipe["output"]["formats"])]
    lines = [
        "---",
        f"license: {json.dumps(str(recipe['license']).lower())}",
        f"pretty_name: {json.dumps(recipe['name'])}",
        "tags: [rotordynamics, blade-rub, condition-monitoring, time-series, simulated]",
        "configs:",
    ]
    for position, name in enumerate([*names, "runs", "sensors"]):
        lines += [f"- config_name: {name}", *(["  default: true"] if position == 0 else []), "  data_files:"]
        one = name in ("runs", "sensors")  # a file for all splits
        for split in [_together(tally)] if one else tally.splits:
            path = f"{name}.parquet" if one else files_of(name, split)
            lines += [f"  - split: {split}", f"    path: {json.dumps(path)}"]
    return "\n".join([*lines, "---"])


def _together(tally: Tally) -> str:
    """Name the split of a file that holds the runs of all splits: the only one, or `runs`."""
    return next(iter(tally.splits), SPLIT) if len(tally.splits) < 2 else "runs"


def column_table(columns: Sequence[Column]) -> str:
    """Write the columns as a table in Markdown: name, role, type, unit, meaning."""
    head = "| column | role | type | unit | meaning |\n|---|---|---|---|---|\n"
    return head + "\n".join(f"| `{c.name}` | {c.role.value} | {c.kind} | {c.unit} | {c.meaning} |" for c in columns)


def _section_table() -> str:
    return "\n".join(f"| `{name}` | {kind} | {meaning} |" for name, (kind, meaning) in RECORD_COLUMNS.items())
