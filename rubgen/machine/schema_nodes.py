"""Look up what a type allows at a place of its data, in its JSON schema: keys, and bounds of a number."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import TypeAdapter

Path = tuple[int | str, ...]
Node = Mapping[str, Any]
BOUNDS = {
    "minimum": "at least",
    "exclusiveMinimum": "above",
    "maximum": "at most",
    "exclusiveMaximum": "below",
}
DEEPEST = 6
"""The deepest table of a recipe, machine or sensor set."""


class SchemaNodes:
    """The JSON schema of an adapter's type, followed along data: the kind of a sensor decides its keys."""

    def __init__(self, adapter: TypeAdapter[Any]) -> None:
        self.root: Node = adapter.json_schema()

    def at(self, data: object, path: Path) -> list[Node]:
        """Return all schema nodes that describe the value at `path` of `data`; none where the schema has no such path.

        References are followed. Of a union all branches are returned, then the union itself. Where a key such as `kind`
        in `data` chooses a branch, only this branch is followed. `data` need not contain the path.
        """
        nodes = list(self._branches(self.root, data))
        for part in path:
            data = _within(data, part)
            found = (node.get("items") if isinstance(part, int) else _value_of(node, part) for node in nodes)
            nodes = [branch for node in found if isinstance(node, Mapping) for branch in self._branches(node, data)]
        return nodes

    def keys(self, data: object, path: Path) -> list[str]:
        """Return the keys that a table at `path` may have, sorted."""
        return sorted({key for node in self.at(data, path) for key in _properties(node)})

    def every_key(self) -> list[tuple[str, ...]]:
        """Return the paths of all keys of all tables, without numbers of list elements."""
        return list(self._below(self.root, ()))

    def _below(self, node: Node, path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
        if len(path) > DEEPEST:
            return
        for branch in self._branches(node, None):
            for key, child in _properties(branch).items():
                yield (*path, key)
                yield from self._below(child, (*path, key))

    def _branches(self, node: Node, data: object) -> Iterator[Node]:
        """Yield the node itself, or the node it refers to: every branch of a union that fits the data."""
        if "$ref" in node:
            yield from self._branches(self.root["$defs"][str(node["$ref"]).rsplit("/", 1)[-1]], data)
            return
        chosen = _chosen(node, data)
        for key in ("anyOf", "oneOf", "allOf"):
            for branch in [chosen] if chosen else node.get(key, ()):
                yield from self._branches(branch, data)
        yield node


def bounds_in_words(nodes: list[Node]) -> str:
    """Return the allowed range of a number in words, "at least 0 and below 1"; empty without bounds.

    It is the range of the first of the JSON schema nodes `nodes` that has bounds.
    """
    for node in nodes:
        if any(key in node for key in BOUNDS):
            return " and ".join(f"{words} {limit(node[key])}" for key, words in BOUNDS.items() if key in node)
    return ""


def limit(value: float) -> str:
    """Write a number with commas between thousands, such as "1,000,000"."""
    return f"{value:,}" if isinstance(value, int) else f"{value:,.12g}"


def digits(value: float) -> str:
    """Write a number with three significant digits and commas between thousands.

    It has an exponent only below 0.0001 and from 1e12 on.
    """
    return limit(float(f"{value:.3g}"))


def below(value: float) -> str:
    """Write a number above 0, rounded down to three significant digits, for a value that may not exceed it."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{math.floor(value / unit) * unit:.12g}"


def _chosen(node: Node, data: object) -> Node | None:
    """Return the branch that a discriminator of the data names, if it does."""
    tags = node.get("discriminator", {})
    if not isinstance(data, Mapping) or "mapping" not in tags:
        return None
    reference = tags["mapping"].get(str(data.get(tags["propertyName"])))
    return {"$ref": reference} if reference else None


def _properties(node: Node) -> Mapping[str, Any]:
    found = node.get("properties", {})
    return found if isinstance(found, Mapping) else {}


def _value_of(node: Node, key: str) -> object:
    """Return the node of a key: its own, or the one for keys that the user names, such as splits."""
    named = next(iter(node.get("patternProperties", {}).values()), None)
    return _properties(node).get(key, named)


def _within(data: object, part: int | str) -> object:
    if isinstance(data, Mapping):
        return data.get(part)
    if isinstance(data, list | tuple) and isinstance(part, int) and part < len(data):
        return data[part]
    return None
