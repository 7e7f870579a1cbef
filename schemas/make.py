"""The schemas of what users write and read, and the tables of labels in docs/labels.md.

`python -m schemas.make DIRECTORY PAGE` writes the schemas into the directory and the tables into the page.
"""

import re
import sys
from pathlib import Path
from typing import Any

from rubgen.dataset.card import column_table
from rubgen.dataset.files import write_json, write_text
from rubgen.dataset.manifest import Manifest
from rubgen.io.columns import Column, every_scalar, label_columns, scalar_columns, tap_columns
from rubgen.io.mcap.messages import MESSAGES, PACKAGE
from rubgen.labels import registry
from rubgen.labels.classes import class_numbers
from rubgen.machine.descriptions import complete
from rubgen.planning.user_schemas import DIALECT, FILE_NAMES, user_schema
from rubgen.sensors.load import default_sensor_set

JSON_TYPES: dict[str, dict[str, Any]] = {
    "text": {"type": "string"},
    "texts": {"type": "array", "items": {"type": "string"}},
    "flag": {"type": "boolean"},
    "class": {"type": "integer"},
    "integer": {"type": "integer"},
    "number": {"type": "number"},
    "integers": {"type": "array", "items": {"type": "integer"}},
    "numbers": {"type": "array", "items": {"type": ["number", "null"]}},
}


def documents() -> dict[str, dict[str, Any]]:
    """File name to schema as pydantic makes it: recipe, machine, sensor set, manifest."""
    users = {name: user_schema(kind) for kind, name in FILE_NAMES.items()}
    return {**users, "manifest.schema.json": Manifest.model_json_schema()}


def schemas() -> dict[str, dict[str, Any]]:
    """File name to schema with whole descriptions; one more is of a row of `runs.parquet`."""
    completed = {name: complete(document) for name, document in documents().items()}
    completed["run.schema.json"] = _run_schema()
    return {name: {"$schema": DIALECT, **document} for name, document in completed.items()}


def write_schemas(directory: Path) -> None:
    """Write every schema into `directory`, and the protobuf messages of MCAP files."""
    directory.mkdir(parents=True, exist_ok=True)
    for name, document in schemas().items():
        write_json(directory / name, document)
    write_text(directory / "rubgen.v1.proto", proto_text())


def proto_text() -> str:
    """The messages as a .proto file, as under `schemas/`."""
    lines = ['syntax = "proto3";', "", f"package {PACKAGE};", "", 'import "google/protobuf/timestamp.proto";']
    for name, (comment, fields) in MESSAGES.items():
        lines += ["", f"// {comment}", f"message {name} {{"]
        for number, field in enumerate(fields, start=1):
            kind = f"repeated {field.type}" if field.repeated else field.type
            note = f"  // {field.comment}" if field.comment else ""
            lines.append(f"  {kind} {field.name} = {number};{note}")
        lines.append("}")
    return "\n".join(lines) + "\n"


def with_tables(page: str) -> str:
    """The page with its tables of labels made from the registry, each from `<!-- group -->` to `<!-- end -->`."""
    groups = {
        "contact": label_columns(registry.CONTACT),
        "motion": label_columns(registry.MOTION),
        "orders": label_columns(registry.ORDERS),
        "exponent": label_columns(registry.EXPONENT),
        "history": label_columns(registry.HISTORY),
        "windows": label_columns(registry.WINDOWS),
        "taps": tap_columns("<tap>", "of the tap"),
    }
    for group, columns in groups.items():
        table = f"<!-- {group} -->\n{column_table(columns)}\n<!-- end -->"
        page = re.sub(rf"<!-- {group} -->\n.*?<!-- end -->", lambda _, table=table: table, page, flags=re.DOTALL)  # type: ignore[misc]
    return page


def _run_schema() -> dict[str, Any]:
    columns, endings = scalar_columns(default_sensor_set()), "|".join(registry.TAP_ENDINGS)
    around = every_scalar(default_sensor_set())[len(columns) :]
    return {
        "title": "Run",
        "description": "One row of runs.parquet. Labels are null where a run failed or has no such value; levels of "
        "surroundings, labels of faults, values of virtual machines and the partners of twins are there where the "
        "recipe has them.",
        "type": "object",
        "properties": {column.name: _property(column) for column in (*columns, *around)},
        "required": [column.name for column in columns],
        "patternProperties": {f"^[A-Za-z]\\w*({endings})$": {"description": "of a further true signal"}},
        "additionalProperties": False,
    }


def _property(column: Column) -> dict[str, Any]:
    kind = dict(JSON_TYPES[column.kind])
    numbers = class_numbers(column.words) if column.words else {}
    if column.kind == "class":
        kind["enum"] = sorted(numbers.values())
    nullable = {"anyOf": [kind, {"type": "null"}]} if column.nullable else kind
    meaning = f"{column.meaning}{f', in {column.unit}' if column.unit else ''}"
    classes = {"classes": numbers} if numbers else {}
    return {"description": meaning, "role": column.role.value, **classes, **nullable}


if __name__ == "__main__":
    write_schemas(Path(sys.argv[1]))
    for page in map(Path, sys.argv[2:]):
        write_text(page, with_tables(page.read_text(encoding="utf-8")))
