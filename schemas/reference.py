"""The reference pages of the site, made from the code: `python -m schemas.reference docs/reference`."""

import inspect
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import Any

from cyclopts import App

from rubgen.cli.app import app
from rubgen.cli.run import EXIT_CODES
from rubgen.dataset.card import column_table
from rubgen.dataset.files import write_text
from rubgen.io.columns import label_columns, scalar_columns, signal_columns, tap_columns
from rubgen.labels import registry
from rubgen.machine.descriptions import Key, keys_of
from rubgen.machine.faults.registry import FAULTS
from rubgen.machine.schema_nodes import Node
from rubgen.sensors.load import load_sensor_set, sensor_set_names
from rubgen.sensors.registry import SENSOR_KINDS
from rubgen.sensors.sensor import SampledSensor
from schemas.make import documents

MADE = "<!-- Made from the code by `make reference`; do not edit. -->"
DRAWN = ("Constant", "Uniform", "LogUniform", "Normal", "NormalShape", "Choice", "WordChoice")
"""The ways to draw a value. They have a section of their own and are not followed in every key."""
TWIN, OF_MACHINE = "The twin's value, in place of that of its run. ", " Without it the machine's own value."
"""Sentences of many keys that a table need not repeat: the text above [twins] says the one, the default the other."""
HEAD = "| key | meaning | unit | allowed | default |\n|---|---|---|---|---|\n"


def pages() -> dict[str, str]:
    """File name to page: recipe, machine, sensors, faults, columns, commands."""
    return {
        "recipe.md": recipe_page(documents()["recipe.schema.json"]),
        "machine.md": machine_page(documents()["machine.schema.json"]),
        "sensor-sets.md": sensors_page(documents()["sensor-set.schema.json"]),
        "faults.md": faults_page(documents()["recipe.schema.json"]),
        "columns.md": columns_page(),
        "commands.md": commands_page(app),
    }


def recipe_page(schema: Node) -> str:
    """The keys of a recipe, table by table, and the ways to draw a value."""
    ways = []
    for name in DRAWN:
        way = _defs(schema)[name]
        if _keys(way):
            title = "Keys of the table `normal`" if name == "NormalShape" else _first(way).rstrip(".")
            ways.append(f"### {title}\n\n{key_table(way, schema)}")
    return _page(
        "Recipe",
        "A recipe is a TOML file that defines a data set: `rubgen generate RECIPE --out DIR` makes it. "
        "`rubgen init recipe` writes one with these comments.",
        key_table(schema, schema),
        *sections(schema, schema),
        "## How a value is drawn\n\nA number is the same in every run. A table of one key draws the value.",
        *ways,
    )


def machine_page(schema: Node) -> str:
    """The keys of a machine, table by table."""
    return _page(
        "Machine",
        "A machine is a TOML file. `rubgen init machine` writes one with these comments from a preset.",
        key_table(schema, schema),
        *sections(schema, schema),
    )


def sensors_page(schema: Node) -> str:
    """The keys of a sensor set: of all sampled sensors, then those that belong to one kind."""
    kinds = {node["properties"]["kind"]["const"]: node for node in _defs(schema).values() if "kind" in _keys(node)}
    common = set.intersection(*(set(_keys(node)) for node in kinds.values() if "range" in _keys(node)))
    shared = next(node for node in kinds.values() if "range" in _keys(node))
    classes = {each.__dict__.get("kind"): each for each in _below(SampledSensor)}
    parts = []
    for kind in SENSOR_KINDS:
        own = [key for key in keys_of(kinds[kind], schema) if key.name not in common]
        units = getattr(classes.get(kind), "UNITS", {})
        text = f"Units: {', '.join(units)}." if units else "It records events and no signal."
        parts.append(f"### `{kind}`\n\n{_first(kinds[kind])} {text}\n\n{_rows(own)}")
    return _page(
        "Sensor sets",
        "A sensor set is a TOML file. `rubgen init sensors` writes one with these comments. "
        "[Sensors](../sensors.md) describes the measuring chain.",
        key_table(schema, schema),
        "## `[[shaft_runout]]`\n\n" + key_table(_defs(schema)["RunoutOrder"], schema),
        "## Keys of every sampled sensor\n\n"
        "All kinds but `once_per_rev` and `blade_tip_timing` are sampled.\n\n"
        + _rows([key for key in keys_of(shared, schema) if key.name in common]),
        "## Kinds",
        *parts,
    )


def faults_page(schema: Node) -> str:
    """Each fault with its text and keys, then the keys of the surroundings."""
    parts = []
    for kind, fault in FAULTS.items():
        table = key_table(_defs(schema)[f"{fault.__name__}Table"], schema)
        severity = fault.SEVERITY
        label = f"Severity in the column `{severity.column}`: {severity.meaning}, in {severity.unit}."
        parts.append(f"### `{kind}`\n\n{_markdown(inspect.getdoc(fault) or '')}\n\n{label}\n\n{table}")
    around, tone = (_defs(schema)[name] for name in ("SurroundingsTable", "ToneTable"))
    return _page(
        "Faults and surroundings",
        "Keys of `[[faults]]` and `[surroundings]` in a recipe. Every number may be drawn. In a machine `[[faults]]` "
        "has the same keys with fixed values, and no `share`. [Faults](../faults.md) and "
        "[surroundings](../surroundings.md) say how to use them.",
        "## Faults",
        *parts,
        "## `[surroundings]`\n\n" + key_table(around, schema),
        "## `[[surroundings.tones]]`\n\n" + key_table(tone, schema),
    )


def columns_page() -> str:
    """The columns of the tables of a data set: labels, and the channels of each sensor set."""
    default = load_sensor_set("default")
    scalar, labels = scalar_columns(default), {each.name for each in label_columns()}
    every = scalar_columns(default, surroundings=True, faults=FAULTS)
    first = [each for each in scalar if each.name not in labels and not each.name.endswith(registry.TAP_ENDINGS)]
    channels = []
    for name in sensor_set_names():
        names = {sensor.name for sensor in load_sensor_set(name).sensors}
        found = [each for each in signal_columns(load_sensor_set(name), clean=False) if _sensor(each.name) & names]
        channels.append(f"### Sensor set `{name}`\n\n{column_table(found)}")
    rest = [each for each in signal_columns(default, clean=False) if each.kind != "signal"]
    return _page(
        "Labels and channels",
        "Columns of the tables of a data set. [Labels](../labels.md) says what labels mean and how they are computed.",
        "## Identity, parameters and energies of a run\n\n" + column_table(first),
        "## Labels of a run\n\n" + column_table(label_columns()),
        "## Orders of each true signal\n\nEach name begins with that of the signal; here `contact_force`.\n\n"
        + column_table(tap_columns("contact_force", "N")),
        "## Surroundings and faults\n\nOnly where the recipe has them.\n\n" + column_table(every[len(scalar) :]),
        "## Channels",
        *channels,
        "## Beside the channels\n\n" + column_table(rest),
    )


def commands_page(commands: App) -> str:
    """Each command of `rubgen` with its arguments and options, from its `--help`."""
    parts = [_command(name, commands[name]) for name in commands if not name.startswith("-")]
    return _page("Commands", "`rubgen COMMAND --help` prints the same in the terminal.", _exit_codes(), *parts)


def _exit_codes() -> str:
    rows = [f"| {code} | {meaning} |" for code, meaning in EXIT_CODES.items()]
    return "\n".join(["| exit code | meaning |", "|---:|---|", *rows])


def sections(table: Node, root: Node) -> Iterator[str]:
    """Yield a section for every kind of table below a table, with the names of all tables of this kind."""
    found: dict[str, list[tuple[str, str]]] = {}
    _find(table, root, (), found)
    for kind, places in found.items():
        titles = ", ".join(f"`{title}`" for title, _ in places)
        meaning = places[0][1] if len(places) == 1 else ""
        keys = key_table(_defs(root)[kind], root) if kind in _defs(root) else ""
        yield "\n\n".join(part for part in (f"## {titles}", meaning, keys) if part)


def _find(table: Node, root: Node, path: tuple[str, ...], found: dict[str, list[tuple[str, str]]]) -> None:
    """Collect the tables below a table by their kind: title and meaning of each."""
    for name, node in sorted(_keys(table).items(), key=lambda item: _is_named(item[1])):
        kinds = [each for each in _references(node) if each not in DRAWN]
        begin, end = ("[[", "]]") if _is_list(node) else ("[", "]")
        name += ".NAME" if _is_named(node) else ""
        title, meaning = f"{begin}{'.'.join((*path, name))}{end}", node.get("description", "")
        if len(kinds) > 1:  # kinds of fault or of sensor
            found[title] = [(title, f"{meaning} [Faults and surroundings](faults.md) has the keys of each kind.")]
        elif kinds:
            first = kinds[0] not in found
            found.setdefault(kinds[0], []).append((title, meaning))
            if first:
                _find(_defs(root)[kinds[0]], root, (*path, name), found)


def key_table(table: Node, root: Node) -> str:
    """Write the keys of a table as a table in Markdown."""
    return _rows(keys_of(table, root))


def _rows(keys: Iterable[Key]) -> str:
    lines = [f"| {' | '.join(_cell(cell) for cell in _cells(key))} |" for key in keys]
    return HEAD + "\n".join(lines) if lines else ""


def _cells(key: Key) -> tuple[str, ...]:
    default = "required" if key.required else f"`{key.default}`" if key.default else ""
    meaning = key.meaning.removeprefix(TWIN).removesuffix(OF_MACHINE)
    if key.meaning.startswith(TWIN):
        text = re.sub(r" Without it [^.]+\.$", "", meaning).rstrip(".")
        meaning, default = f"{text[0].upper()}{text[1:]}.", "its run's"
    elif key.meaning.endswith(OF_MACHINE):
        default = "the machine's"
    return f"`{key.name}`", meaning, key.unit, key.allowed, default


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _command(name: str, command: App) -> str:
    lines = [
        f"## `rubgen {name}`\n\n{inspect.cleandoc(command.help or '')}\n",
        "| argument | meaning | default |",
        "|---|---|---|",
    ]
    for each in command.assemble_argument_collection():
        default = each.field_info.default
        shown = "" if default in (None, False, inspect.Parameter.empty) else f"`{default}`"
        names = ", ".join(f"`{one}`" for one in each.names)
        lines.append(f"| {names} | {_cell(each.parameter.help or '')} | {'required' if each.required else shown} |")
    return "\n".join(lines) if len(lines) > 3 else lines[0].rstrip()


def _references(node: object) -> Iterator[str]:
    """Yield the names of the definitions to which a key refers."""
    if isinstance(node, Mapping):
        if "$ref" in node:
            yield str(node["$ref"]).rsplit("/", 1)[-1]
        for key in ("anyOf", "oneOf", "allOf", "items"):
            yield from _references(node.get(key))
        yield from _references(list(node.get("patternProperties", {}).values()))
    elif isinstance(node, list):
        yield from chain.from_iterable(map(_references, node))


def _is_list(node: Node) -> bool:
    return any(each.get("type") == "array" for each in (node, *node.get("anyOf", ())))


def _is_named(node: Node) -> bool:
    """Whether a key has tables whose names the user chooses."""
    return any("patternProperties" in each for each in (node, *node.get("anyOf", ())))


def _defs(schema: Node) -> dict[str, Any]:
    found: dict[str, Any] = schema["$defs"]
    return found


def _keys(node: Node) -> dict[str, Any]:
    found: dict[str, Any] = node.get("properties", {})
    return found


def _first(node: Node) -> str:
    return str(node.get("description", "")).split("\n", maxsplit=1)[0]


def _below(kind: type[Any]) -> Iterator[type[Any]]:
    for each in kind.__subclasses__():
        yield each
        yield from _below(each)


def _sensor(column: str) -> set[str]:
    """The names that a sensor of this column may have: the column's own, and those before an ending."""
    return {column} | {column.removesuffix(ending) for ending in ("_s", "_blade", "_true_m")}


def _markdown(text: str) -> str:
    """A docstring as Markdown: lists get the blank line that they need."""
    return re.sub(r"\n(?=- )", "\n\n", text, count=1)


def _page(title: str, *parts: str) -> str:
    return "\n\n".join([MADE, f"# {title}", *(part for part in parts if part)]) + "\n"


if __name__ == "__main__":
    for _name, _text in pages().items():
        write_text(Path(sys.argv[1]) / _name, _text)
