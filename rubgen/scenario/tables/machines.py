"""`[machines]` of a recipe: how many virtual machines, their ranges, and the bounds of a sane one."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Self

from pydantic import BaseModel, Field, create_model, model_validator

from rubgen.machine import Machine
from rubgen.machine.descriptions import draws
from rubgen.machine.quantities import MOST_RUNS, Length, RunCount, Speed, StrictModel, TryCount
from rubgen.scenario.distributions import Choice, Constant, Distribution
from rubgen.scenario.machines.keys import MACHINE_KEYS, MachineKey, with_values

CLEARANCES = ("clearance_m", "casing_radius_m")
_FIELDS: dict[str, Any] = {
    entry.key: (
        Annotated[Distribution | None, Field(description=entry.about, json_schema_extra=draws(entry.quantity))],
        None,
    )
    for entry in MACHINE_KEYS
}
MachineVary = create_model(
    "MachineVary",
    __base__=StrictModel,
    __doc__="`[machines.vary]`: a number fixes a value of every machine, a table draws it once a machine.",
    **_FIELDS,
)


class MachineTable(StrictModel):
    """`[machines]`: virtual machines, each with its own values and with runs that follow each other."""

    count: Annotated[
        RunCount | None,
        Field(description="Number of machines, in place of `runs`: the runs are count x runs_per_machine."),
    ] = None
    runs_per_machine: Annotated[
        RunCount, Field(description="Number of runs of each machine. They follow each other.")
    ] = 1
    vary: Annotated[
        MachineVary,
        Field(description="Values of the machines. What is not named keeps the value of the machine's file."),
    ] = MachineVary()
    critical_speed_rpm: Annotated[
        tuple[Speed, Speed] | None,
        Field(description="Least and largest critical speed of a machine that is used. Any where not given."),
    ] = None
    onset_clearance_m: Annotated[
        tuple[Length, Length] | None,
        Field(
            description="Least and largest clearance at which the blades just reach the casing, at the speed of the "
            "recipe where they reach farthest. Any where not given."
        ),
    ] = None
    tries: Annotated[
        TryCount, Field(description="Largest number of candidates for a machine; raise it where most are refused.")
    ] = 20

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        for key in ("critical_speed_rpm", "onset_clearance_m"):
            bounds = getattr(self, key)
            if bounds and bounds[0] > bounds[1]:
                raise ValueError(f"{key} = [{bounds[0]:g}, {bounds[1]:g}]: the lower end comes first; swap the two")
        return self

    def distributions(self) -> Iterator[tuple[MachineKey, Distribution]]:
        """Yield the keys of `[machines.vary]` in the recipe and their distributions, in the order of MACHINE_KEYS."""
        for entry in MACHINE_KEYS:
            distribution = getattr(self.vary, entry.key)
            if distribution is not None:
                yield entry, distribution

    def largest(self, machine: Machine) -> Machine:
        """Return `machine` with the largest number of blades that may be drawn."""
        count = self.vary.blade_count  # type: ignore[attr-defined]
        return with_values(machine, {"blade_count": max(count.extremes())}) if count else machine

    @property
    def never_twice(self) -> bool:
        """Whether no two machines are equal: a value is drawn from a range, or each machine has its own mistuning."""
        ends = [(entry.key, each, min(each.extremes()), max(each.extremes())) for entry, each in self.distributions()]
        return any(
            (key == "mistuning" and least > 0) or (not isinstance(each, Constant | Choice) and largest > least)
            for key, each, least, largest in ends
        )


def merged(table: BaseModel, changes: BaseModel | None) -> Any:
    """Return `table` with the keys that are set in `changes` replaced. Without `changes` it is an equal copy."""
    given = {key: getattr(table, key) for key in table.model_fields_set}
    given |= {key: getattr(changes, key) for key in changes.model_fields_set} if changes else {}
    return type(table)(**given)


def with_runs(data: Any) -> Any:
    """Return the TOML values of a recipe with `runs` computed from `machines.count`, and without `machines.count`.

    Values without a valid `machines.count` are returned as they are. Raises ValueError where `runs` is given and does
    not agree, or where there are too many runs.
    """
    machines = data.get("machines") if isinstance(data, Mapping) else None
    if not isinstance(machines, Mapping):
        return data
    count, each = machines.get("count"), machines.get("runs_per_machine", 1)
    if not all(isinstance(number, int) and number > 0 for number in (count, each)):
        return data
    runs = data.get("runs", count * each)
    if count * each > MOST_RUNS:
        raise ValueError(
            f"machines.count = {count}: with {each} runs each they make {count * each:,} runs, at most {MOST_RUNS:,}; "
            "lower machines.count or machines.runs_per_machine"
        )
    if runs != count * each:
        raise ValueError(
            f"runs = {runs!r:.60}: machines.count = {count} with {each} runs each make {count * each}; "
            "leave out runs or machines.count"
        )
    return {**data, "runs": runs, "machines": {key: value for key, value in machines.items() if key != "count"}}


def replaced_runs(data: dict[str, Any], runs: int) -> dict[str, Any]:
    """Return the TOML values of a recipe with `runs` replaced, and without `machines.count`: `runs` determines it."""
    machines = data.get("machines")
    if isinstance(machines, Mapping):
        data = {**data, "machines": {key: value for key, value in machines.items() if key != "count"}}
    return {**data, "runs": runs}
