"""A scenario as a dictionary for JSON."""

from typing import cast

from pydantic import TypeAdapter

from rubgen.scenario.scenario import Scenario


def scenario_dict(scenario: Scenario) -> dict[str, object]:
    """The scenario as nested JSON-ready Python values, keys as in the dataclasses, complete with its machine.

    `TypeAdapter(Scenario).validate_python(scenario_dict(s)) == s`: every float keeps all its bits in JSON.
    """
    return cast("dict[str, object]", TypeAdapter(Scenario).dump_python(scenario, mode="json"))
