"""What the documents name exists: commands, options, files, functions, labels; and their examples parse."""

import ast
import importlib
import re
import shlex
import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

import rubgen
from rubgen.cli.app import app
from rubgen.dataset.reading.samples import Arrays
from rubgen.io.columns import label_columns
from rubgen.labels.registry import LABELS, TAP_ENDINGS
from rubgen.labels.to_json import labels_to_json
from rubgen.planning.offered import offered
from rubgen.scenario import load_recipe, parse_recipe
from rubgen.scenario.load import RECIPES
from rubgen.solver import Status
from schemas.make import with_tables
from tests.default_columns import CHANNELS, SCALARS

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in ROOT.glob("docs/**/*.md")}
DOCUMENTS |= {
    name: (ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")
}
FOLDERS = ("rubgen", "tests", "docs", "schemas", "datasets", "benchmarks", "validation")


def blocks(text: str, language: str = "") -> list[str]:
    """Contents of the fenced blocks of that language."""
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def commands(text: str) -> list[list[str]]:
    """The calls of rubgen in code, fenced or indented, without comments."""
    lines = re.findall(r"^(?: {4})?(?:\.venv/bin/)?rubgen (.*)$", text, re.MULTILINE)
    return [shlex.split(line, comments=True) for line in lines]


def resolve(dotted: str) -> object:
    """The object of that dotted name; AttributeError or ImportError when there is none."""
    found: object = importlib.import_module(dotted.split(".")[0])
    name = "rubgen"
    for part in dotted.split(".")[1:]:
        name = f"{name}.{part}"
        found = getattr(found, part) if hasattr(found, part) else importlib.import_module(name)
    return found


@pytest.mark.parametrize("name", DOCUMENTS)
def test_commands_are_understood(name):
    for arguments in commands(DOCUMENTS[name]):
        app.parse_args(arguments, exit_on_error=False, print_error=False)


def test_readme_shows_every_command():
    shown = {arguments[0] for arguments in commands(README)}
    assert shown == {name for name in app if not name.startswith("-")}


def test_targets_of_make_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    named = re.findall(r"\bmake ([a-z]+)\b(?! and)", "\n".join(blocks(README, "sh")))
    assert set(named) >= {"demo", "test"}
    for target in named:
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target


@pytest.mark.parametrize("name", DOCUMENTS)
def test_links_lead_to_files(name):
    for target in re.findall(r"\]\(([^)#\s]+)", DOCUMENTS[name]):
        assert target.startswith("https://") or ((ROOT / name).parent / target).exists(), target


@pytest.mark.parametrize("name", DOCUMENTS)
def test_files_that_are_named_exist(name):
    for path in re.findall(rf"`((?:{'|'.join(FOLDERS)})/[^`\s]*)`", DOCUMENTS[name]):
        assert list(ROOT.glob(path.rstrip("/"))), path


def test_every_document_is_in_the_navigation_of_the_site():
    navigation = (ROOT / "mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:\n")[2]
    listed = {f"docs/{name}" for name in re.findall(r": ([\w/.-]+\.md)$", navigation, re.MULTILINE)}
    assert listed == {name for name in DOCUMENTS if name.startswith("docs/")}


@pytest.mark.parametrize("name", DOCUMENTS)
def test_functions_that_are_named_exist(name):
    of_torch = ast.parse((ROOT / "rubgen" / "torch.py").read_text(encoding="utf-8")).body  # torch may be missing
    defined = {each.name for each in of_torch if isinstance(each, ast.ClassDef | ast.FunctionDef)}
    for dotted in re.findall(r"`(rubgen(?:\.\w+)+)\b", DOCUMENTS[name]):
        if dotted.startswith("rubgen.torch."):
            assert dotted.removeprefix("rubgen.torch.") in defined
        elif not dotted.startswith("rubgen.v1"):  # the package of the protobuf messages
            assert resolve(dotted) is not None


def test_python_of_the_readme_uses_public_names():
    trees = [ast.parse(code) for code in blocks(README, "python")]
    used = {
        node.attr
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "rubgen"
    }
    assert used
    assert used <= set(rubgen.__all__)


def test_columns_and_channels_of_the_readme_exist():
    nodes = [node for code in blocks(README, "python") for node in ast.walk(ast.parse(code))]
    strings = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    named = strings - {"out/demo", "run-000000", "run.mcap"}
    assert len(named) >= 5
    assert named <= {column.name for column in SCALARS} | set(CHANNELS)


def test_the_program_of_begin_fits_one_machine_and_several(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (program,) = blocks(DOCUMENTS["docs/begin.md"], "python")
    runs = [f"run-{number:06}" for number in range(20)]
    for machines in (runs, [f"machine-{number // 4}" for number in range(20)]):
        X, y = np.random.default_rng(0).normal(size=(20, 1, 50)), np.arange(20) % 2
        arrays = Arrays(X, y, np.array(machines))
        data = SimpleNamespace(ok=pd.DataFrame(index=runs), arrays=lambda *_, arrays=arrays: arrays)
        monkeypatch.setattr("rubgen.open", lambda _, data=data: data)
        exec(program, {})  # noqa: S102 -- the page is our own
        answers = pd.read_csv("answers.csv")
        assert (list(answers["run_id"]), set(answers["rub"]) <= {0, 1}) == (runs, True)


def test_the_recipe_of_the_readme_is_a_recipe():
    (text,) = blocks(README, "toml")
    recipe = parse_recipe(tomllib.loads(text))
    assert (recipe.name, recipe.seed, recipe.runs) == ("my-data", 7, 100)
    assert 6500 <= recipe.scenario(3).operation.speed_rpm <= 12000
    assert recipe.scenario(3).contact.friction == 0.01


@pytest.mark.parametrize("path", sorted(RECIPES.glob("*.toml")), ids=lambda path: path.stem)
def test_recipes_that_come_with_rubgen_can_be_run(path):
    recipe = load_recipe(path)
    assert recipe.name == path.stem
    assert recipe.scenario(recipe.runs - 1).index == recipe.runs - 1


def test_the_folder_of_data_sets_links_to_every_recipe():
    links = {path.name: path.resolve() for path in ROOT.glob("datasets/*.toml")}
    assert links == {path.name: path.resolve() for path in RECIPES.glob("*.toml")}


def test_recipes_that_documents_name_come_with_rubgen():
    named = {name for text in DOCUMENTS.values() for name in re.findall(r"[Rr]ecipe `([\w-]+)`", text)}
    assert len(named) >= 8
    assert named <= set(offered("recipe"))


def test_the_rooms_of_the_package_are_those_that_the_architecture_names():
    rows = re.findall(r"^\| `(rubgen/\w*/?)` \| (.+) \|$", DOCUMENTS["docs/architecture.md"], re.MULTILINE)
    named = [room for room, _ in rows] + [
        f"{room}{inner}" for room, text in rows for inner in re.findall(r"`(\w+/)`", text)
    ]
    rooms = [path.parent.relative_to(ROOT).as_posix() + "/" for path in (ROOT / "rubgen").rglob("__init__.py")]
    assert sorted(named) == sorted(rooms)


def test_tables_of_labels_are_those_of_the_registry():
    page = DOCUMENTS["docs/labels.md"]
    assert page == with_tables(page), "run `make schemas`"
    columns = label_columns(LABELS)
    rows = [f"| `{each.name}` | {each.role.value} | {each.kind} | {each.unit} |" for each in columns]
    assert [row for row in rows if row not in page] == []


def test_labels_and_statuses_are_described(rub_run):
    orders = TAP_ENDINGS
    labels = [name for name in labels_to_json(rub_run.labels) if not name.endswith(orders)]
    assert [name for name in labels if f"`{name}`" not in DOCUMENTS["docs/labels.md"]] == []
    assert [status.code for status in Status if f"`{status.code}`" not in DOCUMENTS["docs/status.md"]] == []


def test_one_version_everywhere():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert project["version"] == rubgen.__version__
    assert f"\nversion: {rubgen.__version__}\n" in citation
