"""Begin a file: write a recipe, a machine or a sensor set of rubgen with a comment for each key."""

from pathlib import Path

from rubgen.dataset.files import json_text
from rubgen.errors import write_problems
from rubgen.io.files import write_durably
from rubgen.machine.descriptions import complete
from rubgen.machine.toml_file import read_toml
from rubgen.planning.commented import Commented
from rubgen.planning.offered import file_of
from rubgen.planning.user_schemas import DIALECT, FILE_NAMES, user_schema

USES = {
    "recipe": "rubgen plan {word} says what it will do; rubgen generate {word} --out DIR makes the data set",
    "machine": "rubgen modes {word} prints its frequencies; a recipe names it by machine = '{file}'",
    "sensors": "a recipe names it by set = '{file}' in [sensors]",
}
"""What to do with a file of each kind: {file} is its path, {word} the path as a word of a command."""


def commented(kind: str, name: str) -> str:
    """Return the text of rubgen's file `name` with a comment for each key. It has the values of rubgen's file.

    A key without a value there is a comment too, with its default. `kind` is recipe, machine or sensors. Raises
    UserError where rubgen has no such file.
    """
    head = (
        f"#:schema {FILE_NAMES[kind]}\n# Begun from {name} by `rubgen init {kind}`. Lines without # are in force.\n\n"
    )
    return head + Commented(user_schema(kind)).text(read_toml(file_of(kind, name)))


def begin(kind: str, name: str, path: Path) -> list[Path]:
    """Write the text of `commented` to `path`, and its schema for editors beside it. Return the written files.

    An existing schema is kept, an existing file at `path` is replaced. Raises UserError where rubgen has no file
    `name`, and where a file cannot be written.
    """
    text = commented(kind, name)
    schema = path.with_name(FILE_NAMES[kind])
    made = [] if schema.exists() else [schema]
    with write_problems(path.parent, named=f"FILE {path}"):
        if made:
            document = {"$schema": DIALECT, **complete(user_schema(kind))}
            write_durably(schema, lambda part: part.write_bytes(json_text(document).encode()))
        write_durably(path, lambda part: part.write_bytes(text.encode()))
    return [path, *made]
