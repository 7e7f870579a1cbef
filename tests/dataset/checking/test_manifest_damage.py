"""A manifest whose digest fits but whose content is wrong: one line that names the file, from every command."""

import json
import os
import shutil
from hashlib import sha256

import numpy as np
import pytest

import rubgen
from rubgen.dataset.layout import Layout
from rubgen.dataset.manifest import read_manifest
from rubgen.errors import UserError

WRONG = [None, [], {}, "x", -1, 0.5, 10**30, float("nan"), True, [[]], {"a": 1}, "../../etc/passwd", "\0"]


@pytest.fixture(scope="module")
def good(small_set):
    return json.loads((small_set.directory / "manifest.json").read_text())


@pytest.fixture
def sealed(tmp_path):
    """Writes a manifest with the digest that fits; gives its directory."""

    def write(content):
        data = content if isinstance(content, bytes) else json.dumps(content).encode()
        (tmp_path / "manifest.json").write_bytes(data)
        (tmp_path / "manifest.json.sha256").write_text(f"{sha256(data).hexdigest()}  manifest.json\n")
        return tmp_path

    return write


def refusal(directory):
    with pytest.raises(UserError) as caught:
        read_manifest(Layout(directory))
    assert str(caught.value).startswith(str(directory))
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 2000
    return str(caught.value)


def test_what_was_written_is_read(small_set, good):
    manifest = read_manifest(Layout(small_set.directory))
    assert manifest.model_dump(mode="json") == good


@pytest.mark.parametrize(
    ("part", "value", "message"),
    [
        ("recipe", {}, "identity: recipe: name: this key is missing"),
        ("sensors", [], "identity.sensors"),
        ("sensors", {"name": "a"}, "identity: sensors: sensors: this key is missing"),
        ("machine", {"name": 3}, "identity: machine: "),
        ("machine", {"name": json.loads('{"a": ' * 400 + "1" + "}" * 400)}, "identity: machine: "),
        ("machine", {"name": json.loads("[" * 400 + "]" * 400)}, "identity: machine: "),
        ("packages", {}, "packages names no rubgen"),
    ],
)
def test_an_identity_that_is_none_is_named(part, value, message, good, sealed):
    assert message in refusal(sealed({**good, "identity": {**good["identity"], part: value}}))


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("runs", 10**9, "runs is not the one of its recipe"),
        ("status", {"ok": -1}, "status.ok = -1"),
        ("status", {"ok": 10**9}, "status counts other than 4 runs"),
        ("files", [{"path": "../x", "bytes": 1, "sha256": "0" * 64}], "files.0.path = '../x'"),
        ("files", [{"path": "/etc/passwd", "bytes": 1, "sha256": "0" * 64}], "files.0.path = '/etc/passwd'"),
        ("derived", ["mcap/../../x"], "derived.0 = "),
    ],
)
def test_values_that_contradict_or_lead_out_are_named(key, value, message, good, sealed):
    assert message in refusal(sealed({**good, key: value}))


@pytest.mark.parametrize(
    "content",
    [b"", b"[]", b"null", b"\xff\xfe", b"[" * 100_000, b'{"runs": ' + b"1" * 5000 + b"}", b'"' + b"a" * 10_000 + b'"'],
    ids=["empty", "list", "null", "no text", "deep", "long number", "long text"],
)
def test_no_manifest_is_named(content, sealed):
    refusal(sealed(content))


@pytest.mark.parametrize("seed", range(250))
def test_any_wrong_value_is_named_or_harmless(seed, good, sealed):
    """One value anywhere in the tree is replaced, removed or added; what passes can be used everywhere."""
    generator = np.random.default_rng(seed)
    content = json.loads(json.dumps(good))
    parts = content["identity"] if generator.random() < 0.7 else content
    node, key = _somewhere(parts, generator)
    if generator.random() < 0.25 and isinstance(node, dict):
        del node[key]
    else:
        node[key] = WRONG[generator.integers(len(WRONG))]
    directory = sealed(content)
    try:
        manifest = read_manifest(Layout(directory))
    except UserError:
        refusal(directory)
        return
    identity = manifest.identity
    assert identity.recipe["output"]["formats"]
    assert identity.sensor_set.sensors
    assert identity.machine["name"]
    assert rubgen.open(directory).units


def _somewhere(node, generator):
    """A place in the tree: any depth, whatever the number of values below."""
    while True:
        keys = list(node) if isinstance(node, dict) else list(range(len(node)))
        key = keys[generator.integers(len(keys))]
        below = node[key]
        if not isinstance(below, dict | list) or not below or generator.random() < 0.25:
            return node, key
        node = below


def test_a_pipe_or_folder_in_its_place_is_named(small_set, tmp_path):
    shutil.copy(small_set.directory / "manifest.json.sha256", tmp_path)
    os.mkfifo(tmp_path / "manifest.json")
    assert "is a pipe" in refusal(tmp_path)
    (tmp_path / "manifest.json").unlink()
    (tmp_path / "manifest.json").mkdir()
    assert "is a folder" in refusal(tmp_path)


def test_the_sensors_are_those_of_the_set_and_not_of_a_file(tmp_path, good, sealed):
    """The recipe names a file that is somewhere else by now."""
    recipe = {**good["identity"]["recipe"], "sensors": {**good["identity"]["recipe"]["sensors"], "set": "gone.toml"}}
    data = rubgen.open(sealed({**good, "identity": {**good["identity"], "recipe": recipe}}))
    assert data.units["proximity_x"] == "m"
