"""A recipe: the TOML file that defines a whole data set, run by run."""

from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from pkgutil import resolve_name
from typing import Annotated, Any

import numpy as np
from pydantic import ConfigDict, Field, PrivateAttr, model_validator

from rubgen.brief import counted
from rubgen.errors import UserError
from rubgen.machine import Machine, load_machine
from rubgen.machine.load import file_named, machine_id
from rubgen.machine.quantities import MOST_RUNS, RunCount, Seed, StrictModel, about
from rubgen.machine.sentences import FILE_NAME
from rubgen.scenario.checks.feasible import check_feasible
from rubgen.scenario.contact_laws.contact_law import ContactLaw
from rubgen.scenario.distributions import Distribution
from rubgen.scenario.faults import FaultTable, kinds_of, with_faults
from rubgen.scenario.faults import extremes as fault_extremes
from rubgen.scenario.machines.draw import Population
from rubgen.scenario.machines.keys import MachineKey, own_keys
from rubgen.scenario.scenario import Chosen, Labelling, Operation, Reduction, Scenario, Sensing
from rubgen.scenario.surroundings import SurroundingsTable, drawn, extremes
from rubgen.scenario.tables.balance import Balance, band_name
from rubgen.scenario.tables.machines import MachineTable, with_runs
from rubgen.scenario.tables.run import Output, Profile, Sensors, Simulation
from rubgen.scenario.tables.splits import ONE_SPLIT, Splits, SplitTable, changes_of, split_of_machine
from rubgen.scenario.tables.twins import Twins, fault_of, paired, partner_of, with_twin
from rubgen.scenario.tables.vary import Vary
from rubgen.scenario.vary import DEFAULT_SPEED_RPM, DRAWN, Parameter, candidate_point, vary
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.sensor_set import SensorSet

CHOICE = "rubgen.balancing.choose:choose"
"""The choice of a candidate of a balance. It needs solver and labels, above this room."""
CANDIDATE_CHECK = "rubgen.solver.candidate:candidate_problem"
"""The check of a virtual machine. It needs the solver, above this room, so it is named here and imported when used."""


def _runs_or_count(schema: dict[str, Any]) -> None:
    """Require `runs`, or `machines`, whose `count` stands in its place."""
    schema["required"].remove("runs")
    schema["anyOf"] = [{"required": ["runs"]}, {"required": ["machines"]}]


MachineFile = Annotated[str, Field(min_length=1)]


class Recipe(StrictModel):
    """The definition of a data set: a machine, what varies, the length of each run, the files."""

    model_config = ConfigDict(json_schema_extra=_runs_or_count)
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
            "A preset of rubgen by its name, or the path of a machine in TOML. `[machines]` takes several in a "
            "list in turn."
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
    balance: Annotated[
        Balance | None,
        about(
            "Shares of classes of runs. Each run is drawn until it is in its class, by short runs. Without it classes "
            "come as they are drawn."
        ),
    ] = None
    twins: Annotated[
        Twins | None,
        about("The one key in which a twin differs from its run. Without it no run has a twin."),
    ] = None
    _folder: Path = PrivateAttr(default_factory=Path)
    _checked: bool = PrivateAttr(default=False)
    _machines: tuple[Machine, ...] = PrivateAttr(default=())
    _sensor_sets: dict[str, SensorSet] = PrivateAttr(default_factory=dict)
    _known: dict[int, int] = PrivateAttr(default_factory=dict)
    _candidates: dict[int, Chosen] = PrivateAttr(default_factory=dict)
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
        """The presets or machine files that the recipe names."""
        return (self.machine,) if isinstance(self.machine, str) else self.machine

    @property
    def base(self) -> Scenario:
        """The scenario of the first machine file without the draws of `[vary]`, at 10,000 rev/min."""
        return self.bases[0]

    @cached_property
    def bases(self) -> tuple[Scenario, ...]:
        """One scenario for each machine file, without anything that the recipe draws, at 10,000 rev/min.

        The machine's frame is removed if no sensor feels the frame: `machine_id` and JSON are then those of the machine
        without a frame. Reading a file may raise UserError.
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
        """Whether the sensors of any run may feel the machine's frame."""
        return any(
            part.sensing.set.on_housing or getattr(table, "path_gain", None) is not None
            for part in (self._whole or self).parts.values()
            for table in (part.surroundings, part.twins)
        )

    @cached_property
    def sensing(self) -> Sensing:
        """The keys of `[sensors]`, with the loaded sensor set in place of its name."""
        rest, name = self.sensors.model_dump(exclude={"set"}), self.sensors.set
        return Sensing(set=self._sensor_sets.get(name) or load_sensor_set(name, self._folder), **rest)

    @cached_property
    def parts(self) -> "dict[str, Recipe]":
        """The recipe of each split, by the split's name: this recipe with the keys that the split changes.

        Splits without changes share one recipe. Without `[splits]` there is one split, "train", with this recipe.
        """
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
        part._checked, part._known, part._whole = self._checked, self._known, self
        part._candidates = self._candidates
        return part

    @cached_property
    def population(self) -> Population:
        """The virtual machines of the recipe's runs."""
        files = tuple(base.machine for base in self.bases)
        return Population(self.machines or MachineTable(), files, self.seed, self._candidate_problem, self._known)

    def remember(self, number: int, candidate: int) -> None:
        """Use the recorded candidate number `candidate` for virtual machine `number`, without checking it again."""
        self._known[number] = candidate

    def remember_choice(self, index: int, chosen: Chosen) -> None:
        """Use the recorded candidate `chosen` of a balance for run number `index`, without simulating it again."""
        self._candidates[index] = chosen

    def machine_named(self) -> AbstractContextManager[None]:
        """Name the machine's file, if there is only one, in errors about the machine that the block raises."""
        return file_named(self.machine, self._folder) if isinstance(self.machine, str) else nullcontext()

    def distributions(self) -> Iterator[tuple[Parameter, Distribution]]:
        """Yield the keys of `[vary]` that the recipe has, with their distributions, in the order of PARAMETERS."""
        for entry in DRAWN:
            distribution = getattr(self.vary, entry.key)
            if distribution is not None:
                yield entry, distribution

    @property
    def sources(self) -> "tuple[tuple[int, Recipe], ...]":
        """The recipes of a merged set, each after the number of its first run.

        Any other recipe is its own only source.
        """
        return ((0, self),)

    def scenario(self, index: int, *, screened: bool = True) -> Scenario:
        """Draw run number `index`, from 0, as a complete scenario.

        It depends on no other run and not on the number of runs. With `[balance]` its candidates are simulated briefly
        until one has the wanted class, which takes seconds (`rubgen.balancing`). With `screened` False nothing is
        simulated: the first candidate is returned, for checks. Numbers from `runs` on are drawn too. Raises UserError
        for anything but a whole number from 0 to below MOST_RUNS, and for drawn values that make no machine.
        """
        if isinstance(index, bool) or not isinstance(index, int | np.integer) or not 0 <= index < MOST_RUNS:
            raise UserError(f"index = {index!r:.100}: give the number of a run, from 0 to below {MOST_RUNS:,}")
        part = self.parts[self.split_of(index)]
        if part is not self:
            return part.scenario(index, screened=screened)
        draw = self._chosen if self.balance and screened else self.candidate
        return paired(self.twins, self.twin_of(index), index, draw) if self.twins else draw(index)

    def candidate(self, index: int, attempt: int = 0) -> Scenario:
        """Draw candidate number `attempt` of run number `index`, both from 0. Nothing is simulated.

        Without `[balance]` candidate 0 is the run itself, unless the run is a twin.
        """
        part = self.parts[self.split_of(index)]
        if part is not self:
            return part.candidate(index, attempt)
        point = candidate_point(self.seed, index, attempt)
        chosen = None
        if self.balance:
            cell, band = self.balance.place(self.seed, index)
            point["speed_rpm"] = (band + point["speed_rpm"]) / self.balance.speed_bands
            chosen = Chosen(cell=cell.name + band_name(band, self.balance.speed_bands), tries=attempt + 1)
        return replace(self._drawn(index, point, index + attempt * MOST_RUNS), balance=chosen)

    def _chosen(self, index: int) -> Scenario:
        """Return the candidate in the cell of the run: the recorded one, or the first that screening finds."""
        known = self._candidates.get(index)
        if known:
            return replace(self.candidate(index, known.tries - 1), balance=known)
        chosen: Scenario = resolve_name(CHOICE)(self, self.balance, index)
        if self.twins and chosen.balance:  # for the twin, which comes next
            self._candidates.clear()
            self._candidates[index] = chosen.balance
        return chosen

    def twin_of(self, index: int) -> int | None:
        """Return the number of the partner of run number `index` if the run is a twin; None for any other run."""
        count = self.machines.runs_per_machine if self.machines else MOST_RUNS
        if not self.twins:
            return None
        return partner_of(index, self.twins.share, self.seed, index // count * count, count)  # type: ignore[attr-defined]

    def _drawn(self, index: int, point: Mapping[str, float], number: int) -> Scenario:
        """Draw run number `index` at that point of `[vary]`; its faults have the random numbers of `number`."""
        values = {entry.key: distribution.quantile(point[entry.key]) for entry, distribution in self.distributions()}
        around = drawn(self.surroundings, self.seed, index) if self.surroundings else None
        scenario = vary(replace(self._base_of(index), index=index, surroundings=around), values)
        if not self.fault_kinds:
            return scenario
        scenario = with_faults(replace(scenario, index=number), self.faults or ())
        return replace(scenario, index=index, fault_kinds=self.fault_kinds)

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
        """The kinds of fault that the runs may have, from the recipe, its machines and its twins."""
        own = [fault for base in self.bases for fault in base.machine.faults]
        return kinds_of((*own, *(self.faults or ()), *fault_of(self.twins)))

    @property
    def machine_keys(self) -> tuple[MachineKey, ...]:
        """The keys of `[machines.vary]` that have columns of their own; none without `[machines]`."""
        return own_keys(frame=self.base.machine.frame is not None) if self.machines else ()

    @property
    def split_names(self) -> tuple[str, ...]:
        """The names of the splits, in the order of the recipe; "train" alone without `[splits]`."""
        return tuple(self.splits or ONE_SPLIT)

    def split_of(self, index: int) -> str:
        """Return the name of the split of run number `index`.

        It follows from the run's machine, not from the number of runs.
        """
        return split_of_machine(self.splits, self.seed, self.machine_number(index)) if self.splits else ONE_SPLIT[0]

    def machine_number(self, index: int) -> int:
        """Return the number of the machine of run number `index`; the runs of a machine follow each other."""
        return index // self.machines.runs_per_machine if self.machines else 0

    @property
    def machine_count(self) -> int:
        """The number of virtual machines of the recipe's runs; 1 without `[machines]`."""
        return self.machine_number(self.runs - 1) + 1

    def named_parts(self, source: str = "") -> "Iterator[tuple[str, Recipe]]":
        """Yield each different recipe of the splits, after its name in messages, which begins with `source`."""
        seen: list[Recipe] = []
        for name, part in self.parts.items():
            if all(part is not each for each in seen):
                seen.append(part)
                split = (self.splits or {}).get(name)
                own = isinstance(split, SplitTable) and split.changes
                yield f"{source}: splits.{name}".removeprefix(": ") if own else source, part

    def corners(self) -> Iterator[Scenario]:
        """Yield the scenarios at the extreme values of all distributions. Checks of the recipe use them.

        In the first, each key of `[vary]` has the first of its extreme values; in each further one a single key has
        another. The keys of the surroundings are all at their least, then all at their largest value; for faults see
        `scenario.faults.extremes`. The machines are those of the files, with the largest number of blades of
        `[machines]`. With `[twins]` each scenario is followed by its twin. Raises UserError for an extreme value that
        its key cannot have; whether the machine can have it is checked by `check_feasible`.
        """
        for where, part in self.named_parts():
            yield from part.own_corners(where)

    def own_corners(self, source: str = "") -> Iterator[Scenario]:
        """Yield the scenarios of `corners` without the changes of splits. Messages begin with `source`."""
        for base in self.bases:
            machine = self.machines.largest(base.machine) if self.machines else base.machine
            for corner in self.corners_of(base, machine, source):
                yield from with_twin(corner, self.twins, source)

    def corners_of(self, base: Scenario, machine: Machine, source: str = "") -> Iterator[Scenario]:
        """Yield the scenarios of `corners` for the scenario `base` with `machine` as its machine.

        Twins and the changes of splits are left out. Messages begin with `source`.
        """
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
