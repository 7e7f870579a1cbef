"""Valid documents made hostile: right in their structure, wrong in a value, a type, a name, a number of levels."""

from __future__ import annotations

import copy
import json
import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

DEEP = 400
HUGE = 10**5000
WRONG: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 2, 3, 7, 10**6, 10**9, 2**31, 2**53 + 1, 2**63 - 1, 2**63, -(2**63), 10**30,
    0.0, -0.0, 0.5, 1e-300, 1e-12, 1e12, 1e300, -1e300, math.nan, math.inf, -math.inf, 5e-324,
    "", " ", "x", "nan", "1e3", "1,5", "0x10", "true", "None", "../../etc/passwd", "/dev/zero", "/etc/shadow", "~",
    "~nobody", "C:\\temp\\new", "a\0b", "\ud800", "é" * 50, "💥", "\u202e", "a" * 5000, "%s%n", "{0}", "[red]x[/red]",
    "<script>", "run-up", "rig", "default", "zeng2019", "zeng2019.toml", "parquet", "constant", "$(id)", "'; --",
    [], [[]], [None], [1, 2], [2, 1], [0.0, 0.0], [math.nan, 1.0], ["x"], [True], [1] * 1000, [[1, 2], [1, 2]],
    [[1, 2], [3]], {}, {"": 1}, {"uniform": [1, 2]}, {"uniform": [2, 1]}, {"uniform": [math.nan, math.inf]},
    {"uniform": "x"}, {"uniform": []}, {"log_uniform": [0, 1]}, {"log_uniform": [-1, -2]}, {"normal": [1, 1e300]},
    {"choice": []}, {"choice": [[]]}, {"choice": [math.nan]}, {"choice": list(range(2000))},
    {"uniform": [1, 2], "choice": [1]}, {"a": {"b": {"c": {}}}},
)  # fmt: skip
"""What does not belong where it is put, or only rarely does."""


@contextmanager
def _deep() -> Iterator[None]:
    """Our own recursion goes deeper than that of readers."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(20 * DEEP)
    try:
        yield
    finally:
        sys.setrecursionlimit(limit)


@_deep()
def mutated(document: Any, generator: np.random.Generator) -> Any:
    """A copy with one to three changes."""
    changed = copy.deepcopy(document)
    for _ in range(generator.integers(1, 4)):
        node, key = _somewhere(changed, generator)
        if node is None:
            return WRONG[generator.integers(len(WRONG))]
        _CHANGES[generator.integers(len(_CHANGES))](node, key, generator)
    return changed


def _somewhere(document: Any, generator: np.random.Generator) -> tuple[Any, Any]:
    """A place in the tree: any depth, whatever the number of values below; (None, None) in an empty one."""
    node, holder, key = document, None, None
    while isinstance(node, dict | list) and node:
        keys: list[Any] = list(node) if isinstance(node, dict) else list(range(len(node)))
        holder, key = node, keys[generator.integers(len(keys))]
        node = holder[key]
        if generator.random() < 0.2:
            break
    return holder, key


def _replace(node: Any, key: Any, generator: np.random.Generator) -> None:
    node[key] = copy.deepcopy(WRONG[generator.integers(len(WRONG))])


def _scale(node: Any, key: Any, generator: np.random.Generator) -> None:
    """A number of another unit, sign or size; anything else is replaced."""
    value = node[key]
    if isinstance(value, bool) or not isinstance(value, int | float) or abs(value) > 1e300:
        _replace(node, key, generator)
        return
    factor = [-1, 0, 2, 0.5, 1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9, 60 / (2 * math.pi), 1.0000001][generator.integers(12)]
    scaled = value * factor
    node[key] = int(scaled) if isinstance(value, int) and abs(scaled) < 1e300 and generator.random() < 0.8 else scaled


def _remove(node: Any, key: Any, generator: np.random.Generator) -> None:
    del node[key]
    if isinstance(node, list) and generator.random() < 0.3:
        node.clear()


def _add(node: Any, key: Any, generator: np.random.Generator) -> None:
    """One more value: of a new name, of a name with a slip, or twice the same."""
    if isinstance(node, list):
        node.extend([copy.deepcopy(node[key])] * int(generator.choice([1, 3, 300])))
        return
    names = [
        "extra",
        "",
        "é",
        "a\0",
        "__class__",
        "model_config",
        "x" * 300,
        f"{key}s",
        str(key)[:-1],
        str(key).upper(),
    ]
    node[names[generator.integers(len(names))]] = copy.deepcopy(WRONG[generator.integers(len(WRONG))])


def _swap(node: Any, key: Any, generator: np.random.Generator) -> None:
    keys = list(node) if isinstance(node, dict) else list(range(len(node)))
    other = keys[generator.integers(len(keys))]
    node[key], node[other] = node[other], node[key]


def _nest(node: Any, key: Any, generator: np.random.Generator) -> None:
    value, table = node[key], generator.random() < 0.5
    for _ in range(int(generator.choice([1, 2, 50, DEEP]))):
        value = {"a": value} if table else [value]
    node[key] = value


def _huge(node: Any, key: Any, generator: np.random.Generator) -> None:
    node[key] = [HUGE, -HUGE, "a" * 100_000, [0.5] * 20_000, {f"k{i}": i for i in range(2000)}][generator.integers(5)]


_CHANGES = (_replace, _replace, _replace, _scale, _scale, _scale, _remove, _add, _swap, _nest, _huge)


@_deep()
def toml_text(document: Any) -> str:
    """The document in TOML, each top value on a line of its own; what TOML has not (None) as a word that is none."""
    if not isinstance(document, dict):
        return _toml_value(document)
    return "".join(f"{_toml_key(key)} = {_toml_value(value)}\n" for key, value in document.items())


def _toml_key(key: object) -> str:
    return json.dumps(str(key), ensure_ascii=False)


def _toml_value(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_toml_key(key)} = {_toml_value(each)}" for key, each in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_toml_value, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return "9" * 5001 if abs(value) >= 10**4000 else str(value)
    if isinstance(value, float):
        return repr(value)
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else "null"


@_deep()
def json_bytes(document: Any) -> bytes:
    """The document in JSON."""
    return json.dumps(document, default=str).encode(errors="surrogatepass") if not _too_long(document) else b"9" * 5001


def _too_long(document: Any) -> bool:
    """Whether Python refuses to write one of its integers."""
    if isinstance(document, dict | list):
        return any(map(_too_long, document.values() if isinstance(document, dict) else document))
    return isinstance(document, int) and abs(document) >= 10**4000
