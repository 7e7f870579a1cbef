"""Check `[machines]` and `[splits]` of a recipe before anything is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, create_model

from rubgen.errors import UserError
from rubgen.machine.problems import validated
from rubgen.machine.quantities import STRICT
from rubgen.scenario.checks.feasible import check_feasible
from rubgen.scenario.distributions import Choice, Constant
from rubgen.scenario.machines.keys import MACHINE_KEYS, with_values
from rubgen.scenario.scenario import Scenario
from rubgen.scenario.tables.machines import MachineTable
from rubgen.scenario.tables.splits import SplitTable, enough_machines
from rubgen.scenario.vary import FREE_PENETRATION
from rubgen.sensors.sensor_set import SensorSet

if TYPE_CHECKING:
    from rubgen.scenario.recipe import Recipe

_FIELDS: dict[str, Any] = {entry.key: (entry.quantity, None) for entry in MACHINE_KEYS}
_VALUES: TypeAdapter[Any] = TypeAdapter(create_model("MachineValues", __config__=STRICT, **_FIELDS))
CLEARANCES = {"clearance_m", "casing_radius_m", FREE_PENETRATION.key}
"""Keys of which each decides the clearance."""


def check_machines(recipe: Recipe, source: str) -> None:
    """Check that the virtual machines of a recipe can be drawn, from its keys and ranges; no machine is drawn.

    A recipe without `[machines]` passes if it names one machine. Raises UserError, beginning with `source`, where they
    cannot. Whether a candidate is sane is found when it is drawn.
    """
    files = recipe.files
    if len(set(files)) != len(files):
        raise UserError(f"{source}: machine = {list(files)}: name each machine once")
    if recipe.machines is None and len(files) > 1:
        raise UserError(
            f"{source}: machine = {list(files)}: several machines need [machines] with count and runs_per_machine; "
            "add it, or name one machine"
        )
    for where, part in recipe.named_parts(source):
        if part.machines:
            _check_ranges(part, part.machines, where)
            _check_count(recipe, part.machines, where)


def _check_ranges(recipe: Recipe, table: MachineTable, source: str) -> None:
    varied = {entry.key for entry, _ in recipe.distributions()}
    drawn = {entry.key for entry, _ in table.distributions()}
    for entry, distribution in table.distributions():
        place = ("machines", "vary", entry.key)
        for value in distribution.extremes():
            validated(source, {entry.key: value}, _VALUES, lambda _, place=place: place)  # type: ignore[misc]
        if entry.whole and not isinstance(distribution, Constant | Choice):
            raise UserError(f"{source}: {'.'.join(place)}: takes whole numbers only; give a number or a choice")
        if entry.key in varied:
            raise UserError(f"{source}: vary.{entry.key}: stands in machines.vary too; keep one of the two")
        for base in recipe.bases:
            if entry.of_frame and base.machine.frame is None:
                why = f"machine {base.machine.name} has no [frame]" if recipe.feels_frame else "no sensor feels a frame"
                raise UserError(f"{source}: {'.'.join(place)}: {why}; leave it out")
            pattern = base.machine.blades.mistuning and base.machine.blades.mistuning.pattern
            if entry.key == "blade_count" and pattern and "mistuning" not in drawn:
                raise UserError(
                    f"{source}: machines.vary.blade_count: machine {base.machine.name} has a mistuning.pattern of "
                    f"{len(pattern)} blades; add machines.vary.mistuning, or leave one of the two out"
                )
    both = [f"machines.vary.{key}" for key in sorted(CLEARANCES & drawn)]
    both += [f"vary.{key}" for key in sorted(CLEARANCES & varied)]
    if len(both) > 1 and both[0].startswith("machines"):
        raise UserError(f"{source}: {' and '.join(both)}: each decides the clearance; keep one of them")


def _check_count(recipe: Recipe, table: MachineTable, source: str) -> None:
    files = len(recipe.files)
    if recipe.machine_count <= files or table.never_twice:
        return
    raise UserError(
        f"{source}: machines: {recipe.machine_count} machines, of which only {files} can differ: without a key drawn "
        "from a range some would be equal, and stand in two splits; add a range or mistuning above 0 to machines.vary, "
        f"or take {files * table.runs_per_machine} runs"
    )


def check_splits(recipe: Recipe, source: str) -> None:
    """Check that every split of a recipe has machines, and that all splits have the same columns.

    Raises UserError, beginning with `source`, where they do not. A recipe without `[splits]` passes.
    """
    splits, machines = recipe.splits, recipe.machine_count
    if not splits:
        return
    if recipe.machines is None:
        raise UserError(
            f"{source}: splits: go by machine, and the recipe has one machine; add [machines], or leave [splits] out"
        )
    for name, split in splits.items():
        enough = enough_machines(splits, recipe.seed, name)
        if enough is None or enough > machines:
            runs = enough and enough * recipe.machines.runs_per_machine
            more = f"at least {enough} machines, {runs} runs, or " if enough else ""
            raise UserError(
                f"{source}: splits.{name}: none of the {machines} machines falls into it; take {more}a larger share"
            )
        if isinstance(split, SplitTable):
            _check_columns(recipe, split, f"{source}: splits.{name}")


def _check_columns(recipe: Recipe, split: SplitTable, source: str) -> None:
    if split.surroundings and not recipe.surroundings:
        raise UserError(
            f"{source}.surroundings: the recipe has no [surroundings], and all splits have the same columns; add the "
            "table, with levels of 0 where nothing disturbs"
        )
    if split.sensors:
        own = recipe.parts[source.rpartition(".")[2]].sensing.set
        if _columns(own) != _columns(recipe.sensing.set):
            raise UserError(
                f"{source}.sensors = {split.sensors!r}: other sensors than sensors.set = {recipe.sensors.set!r}, and "
                "all splits have the same columns; give the same names, kinds and places in the same order, with "
                "another chain"
            )


def _columns(sensors: SensorSet) -> list[object]:
    """Return what decides the columns of a sensor set: names, kinds and places of its sensors."""
    places = [tap.name for tap in sensors.taps]
    return [
        *((sensor.name, type(sensor).__name__, str(getattr(sensor, "unit", ""))) for sensor in sensors.sensors),
        places,
    ]


def machine_extremes(recipe: Recipe) -> Iterator[Scenario]:
    """Yield a scenario at each end of each range of `[machines.vary]`, for warnings.

    All other keys of `[machines.vary]` are those of the machine's file. Ends without a feasible machine are left out.
    """
    for _, part in recipe.named_parts():
        for entry, distribution in part.machines.distributions() if part.machines else ():
            for value in distribution.extremes():
                for base in part.bases:
                    try:
                        machine = with_values(base.machine, {entry.key: value})
                        scenario = next(part.corners_of(base, machine))
                        check_feasible(scenario)
                    except UserError:
                        continue
                    yield scenario
