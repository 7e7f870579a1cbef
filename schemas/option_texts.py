"""Help texts of `rubgen simulate`, made from the descriptions: `python -m schemas.option_texts`.

They stand in a module of texts, because the command line must not import the package.
"""

import json
import re
from inspect import signature
from pathlib import Path

from rubgen.dataset.files import write_text
from rubgen.machine.descriptions import Key, keys_of
from rubgen.planning.user_schemas import user_schema
from rubgen.scenario.make import SURROUNDINGS_KEYS, TABLES, make_scenario
from rubgen.scenario.vary import DRAWN

TEXTS_FILE = Path(__file__).parents[1] / "rubgen/cli/option_texts.py"
HEAD = '''"""Help texts of the keys of a run, made from their descriptions by `make reference`; do not edit."""

TEXTS = {
'''
NOT_GIVEN = [name for name, each in signature(make_scenario).parameters.items() if each.default is None]
"""Keys whose default is not in the signature."""
DEFINITIONS = {
    "operation": "Profile",
    "simulation": "Simulation",
    "sensors": "Sensors",
    "output": "Output",
    "labels": "Labelling",
}
"""The definition of each table of a recipe in its schema."""


def run_keys() -> dict[str, Key]:
    """The keys of `make_scenario` that are keys of a recipe, by their names there, each described."""
    schema = user_schema("recipe")

    def of(table: str) -> dict[str, Key]:
        return {key.name: key for key in keys_of(schema["$defs"][table], schema)}

    own = {key.name: key for key in keys_of(schema, schema)}
    found = {name: own[name] for name in ("machine", "seed")}
    found |= {entry.key: of("Vary")[entry.key] for entry in DRAWN}
    found |= {name: key for name, key in of("Profile").items() if name in found}  # says which profile needs it
    found |= {name: of("SurroundingsTable")[name] for name in SURROUNDINGS_KEYS}
    found |= {name: of(DEFINITIONS[table])[name] for table, names in TABLES.items() for name in names}
    return found | {"sensors": of("Sensors")["set"]}


def short(key: Key) -> str:
    """The first sentence of a description, with unit, allowed values and default.

    A key that a profile needs has no default there, although the table of all profiles has one.
    """
    sentence = key.meaning.split(". ", maxsplit=1)[0].rstrip(".")
    without = re.search(r"Without it (\d[\d,]*)", key.meaning)
    default = without[1] if without else key.default if key.name in NOT_GIVEN and "needs it" not in sentence else ""
    range_ = ", ".join(filter(None, (f"in {key.unit}" if key.unit else "", key.allowed)))
    return "; ".join(filter(None, (sentence, range_, f"{default} when not given" if default else ""))) + "."


def texts_module() -> str:
    """The module with the help texts."""
    lines = [f'    "{name}": {_literal(short(key))},\n' for name, key in run_keys().items()]
    return HEAD + "".join(lines) + '}\n"""By the key of `make_scenario`."""\n'


def _literal(text: str) -> str:
    """The text in the quotes that the formatter prefers."""
    return f"'{text}'" if '"' in text and "'" not in text else json.dumps(text, ensure_ascii=False)


if __name__ == "__main__":
    write_text(TEXTS_FILE, texts_module())
