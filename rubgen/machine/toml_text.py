"""Values in TOML, for messages about a user's file."""

import re
from collections.abc import Mapping
from datetime import date, time
from numbers import Integral, Real

LEVELS = 6
"""Deeper values are shown as `...`, because a manifest may nest without bound."""


def toml_text(value: object, levels: int = LEVELS) -> str:
    """The value in TOML: `true`, `{ uniform = [1, 2] }`, `2026-01-31`; texts in single quotes."""
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
    """A key in TOML: bare where that is allowed, else in quotes with control characters escaped."""
    text = str(key)
    return text if re.fullmatch(r"[A-Za-z0-9_-]+", text) else repr(text)
