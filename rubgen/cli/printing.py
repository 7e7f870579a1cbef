"""Results for people and for programs."""

import json
import math
import sys


def say(text: str) -> None:
    """One or more lines on stdout."""
    sys.stdout.write(f"{text}\n")


def print_json(values: dict[str, object]) -> None:
    """One JSON document on stdout; what is not a number becomes null."""
    say(json.dumps(_plain(values), indent=2, allow_nan=False))


def print_pairs(values: dict[str, object]) -> None:
    """Names and values in two columns."""
    width = max(map(len, values), default=0)
    for name, value in values.items():
        say(f"{name:<{width}}  {_text(value)}")


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        return "  ".join(_text(each) for each in value) or "-"
    if isinstance(value, dict):
        return "  ".join(f"{name} {_text(each)}" for name, each in value.items()) or "-"
    return str(value)


def _plain(value: object) -> object:
    if isinstance(value, dict):
        return {str(name): _plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
