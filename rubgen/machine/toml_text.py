"""Values as they stand in TOML: what a message shows of a user's file."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import date, time
from numbers import Integral, Real


def toml_text(value: object) -> str:
    """The value in the words of TOML: `true`, `{ uniform = [1, 2] }`, `2026-01-31`; texts in single quotes."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        return f"{float(value):.12g}"
    if isinstance(value, date | time):
        return str(value)
    if isinstance(value, Mapping):
        pairs = ", ".join(f"{key} = {toml_text(each)}" for key, each in value.items())
        return f"{{ {pairs} }}" if pairs else "{}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(toml_text, value))}]"
    return repr(value)
