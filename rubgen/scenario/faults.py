"""Draw the faults of `[[faults]]` in a recipe: which runs have which fault, and how severe it is.

The tables are made from the fields of each kind (`rubgen.machine.faults.registry`), so a new kind needs nothing here.
"""

import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import MISSING, fields, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, cast, get_args, get_origin, get_type_hints

import numpy as np
from pydantic import AfterValidator, BaseModel, Field, TypeAdapter, create_model

from rubgen.errors import UserError
from rubgen.machine.descriptions import draws
from rubgen.machine.faults.fault import Fault
from rubgen.machine.faults.registry import FAULTS, AnyFault
from rubgen.machine.problems import nearest, validated
from rubgen.machine.quantities import StrictModel, about
from rubgen.machine.schema_nodes import Path
from rubgen.machine.sentences import toml_text
from rubgen.scenario.distributions import Choice, Constant, Distribution
from rubgen.scenario.scenario import Scenario

_FAULT: TypeAdapter[Fault] = TypeAdapter(AnyFault)
Value = Callable[[str, Any], object]
"""The value of a key, from its name and its distribution."""


class WordChoice(StrictModel):
    """`{ choice = ["a", "b"] }`: each listed word with the same probability."""

    choice: Annotated[tuple[str, ...], Field(min_length=1), about("Words of which each is equally likely.")]

    def quantile(self, u: float) -> str:
        """Return the word number floor(u n), for u in [0, 1)."""
        return self.choice[int(u * len(self.choice))]

    def extremes(self) -> tuple[str, ...]:
        """Return every word."""
        return self.choice


def _is_share(share: Distribution) -> Distribution:
    if not all(0 <= value <= 1 for value in share.extremes()):
        raise ValueError("a share of the runs must be at least 0 and at most 1")
    return share


def _is_whole(number: Distribution) -> Distribution:
    if not isinstance(number, Constant | Choice):
        raise ValueError("takes whole numbers only; give a number or a choice")  # noqa: TRY004
    return number


_WHOLE = Annotated[Distribution, AfterValidator(_is_whole)]


def _words(hint: Any) -> tuple[str, ...]:
    """Return the words that a field allows; none where it is a number."""
    if get_origin(hint) is Literal:
        return get_args(hint)
    return next((words for part in get_args(hint) if (words := _words(part))), ())


def _table(kind: str, fault: type[Fault]) -> type[BaseModel]:
    """Make the table of one kind: each number of it may be drawn, each word chosen."""
    share = Annotated[Distribution, AfterValidator(_is_share)]
    values: dict[str, Any] = {
        "kind": (Annotated[Literal[kind], about("Kind of this fault.")], ...),
        "share": (Annotated[share | None, about("Share of the runs that have this fault. All where not given.")], None),
    }
    hints, quantities = get_type_hints(fault), get_type_hints(fault, include_extras=True)
    for field in fields(cast("Any", fault))[1:]:
        words = _words(hints[field.name])
        whole = hints[field.name] is int
        allowed: Any = Literal[words] | WordChoice if words else _WHOLE if whole else Distribution
        text = cast("Any", fault).__pydantic_fields__[field.name].description
        if field.default is MISSING:
            extra = draws(quantities[field.name])
            values[field.name] = (Annotated[allowed, Field(description=text, json_schema_extra=extra)], ...)
        else:
            extra = draws(quantities[field.name], field.default)
            values[field.name] = (Annotated[allowed | None, Field(description=text, json_schema_extra=extra)], None)
    return create_model(f"{fault.__name__}Table", __base__=StrictModel, __doc__=f"`[[faults]]` of {kind}.", **values)


if TYPE_CHECKING:
    FaultTable = BaseModel
else:
    _TABLES = tuple(_table(kind, fault) for kind, fault in FAULTS.items())
    FaultTable = Annotated[Union[_TABLES], Field(discriminator="kind")]  # noqa: UP007


def kind_of(fault: Fault | BaseModel) -> str:
    """Return the kind of a fault, or of a `[[faults]]` table of a recipe, such as "bearing-defect"."""
    return str(cast("Any", fault).kind)


def with_faults(scenario: Scenario, tables: Sequence[BaseModel]) -> Scenario:
    """Draw the faults of a run and return the scenario with them, in addition to the faults of its machine.

    - scenario: its seed and index determine the random numbers.
    - tables: the `[[faults]]` tables of the recipe.

    `fault_kinds` of the result are all kinds that the machine or the tables name, also those that this run does not
    have. Each key of each kind has its own random numbers, which do not depend on the other keys and kinds. Raises
    UserError for a drawn value that the kind cannot have.
    """

    def number(name: str) -> float:
        key = [scenario.seed, scenario.index, zlib.crc32(f"faults.{name}".encode())]
        return float(np.random.default_rng(key).random())

    def drawn(table: BaseModel) -> Fault:
        return _fault(table, lambda key, entry: entry.quantile(number(f"{kind_of(table)}.{key}")))

    def has(table: BaseModel) -> bool:
        kind, share = kind_of(table), cast("Any", table).share
        return share is None or number(f"{kind}.has") < share.quantile(number(f"{kind}.share"))

    return _having(scenario, tables, tuple(drawn(table) for table in tables if has(table)))


def with_given_faults(scenario: Scenario, kinds: str | Sequence[str], values: Mapping[str, object]) -> Scenario:
    """Return the scenario with faults of these kinds in addition to the machine's own.

    - kinds: one kind or several.
    - values: the values of the faults' keys. Each goes to the kind that has the key.

    Raises UserError of one line for an unknown kind, a kind that the machine has already, a key that no kind or several
    kinds have, and a value that the kind cannot have. Whether the machine can have the fault is checked by
    `check_feasible`.
    """
    named = [kinds] if isinstance(kinds, str) else list(kinds)
    already = kinds_of(scenario.machine.faults)
    for kind in named:
        if kind not in FAULTS:
            raise UserError(f"fault = {toml_text(kind)}: unknown kind; {nearest(str(kind), list(FAULTS))}")
        if kind in already or named.count(kind) > 1:
            raise UserError(f"fault = {kind!r}: the machine has this fault already; name it once")
    for key in values:
        having = [kind for kind in named if key in keys_of_kind(kind)]
        if len(having) > 1:
            raise UserError(f"{key}: {' and '.join(having)} have this key; write a recipe, or make two runs")
        if not having:
            owners = " or ".join(kind for kind in FAULTS if key in keys_of_kind(kind))
            raise UserError(f"{key}: a key of the fault {owners}; name that fault too, or leave the key out")
    faults = tuple(
        validated("", {"kind": kind, **_of_kind(kind, values)}, _FAULT, partial(_place, kind)) for kind in named
    )
    return _having(scenario, (), faults) if named or already else scenario


def _place(kind: str, path: Path) -> Path:
    return ("fault", kind, *path)


def keys_of_kind(kind: str) -> list[str]:
    """Return the keys of a kind, except for `kind`."""
    return [field.name for field in fields(cast("Any", FAULTS[kind]))[1:]]


def _of_kind(kind: str, values: Mapping[str, object]) -> dict[str, object]:
    return {key: values[key] for key in keys_of_kind(kind) if key in values}


FAULT_KEYS = tuple(dict.fromkeys(key for kind in FAULTS for key in keys_of_kind(kind)))
"""The keys of all kinds."""


def extremes(scenario: Scenario, tables: Sequence[BaseModel], source: str) -> Iterator[Scenario]:
    """Yield the scenario with each fault alone, at its least and at its largest values, then with all at their largest.

    The faults come in addition to those of the scenario's machine. All keys of a fault have their least, or all their
    largest value.

    - tables: the `[[faults]]` tables of the recipe, from which the values come.
    - source: beginning of messages.

    Raises UserError for a value that the kind cannot have, and for a kind that the machine and the recipe name twice.
    Whether the machine can have the faults is checked by `check_feasible`.
    """
    kinds = [kind_of(fault) for fault in scenario.machine.faults]
    largest = []
    for number, table in enumerate(tables):
        kind = kind_of(table)
        if kind in kinds:
            where = "the machine" if kind in kinds[: len(scenario.machine.faults)] else "the recipe"
            raise UserError(f"{source}: faults.{number}.kind = {kind!r}: {where} has this fault already; remove one")
        kinds.append(kind)
        for end in (min, max):
            fault = _fault(table, lambda _, entry, end=end: end(entry.extremes()), source, number)  # type: ignore[misc]
            yield _having(scenario, tables, (fault,))
        largest.append(fault)
    yield _having(scenario, tables, tuple(largest))


def named_kinds(*documents: dict[str, Any]) -> tuple[str, ...]:
    """Return the kinds of fault that the documents of a recipe and of its machines name, in the order of the registry.

    A document is the TOML or JSON content as nested dicts. The fault of `[twins]` counts too.
    """
    named = {each["kind"] for document in documents for each in document.get("faults") or ()}
    twins: list[dict[str, Any]] = [document.get("twins") or {} for document in documents]
    named |= {each["fault"]["kind"] for each in twins if each.get("fault")}
    return tuple(kind for kind in FAULTS if kind in named)


def kinds_of(faults: Iterable[Fault | BaseModel]) -> tuple[str, ...]:
    """Return the kinds of these faults or tables, in the order of the registry."""
    kinds = {kind_of(each) for each in faults}
    return tuple(kind for kind in FAULTS if kind in kinds)


def _having(scenario: Scenario, tables: Sequence[BaseModel], faults: tuple[Fault, ...]) -> Scenario:
    already = scenario.machine.faults
    machine = replace(scenario.machine, faults=cast("Any", (*already, *faults)))
    return replace(scenario, machine=machine, fault_kinds=kinds_of((*machine.faults, *tables)))


def _fault(table: BaseModel, value: Value, source: str = "", number: int = 0) -> Fault:
    """Make the fault with the values of its table; `source` and the table's `number` are for messages."""
    given = [(key, getattr(table, key)) for key in type(table).model_fields if key not in ("kind", "share")]
    values = {key: entry if isinstance(entry, str) else value(key, entry) for key, entry in given if entry is not None}
    return validated(source, {"kind": kind_of(table), **values}, _FAULT, lambda path: ("faults", number, *path))
