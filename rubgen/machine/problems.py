"""A failed validation as one line for the user: file, key, value, what is allowed, how to mend it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from typing import Any

from pydantic import TypeAdapter, ValidationError

from rubgen.errors import UserError

UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")
BOUNDS = ("less_than", "greater_than_equal")


def first_problem(
    source: object, error: ValidationError, data: object, adapter: TypeAdapter[Any] | None = None
) -> UserError:
    """The first problem in `data`, which came from the file `source` and does not fit the type of `adapter`."""
    # A misspelt key is also a missing one: say what is there, not what is not.
    problem = min(error.errors(), key=lambda each: each["type"] not in UNKNOWN)
    location = _path_in(data, problem["loc"], missing=problem["type"] == "missing")
    key = ".".join(str(part) for part in location) or "the file"
    if problem["type"] == "missing":
        return UserError(f"{source}: {key}: this key is missing; add it")
    if problem["type"] in UNKNOWN:
        known = sorted(_keys_at(adapter, location[:-1])) if adapter else []
        return UserError(f"{source}: {key}: unknown key; {nearest(str(location[-1]), known)}")
    message = problem["msg"].removeprefix("Value error, ")
    if location[-1:] == ["angle_deg"] and problem["type"] in BOUNDS:
        message = "an angle round the casing is at least 0 and below 360 degrees"
    remedy = "" if ";" in message else "; correct this value"
    value = problem.get("input")
    # Of a whole table, a message that shows the key and its value says enough.
    shown = "" if isinstance(value, Mapping) and " = " in message else _shown(value)
    return UserError(f"{source}: {key}{shown}: {message}{remedy}")


def nearest(name: str, known: list[str]) -> str:
    """What to do about an unknown `name`: the known one that is nearest, and all of them."""
    close = get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"did you mean {close[0]}? " if close else ""
    return f"{hint}allowed: {', '.join(known)}" if known else "remove it"


def _shown(value: object) -> str:
    text = repr(value)
    return f" = {text}" if len(text) <= 120 else ""


def _path_in(data: object, loc: tuple[int | str, ...], *, missing: bool) -> list[int | str]:
    """The parts of `loc` that are keys of the data; pydantic mixes the names of union members in."""
    path: list[int | str] = []
    for position, part in enumerate(loc):
        here = (isinstance(data, Mapping) and part in data) or (
            isinstance(data, list | tuple) and isinstance(part, int) and part < len(data)
        )
        if here:
            data = data[part]  # type: ignore[index]
            path.append(part)
        elif missing and position == len(loc) - 1:
            path.append(part)
    return path


def _keys_at(adapter: TypeAdapter[Any], location: list[int | str]) -> set[str]:
    root = adapter.json_schema()
    nodes = list(_alternatives(root, root))
    for part in location:
        found: list[Any] = [node["properties"][part] for node in nodes if part in node.get("properties", {})]
        if isinstance(part, int):
            found = [node["items"] for node in nodes if "items" in node]
        nodes = [each for node in found for each in _alternatives(node, root)]
    return {key for node in nodes for key in node.get("properties", {})}


def _alternatives(
    node: dict[str, object], root: dict[str, object]
) -> Iterator[dict[str, dict[str, dict[str, object]]]]:
    """The node itself, or what it refers to: every branch of a union."""
    if "$ref" in node:
        name = str(node["$ref"]).rsplit("/", 1)[-1]
        yield from _alternatives(root["$defs"][name], root)  # type: ignore[index]
        return
    for key in ("anyOf", "oneOf", "allOf"):
        for branch in node.get(key, []):  # type: ignore[attr-defined]
            yield from _alternatives(branch, root)
    yield node  # type: ignore[misc]
