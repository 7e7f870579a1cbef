"""Write the values of a user's file as TOML with a comment for each key, from the schema of the file."""

import json
from collections.abc import Iterator, Mapping
from textwrap import wrap
from typing import Any

from rubgen.machine.descriptions import Key, keys_of
from rubgen.machine.schema_nodes import Node
from rubgen.machine.sentences import key_text

WIDTH = 110
KINDS = "kinds"
"""The key of a sensor set whose tables have the names of kinds of sensors."""
Path = tuple[str, ...]


class Commented:
    """Writes a TOML file of one kind with a comment for each key. Use a new object for each file.

    Keys without a value are written as comments, with their default. In a list of tables the first table of each kind
    has comments; further keys are only named.
    """

    def __init__(self, schema: Node) -> None:
        self._schema = schema
        self._seen: set[str] = set()

    def text(self, values: Mapping[str, Any]) -> str:
        """Return the file with these values as TOML, with comments."""
        return "\n".join(self._table((), values, self._schema)).strip() + "\n"

    def _table(self, path: Path, values: Mapping[str, Any], node: Node) -> Iterator[str]:
        """Yield the lines of a table: its own values first, then the tables in it."""
        keys = {key.name: key for key in keys_of(node, self._schema)}
        within = {name: self._tables(node["properties"][name]) for name in keys}
        tables = [name for name in keys if within[name] or name == KINDS]
        for name, key in keys.items():
            if name not in tables:
                yield from _given(key, values[name]) if name in values else _missing(key)
        for name in tables:
            whole = isinstance(node["properties"][name].get("default"), Mapping)
            if name in values or whole:
                yield from self._below((*path, name), values.get(name, {}), keys[name], within[name])
            else:
                yield from ("", *_comment(f"[{'.'.join((*path, name))}] {keys[name].text}"))

    def _below(self, path: Path, value: Any, key: Key, kinds: list[Node]) -> Iterator[str]:
        """Yield the lines of a table in a table, or of a list of tables, under its comment."""
        name = ".".join(map(key_text, path))
        yield from ("", *_comment(key.text))
        if isinstance(value, list):
            for each in value:
                yield from ("", f"[[{name}]]", *self._one_of(each, kinds))
        elif kinds:
            yield f"[{name}]"
            yield from self._table(path, value, kinds[0])
        else:  # tables by the kind of a sensor
            for kind, table in value.items():
                known = self._schema["$defs"].values()
                yield from ("", f"[{name}.{key_text(kind)}]", *self._one_of({**table, "kind": kind}, known, kind))

    def _one_of(self, values: Mapping[str, Any], kinds: Any, title: str = "") -> Iterator[str]:
        """Yield the lines of one table of a list: the keys that are given, for each kind with comments once."""
        node = _kind_of(values, list(kinds))
        keys = {key.name: key for key in keys_of(node, self._schema)}
        first = node.get("title", "") not in self._seen
        self._seen.add(node.get("title", ""))
        for name, value in values.items():
            if title and name == "kind":
                continue
            line = f"{key_text(name)} = {toml_value(value)}"
            yield from _given(keys[name], value) if first and name in keys else (line,)
        others = [name for name in keys if name not in values and name not in ("kind", "name")]
        if first and others:
            yield from _comment(f"Further keys: {', '.join(others)}.")

    def _tables(self, node: Node) -> list[Node]:
        """Return the schemas of the tables that may stand at a key; none where it has a plain or a drawn value."""
        found = [node, *node.get("anyOf", ())]
        found += [each["items"] for each in found if "items" in each]
        names = [each["$ref"] for each in found if "$ref" in each]
        names += [each["$ref"] for part in found if "discriminator" in part for each in part.get("oneOf", ())]
        return [self._schema["$defs"][name.rsplit("/", 1)[-1]] for name in names]


def toml_value(value: Any) -> str:
    """Return a truth value, text, number, list or table as TOML, with all bits of numbers. Texts have double quotes."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key_text(key)} = {toml_value(each)}' for key, each in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml_value, value))}]"
    short = f"{value:g}"
    return short if isinstance(value, float) and float(short) == value and "e" in short else repr(value)


def _kind_of(values: Mapping[str, Any], kinds: list[Node]) -> Node:
    """Return the schema of the table among several kinds."""
    if len(kinds) == 1:
        return kinds[0]
    return next(each for each in kinds if _kind(each) == values.get("kind"))


def _kind(node: Node) -> str | None:
    found: str | None = node.get("properties", {}).get("kind", {}).get("const")
    return found


def _given(key: Key, value: Any) -> Iterator[str]:
    yield from ("", *_comment(key.text), f"{key_text(key.name)} = {toml_value(value)}")


def _missing(key: Key) -> Iterator[str]:
    """Yield the comment of a key that is not given, and a line with its default."""
    if key.default:
        yield from ("", *_comment(key.text), f"# {key_text(key.name)} = {key.default}")
    else:
        yield from ("", *_comment(f"{key_text(key.name)}: {key.text}"))


def _comment(text: str) -> list[str]:
    return [f"# {line}" for line in wrap(text, WIDTH)]
