import errno
import json
import os
import re
import tomllib
from functools import cache
from itertools import pairwise
from pathlib import Path

import jsonschema
import pytest

from rubgen.cli import main
from rubgen.machine import load_machine
from rubgen.planning.begin import begin, commented
from rubgen.planning.commented import toml_value
from rubgen.planning.offered import FOLDERS, offered
from rubgen.scenario import load_recipe
from rubgen.sensors.load import load_sensor_set

EVERY = [(kind, name) for kind in FOLDERS for name in offered(kind)]
LOADERS = {"machine": lambda path: load_machine(str(path)), "sensors": lambda path: load_sensor_set(str(path))}


def meaning(kind, path):
    if kind == "recipe":
        recipe = load_recipe(path)
        return recipe.model_dump(), recipe.base
    return LOADERS[kind](path)


@pytest.mark.parametrize(("kind", "name"), EVERY)
def test_a_file_begun_from_another_has_the_same_meaning(kind, name, tmp_path):
    path = tmp_path / "mine.toml"
    begin(kind, name, path)
    assert meaning(kind, path) == meaning(kind, FOLDERS[kind] / f"{name}.toml")


@pytest.mark.parametrize(("kind", "name"), [each for each in EVERY if each[0] != "recipe"])
def test_defaults_in_comments_are_the_defaults(kind, name, tmp_path):
    """With every default put in force the file still means the same."""
    path = tmp_path / "mine.toml"
    text, count = re.subn(r"(?m)^# (\w+ = )", r"\1", commented(kind, name))
    path.write_text(text, encoding="utf-8")
    assert count >= (0 if kind == "sensors" else 3)
    assert meaning(kind, path) == meaning(kind, FOLDERS[kind] / f"{name}.toml")


def test_defaults_in_the_comments_of_a_recipe_are_the_defaults(tmp_path):
    path = tmp_path / "mine.toml"
    head, operation, rest = re.split(
        r"(?ms)(^\[operation\].*?)(?=^\[simulation\])", commented("recipe", "zeng2019-mini")
    )
    assert "fluctuation_rpm" in operation  # a steady speed refuses these keys
    text, count = re.subn(r"(?m)^# (\w+ = )", r"\1", rest)
    path.write_text(head + text, encoding="utf-8")
    assert count > 10
    expected = load_recipe(FOLDERS["recipe"] / "zeng2019-mini.toml")
    assert load_recipe(path).model_dump() == expected.model_dump()


@cache
def validator(schema):
    return jsonschema.validators.validator_for(json.loads(schema))(json.loads(schema))


@pytest.mark.parametrize(("kind", "name"), EVERY)
def test_the_file_names_its_schema_which_lies_beside_it(kind, name, tmp_path):
    path, schema = begin(kind, name, tmp_path / "mine.toml")
    assert path.read_text(encoding="utf-8").startswith(f"#:schema {schema.name}\n")
    validator(schema.read_text(encoding="utf-8")).validate(tomllib.loads(path.read_text(encoding="utf-8")))


@pytest.mark.parametrize("value", [0.1 + 0.2, 206000000000.0, 1e-7, 123456789.123, 2**53 + 1, True, 'a"b\\c', [1, 2.5]])
def test_a_value_is_written_with_all_its_bits(value):
    read = tomllib.loads(f"key = {toml_value(value)}")["key"]
    assert (read, type(read)) == (value, type(value))


def test_every_key_that_is_given_has_a_comment():
    lines = commented("machine", "zeng2019").splitlines()
    bare = [line for before, line in pairwise(lines) if re.match(r"\w+ = ", line) and before == ""]
    assert bare == []


def run(capsys, *words):
    with pytest.raises(SystemExit) as end:
        main(list(words))
    captured = capsys.readouterr()
    return end.value.code, captured.out, captured.err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["recipe", "there.toml"], "exists already"),
        (["recipe", "folder"], "exists already"),
        (["recipe", "mine.txt"], "end the name in .toml"),
        (["recipe", "no/mine.toml"], "there is no directory no"),
        (["machine", "mine.toml", "--from", "zeng2091"], "did you mean zeng2019"),
        (["sensors", "mine.toml", "--from", "zeng2019"], "allowed: default, field-cheap, field, rig"),
        (["machines", "mine.toml"], "must be one of recipe, machine, sensors"),
        ([], "KIND"),
    ],
)
def test_a_mistake_is_one_line_and_writes_nothing(words, said, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("there.toml").write_text("kept", encoding="utf-8")
    Path("folder").mkdir()
    code, out, err = run(capsys, "init", *words)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert said in err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "there.toml"]
    assert Path("there.toml").read_text(encoding="utf-8") == "kept"


def test_a_folder_that_cannot_be_written_is_named_with_the_file_of_the_user(tmp_path, monkeypatch, capsys):
    def refused(path, _write):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("rubgen.planning.begin.write_durably", refused)
    for _ in range(2):  # without the schema, then with it
        code, _, err = run(capsys, "init", "recipe", "mine.toml")
        assert (code, err.count("\n")) == (2, 1)
        assert err.startswith("rubgen: FILE mine.toml: cannot be written (Read-only file system); choose another place")
        Path("recipe.schema.json").touch()


def test_init_says_what_to_do_with_the_file(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    code, out, _ = run(capsys, "init", "machine")
    assert code == 0
    assert "rubgen modes machine.toml" in out
    assert load_machine("machine.toml") == load_machine("zeng2019")
    _, out, _ = run(capsys, "init", "recipe", "my own.toml")
    assert "rubgen plan 'my own.toml' says" in out


def test_list_names_all_that_comes_with_rubgen(capsys):
    _, out, _ = run(capsys, "list")
    for _kind, name in EVERY:
        assert f"  {name} " in out
    assert "  bearing-defect " in out
    _, out, _ = run(capsys, "list", "--json")
    found = json.loads(out)
    assert list(found) == ["recipes", "machines", "sensor_sets", "faults"]
    assert all(about and "\n" not in about for names in found.values() for about in names.values())
