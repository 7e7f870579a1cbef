"""The JSON schemas of the files that users write."""

from typing import Any

from pydantic import TypeAdapter

from rubgen.machine import Machine
from rubgen.scenario import Recipe
from rubgen.sensors.registry import SENSOR_KINDS
from rubgen.sensors.sensor_set import SensorSet

FILE_NAMES = {
    "recipe": "recipe.schema.json",
    "machine": "machine.schema.json",
    "sensors": "sensor-set.schema.json",
}
"""The file of each schema, by the kind of file that it describes."""
DIALECT = "https://json-schema.org/draft/2020-12/schema"


def user_schema(kind: str) -> dict[str, Any]:
    """Return the JSON schema of a kind of file (recipe, machine or sensors), as pydantic makes it.

    The descriptions lack unit, allowed values and default.
    """
    if kind == "recipe":
        return Recipe.model_json_schema()
    return TypeAdapter(Machine).json_schema() if kind == "machine" else _sensor_set_schema()


def _sensor_set_schema() -> dict[str, Any]:
    """Return the schema of a sensor set. Its `[kinds.<kind>]` tables are merged into the sensors before validation."""
    schema: dict[str, Any] = TypeAdapter(SensorSet).json_schema()
    tables = {
        "type": "object",
        "additionalProperties": {"type": "object"},
        "propertyNames": {"enum": list(SENSOR_KINDS)},
    }
    about = "Values of every sensor of a kind, by the name of the kind."
    schema["properties"]["kinds"] = {"description": about, **tables}
    return schema
