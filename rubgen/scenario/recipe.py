"""A recipe: the TOML file that defines a whole data set, run by run."""

from collections.abc import Iterator
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, TypeAdapter, ValidationError, create_model

from rubgen.brief import counted
from rubgen.errors import UserError, warn
from rubgen.machine import Machine, load_machine
from rubgen.machine.descriptions import draws
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
from rubgen.scenario.plausible import warn_of
from rubgen.scenario.profiles import check_used
from rubgen.scenario.scenario import Labelling, Operation, Reduction, Scenario, Sensing
from rubgen.scenario.surroundings import SurroundingsTable, drawn, extremes
from rubgen.scenario.tables.run import Output, Profile, Sensors, Simulation
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
_STRICT = ConfigDict(extra="forbid", frozen=True)


def _vary_fields() -> dict[str, Any]:
    return {
        entry.key: (
            Annotated[Distribution | None, Field(description=entry.about, json_schema_extra=draws(entry.quantity))],
            None,
        )
        for entry in DRAWN
    }


Vary = create_model(
    "Vary", __config__=_STRICT, __doc__="`[vary]`: a number fixes a value, a table draws it.", **_vary_fields()
)


class Recipe(BaseModel):
    """The definition of a data set: a machine, what varies, the length of each run, the files."""

    model_config = _STRICT
    name: Annotated[str, Field(pattern=FILE_NAME), about("Name of the data set, in its files and its card.")]
    seed: Annotated[
        Seed,
        about(
            "Seed of all random numbers. The same recipe and seed make the same bytes; another seed makes other runs."
        ),
    ] = 0
    runs: Annotated[RunCount, about("Number of runs. Each takes from seconds to minutes; `rubgen plan` estimates it.")]
    machine: Annotated[
        str, Field(min_length=1), about("A preset of rubgen by its name, or the path of a machine in TOML.")
    ]
    license: Annotated[str, Field(min_length=1), about("License of the data, as an SPDX name.")] = "CC-BY-4.0"
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
    _machine: Machine | None = PrivateAttr(default=None)
    _sensor_set: SensorSet | None = PrivateAttr(default=None)

    def __repr__(self) -> str:
        varied = ", ".join(entry.key for entry, _ in self.distributions()) or "nothing"
        runs = counted(self.runs, "run")
        return f"Recipe({self.name!r}: {runs} of {self.machine}, seed {self.seed}; [vary] has {varied})"

    __str__ = __repr__

    @cached_property
    def base(self) -> Scenario:
        """The scenario before `[vary]`: the machine of the file, at the default speed.

        Its frame is left out where no sensor feels it: the machine has the same digits and JSON as one without.
        """
        machine = self._machine or load_machine(self.machine, self._folder)
        if not self.feels_frame:
            machine = replace(machine, frame=None)
        return Scenario(
            machine=machine,
            operation=Operation(
                speed_rpm=DEFAULT_SPEED_RPM, **self.simulation.model_dump(), **self.operation.model_dump()
            ),
            contact=self.contact,
            reduction=self.reduction,
            sensing=self.sensing,
            labelling=self.labels,
            signal_seconds=self.output.signal_seconds,
            seed=self.seed,
            machine_id=machine_id(machine),
        )

    @property
    def feels_frame(self) -> bool:
        """Whether some run's sensors may feel the machine's frame."""
        path = self.surroundings and self.surroundings.path_gain  # type: ignore[attr-defined]
        return bool(self.sensing.set.on_housing or path is not None)

    @cached_property
    def sensing(self) -> Sensing:
        """`[sensors]` with the set that it names."""
        rest = self.sensors.model_dump(exclude={"set"})
        return Sensing(set=self._sensor_set or load_sensor_set(self.sensors.set, self._folder), **rest)

    def machine_named(self) -> AbstractContextManager[None]:
        """Name the machine's file in errors that the block raises about the machine."""
        return file_named(self.machine, self._folder)

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
        point = sobol_point(self.seed, index)
        values = {entry.key: distribution.quantile(point[entry.key]) for entry, distribution in self.distributions()}
        around = drawn(self.surroundings, self.seed, index) if self.surroundings else None
        scenario = vary(replace(self.base, index=index, surroundings=around), values)
        return with_faults(scenario, self.faults or ()) if self.fault_kinds else scenario

    @property
    def fault_kinds(self) -> tuple[str, ...]:
        """The kinds of fault that its runs may have, of the recipe or of its machine."""
        return kinds_of((*self.base.machine.faults, *(self.faults or ())))

    @property
    def split_names(self) -> tuple[str, ...]:
        """The splits of its runs, in the order of the recipe."""
        return ("train",)

    def split_of(self, index: int) -> str:
        """Return the split of run number `index`: that of its machine, whatever the number of runs."""
        return self.split_names[self.machine_number(index) % len(self.split_names)]

    def machine_number(self, index: int) -> int:
        """Return the number of the machine of run number `index`; the runs of a machine follow each other."""
        return index // MOST_RUNS

    def corners(self, source: str = "") -> Iterator[Scenario]:
        """Yield scenarios at the extreme values of each key, the other keys at their first value. Checks use them.

        Raises UserError, beginning with `source`, where an extreme value is not allowed.
        """
        ends = {entry.key: distribution.extremes() for entry, distribution in self.distributions()}
        first = vary(self.base, {key: values[0] for key, values in ends.items()}, source, ("vary",))
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
        data = {**data, "runs": checked_runs(runs)}
    recipe = validated(source, data, TypeAdapter(Recipe))
    recipe._folder = folder or Path()
    check_recipe(recipe, source, data)
    return recipe


def checked_runs(runs: int) -> int:
    """Return a number of runs that replaces the recipe's. Raises UserError where a recipe would not allow it."""
    if isinstance(runs, bool) or not isinstance(runs, int) or not 1 <= runs <= MOST_RUNS:
        raise UserError(f"--runs {runs}: must be at least 1 and at most {MOST_RUNS:,}; give a whole number of runs")
    return runs


def recorded_recipe(data: object, machine: object, sensors: object, source: str = "manifest") -> Recipe:
    """Make the recipe of a data set from its manifest, with the recorded machine and sensors.

    Changes of the machine's or sensors' files since then have no effect.

    - data, machine, sensors: the three documents of the manifest.
    - source: beginning of messages.

    Raises UserError where this version of rubgen cannot read them.
    """
    recipe: Recipe = _recorded(Recipe, data, f"{source}: recipe")
    recipe._checked = True
    recipe._machine = _recorded(Machine, machine, f"{source}: machine")
    recipe._sensor_set = _recorded(SensorSet, sensors, f"{source}: sensors")
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
    _check_whole(recipe, source)
    if {"clearance_m", FREE_PENETRATION.key} <= {entry.key for entry, _ in recipe.distributions()}:
        raise UserError(f"{source}: vary.{TWO_CLEARANCES}")
    try:
        recipe.base  # noqa: B018  (reads the machine file)
    except UserError as error:
        text = str(error)
        raise UserError(f"{source}: {text}" if text.startswith(("machine = ", "sensors.set = ")) else text) from None
    with recipe.machine_named():
        for scenario in recipe.corners(source):
            check_feasible(scenario, f"{source}: ")
    if not recipe._checked:
        warn_of(recipe.corners(), f"{source}: ")
        if recipe.base.machine.name == FOR_COMPARISON:
            warn(f"{source}: machine = {recipe.machine!r}: {NOT_FOR_DATA}")
    recipe._checked = True


def _check_used(recipe: Recipe, source: str, data: dict[str, Any] | None) -> None:
    """Raise UserError for a key that the profile would ignore. A manifest's recipe has every key of every profile."""
    left_out = {"labels"} if data is None else set()  # a dataclass does not tell what was set in it
    given = data or recipe.model_dump(mode="json", exclude_unset=True, exclude=left_out)
    if all(given != recipe.model_dump(mode="json", exclude=left_out, exclude_none=short) for short in (True, False)):
        check_used(f"{source}: ", given)


def _check_whole(recipe: Recipe, source: str) -> None:
    for entry, distribution in recipe.distributions():
        if entry.whole and not isinstance(distribution, Constant | Choice):
            raise UserError(f"{source}: vary.{entry.key}: takes whole numbers only; give a number or a choice")
