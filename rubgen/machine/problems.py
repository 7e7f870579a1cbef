"""Explain data that does not fit its type in one line for the user: file, key, value, what is allowed, the remedy."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from rubgen.errors import UserError
from rubgen.machine.schema_nodes import Path, SchemaNodes, bounds_in_words
from rubgen.machine.sentences import DECIMAL_COMMA, OWN, key_text, sentence, toml_text

T = TypeVar("T")
REPEATING = ("twins",)
"""Tables of a recipe with the keys of other tables. Nobody is sent there for a key."""
UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")
DEEPEST = 16
NEAR, FAR = 0.6, 0.75
"""How like a known key an unknown one must be, in its own table and elsewhere."""
WHOLE_NUMBERS = 2**63
SHARES = ("below 1", "at most 1", "at most 0.3")
"""How the range of a share ends."""
SIGNED = re.compile(r"at least -")
"""Times and angles may be negative."""
UNIT = re.compile("_([a-z]+_per_[a-z0-9]+|kg_m|deg|hz|kg|m|pa|ppm|rpm|s)$")
"""The unit at the end of a key, such as `_m_per_s2`."""
LONGEST = 120
"""Longer values are not shown."""
MOST_LISTED = 40
"""Allowed names that a line lists."""
MOST_ERRORS = 500
"""Largest number of errors that are compared with each other: twenty thousand would take minutes."""
OTHER_NAMES = {
    "channels": "set",
    "channel": "set",
    "mu": "friction",
    "rpm": "speed_rpm",
    "fs": "sample_rate_hz",
    "E": "youngs_modulus_pa",
    "nu": "poisson_ratio",
    "rho": "density_kg_per_m3",
    "sigma": "std",
}
"""Common wrong names of keys that do not resemble the right ones."""


def validated(
    source: object, data: object, adapter: TypeAdapter[T], place: Callable[[Path], Path] = lambda path: path
) -> T:
    """Validate data and return it as the adapter's type.

    - source: file or name of the data, for messages.
    - data: the TOML values.
    - adapter: pydantic's adapter of the type.
    - place: turns the path of a value in `data` into its path in the file.

    Raises UserError of one line. It is the error of `check_plain` if there is one, else the first problem in the order
    of the file, with the number of problems if there are several.
    """
    check_plain(source, data)
    try:
        return adapter.validate_python(data)
    except ValidationError as error:
        raise first_problem(source, error, data, adapter, place) from None


def first_problem(
    source: object,
    error: ValidationError,
    data: object,
    adapter: TypeAdapter[Any] | None = None,
    place: Callable[[Path], Path] = lambda path: path,
) -> UserError:
    """Make the UserError of the first problem, in the order of the file, of data that does not fit its type.

    - source: file or name of the data.
    - error: the error of pydantic.
    - data: the TOML values.
    - adapter: pydantic's adapter of the type; without it no similar keys are suggested.
    - place: turns the path of a value in `data` into its path in the file.
    """
    problems = _problems(error, data)
    first = min(problems, key=lambda each: _order(data, each.path))
    schema = SchemaNodes(adapter) if adapter else None
    path = place(first.path)
    words = first.text(data, schema)
    name = key_name(path) or "the file"
    if first.own and not first.path:  # a rule of the whole: its words name the keys
        name = f"{name}: " if path else ""
    text = _of(source, f"{name}{words}")
    count = f"more than {MOST_ERRORS}" if error.error_count() > MOST_ERRORS else len(problems)
    others = f" ({count} problems in all)" if len(problems) > 1 else ""
    return UserError(f"{text}{others}")


def check_plain(source: object, value: object, path: Path = ()) -> None:
    """Check that data is nested at most 16 levels deep, and that its integers fit in 64 bits with sign.

    `source` is the file or name of the data, `path` the keys and numbers that lead to `value` in it. Raises UserError
    where the check fails.
    """
    if len(path) > DEEPEST:
        raise UserError(_of(source, f"{key_name(path[:3])}: tables or lists in one another without end; write it flat"))
    if isinstance(value, Mapping):
        for key, each in value.items():
            check_plain(source, each, (*path, str(key)))
    elif isinstance(value, list | tuple):
        for number, each in enumerate(value):
            check_plain(source, each, (*path, number))
    elif isinstance(value, int) and not -WHOLE_NUMBERS <= value < WHOLE_NUMBERS:
        raise UserError(_of(source, f"{key_name(path)}: an integer that does not fit in 64 bits; give a smaller one"))


def _of(source: object, text: str) -> str:
    """Return the text after its source, if that has a name."""
    return f"{source}: {text}".removeprefix(": ")


def nearest(name: str, known: list[str]) -> str:
    """Return a hint for an unknown `name`: "did you mean ...?" with the nearest known name, and the allowed names.

    The question is left out where no known name is like `name`. At most MOST_LISTED names are listed. Without known
    names the hint is "remove it".
    """
    close = _closest(name, known)
    hint = f"did you mean {close}? " if close else ""
    more = f" and {len(known) - MOST_LISTED} more" if len(known) > MOST_LISTED else ""
    return f"{hint}allowed: {', '.join(known[:MOST_LISTED])}{more}" if known else "remove it"


def key_name(path: Path) -> str:
    """Write a path of keys and numbers as in TOML, `blades.material`. A part that is no bare key is quoted."""
    return ".".join(_cut(key_text(part)) for part in path)


@dataclass(frozen=True, kw_only=True)
class _Problem:
    """All errors of pydantic for the value at one path: each branch of a union has its own errors."""

    path: Path
    errors: list[Any]

    @property
    def kind(self) -> str:
        return str(self.errors[0]["type"])

    @property
    def own(self) -> bool:
        """Whether the message is written in rubgen, where the rule is; it then contains its key."""
        return self.kind in OWN

    def text(self, data: object, schema: SchemaNodes | None) -> str:
        """Return value, what is allowed and the remedy, after the key."""
        nodes = schema.at(data, self.path) if schema else []
        if self.kind == "missing":
            bounds = bounds_in_words(nodes)
            return f": this key is missing; add it{f', {bounds}' if bounds else ''}"
        if self.kind in UNKNOWN:
            return f": unknown key; {_instead(self.path, data, schema)}"
        sentences = [sentence(each, bounds_in_words(nodes), nodes) for each in self.errors]
        message = " or ".join(dict.fromkeys(sentences)).replace(" or must be", " or")
        value = self.errors[0].get("input")
        if not self.path and self.own:
            return message
        hint = _hint(value, message)
        remedy = "" if hint or ";" in message else "; change the value"
        # Of a whole table, a message that shows the key and its value says enough.
        shown = "" if isinstance(value, Mapping) and " = " in message else _shown(value)
        return f"{shown}: {message}{hint}{remedy}"


def _problems(error: ValidationError, data: object) -> list[_Problem]:
    found: dict[tuple[Path, bool], _Problem] = {}
    for each in error.errors(include_url=False)[:MOST_ERRORS]:
        lacking = each["type"] == "missing"
        path = _path_in(data, each["loc"], missing=lacking)
        if lacking and isinstance(path[-1], int):  # too few values of a pair
            path, each["input"] = path[:-1], _at(data, path[:-1])
            each["type"] = "pair"
        found.setdefault((path, each["type"] in UNKNOWN), _Problem(path=path, errors=[])).errors.append(each)
    return [each for each in found.values() if not _follows(each, list(found.values()))]


def _follows(problem: _Problem, problems: list[_Problem]) -> bool:
    """Return whether a problem follows from another.

    A misspelt key is also a missing key, and a list lacks its bad value.
    """
    if problem.kind not in ("too_short", "missing"):
        return False
    path, others = problem.path, [each for each in problems if each is not problem]
    if problem.kind == "too_short":
        return any(each.path[: len(path)] == path for each in others)
    unknown = [each.path for each in others if each.kind in UNKNOWN and each.path[:-1] == path[:-1]]
    return any(_closest(str(each[-1]), [str(path[-1])]) for each in unknown)


def _instead(path: Path, data: object, schema: SchemaNodes | None) -> str:
    """Say what to write for an unknown key: a near one of its table, or one of that name elsewhere."""
    if schema is None:
        return "remove it"
    name, here = str(path[-1]), schema.keys(data, path[:-1])
    wanted = OTHER_NAMES.get(name, name)
    if wanted in here:
        return f"did you mean {wanted}? allowed: {', '.join(here)}"
    places = [key for key in schema.every_key() if key[0] not in REPEATING]
    elsewhere = [key for key in places if key[-1] == wanted and key != path[:-1]]
    if elsewhere:
        parts = [part for part in path[:-1] if isinstance(part, str)]
        best = max(elsewhere, key=lambda key: sum(a == b for a, b in zip(key, parts, strict=False)))
        return f"did you mean {'.'.join(best)}? allowed: {', '.join(here)}"
    if _closest(name, here):
        return nearest(name, here)
    every = {key[-1]: key for key in places}
    far = _closest(name, list(every), FAR)
    return f"did you mean {'.'.join(every[far])}? {nearest(name, here)}" if far else nearest(name, here)


def _closest(name: str, known: list[str], cutoff: float = NEAR) -> str | None:
    """Return the known name that is most like `name`, or has it as one of its words."""
    lower = {each.lower(): each for each in known}
    units = [each for each in lower if UNIT.sub("", each) == name.lower()]  # all but its unit
    if len(units) == 1:
        return lower[units[0]]
    close = get_close_matches(name.lower(), lower, n=1, cutoff=cutoff)
    if not close and cutoff < FAR:
        close = [each for each in lower if name.lower() in each.split("_")]
    return lower[close[0]] if close else None


def _hint(value: object, message: str) -> str:
    """Name the likely mistake, where a number is written as text or a share in percent."""
    if isinstance(value, int | float) and 1 < value <= 100 and message.endswith(SHARES) and not SIGNED.search(message):
        return f"; {value:g} % is written {value / 100:g}"
    if not isinstance(value, str) or "number" not in message:
        return ""
    comma = DECIMAL_COMMA.fullmatch(value.strip())
    if comma:
        return f"; decimals have a point, write {comma[1]}.{comma[2]}"
    try:
        float(value)
    except ValueError:
        return ""
    return "; write it without quotes"


def _shown(value: object) -> str:
    text = toml_text(value)
    return f" = {text}" if len(text) <= LONGEST else ""


def _cut(text: str) -> str:
    return text if len(text) <= LONGEST else f"{text[:60]}..."


def _at(data: object, path: Path) -> Any:
    for part in path:
        data = data[part]  # type: ignore[index]
    return data


def _path_in(data: object, loc: tuple[int | str, ...], *, missing: bool) -> Path:
    """Return the parts of `loc` that are keys of the data; pydantic mixes the names of union members in."""
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
    return tuple(path)


def _order(data: object, path: Path) -> tuple[int, ...]:
    """Return the place of a path in the file. A missing key is at the end of its table."""
    order = []
    for part in path:
        keys = list(data) if isinstance(data, Mapping) else list(range(len(data))) if isinstance(data, list) else []
        order.append(keys.index(part) if part in keys else len(keys))
        data = _at(data, (part,)) if part in keys else None
    return tuple(order)
