"""Load and check recipes: of a TOML file, of TOML values, and of the manifest of a data set."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pydantic import TypeAdapter, ValidationError

from rubgen.errors import UserError, warn
from rubgen.machine import Machine
from rubgen.machine.load import FOR_COMPARISON
from rubgen.machine.problems import first_problem, nearest, validated
from rubgen.machine.quantities import MOST_RUNS
from rubgen.machine.toml_file import check_kind, names_toml, read_toml, toml_path
from rubgen.scenario.checks.feasible import check_feasible
from rubgen.scenario.checks.plausible import warn_of
from rubgen.scenario.checks.profiles import check_used
from rubgen.scenario.distributions import Choice, Constant
from rubgen.scenario.machines.check import check_machines, check_splits, machine_extremes
from rubgen.scenario.recipe import Recipe
from rubgen.scenario.tables.balance import check_balance
from rubgen.scenario.tables.machines import replaced_runs
from rubgen.scenario.tables.twins import check_twins
from rubgen.scenario.vary import FREE_PENETRATION, TWO_CLEARANCES
from rubgen.sensors.sensor_set import SensorSet

RECIPES = Path(__file__).parent / "recipes"
"""The recipes that come with rubgen."""
DEFAULT_RECIPE = RECIPES / "zeng2019-mini.toml"
NOT_FOR_DATA = (
    'for comparison with the paper, never for data: it belongs to [contact] surface = "chords", '
    'where every node of the mesh hits the tips; name "zeng2019" instead'
)


def load_recipe(path: Path | str | None = None, *, runs: int | None = None) -> Recipe:
    """Load the recipe of a TOML file, a recipe that comes with rubgen, or the default recipe.

    - path: path of the file, or a name that `rubgen list` prints, without .toml. An existing file comes before a name.
      None is the default recipe.
    - runs: number of runs in place of the recipe's; None keeps the recipe's.

    Warns (RubgenWarning) of values that are hardly intended. Raises UserError with file, key, value, what is allowed
    and the remedy, before anything is computed.
    """
    file = DEFAULT_RECIPE if path is None else _recipe_path(str(path))
    data = read_toml(file)
    check_kind(file, data, "recipe")
    return parse_recipe(data, source=str(file), folder=file.parent, runs=runs)


def _recipe_path(name_or_path: str) -> Path:
    path = toml_path(name_or_path)
    if names_toml(name_or_path) or os.path.lexists(path):
        return path
    names = sorted(each.stem for each in RECIPES.glob("*.toml"))
    if name_or_path not in names:
        hint = nearest(name_or_path, names)
        raise UserError(f"{name_or_path!r:.200}: no such recipe; {hint}, or the path of a recipe .toml")
    return RECIPES / f"{name_or_path}.toml"


def parse_recipe(
    data: dict[str, Any], *, source: str = "recipe", folder: Path | None = None, runs: int | None = None
) -> Recipe:
    """Make the recipe of TOML values and check it.

    - data: the TOML values.
    - source: beginning of messages.
    - folder: folder from which relative paths start; None is the current folder.
    - runs: number of runs in place of the recipe's; None keeps the recipe's.

    Warns (RubgenWarning) of values that are hardly intended. Raises UserError for anything that is not allowed.
    """
    if runs is not None:
        data = replaced_runs(data, checked_runs(runs))
    recipe = validated(source, data, TypeAdapter(Recipe))
    recipe._folder = folder or Path()
    check_recipe(recipe, source, data)
    return recipe


def checked_runs(runs: int) -> int:
    """Return `runs`. Raises UserError where it is no whole number from 1 to the largest number of runs of a recipe."""
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

    The files of the machines and sensors are not read: changes to them have no effect. The recipe counts as checked.

    - data, machine, sensors: the three documents of the manifest. Several machines stand in a list.
    - source: beginning of messages.
    - split_sensors: sensor sets of the splits that have their own, by the set's name in the recipe.

    Raises UserError where this version of rubgen cannot read a document.
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
    """Check that the runs of the recipe are possible, at fixed values and at the extreme values of what it draws.

    Nothing is simulated, and no virtual machine is drawn: the ranges of `[machines]` are checked.

    - source: beginning of messages.
    - data: the TOML values of the recipe, in which keys are sought that its speed profile does not use. Without them,
      fields that are set count as given.

    Warns once of each value that is hardly intended, but not for a recipe that was checked before. Raises UserError
    where some run is not possible.
    """
    validated(
        source, recipe.model_dump(mode="json", warnings=False), TypeAdapter(Recipe)
    )  # it may be a copy with other values
    if not recipe._checked:
        _check_used(recipe, source, data)
    if len(set(recipe.output.formats)) != len(recipe.output.formats):
        raise UserError(f"{source}: output.formats = {list(recipe.output.formats)}: name each format once")
    for where, part in recipe.named_parts(source):
        _check_part(part, where)
    with _source_named(source):
        recipe.base  # noqa: B018  (reads the machine files)
    check_machines(recipe, source)
    check_splits(recipe, source)
    for where, part in recipe.named_parts(source):
        if part.balance:
            check_balance(part.balance, part.operation.profile, {key.key for key, _ in part.distributions()}, where)
        if part.twins:
            check_twins(part.twins, part.surroundings, tuple(part.own_corners(where)), where)
            if part.machines and part.machines.runs_per_machine == 1:
                raise UserError(f"{where}: twins: machines.runs_per_machine = 1: a twin is another run; give 2 or more")
    with recipe.machine_named():
        for where, part in recipe.named_parts(source):
            for scenario in part.own_corners(where):
                check_feasible(scenario, f"{where}: ")
    if not recipe._checked:
        _warn(recipe, source)
    recipe._checked = True


def _warn(recipe: Recipe, source: str) -> None:
    """Warn of what is hardly intended."""
    warn_of(chain(recipe.corners(), machine_extremes(recipe)), f"{source}: ")
    if recipe.contact.friction and "friction" in {key.key for key, _ in recipe.distributions()}:
        value = f"contact.friction = {recipe.contact.friction:g}"
        warn(f"{source}: {value}: vary.friction replaces it in every run; leave one of the two out")
    if FOR_COMPARISON in (base.machine.name for base in recipe.bases):
        warn(f"{source}: machine = {recipe.machine!r}: {NOT_FOR_DATA}")


def _check_used(recipe: Recipe, source: str, data: dict[str, Any] | None) -> None:
    """Raise UserError for a key that the profile would ignore. A manifest's recipe has every key of every profile."""
    left_out = {"labels"} if data is None else set()  # a dataclass does not tell what was set in it
    given = data or recipe.model_dump(mode="json", exclude_unset=True, exclude=left_out)
    if all(given != recipe.model_dump(mode="json", exclude=left_out, exclude_none=short) for short in (True, False)):
        check_used(f"{source}: ", given)


@contextmanager
def _source_named(source: str) -> Iterator[None]:
    """Begin an error about a machine or a sensor set that a recipe names with the recipe's file."""
    try:
        yield
    except UserError as error:
        text = str(error)
        raise UserError(f"{source}: {text}" if text.startswith(("machine = ", "sensors.set = ")) else text) from None


def _check_part(recipe: Recipe, source: str) -> None:
    """Check the drawn keys and the sensor set of a recipe, and of a split the keys that its profile ignores."""
    with _source_named(source):
        recipe.sensing  # noqa: B018  (reads the file of the sensors)
    if recipe._whole and not recipe._checked:
        used = {key: getattr(recipe, key).model_dump(mode="json", exclude_unset=True) for key in ("operation", "vary")}
        check_used(f"{source}: ", used)
    for entry, distribution in recipe.distributions():
        if entry.whole and not isinstance(distribution, Constant | Choice):
            raise UserError(f"{source}: vary.{entry.key}: takes whole numbers only; give a number or a choice")
    if {"clearance_m", FREE_PENETRATION.key} <= {entry.key for entry, _ in recipe.distributions()}:
        raise UserError(f"{source}: vary.{TWO_CLEARANCES}")
