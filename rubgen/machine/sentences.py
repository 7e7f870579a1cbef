"""Say in one plain sentence how a value fails to fit its type, and write values as they stand in TOML."""

import re
from collections.abc import Mapping
from datetime import date, time
from difflib import get_close_matches
from numbers import Integral, Real
from typing import Any

from rubgen.machine.schema_nodes import limit

DECIMAL_COMMA = re.compile(r"[-+]?(\d+),(\d+)")
FILE_NAME = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"
CHANNEL_NAME = r"^[A-Za-z][A-Za-z0-9_]*$"
SPLIT_NAME = r"^[a-z][a-z0-9_]{0,30}$"
PATTERNS = {
    SPLIT_NAME: "must begin with a small letter and go on with small letters, digits and '_' alone, at most 31 in all",
    FILE_NAME: "must begin with a letter or digit and go on with letters, digits, '.', '_' and '-' alone",
    CHANNEL_NAME: "must begin with a letter and go on with letters, digits and '_' alone",
}
"""The patterns of names, in words."""
NUMBER, WHOLE, TEXT = "must be a number", "must be a whole number", "must be a text in quotes"
TABLE, LIST = "must be a table", "must be a list in square brackets"
SENTENCES = {
    "finite_number": "must be a finite number",
    "float_type": NUMBER,
    "float_parsing": NUMBER,
    "number": NUMBER,
    "int_type": WHOLE,
    "int_parsing": WHOLE,
    "int_parsing_size": WHOLE,
    "int_from_float": WHOLE,
    "bool_type": "must be true or false",
    "bool_parsing": "must be true or false",
    "string_type": TEXT,
    "string_unicode": TEXT,
    "string_too_short": "must not be empty",
    "none_required": "must be left out",
    "model_type": TABLE,
    "model_attributes_type": TABLE,
    "dataclass_type": TABLE,
    "dict_type": TABLE,
    "invalid_key": "must have texts as keys",
}
BOUNDS = {
    "greater_than": ("gt", "above"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "below"),
    "less_than_equal": ("le", "at most"),
}
OWN = ("value_error", "distribution")
"""Errors whose message is written where the rule is."""
LEVELS = 6
"""Deeper values are shown as `...`, because a manifest may nest without bound."""


def sentence(error: Mapping[str, Any], bounds: str, nodes: list[Mapping[str, Any]]) -> str:
    """Return what a value must be, as a clause for one error of validation, such as "must be a whole number".

    A message of rubgen's own rules is returned as it is. For an unknown kind of error it is "is not allowed here".

    - error: one error of pydantic.
    - bounds: allowed range in words, for an error about a bound. Empty shows only the bound that the error names.
    - nodes: JSON schema nodes of the value.
    """
    kind, context = str(error["type"]), error.get("ctx", {})
    if kind in OWN:
        return str(error["msg"]).removeprefix("Value error, ")
    if kind in BOUNDS:
        key, words = BOUNDS[kind]
        return f"must be {bounds or f'{words} {limit(context[key])}'}"
    if kind == "literal_error":
        return _one_of(error.get("input"), re.findall(r"'([^']*)'", str(context["expected"])))
    if kind.startswith("union_tag"):
        if kind == "union_tag_not_found":
            return f"must have a {str(context['discriminator']).strip(chr(39))}; add it"
        return _one_of(context.get("tag"), re.findall(r"'([^']*)'", str(context.get("expected_tags", ""))))
    if kind == "string_pattern_mismatch":
        return PATTERNS.get(context["pattern"], f"must match {context['pattern']}")
    if kind in ("pair", "too_long", "too_short", "tuple_type"):
        return _list_of(kind, context, nodes)
    if kind in ("model_type", "dataclass_type"):
        keys = sorted({key for node in nodes for key in node.get("properties", {})})
        return f"{TABLE} of the keys {', '.join(keys)}" if keys else TABLE
    return SENTENCES.get(kind, "is not allowed here")


def _one_of(value: object, allowed: list[str]) -> str:
    if len(allowed) == 1:
        return f"must be '{allowed[0]}'"
    close = get_close_matches(value.lower(), allowed, n=1, cutoff=0.6) if isinstance(value, str) else []
    hint = f"did you mean {close[0]}? " if close else ""
    return f"unknown value; {hint}allowed: {', '.join(allowed)}"


def _list_of(kind: str, context: Mapping[str, Any], nodes: list[Mapping[str, Any]]) -> str:
    lists = [node for node in nodes if node.get("type") == "array"]
    exactly = next((node["maxItems"] for node in lists if node.get("minItems") == node.get("maxItems", -1)), None)
    if exactly:
        return f"must be a list of {exactly} values; decimals have a point, a comma parts values"
    if kind == "too_short":
        return f"must have at least {context['min_length']} value"
    if kind == "too_long":
        return f"must have at most {context['max_length']} values"
    tables = any("$ref" in node.get("items", {}) or "oneOf" in node.get("items", {}) for node in lists)
    return f"{LIST}; begin each of its tables with double brackets, [[...]]" if tables else LIST


def toml_text(value: object, levels: int = LEVELS) -> str:
    """Write a value in TOML for a message: `true`, `{ uniform = [1, 2] }`, `2026-01-31`; texts in single quotes.

    Numbers have 12 significant digits, except for integers. Tables and lists deeper than `levels` are written as "...".
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        return f"{float(value):.12g}"
    if isinstance(value, date | time):
        return str(value)
    if levels == 0 and isinstance(value, Mapping | list | tuple):
        return "..."
    if isinstance(value, Mapping):
        pairs = ", ".join(f"{key_text(key)} = {toml_text(each, levels - 1)}" for key, each in value.items())
        return f"{{ {pairs} }}" if pairs else "{}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(toml_text(each, levels - 1) for each in value)}]"
    return repr(value)


def key_text(key: object) -> str:
    """Write a key as in TOML: bare where this is allowed, else in quotes with control characters escaped."""
    text = str(key)
    return text if re.fullmatch(r"[A-Za-z0-9_-]+", text) else repr(text)
