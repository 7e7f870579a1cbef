"""Short texts for large values: a notebook then shows one line in place of pages."""

import dataclasses
import shlex
from collections.abc import Mapping
from enum import Enum
from html import escape
from itertools import islice

import numpy as np

FEW, LONGEST, MOST = 3, 60, 780
"""Number of entries of a list or mapping that are shown; longest text, in characters, of one value and of an object."""


def brief(value: object) -> str:
    """Return a dataclass as text, `Name(field=..., ...)`, in one line of at most about MOST characters.

    An array is shown by its shape, a mapping by its size and first FEW keys, a list of more than FEW values by its
    size. Fields whose number, text or None is the default, and fields with `repr=False`, are left out. Classes with
    large fields use it as their `__repr__`.
    """
    fields = dataclasses.fields(value) if dataclasses.is_dataclass(value) else ()
    shown = [f"{field.name}={_short(getattr(value, field.name))}" for field in fields if _is_shown(value, field)]
    text = ", ".join(shown)
    return f"{type(value).__name__}({text if len(text) <= MOST else text[:MOST] + '...'})"


def counted(count: int, noun: str) -> str:
    """Return a count with its noun, in the plural unless the count is 1: "1 run", "2 runs"."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def in_shell(path: object) -> str:
    """Return a path or URL as one word of a command to copy: in quotes where it has spaces or the like."""
    return shlex.quote(str(path))


def table(title: str, rows: Mapping[str, str]) -> str:
    """Return a text: the line `title`, then a line for each name in `rows` with its value."""
    width = max(map(len, rows), default=0)
    return "\n".join([title, *(f"  {name:<{width}}  {value}" for name, value in rows.items())])


def html_table(title: str, rows: Mapping[str, str]) -> str:
    """Return a title and rows of names and values as an HTML table, for a notebook."""
    cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows.items())
    return f"<table><caption>{escape(title)}</caption>{cells}</table>"


def number(value: object) -> str:
    """Return a label or parameter as a short text: a float with 4 significant digits, None as "-", else in full."""
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _is_shown(value: object, field: dataclasses.Field[object]) -> bool:
    one = getattr(value, field.name)
    return field.repr and not (isinstance(one, int | float | str | None) and one == field.default)


def _short(value: object) -> str:
    if isinstance(value, np.ndarray):
        return f"array{value.shape}"
    if isinstance(value, Mapping):
        first = ", ".join(map(str, islice(value, FEW)))
        return f"{{{len(value)}: {first}{', ...' if len(value) > FEW else ''}}}"
    if isinstance(value, list | tuple) and len(value) > FEW:
        return f"({len(value)} values)"
    if isinstance(value, Enum):
        return str(value.value).split(":")[0]
    if dataclasses.is_dataclass(value):
        return f"{type(value).__name__}(...)"
    text = f"{value:.6g}" if isinstance(value, float) else repr(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
