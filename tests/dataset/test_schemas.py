import json
import re
import tomllib
from functools import cache
from inspect import signature
from pathlib import Path

import jsonschema
import pyarrow.parquet as pq
import pytest

from rubgen.cli.app import app
from rubgen.cli.option_texts import TEXTS
from rubgen.errors import UserError
from rubgen.scenario import make_scenario, parse_recipe
from schemas import make, reference
from schemas.make import write_schemas
from schemas.option_texts import TEXTS_FILE, texts_module

ROOT = Path(__file__).parents[2]
schemas, pages = cache(make.schemas), cache(reference.pages)


@cache
def validator(name):
    """Return what raises ValidationError for a document that does not fit the schema of that name."""
    checks = jsonschema.validators.validator_for(schemas()[name])
    checks.check_schema(schemas()[name])
    return checks(schemas()[name])


@pytest.mark.parametrize("name", sorted(schemas()))
def test_checked_in_schemas_are_those_of_the_code(name, tmp_path):
    write_schemas(tmp_path)
    assert (ROOT / "schemas" / name).read_text() == (tmp_path / name).read_text(), "run `make schemas`"


@pytest.mark.parametrize("name", sorted(pages()))
def test_checked_in_reference_pages_are_those_of_the_code(name):
    assert (ROOT / "docs/reference" / name).read_text(encoding="utf-8") == pages()[name], "run `make reference`"


def test_texts_in_the_code_are_those_of_the_descriptions():
    assert TEXTS_FILE.read_text(encoding="utf-8") == texts_module(), "run `make reference`"


def test_every_key_of_make_scenario_has_its_help_text():
    keys = set(signature(make_scenario).parameters) - {"fault", "fault_keys"}
    assert keys == set(TEXTS)
    helps = {
        each.name.removeprefix("--"): each.parameter.help for each in app["simulate"].assemble_argument_collection()
    }
    for key in keys - {"machine"}:
        assert helps[key.replace("_", "-")] == TEXTS[key]
    assert TEXTS["speed_rpm"].endswith("10,000 when not given.")
    assert "in N/m" in TEXTS["disk_support_stiffness_n_per_m"]


def property_names(node):
    if isinstance(node, dict):
        yield from node.get("properties", {})
        for value in node.values():
            yield from property_names(value)
    elif isinstance(node, list):
        for value in node:
            yield from property_names(value)


@pytest.mark.parametrize("name", ["recipe.schema.json", "machine.schema.json", "sensor-set.schema.json"])
def test_reference_pages_have_every_key_of_the_schemas(name):
    text = "".join(pages().values())
    names = set(property_names(schemas()[name]))
    assert len(names) > 30
    assert {each for each in names if f"`{each}`" not in text} == set()


def test_the_schema_of_a_recipe_asks_for_the_turns_that_labels_need():
    turns = schemas()["recipe.schema.json"]["$defs"]["Simulation"]["properties"]["record_turns"]
    assert turns["minimum"] == 500 == turns["default"]
    recipe = {"name": "few", "runs": 1, "machine": "zeng2019", "simulation": {"record_turns": 500}}
    validator("recipe.schema.json").validate(recipe)
    parse_recipe(recipe)
    recipe["simulation"]["record_turns"] = 499
    assert not validator("recipe.schema.json").is_valid(recipe)
    with pytest.raises(UserError, match=r"record_turns = 499: labels need at least 500 turns"):
        parse_recipe(recipe)


@pytest.mark.parametrize("name", [name for name in sorted(schemas()) if name.endswith(".json")])
def test_no_description_has_two_blanks_between_words(name):
    assert re.findall(r"[a-z.] {2,}[A-Za-z]+", json.dumps(schemas()[name]).replace(r"\n", "|")) == []


def test_no_schema_is_left_over():
    assert {path.name for path in (ROOT / "schemas").glob("*.schema.json")} == set(schemas())


TOML_FILES = sorted(ROOT.glob("rubgen/**/*.toml"))


@pytest.mark.parametrize("path", TOML_FILES, ids=lambda path: path.stem)
def test_toml_files_name_their_schema_for_editors_and_fit_it(path):
    text = path.read_text(encoding="utf-8")
    schema = path.parent / text.removeprefix("#:schema ").partition("\n")[0]
    assert schema.resolve().parent == ROOT / "schemas"
    validator(schema.name).validate(tomllib.loads(text))


def test_every_recipe_machine_and_sensor_set_is_looked_at():
    assert len(TOML_FILES) >= 14


@pytest.mark.parametrize(
    "change", [{"runs": 0}, {"sed": 1}, {"vary": {"speed": 3}}, {"vary": {"friction": {"uniform": [1]}}}]
)
def test_wrong_recipes_do_not_fit_the_schema(change):
    recipe = {"name": "a", "runs": 1, "machine": "zeng2019", **change}
    with pytest.raises(jsonschema.ValidationError):
        validator("recipe.schema.json").validate(recipe)


def test_a_real_set_fits_the_schemas(small_set):
    manifest = json.loads((small_set.directory / "manifest.json").read_text())
    validator("manifest.schema.json").validate(manifest)
    for row in pq.read_table(small_set.directory / "runs.parquet").to_pylist():
        validator("run.schema.json").validate(row)
