"""`[twins]`: runs that differ from their partner in one thing alone."""

import zlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from pkgutil import resolve_name
from typing import Annotated, Any, Self, get_type_hints

import numpy as np
from pydantic import BaseModel, Field, create_model, model_validator

from rubgen.errors import UserError
from rubgen.machine.faults.fault import Fault
from rubgen.machine.faults.registry import AnyFault
from rubgen.machine.quantities import StrictModel, about
from rubgen.scenario.faults import kind_of
from rubgen.scenario.scenario import Pairing, Scenario
from rubgen.scenario.surroundings import SURROUNDINGS, Surroundings, extremes
from rubgen.scenario.vary import DRAWN, FREE_PENETRATION, vary

AROUND = tuple(each.key for each in SURROUNDINGS)
CLEARANCES = ("clearance_m", FREE_PENETRATION.key)
KEEPS_MOTION = ("friction", *CLEARANCES, *AROUND)
"""Keys that leave the rub-free motion as it is, and so the clearance that follows from a free penetration."""
WITH_CLEARANCE = "rubgen.solver.linear.reach:with_clearance"
"""It needs the solver, above this room, so it is named here and imported when used."""
_HINTS = get_type_hints(Surroundings, include_extras=True)
_SHARE = "Number of twins over the number of all other runs. Fewer twins leave more runs that stand alone."
_FAULT = "A fault of the twin: its kind and its values. It replaces a fault of the same kind that the run has."


class _OneChange(StrictModel):
    @property
    def changed(self) -> str:
        """The key that differs."""
        return next(iter(self._given()))

    def _given(self) -> list[str]:
        return [key for key in type(self).model_fields if key != "share" and getattr(self, key) is not None]

    @model_validator(mode="before")
    @classmethod
    def _has_one_sensor_set(cls, given: Any) -> Any:
        if isinstance(given, dict) and "sensors" in given:
            raise ValueError("a data set has one sensor set; make it, then other sensors with rubgen resense")
        return given

    @model_validator(mode="after")
    def _changes_one_key(self) -> Self:
        given = self._given()
        if len(given) != 1:
            said = f"{' and '.join(given)} differ" if given else "nothing differs"
            raise ValueError(f"{said}: a twin differs from its partner in one thing; give one key beside share")
        return self


def _fields() -> dict[str, Any]:
    drawn = {each.key: (each.quantity, each.about) for each in DRAWN}
    around = {each.key: (_HINTS[each.key], each.meaning) for each in SURROUNDINGS}
    return {
        key: (Annotated[kind | None, about(f"The twin's value, in place of that of its run. {text}")], None)
        for key, (kind, text) in (drawn | around).items()
    }


Twins = create_model(
    "Twins",
    __base__=_OneChange,
    __doc__="`[twins]`: the one key that differs between a run and its twin, with the twin's value.",
    share=(Annotated[float, Field(gt=0, le=1), about(_SHARE)], 1.0),
    fault=(Annotated[AnyFault | None, about(_FAULT)], None),
    **_fields(),
)


def partner_of(index: int, share: float, seed: int, first: int, count: int) -> int | None:
    """Return the number of the partner of run number `index` if the run is a twin; None for any other run.

    - share: number of twins over the number of all other runs, 0 to 1.
    - first, count: number of the first run of the run's machine, and the number of the machine's runs.

    The machine's runs are divided into slots of two neighbours. A slot is a pair with probability p = 2 share / (1 +
    share). The seed draws which slots are pairs, and whether the first or the second run is the twin, so that the
    position in the set does not show which run is a twin. With an odd `count` the last run has no twin: p is raised for
    it, to 1 at most.
    """
    slots, number = count // 2, index - first
    if number >= 2 * slots:
        return None
    wanted = 2 * share / (1 + share) * (count / (2 * slots))
    generator = np.random.default_rng([seed, first // count * slots + number // 2, zlib.crc32(b"twins")])
    is_pair, place = generator.random() < wanted, int(generator.integers(2))
    return index + 1 - 2 * place if is_pair and number % 2 == place else None


def twin(partner: Scenario, twins: BaseModel, source: str = "") -> Scenario:
    """Return the twin of a run: the scenario `partner` with the one value of the table `[twins]` changed.

    A fault replaces a fault of the same kind, or is added. A clearance or a free penetration replaces either of them.
    Index and pairing stay those of the partner: `paired` sets them. Raises UserError, beginning with `source`, for a
    value of `[vary]` out of its range. Whether the machine can have the value or the fault is checked by
    `check_feasible`.
    """
    key = twins.changed  # type: ignore[attr-defined]
    value = getattr(twins, key)
    if key == "fault":
        kept = tuple(fault for fault in partner.machine.faults if kind_of(fault) != kind_of(value))
        return replace(partner, machine=replace(partner.machine, faults=(*kept, value)))
    if key in AROUND:
        return replace(partner, surroundings=replace(partner.surroundings or Surroundings(), **{key: value}))
    if key in CLEARANCES:
        partner = replace(partner, free_penetration_m=None)
    return vary(partner, {key: value}, source, ("twins",))


def with_twin(scenario: Scenario, twins: BaseModel | None, source: str) -> Iterator[Scenario]:
    """Yield the scenario, then its twin. Without the table `[twins]` only the scenario is yielded.

    Raises UserError, beginning with `source`, as `twin` does.
    """
    yield scenario
    if twins:
        yield twin(scenario, twins, source)


def paired(twins: BaseModel, partner: int | None, index: int, draw: Callable[[int], Scenario]) -> Scenario:
    """Return the scenario of run number `index` of a recipe with `[twins]`: a twin, or a run as it is drawn.

    - twins: the table `[twins]`.
    - partner: number of the partner if the run is a twin, else None.
    - draw: returns the scenario of a run number, before twins are made.

    A twin is its partner with one value changed, its own index and the partner's random numbers. It also has the
    partner's clearance, even if the recipe draws a free penetration and the changed value would lead to another
    clearance. This clearance is then computed here, which reduces the machine.
    """
    run = draw(index if partner is None else partner)
    if partner is not None:
        if twins.changed not in KEEPS_MOTION:  # type: ignore[attr-defined]
            with suppress(UserError):  # of the partner, which is then refused
                run = resolve_name(WITH_CLEARANCE)(run)
        run = replace(twin(run, twins), index=index)
    return replace(run, pairing=Pairing(twin_of=partner))


def check_twins(twins: BaseModel, around: BaseModel | None, corners: Sequence[Scenario], source: str) -> None:
    """Check that a run of the recipe can differ from its twin.

    - twins: the table `[twins]`.
    - around: the recipe's table `[surroundings]`, or None.
    - corners: scenarios at the extreme values of the recipe, each followed by its twin; at least one pair.
    - source: beginning of messages.

    The pairs of `corners` are compared. If the twin changes a key of `[surroundings]`, the first scenario of `corners`
    is compared with its twin instead, in the least and in the largest surroundings of the table.

    Raises UserError of one line where every scenario equals its twin, and where the twin changes a key of
    `[surroundings]` and the recipe has no such table.
    """
    key = twins.changed  # type: ignore[attr-defined]
    if key in AROUND and around is None:
        raise UserError(f"{source}: twins.{key}: the recipe has no [surroundings]; add the table with this key")
    ends = extremes(around) if around and key in AROUND else None
    pairs = [(one, twin(one, twins)) for one in (replace(corners[0], surroundings=end) for end in ends or ())]
    if all(one == other for one, other in pairs or zip(corners[::2], corners[1::2], strict=True)):
        value = getattr(twins, key)
        shown = f"{value:g}" if isinstance(value, int | float) else kind_of(value)
        raise UserError(f"{source}: twins.{key} = {shown}: every run has it already; give another value")


def fault_of(twins: BaseModel | None) -> tuple[Fault, ...]:
    """Return a tuple of the fault that the table adds to twins. It is empty without a table or without a fault."""
    fault: Fault | None = getattr(twins, "fault", None)
    return (fault,) if fault else ()
