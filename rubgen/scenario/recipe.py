"""A recipe: the TOML file that defines a whole data set, run by run."""

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import cached_property
from itertools import chain
from pathlib import Path
from pkgutil import resolve_name
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, TypeAdapter, ValidationError, model_validator

from rubgen.brief import counted
from rubgen.errors import UserError, warn
from rubgen.machine import Machine, load_machine
from rubgen.machine.load import FOR_COMPARISON, file_named, machine_id
from rubgen.machine.problems import first_problem, validated
from rubgen.machine.quantities import (
    MOST_RUNS,
    RunCount,
    Seed,
    about,
)
from rubgen.machine.sentences import FILE_NAME
from rubgen.machine.toml_file import check_kind, read_toml, toml_path
from rubgen.scenario.contact_laws.contact_law import ContactLaw
from rubgen.scenario.distributions import Choice, Constant, Distribution
from rubgen.scenario.faults import FaultTable, kinds_of, with_faults
from rubgen.scenario.faults import extremes as fault_extremes
from rubgen.scenario.feasible import check_feasible
from rubgen.scenario.machines.check import check_machines, check_splits, machine_extremes
from rubgen.scenario.machines.draw import Population
from rubgen.scenario.machines.keys import MachineKey, own_keys
from rubgen.scenario.plausible import warn_of
from rubgen.scenario.profiles import check_used
from rubgen.scenario.scenario import Labelling, Operation, Reduction, Scenario, Sensing
from rubgen.scenario.surroundings import SurroundingsTable, drawn, extremes
from rubgen.scenario.tables.machines import MachineTable, replaced_runs, with_runs
from rubgen.scenario.tables.run import Output, Profile, Sensors, Simulation
from rubgen.scenario.tables.splits import ONE_SPLIT, Splits, SplitTable, changes_of, split_of_machine
from rubgen.scenario.tables.vary import Vary
from rubgen.scenario.vary import (
    DEFAULT_SPEED_RPM,
    DRAWN,
    FREE_PENETRATION,
    TWO_CLEARANCES,
    Parameter,
    sobol_point,
    vary,
)
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.sensor_set import SensorSet

DEFAULT_RECIPE = Path(__file__).parent / "zeng2019-mini.toml"
NOT_FOR_DATA = (
    'for comparison with the paper, never for data: it belongs to [contact] surface = "chords", '
    'where every node of the mesh hits the tips; name "zeng2019" instead'
)
CANDIDATE_CHECK = "rubgen.solver.candidate:candidate_problem"
"""The check of a virtual machine. It needs the solver, above this room, so it is named here and imported when used."""
_STRICT = ConfigDict(extra="forbid", frozen=True)


def _runs_or_count(schema: dict[str, Any]) -> None:
    """Require `runs`, or `machines`, whose `count` stands in its place."""
    schema["required"].remove("runs")
    schema["anyOf"] = [{"required": ["runs"]}, {"required": ["machines"]}]


MachineFile = Annotated[str, Field(min_length=1)]


class Recipe(BaseModel):
    """The definition of a data set: a machine, what varies, the length of each run, the files."""

    model_config = ConfigDict(**_STRICT, json_schema_extra=_runs_or_count)
    name: Annotated[str, Field(pattern=FILE_NAME), about("Name of the data set, in its files and its card.")]
    seed: Annotated[
        Seed,
        about(
            "Seed of all random numbers. The same recipe and seed make the same bytes; another seed makes other runs."
        ),
    ] = 0
    runs: Annotated[RunCount, about("Number of runs. Each takes from seconds to minutes; `rubgen plan` estimates it.")]
    machine: Annotated[
        MachineFile | Annotated[tuple[MachineFile, ...], Field(min_length=1)],
        about(
            "A preset of rubgen by its name, or the path of a machine in TOML; or a list of such, which "
            "`[machines]` takes in turn."
        ),
    ]
    license: Annotated[str, Field(min_length=1), about("License of the data, as an SPDX name.")] = "CC-BY-4.0"
    machines: Annotated[
        MachineTable | None,
        about("Virtual machines, each with its own values. Without it all runs have the machine of the file."),
    ] = None
    splits: Annotated[
        Splits | None,
        about(
            "Splits by their names: a share of the machines, or a table with the share and ranges of its own. Without "
            "it all runs are in `train`."
        ),
    ] = None
    vary: Annotated[Vary, about("What differs between the runs. A number fixes a value, a table draws it.")] = Vary()
    surroundings: Annotated[
        SurroundingsTable | None,
        about(
            "What sensors feel besides the machine's motion: background, blade passing, runout, "
            "tones. Without it they feel the motion alone."
        ),
    ] = None
    faults: Annotated[
        tuple[FaultTable, ...] | None,
        about(
            "Faults that runs may have besides the rub, each drawn on its own. Without it only the "
            "machine's own faults are there."
        ),
    ] = None
    operation: Annotated[Profile, about("How the speed changes within a run.")] = Profile()
    simulation: Annotated[Simulation, about("Turns and integration steps of every run.")] = Simulation()
    sensors: Annotated[Sensors, about("The sensors and how their signals are recorded.")] = Sensors()
    labels: Annotated[Labelling, about("What is computed only for the labels.")] = Labelling()
    output: Annotated[Output, about("Which files are written, and how much of each run they hold.")] = Output()
    reduction: Annotated[Reduction, about("How many modes stand for the parts of the machine.")] = Reduction()
    contact: Annotated[ContactLaw, about("What happens where a blade touches the casing.")] = ContactLaw()
    _folder: Path = PrivateAttr(default_factory=Path)
    _checked: bool = PrivateAttr(default=False)
    _machines: tuple[Machine, ...] = PrivateAttr(default=())
    _sensor_sets: dict[str, SensorSet] = PrivateAttr(default_factory=dict)
    _whole: "Recipe | None" = PrivateAttr(default=None)

    @model_validator(mode="before")
    @classmethod
    def _with_runs(cls, data: Any) -> Any:
        return with_runs(data)

    def __repr__(self) -> str:
        varied = ", ".join(entry.key for entry, _ in self.distributions()) or "nothing"
        runs = counted(self.runs, "run")
        return f"Recipe({self.name!r}: {runs} of {self.machine}, seed {self.seed}; [vary] has {varied})"

    __str__ = __repr__

    @property
    def files(self) -> tuple[str, ...]:
        """The presets or files of its machines."""
        return (self.machine,) if isinstance(self.machine, str) else self.machine

    @property
    def base(self) -> Scenario:
        """The scenario before `[vary]`: the machine of the first file, at the default speed."""
        return self.bases[0]

    @cached_property
    def bases(self) -> tuple[Scenario, ...]:
        """The scenario before `[vary]` of each machine file, at the default speed.

        A frame is left out where no sensor feels it: the machine has the same digits and JSON as one without.
        """
        machines = self._machines or tuple(load_machine(name, self._folder) for name in self.files)
        if not self.feels_frame:
            machines = tuple(replace(machine, frame=None) for machine in machines)
        operation = {**self.simulation.model_dump(), **self.operation.model_dump()}
        return tuple(
            Scenario(
                machine=machine,
                operation=Operation(speed_rpm=DEFAULT_SPEED_RPM, **operation),
                contact=self.contact,
                reduction=self.reduction,
                sensing=self.sensing,
                labelling=self.labels,
                signal_seconds=self.output.signal_seconds,
                seed=self.seed,
                machine_id=machine_id(machine),
            )
            for machine in machines
        )

    @property
    def feels_frame(self) -> bool:
        """Whether some run's sensors may feel a machine's frame."""
        return any(
            part.sensing.set.on_housing or getattr(part.surroundings, "path_gain", None) is not None
            for part in (self._whole or self).parts.values()
        )

    @cached_property
    def sensing(self) -> Sensing:
        """`[sensors]` with the set that it names."""
        rest, name = self.sensors.model_dump(exclude={"set"}), self.sensors.set
        return Sensing(set=self._sensor_sets.get(name) or load_sensor_set(name, self._folder), **rest)

    @cached_property
    def parts(self) -> "dict[str, Recipe]":
        """The recipe of each split by its name: this one without splits, with what the split changes."""
        if not self.splits:
            return dict.fromkeys(ONE_SPLIT, self)
        plain = self._part({})
        changed = {
            name: self._part(changes_of(self, split))
            for name, split in self.splits.items()
            if isinstance(split, SplitTable) and split.changes
        }
        return {name: changed.get(name, plain) for name in self.splits}

    def _part(self, changes: dict[str, Any]) -> "Recipe":
        part = Recipe(**{key: getattr(self, key) for key in self.model_fields_set - {"splits"}} | changes)
        part._folder, part._machines, part._sensor_sets = self._folder, self._machines, self._sensor_sets
        part._checked, part._whole = self._checked, self
        return part

    @cached_property
    def population(self) -> Population:
        """The virtual machines of its runs."""
        files = tuple(base.machine for base in self.bases)
        return Population(self.machines or MachineTable(), files, self.seed, self._candidate_problem)

    def machine_named(self) -> AbstractContextManager[None]:
        """Name the machine's file in errors that the block raises about the machine; of several files none."""
        return file_named(self.machine, self._folder) if isinstance(self.machine, str) else nullcontext()

    def distributions(self) -> Iterator[tuple[Parameter, Distribution]]:
        """Yield the keys of the recipe with their distributions, in the order of PARAMETERS."""
        for entry in DRAWN:
            distribution = getattr(self.vary, entry.key)
            if distribution is not None:
                yield entry, distribution

    def scenario(self, index: int) -> Scenario:
        """Draw run number `index` from 0, complete. It depends on no other run and not on the number of runs."""
        if isinstance(index, bool) or not isinstance(index, int | np.integer) or not 0 <= index < MOST_RUNS:
            raise UserError(f"index = {index!r:.100}: give the number of a run, from 0 to below {MOST_RUNS:,}")
        part = self.parts[self.split_of(index)]
        if part is not self:
            return part.scenario(index)
        point = sobol_point(self.seed, index)
        values = {entry.key: distribution.quantile(point[entry.key]) for entry, distribution in self.distributions()}
        around = drawn(self.surroundings, self.seed, index) if self.surroundings else None
        scenario = vary(replace(self._base_of(index), index=index, surroundings=around), values)
        return with_faults(scenario, self.faults or ()) if self.fault_kinds else scenario

    def _base_of(self, index: int) -> Scenario:
        """Return the scenario before `[vary]` of a run, with its machine."""
        if self.machines is None:
            return self.base
        machine, virtual = self.population.machine(self.machine_number(index))
        base = self.bases[virtual.number % len(self.bases)]
        digits = "" if virtual.problem else machine_id(machine)
        return replace(base, machine=machine, machine_id=digits, virtual=virtual)

    def _candidate_problem(self, number: int, machine: Machine) -> str | None:
        """Return why that candidate of machine `number` is not used; None where it is sane."""
        corners = list(self.corners_of(self.bases[number % len(self.bases)], machine))
        for corner in corners:
            check_feasible(corner)
        rotations = [corner.operation.rotation for corner in corners]
        slowest, fastest = min(each.slowest for each in rotations), max(each.fastest for each in rotations)
        problem: str | None = resolve_name(CANDIDATE_CHECK)(corners[0], self.machines, slowest, fastest)
        return problem

    @property
    def fault_kinds(self) -> tuple[str, ...]:
        """The kinds of fault that its runs may have, of the recipe or of its machines."""
        own = [fault for base in self.bases for fault in base.machine.faults]
        return kinds_of((*own, *(self.faults or ())))

    @property
    def machine_keys(self) -> tuple[MachineKey, ...]:
        """The keys of virtual machines that have columns of their own; none without `[machines]`."""
        return own_keys(frame=self.base.machine.frame is not None) if self.machines else ()

    @property
    def split_names(self) -> tuple[str, ...]:
        """The splits of its runs, in the order of the recipe."""
        return tuple(self.splits or ONE_SPLIT)

    def split_of(self, index: int) -> str:
        """Return the split of run number `index`: that of its machine, whatever the number of runs."""
        return split_of_machine(self.splits, self.seed, self.machine_number(index)) if self.splits else ONE_SPLIT[0]

    def machine_number(self, index: int) -> int:
        """Return the number of the machine of run number `index`; the runs of a machine follow each other."""
        return index // self.machines.runs_per_machine if self.machines else 0

    @property
    def machine_count(self) -> int:
        """The number of machines that its runs have."""
        return self.machine_number(self.runs - 1) + 1

    def named_parts(self, source: str = "") -> "Iterator[tuple[str, Recipe]]":
        """Yield each different recipe of its splits, after the name of it in messages, which begins with `source`."""
        seen: list[Recipe] = []
        for name, part in self.parts.items():
            if all(part is not each for each in seen):
                seen.append(part)
                split = (self.splits or {}).get(name)
                own = isinstance(split, SplitTable) and split.changes
                yield f"{source}: splits.{name}".removeprefix(": ") if own else source, part

    def corners(self, source: str = "") -> Iterator[Scenario]:
        """Yield scenarios at the extreme values of each key, the other keys at their first value. Checks use them.

        Virtual machines are those of the files with the largest number of blades. Raises UserError, beginning with
        `source`, where an extreme value is not allowed.
        """
        for where, part in self.named_parts(source):
            yield from part.own_corners(where)

    def own_corners(self, source: str = "") -> Iterator[Scenario]:
        """Yield the `corners` of a recipe without its splits."""
        for base in self.bases:
            machine = self.machines.largest(base.machine) if self.machines else base.machine
            yield from self.corners_of(base, machine, source)

    def corners_of(self, base: Scenario, machine: Machine, source: str = "") -> Iterator[Scenario]:
        """Yield the `corners` with that machine in place of the one of `base`."""
        base = replace(base, machine=machine)
        ends = {entry.key: distribution.extremes() for entry, distribution in self.distributions()}
        first = vary(base, {key: values[0] for key, values in ends.items()}, source, ("vary",))
        yield first
        for around in extremes(self.surroundings, source) if self.surroundings else ():
            yield replace(first, surroundings=around)
        if self.faults:
            yield from fault_extremes(first, self.faults, source)
        for key, values in ends.items():
            for value in values[1:]:
                yield vary(first, {key: value}, source, ("vary",))


def load_recipe(path: Path | str | None = None, *, runs: int | None = None) -> Recipe:
    """Load the recipe in that TOML file, or the default recipe of rubgen; `runs` overrides its number of runs.

    Raises UserError with file, key, value, what is allowed and the remedy, before anything is computed.
    """
    file = DEFAULT_RECIPE if path is None else toml_path(path)
    data = read_toml(file)
    check_kind(file, data, "recipe")
    return parse_recipe(data, source=str(file), folder=file.parent, runs=runs)


def parse_recipe(
    data: dict[str, Any], *, source: str = "recipe", folder: Path | None = None, runs: int | None = None
) -> Recipe:
    """Make the recipe of TOML values and check it.

    - data: the TOML values.
    - source: beginning of messages.
    - folder: start of relative paths.
    - runs: overrides the number of runs.

    Raises UserError for anything that is not allowed.
    """
    if runs is not None:
        data = replaced_runs(data, checked_runs(runs))
    recipe = validated(source, data, TypeAdapter(Recipe))
    recipe._folder = folder or Path()
    check_recipe(recipe, source, data)
    return recipe


def checked_runs(runs: int) -> int:
    """Return a number of runs that replaces the recipe's. Raises UserError where a recipe would not allow it."""
    if isinstance(runs, bool) or not isinstance(runs, int) or not 1 <= runs <= MOST_RUNS:
        raise UserError(f"--runs {runs}: must be at least 1 and at most {MOST_RUNS:,}; give a whole number of runs")
    return runs


def recorded_recipe(
    data: object,
    machine: object,
    sensors: object,
    source: str = "manifest",
    split_sensors: Mapping[str, object] = MappingProxyType({}),
) -> Recipe:
    """Make the recipe of a data set from its manifest, with the recorded machines and sensors.

    Changes of the machines' or sensors' files since then have no effect.

    - data, machine, sensors: the three documents of the manifest. Several machines stand in a list.
    - source: beginning of messages.
    - split_sensors: the sensor sets of splits that have their own, by the name in the recipe.

    Raises UserError where this version of rubgen cannot read them.
    """
    recipe: Recipe = _recorded(Recipe, data, f"{source}: recipe")
    recipe._checked = True
    machines = machine if isinstance(machine, list | tuple) else [machine]
    recipe._machines = tuple(_recorded(Machine, each, f"{source}: machine") for each in machines)
    sets = {recipe.sensors.set: sensors, **split_sensors}
    recipe._sensor_sets = {name: _recorded(SensorSet, each, f"{source}: sensors") for name, each in sets.items()}
    return recipe


def _recorded(kind: Any, data: object, source: str) -> Any:
    adapter: TypeAdapter[Any] = TypeAdapter(kind)
    try:
        return adapter.validate_python(data)
    except ValidationError as error:
        raise first_problem(source, error, data, adapter) from None


def check_recipe(recipe: Recipe, source: str = "recipe", data: dict[str, Any] | None = None) -> None:
    """Check that every run of the recipe is possible, at single values and at the extremes of `[vary]`.

    Warns once of each value that is hardly intended.

    - source: beginning of messages.
    - data: the TOML values of the recipe; without them, fields that are set count as given.

    Raises UserError where some run is not possible.
    """
    validated(
        source, recipe.model_dump(mode="json", warnings=False), TypeAdapter(Recipe)
    )  # it may be a copy with other values
    if not recipe._checked:
        _check_used(recipe, source, data)
    if len(set(recipe.output.formats)) != len(recipe.output.formats):
        raise UserError(f"{source}: output.formats = {list(recipe.output.formats)}: name each format once")
    for where, part in recipe.named_parts(source):
        _check_drawn(part, where)
    try:
        recipe.base  # noqa: B018  (reads the machine files)
    except UserError as error:
        text = str(error)
        raise UserError(f"{source}: {text}" if text.startswith(("machine = ", "sensors.set = ")) else text) from None
    check_machines(recipe, source)
    check_splits(recipe, source)
    with recipe.machine_named():
        for where, part in recipe.named_parts(source):
            for scenario in part.own_corners(where):
                check_feasible(scenario, f"{where}: ")
    if not recipe._checked:
        warn_of(chain(recipe.corners(), machine_extremes(recipe)), f"{source}: ")
        if FOR_COMPARISON in (base.machine.name for base in recipe.bases):
            warn(f"{source}: machine = {recipe.machine!r}: {NOT_FOR_DATA}")
    recipe._checked = True


def _check_used(recipe: Recipe, source: str, data: dict[str, Any] | None) -> None:
    """Raise UserError for a key that the profile would ignore. A manifest's recipe has every key of every profile."""
    left_out = {"labels"} if data is None else set()  # a dataclass does not tell what was set in it
    given = data or recipe.model_dump(mode="json", exclude_unset=True, exclude=left_out)
    if all(given != recipe.model_dump(mode="json", exclude=left_out, exclude_none=short) for short in (True, False)):
        check_used(f"{source}: ", given)


def _check_drawn(recipe: Recipe, source: str) -> None:
    for entry, distribution in recipe.distributions():
        if entry.whole and not isinstance(distribution, Constant | Choice):
            raise UserError(f"{source}: vary.{entry.key}: takes whole numbers only; give a number or a choice")
    if {"clearance_m", FREE_PENETRATION.key} <= {entry.key for entry, _ in recipe.distributions()}:
        raise UserError(f"{source}: vary.{TWO_CLEARANCES}")
