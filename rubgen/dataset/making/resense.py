"""Make a data set again with other sensors on the same motions."""

from dataclasses import replace
from pathlib import Path

from pydantic import TypeAdapter

from rubgen.dataset.layout import Layout
from rubgen.dataset.making.generate import Generated, generate_as
from rubgen.dataset.manifest import Identity, identity_of, read_manifest
from rubgen.errors import UserError, warn
from rubgen.io.places import check_local
from rubgen.machine import Machine, load_machine
from rubgen.progress import Report
from rubgen.scenario import Recipe
from rubgen.scenario.checks.plausible import warn_of
from rubgen.scenario.costs import steps_per_turn
from rubgen.sensors.load import load_sensor_set
from rubgen.sensors.sensor_set import SensorSet


def resense(
    directory: Path | str,
    sensors: str | Path,
    out: Path | str,
    *,
    workers: int | None = None,
    progress: Report | bool | None = None,
) -> Generated:
    """Make the data set in `directory` again in the directory `out`, with another sensor set on the same motions.

    Every run is simulated again from the recorded recipe and machine, because a set contains no true signals for new
    sensors. Virtual machines and candidates of a balance are those recorded in `directory`; they are not drawn again.
    The new set is complete, with its own manifest. It has the recipe of `directory` with the new sensors.

    - directory: a finished data set that was not merged; it is only read.
    - sensors: name of a sensor set, or the path of its TOML file.
    - out: directory of the new set.
    - workers: number of processes, by default one for each usable core.
    - progress: called with the numbers of finished and of all runs, as in `generate`.

    The same call completes an interrupted set. Labels that need no sensor keep all bits where a run has the same steps
    a turn and the package versions are the same. Fast sensors need more steps: a warning names a speed at which the
    steps change. Labels of amplitudes at orders are computed for the new sensors' signals. A sensor on the housing adds
    the machine's frame, which changes `machine_id`. Raises UserError for a URL as `directory`, a directory without a
    finished set, a merged set, an unknown sensor set, the sensors that the set has already, and sensors that the
    machine cannot have.
    """
    layout = Layout(directory)
    check_local(layout.root, "resense")
    identity = read_manifest(layout).identity
    if identity.sources:
        raise UserError(f"{directory}: is a merged set; give the command for each of its sources and merge them again")
    before = identity.recorded()
    new = load_sensor_set(str(sensors))
    if new == before.sensing.set:
        raise UserError(f"--sensors {sensors}: the data set in {directory} has these sensors already; name others")
    recipe = _with_sensors(identity, str(sensors), new, layout.root)
    _warn_of_other_steps(before, recipe, str(sensors))
    versions = identity_of(recipe).packages
    other = [name for name, version in identity.packages.items() if versions.get(name, version) != version]
    if other:
        warn(f"{directory}: made with other versions of {', '.join(other)}; chaotic motions may differ from it")
    warn_of(recipe.corners(), f"{directory}: ")
    return generate_as(recipe, out, decided=layout.runs, workers=workers, progress=progress)


def _with_sensors(identity: Identity, name: str, new: SensorSet, directory: Path) -> Recipe:
    """Return the recorded recipe with the sensor set `new`, and with the machines' frames where they feel them."""
    table = {**identity.recipe.get("sensors", {}), "set": name}
    document = TypeAdapter(SensorSet).dump_python(new, mode="json")
    changed = identity.model_copy(update={"recipe": {**identity.recipe, "sensors": table}, "sensors": document})
    recipe = changed.recorded(str(directory))
    if not recipe.feels_frame or recipe.base.machine.frame is not None:
        return recipe
    found = [
        _with_frame(file, base.machine, name, directory) for file, base in zip(recipe.files, recipe.bases, strict=True)
    ]
    machines = [TypeAdapter(Machine).dump_python(each, mode="json") for each in found]
    machine = machines if len(machines) > 1 else machines[0]
    return changed.model_copy(update={"machine": machine}).recorded(str(directory))


def _with_frame(file: str, recorded: Machine, name: str, directory: Path) -> Machine:
    """Return the recorded machine with the frame of its file: a set whose sensors feel no frame does not record it."""
    needs = f"--sensors {name}: needs the machine's [frame], which {directory} does not record"
    try:
        named = load_machine(file)
    except UserError as error:
        raise UserError(f"{needs}; {error}: give the command in the directory of the recipe") from None
    if replace(named, frame=None) != recorded:
        raise UserError(f"{needs}, and machine = {file!r} has changed; put back the file as it was")
    return named


def _warn_of_other_steps(before: Recipe, after: Recipe, name: str) -> None:
    """Warn once where the sensors need other steps a turn, which stability may need as well."""
    for old, new in zip(before.corners(), after.corners(), strict=True):
        steps = steps_per_turn(old), steps_per_turn(new)
        if steps[0] != steps[1]:
            warn(
                f"--sensors {name}: needs {steps[1]:,} steps a turn instead of {steps[0]:,} at "
                f"{new.operation.speed_rpm:g} rev/min; runs whose column steps_per_turn differs have another motion"
            )
            return
