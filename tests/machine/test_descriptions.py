import re

import pytest
from pydantic import TypeAdapter

from rubgen.errors import UserError
from rubgen.machine.descriptions import complete, unit_of
from rubgen.machine.faults.registry import FAULTS
from rubgen.scenario import Recipe, parse_recipe
from schemas.make import documents, schemas

SCHEMAS = schemas()
ENDS = re.compile(r"Allowed: (?:at least|above) (\S+) and (?:at most|below) (\S+)\.")


def properties(node, place="#"):
    """Yield every property of a schema with its place."""
    if isinstance(node, dict):
        named = node.get("properties", {})
        for key, value in named.items() if isinstance(named, dict) else ():
            yield f"{place}/{key}", value
        for key, value in node.items():
            yield from properties(value, f"{place}/{key}")
    elif isinstance(node, list):
        for number, value in enumerate(node):
            yield from properties(value, f"{place}/{number}")


@pytest.mark.parametrize("name", sorted(SCHEMAS))
def test_every_property_of_every_schema_has_a_description(name):
    """Counted before unit, range and default are added, which alone describe nothing."""
    found = dict(properties(documents().get(name, SCHEMAS[name])))
    assert len(found) > 10
    assert [place for place, value in found.items() if len(value.get("description", "")) < 10] == []


def test_the_unit_stands_in_the_description_of_a_key_with_a_unit():
    machine = dict(properties(SCHEMAS["machine.schema.json"]))
    assert "Unit: N/m." in machine["#/$defs/DiskSupport/lateral_stiffness_n_per_m"]["description"]
    assert "Unit: kg m." in machine["#/unbalance_kg_m"]["description"]
    assert [unit_of(key) for key in ("drift_per_s", "dropouts_per_s", "runs", "blades", "lobes")] == [""] * 5


def recipe(**tables):
    return {"name": "a", "runs": 1, "machine": "zeng2019", **tables}


def text_of(table, key):
    return SCHEMAS["recipe.schema.json"]["$defs"][table]["properties"][key]["description"]


def ends(text):
    return [float(end.replace(",", "")) for end in ENDS.search(text).groups()]


@pytest.mark.parametrize("key", ["friction", "support_anisotropy", "ovality_m", "lobes"])
def test_a_drawn_key_is_refused_just_outside_of_the_range_in_its_description(key):
    low, high = ends(text_of("Vary", key))
    for value in (low - 1, high + 1):
        with pytest.raises(UserError, match=key):
            parse_recipe(recipe(vary={key: value}))


def test_the_default_of_a_fault_key_is_the_one_that_the_fault_gets():
    kind, key = "misalignment", "coupling_length_m"
    stated = float(re.search(r"Default: (\S+)\.$", text_of("MisalignmentTable", key))[1])
    given = recipe(faults=[{"kind": kind, "parallel_m": 1e-4}])
    assert getattr(parse_recipe(given).scenario(0).machine.faults[0], key) == stated


def test_a_description_is_the_same_for_a_machine_and_where_the_key_is_drawn():
    machine = SCHEMAS["machine.schema.json"]["$defs"]
    about = machine["Casing"]["properties"]["clearance_m"]["description"].partition(" Unit:")[0]
    assert about
    assert text_of("Vary", "clearance_m").startswith(about)
    for kind, fault in FAULTS.items():
        for key, value in machine[fault.__name__]["properties"].items():
            table = f"{fault.__name__}Table"
            assert text_of(table, key).partition(" Unit:")[0].startswith(value["description"].split(".")[0]), kind


def test_what_is_added_to_schemas_of_draws_is_no_part_of_a_schema_for_users():
    raw = TypeAdapter(Recipe).json_schema()
    assert "x-allowed" in str(raw)
    assert "x-" not in str([value.keys() for _, value in properties(complete(raw))])
