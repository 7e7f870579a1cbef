"""What SECURITY.md promises."""

import ast
import json
import pickle
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

import rubgen
from rubgen.dataset.reading.replaying import find_runs
from rubgen.errors import UserError

PACKAGE = Path(rubgen.__file__).parent
SOURCES = sorted(PACKAGE.rglob("*.py"))
UNPICKLES = {"pickle", "_pickle", "cPickle", "dill", "cloudpickle", "joblib", "shelve", "marshal", "yaml", "jsonpickle"}
EVALUATES = {"eval", "exec", "compile", "__import__", "execfile"}


def calls(tree):
    return [node for node in ast.walk(tree) if isinstance(node, ast.Call)]


def imported(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield (node.module or "").partition(".")[0]


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.relative_to(PACKAGE).as_posix())
def test_nothing_is_evaluated_or_unpickled(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert not UNPICKLES & set(imported(tree)) or path == PACKAGE / "jit.py"
    assert not EVALUATES & {call.func.id for call in calls(tree) if isinstance(call.func, ast.Name)}
    keywords = [keyword for call in calls(tree) for keyword in call.keywords]
    named = {keyword.arg: keyword.value for keyword in keywords if isinstance(keyword.value, ast.Constant)}
    for name in ("shell", "allow_pickle", "trust_remote_code"):
        assert name not in named or named[name].value is False
    loads = [
        call for call in calls(tree) if isinstance(call.func, ast.Attribute) and ast.unparse(call.func) == "np.load"
    ]
    assert all("allow_pickle" in {keyword.arg for keyword in call.keywords} for call in loads)


class _Trap:
    """Whoever unpickles it makes a file."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


@pytest.mark.parametrize("name", ["manifest.json", "runs.parquet", "mcap/0000/run-000000.mcap"])
def test_a_pickle_in_the_place_of_a_file_is_not_opened(name, copied_set, tmp_path):
    trap = tmp_path / "sprung"
    (copied_set / name).write_bytes(pickle.dumps(_Trap(trap)))
    with suppress(UserError):
        assert rubgen.verify(copied_set)
    assert not trap.exists()


def test_a_pickle_in_the_cache_of_blisks_is_not_opened(tmp_path, monkeypatch):
    from rubgen.reduction import cache

    trap, packed = tmp_path / "sprung", tmp_path / "trap.npz"
    np.savez(packed, M=np.array([_Trap(trap)], dtype=object), allow_pickle=True)
    monkeypatch.setattr(cache, "read_cached", lambda _path: packed.read_bytes())
    with pytest.raises(ValueError, match="allow_pickle=False"):
        cache._load(tmp_path / "x.blisk")
    assert not trap.exists()


@pytest.mark.parametrize(
    "text",
    [
        "__import__('os').system('touch FILE')",
        "${touch FILE}",
        "!!python/object/apply:os.system ['touch FILE']",
        "{{ 7*7 }}",
    ],
)
@pytest.mark.parametrize("key", ["name", "machine", "license", "vary.friction", "sensors.set"])
def test_a_recipe_is_no_code(key, text, tmp_path):
    trap = tmp_path / "sprung"
    recipe = {"name": "a", "runs": 1, "machine": "zeng2019"}
    table, _, last = key.rpartition(".")
    (recipe.setdefault(table, {}) if table else recipe)[last] = text.replace("FILE", str(trap))
    path = tmp_path / "recipe.toml"
    path.write_text("".join(f"{name} = {json.dumps(value).replace(': ', ' = ')}\n" for name, value in recipe.items()))
    with suppress(UserError):
        assert rubgen.load_recipe(path).license == text.replace("FILE", str(trap))  # free text, kept as it is
    assert not trap.exists()


@pytest.mark.parametrize(
    "condition",
    [
        "(SELECT count(*) FROM read_text('FILE')) > 0",
        "(SELECT count(*) FROM read_csv('FILE')) > 0",
        "(SELECT count(*) FROM 'FILE') > 0",
        "(SELECT count(*) FROM glob('FILE')) > 0",
        "(SELECT count(*) FROM data) > 0",
        "getenv('HOME') <> ''",
        "TRUE); COPY runs TO 'NEW'; SELECT run_id FROM runs WHERE (TRUE",
        "TRUE); ATTACH 'NEW'; SELECT run_id FROM runs WHERE (TRUE",
        "TRUE); INSTALL httpfs; SELECT run_id FROM runs WHERE (TRUE",
        "TRUE); LOAD '/tmp/x.duckdb_extension'; SELECT run_id FROM runs WHERE (TRUE",
        "TRUE); EXPORT DATABASE 'NEW'; SELECT run_id FROM runs WHERE (TRUE",
        "TRUE); SET enable_external_access = true; SELECT run_id FROM runs WHERE (TRUE",
    ],
)
def test_a_condition_reads_the_table_of_runs_alone(condition, small_set, tmp_path):
    (tmp_path / "file.csv").write_text("a\n1\n")
    condition = condition.replace("FILE", str(tmp_path / "file.csv")).replace("NEW", str(tmp_path / "new"))
    with pytest.raises(UserError, match="--where"):
        find_runs(rubgen.open(small_set.directory), condition)
    assert [path.name for path in tmp_path.iterdir()] == ["file.csv"]


def test_a_report_escapes_what_it_takes_from_the_set():
    from rubgen.report import page as report

    text = Path(report.__file__).read_text(encoding="utf-8")
    assert "autoescape=True" in text
    template = Path(report.__file__).with_name("report.html.j2").read_text(encoding="utf-8")
    unescaped = re.findall(r".{20}\|\s*safe\b|autoescape\s+false|Markup", text + template)
    assert unescaped == ["_') | join('_<wbr>' | safe"], "keys of [vary] are ours"
    scripts = "".join(re.findall(r"<script.*?</script>", template, re.DOTALL))
    filled = re.findall(r"\{\{ .*? \}\}", scripts)
    # values of the set stand in a script only as JSON, in which tojson writes no < and no >
    assert filled == ['{{ {"data": row.data, "layout": row.layout} | tojson }}', "{{ library }}"]
