"""The manifest: the origin of a data set, and the sha256 of its files."""

import hashlib
import platform
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    Field,
    NonNegativeInt,
    SerializerFunctionWrapHandler,
    TypeAdapter,
    ValidationError,
    model_serializer,
)

from rubgen.dataset.files import json_text, sha256_of, write_text
from rubgen.dataset.layout import Layout
from rubgen.errors import UserError, os_reason
from rubgen.io.files import check_regular, read_json
from rubgen.io.places import answered, is_there, is_url
from rubgen.machine import Machine
from rubgen.machine.problems import first_problem
from rubgen.machine.quantities import StrictModel, about
from rubgen.scenario import Recipe
from rubgen.scenario.faults import named_kinds
from rubgen.scenario.load import recorded_recipe
from rubgen.scenario.machines.keys import MachineKey, own_keys
from rubgen.scenario.merged import merged_recipe
from rubgen.sensors.sensor_set import SensorSet

PACKAGES = ("rubgen", "numpy", "scipy", "numba", "llvmlite", "pyarrow", "mcap", "protobuf", "zstandard", "rerun-sdk")
FORMAT: Literal["rubgen data set 1"] = "rubgen data set 1"
MAKE_AGAIN = "make the set again in a new directory: rubgen generate RECIPE --out NEW"
DIGITS = 12
InnerPath = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*(/[A-Za-z0-9][A-Za-z0-9._-]*)*$")]
"""The path of a file within the set. No other path is allowed."""


class FileEntry(StrictModel):
    """A file of the set, its size and digest."""

    path: Annotated[InnerPath, about("Path of the file within the set.")]
    bytes: Annotated[NonNegativeInt, about("Size of the file.")]
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$"), about("SHA-256 of its content, in hexadecimal digits.")]


class Identity(StrictModel):
    """Everything that decides the bytes of a data set on one computer: recipe, machine, sensors, package versions."""

    recipe: Annotated[dict[str, Any], about("The recipe with every value that was given or is a default.")]
    machine: Annotated[
        dict[str, Any] | list[dict[str, Any]],
        about("The machine with all its values; of a recipe with several machine files, a list in their order."),
    ]
    sensors: Annotated[dict[str, Any], about("The sensor set with all its values.")]
    packages: Annotated[dict[str, str], about("Version of each package on which the bytes depend.")]
    split_sensors: Annotated[
        dict[str, dict[str, Any]],
        about("Sensor sets of splits that have their own, by the name in the recipe. Left out where there are none."),
    ] = Field({})
    sources: Annotated[
        tuple["Source", ...],
        about(
            "The sets of which a merged set was made, in the order of their runs. The recipe beside them is that of "
            "the first, with name and number of runs of the whole. Left out where the set was not merged."
        ),
    ] = ()

    @model_serializer(mode="wrap")
    def _without_absent(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Leave out the keys that few sets have where they are empty: manifests of other recipes stay as they were."""
        values: dict[str, Any] = handler(self)
        absent = [key for key in ("split_sensors", "sources") if not getattr(self, key)]
        return {key: each for key, each in values.items() if key not in absent}

    def same_recipe(self, other: "Identity") -> bool:
        """Return whether both identities describe the same data set.

        Package versions are ignored, except those in the sources of a merged set.
        """
        return self._described == other._described

    @property
    def _described(self) -> tuple[object, ...]:
        return self.recipe, self.machine, self.sensors, self.split_sensors, self.sources

    def with_runs(self, runs: int) -> "Identity":
        """Return the identity of the same recipe with another number of runs."""
        return self.model_copy(update={"recipe": {**self.recipe, "runs": runs}})

    def checked(self, source: str) -> "Identity":
        """Return the identity, which may come from a file, with every key of its recipe present.

        Raises UserError, beginning with `source`, where a key or value is not valid.
        """
        if "rubgen" not in self.packages:
            raise UserError(f"{source}: identity.packages names no rubgen; {MAKE_AGAIN}")
        whole = _identity(self.recorded(f"{source}: identity"), self.packages)
        sources = tuple(
            each.model_copy(update={"identity": each.identity.checked(f"{source}: identity.sources.{number}")})
            for number, each in enumerate(self.sources)
        )
        return whole.model_copy(update={"sources": sources})

    def recorded(self, source: str = "manifest") -> Recipe:
        """Make the recipe with the recorded machine and sensors. The files that the recipe names are not read.

        Raises UserError, beginning with `source`, where a key or value is not valid.
        """
        whole = recorded_recipe(self.recipe, self.machine, self.sensors, source, self.split_sensors)
        if not self.sources:
            return whole
        recipes = [each.identity.recorded(f"{source}.sources.{n}") for n, each in enumerate(self.sources)]
        if sum(each.runs for each in recipes) != whole.runs:
            raise UserError(f"{source}: recipe.runs = {whole.runs}: not the runs of all sources; {MAKE_AGAIN}")
        return merged_recipe(whole, recipes, [each.digits for each in self.sources])

    @property
    def sensor_set(self) -> SensorSet:
        """The sensors of every run, without the sets that single splits have (`split_sensors`)."""
        return TypeAdapter(SensorSet).validate_python(self.sensors)

    @property
    def fault_kinds(self) -> tuple[str, ...]:
        """The kinds of fault that the runs may have."""
        return named_kinds(self.recipe, *self.machines)

    @property
    def machines(self) -> list[dict[str, Any]]:
        """The machines of the recipe's files, in their order.

        A merged set has the machines of each source after each other.
        """
        if self.sources:
            return [machine for each in self.sources for machine in each.identity.machines]
        return self.machine if isinstance(self.machine, list) else [self.machine]

    @property
    def recipes(self) -> list[dict[str, Any]]:
        """The recipe, in a list; for a merged set the recipes of its sources."""
        return [each.identity.recipe for each in self.sources] or [self.recipe]

    @property
    def machine_keys(self) -> tuple[MachineKey, ...]:
        """The keys of `[machines.vary]` that have columns of their own; none without `[machines]`."""
        return own_keys(frame=bool(self.machines[0].get("frame"))) if "machines" in self.recipe else ()


class Source(StrictModel):
    """One of the data sets from which a merged set was made."""

    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$"), about("SHA-256 of its manifest.json.")]
    identity: Annotated[Identity, about("What decided its bytes: with it any of its runs is made again.")]

    @property
    def digits(self) -> str:
        """The first 12 digits of the manifest's sha256. The column `merged_from` names the source by these digits."""
        return self.sha256[:DIGITS]


class Manifest(StrictModel):
    """The content of manifest.json. `derived` lists files that can be made again and whose bytes may differ then.

    The digests of derived files are in derived.json, so that making a set twice makes the same manifest.
    """

    format: Annotated[
        Literal["rubgen data set 1"], about("Format of the set. It changes where a new version cannot read old sets.")
    ] = FORMAT
    name: Annotated[str, about("Name of the data set.")]
    license: Annotated[str, about("License of the data, as an SPDX name.")]
    seed: Annotated[int, about("Seed of all random numbers; of a merged set that of its first source.")]
    runs: Annotated[int, about("Number of runs, failed ones included.")]
    status: Annotated[dict[str, NonNegativeInt], about("Number of runs by their status.")]
    identity: Annotated[Identity, about("Everything that decides the bytes of the set on one computer.")]
    files: Annotated[tuple[FileEntry, ...], about("Every file whose bytes are reproducible, with its hash.")]
    derived: Annotated[tuple[InnerPath, ...], about("Paths of files that can be made again from the others.")]

    def listed(self, folder: str) -> list[str]:
        """Return the paths of the listed files below `folder`, sorted, relative to the set."""
        names = [*(entry.path for entry in self.files), *self.derived]
        return sorted(name for name in names if name.startswith(f"{folder}/"))


def identity_of(recipe: Recipe) -> Identity:
    """Return the identity of the data set that `recipe` makes with the installed packages."""
    return _identity(recipe, {name: version(name) for name in PACKAGES} | {"python": platform.python_version()})


def _identity(recipe: Recipe, packages: dict[str, str]) -> Identity:
    machines = [TypeAdapter(Machine).dump_python(base.machine, mode="json") for base in recipe.bases]
    return Identity(
        recipe=recipe.model_dump(mode="json", exclude_none=True),
        machine=machines if len(machines) > 1 else machines[0],
        sensors=TypeAdapter(SensorSet).dump_python(recipe.sensing.set, mode="json"),
        packages=packages,
        split_sensors={
            part.sensors.set: TypeAdapter(SensorSet).dump_python(part.sensing.set, mode="json")
            for part in recipe.parts.values()
            if part.sensors.set != recipe.sensors.set
        },
    )


def write_manifest(
    layout: Layout,
    identity: Identity,
    status: dict[str, int],
    files: Sequence[FileEntry],
    derived: Sequence[FileEntry],
) -> Manifest:
    """Finish a data set: write derived.json, then manifest.json, then the digest of manifest.json. Return the manifest.

    All other files of the set must be complete.

    - layout: paths of the set.
    - identity: recipe, machine, sensors and versions.
    - status: number of runs by status, such as ok or refused.
    - files: path, size and sha256 of each file with reproducible bytes. The manifest lists them with their sha256.
    - derived: the same for files that can be made again (.rrd), which are not in `files`. The manifest lists their
      paths. derived.json lists their sizes and sha256; it is not written if there are none.
    """
    recipe = identity.recipe
    manifest = Manifest(
        name=recipe["name"],
        license=recipe["license"],
        seed=recipe["seed"],
        runs=recipe["runs"],
        status=status,
        identity=identity,
        files=tuple(files),
        derived=tuple(entry.path for entry in derived),
    )
    _write_derived(layout, derived)
    write_text(layout.manifest, json_text(manifest.model_dump(mode="json")))
    write_text(layout.digest, _digest_text(layout, layout.manifest.read_bytes()))
    return manifest


def read_identity(layout: Layout) -> Identity:
    """Read the identity of an unfinished data set.

    Raises UserError where it is damaged, OSError where no file is there.
    """
    try:
        return Identity.model_validate(read_json(layout.identity.read_bytes()))
    except ValueError as error:
        reason = " ".join(str(error).split())[:100]
        raise UserError(
            f"{layout.identity}: damaged ({reason}), so nothing tells what the runs there are; give another directory"
        ) from None


def read_manifest(layout: Layout) -> Manifest:
    """Read the manifest of a finished data set and check it against its digest.

    Raises UserError where there is no manifest, or it is damaged or was not written by rubgen.
    """
    if not is_there(layout.manifest):
        why = answered(layout.root, lambda: _why_none(layout)) if is_url(layout.root) else _why_none(layout)
        raise UserError(f"{layout.root}: no finished data set of rubgen: {why}")
    try:
        for path in (layout.manifest, layout.digest):
            check_regular(path)
        content, digest = layout.manifest.read_bytes(), layout.digest.read_bytes()
    except UserError as error:
        raise UserError(
            f"{layout.root}: no finished data set of rubgen ({error}); give the directory of `rubgen generate`"
        ) from None
    except OSError as error:
        raise UserError(f"{layout.root}: its manifest cannot be read ({os_reason(error)})") from None
    if digest != _digest_text(layout, content).encode():
        raise UserError(f"{layout.manifest}: its digest is not the one in {layout.digest.name}; {MAKE_AGAIN}")
    try:
        manifest = Manifest.model_validate(read_json(content))
    except ValidationError as error:
        raise first_problem(layout.manifest, error, read_json(content)) from None
    except ValueError as error:
        raise UserError(f"{layout.manifest}: not a manifest of rubgen ({error}); {MAKE_AGAIN}") from None
    return _checked(manifest, layout.manifest)


def _why_none(layout: Layout) -> str:
    if layout.identity.exists():
        return "it is unfinished; the `rubgen generate` command that began it makes the rest"
    there = "it is a file" if layout.root.exists() else "there is no such directory"
    what = "it has no manifest.json" if layout.root.is_dir() else there
    return f"{what}; give the directory of `rubgen generate`"


def _checked(manifest: Manifest, path: Path) -> Manifest:
    """Return the manifest with its identity complete. Raises UserError where the two contradict each other."""
    identity = manifest.identity.checked(str(path))
    for key in ("name", "license", "seed", "runs"):
        if getattr(manifest, key) != identity.recipe[key]:
            raise UserError(f"{path}: {key} is not the one of its recipe; {MAKE_AGAIN}")
    if sum(manifest.status.values()) != manifest.runs:
        raise UserError(f"{path}: status counts other than {manifest.runs} runs; {MAKE_AGAIN}")
    return manifest.model_copy(update={"identity": identity})


def entry_of(path: Path, root: Path) -> FileEntry:
    """Hash the file at `path` and return its entry, with the path relative to `root`."""
    return FileEntry(path=path.relative_to(root).as_posix(), bytes=path.stat().st_size, sha256=sha256_of(path))


def write_derived(layout: Layout, names: Sequence[str]) -> bool:
    """Write sizes and digests of the derived files `names` to derived.json. Return whether derived.json changed.

    If `names` is empty, nothing is written.
    """
    return _write_derived(layout, [entry_of(layout.root / name, layout.root) for name in names])


def _write_derived(layout: Layout, entries: Sequence[FileEntry]) -> bool:
    text = _derived_text(tuple(entries))
    if not entries or (layout.derived.is_file() and layout.derived.read_bytes() == text.encode()):
        return False
    write_text(layout.derived, text)
    return True


def read_derived(layout: Layout) -> dict[str, FileEntry]:
    """Read derived.json: path, size and sha256 of each derived file when it was written, by path.

    Raises UserError where derived.json is missing or damaged.
    """
    try:
        check_regular(layout.derived)
        content = layout.derived.read_bytes()
    except OSError as error:
        raise UserError(f"{layout.derived}: cannot be read ({error.strerror})") from None
    try:
        entries = TypeAdapter(tuple[FileEntry, ...]).validate_python(read_json(content)["files"])
    except (ValueError, LookupError, TypeError):  # a ValidationError is a ValueError
        entries = ()
    if content != _derived_text(entries).encode():
        raise UserError(f"{layout.derived}: damaged, its digest is another")
    return {entry.path: entry for entry in entries}


def _derived_text(entries: tuple[FileEntry, ...]) -> str:
    """Return the JSON of the entries and its own sha256, by which any flipped bit is detected."""
    files = [entry.model_dump() for entry in entries]
    return json_text({"files": files, "sha256": hashlib.sha256(json_text(files).encode()).hexdigest()})


def _digest_text(layout: Layout, content: bytes) -> str:
    return f"{hashlib.sha256(content).hexdigest()}  {layout.manifest.name}\n"
