"""The manifest: what a data set is made from, and the sha256 of what it holds."""

from __future__ import annotations

import hashlib
import platform
from importlib.metadata import version
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, NonNegativeInt, TypeAdapter, ValidationError

from rubgen.dataset.files import json_text, sha256_of, write_text
from rubgen.dataset.layout import FOLDERS, Layout
from rubgen.errors import UserError
from rubgen.io.json_read import read_json
from rubgen.io.regular_file import check_regular
from rubgen.machine import Machine
from rubgen.machine.problems import first_problem
from rubgen.scenario import Recipe
from rubgen.scenario.recipe import recorded_recipe
from rubgen.scenario.sensors import SensorSet

PACKAGES = ("rubgen", "numpy", "scipy", "numba", "llvmlite", "pyarrow", "mcap", "protobuf", "zstandard", "rerun-sdk")
_STRICT = ConfigDict(extra="forbid", frozen=True)
InnerPath = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*(/[A-Za-z0-9][A-Za-z0-9._-]*)*$")]
"""The path of a file within the set: no other place can be named."""


class FileEntry(BaseModel):
    """A file whose bytes follow from the recipe."""

    model_config = _STRICT
    path: InnerPath
    bytes: NonNegativeInt
    sha256: Annotated[str, Field(pattern="^[0-9a-f]{64}$")]


class Identity(BaseModel):
    """All that decides the bytes of a data set on one machine: recipe, the machine and sensors it names, versions."""

    model_config = _STRICT
    recipe: dict[str, Any]
    machine: dict[str, Any]
    sensors: dict[str, Any]
    packages: dict[str, str]

    def same_recipe(self, other: Identity) -> bool:
        """Whether both describe the same data set, whatever the versions."""
        return (self.recipe, self.machine, self.sensors) == (other.recipe, other.machine, other.sensors)

    def checked(self, source: str) -> Identity:
        """The same with every key in its place; UserError, beginning with `source`, where it is no identity."""
        if "rubgen" not in self.packages:
            raise UserError(f"{source}: identity.packages names no rubgen; generate the set again")
        return _identity(self.recorded(f"{source}: identity"), self.packages)

    def recorded(self, source: str = "manifest") -> Recipe:
        """The recipe with machine and sensors as they were; UserError, beginning with `source`, for an unknown one."""
        return recorded_recipe(self.recipe, self.machine, self.sensors, source)

    @property
    def sensor_set(self) -> SensorSet:
        """The sensors of every run."""
        return TypeAdapter(SensorSet).validate_python(self.sensors)


class Manifest(BaseModel):
    """The content of manifest.json; `derived` lists files that may differ in their bytes and can be made again."""

    model_config = _STRICT
    format: str = "rubgen data set 1"
    name: str
    license: str
    seed: int
    runs: int
    status: dict[str, NonNegativeInt]
    identity: Identity
    files: tuple[FileEntry, ...]
    derived: tuple[InnerPath, ...]

    def listed(self, folder: str) -> list[str]:
        """The paths below `folder` of the set, in order: what the set consists of, whatever else lies there."""
        names = [*(entry.path for entry in self.files), *self.derived]
        return sorted(name for name in names if name.startswith(f"{folder}/"))


def identity_of(recipe: Recipe) -> Identity:
    """The identity of the data set that this recipe makes with the installed packages."""
    return _identity(recipe, {name: version(name) for name in PACKAGES} | {"python": platform.python_version()})


def _identity(recipe: Recipe, packages: dict[str, str]) -> Identity:
    return Identity(
        recipe=recipe.model_dump(mode="json", exclude_none=True),
        machine=TypeAdapter(Machine).dump_python(recipe.base.machine, mode="json"),
        sensors=TypeAdapter(SensorSet).dump_python(recipe.sensing.set, mode="json"),
        packages=packages,
    )


def write_manifest(layout: Layout, identity: Identity, status: dict[str, int]) -> Manifest:
    """Hash every file of the finished set and write the manifest, then its digest."""
    recipe = identity.recipe
    manifest = Manifest(
        name=recipe["name"],
        license=recipe["license"],
        seed=recipe["seed"],
        runs=recipe["runs"],
        status=status,
        identity=identity,
        files=tuple(_entry(path, layout.root) for path in hashed_files(layout)),
        derived=tuple(path.relative_to(layout.root).as_posix() for path in derived_files(layout)),
    )
    write_text(layout.manifest, json_text(manifest.model_dump(mode="json")))
    write_text(layout.digest, f"{sha256_of(layout.manifest)}  {layout.manifest.name}\n")
    return manifest


def read_manifest(layout: Layout) -> Manifest:
    """The manifest of a finished set; UserError where there is none, or it is damaged or of no set of rubgen."""
    try:
        for path in (layout.manifest, layout.digest):
            check_regular(path)
        content = layout.manifest.read_bytes()
        digest = layout.digest.read_text(encoding="ascii").split()
    except (UserError, OSError, UnicodeDecodeError) as error:
        raise UserError(
            f"{layout.root}: no finished data set of rubgen ({error}); give the directory of `rubgen generate`"
        ) from None
    if digest[:1] != [hashlib.sha256(content).hexdigest()]:
        raise UserError(f"{layout.manifest}: its digest is not the one in {layout.digest.name}; generate the set again")
    try:
        manifest = Manifest.model_validate(read_json(content))
    except ValidationError as error:
        raise first_problem(layout.manifest, error, read_json(content)) from None
    except ValueError as error:
        raise UserError(f"{layout.manifest}: not a manifest of rubgen ({error}); generate the set again") from None
    return _checked(manifest, layout.manifest)


def _checked(manifest: Manifest, path: Path) -> Manifest:
    """The manifest with its identity complete; UserError where the two say different things."""
    identity = manifest.identity.checked(str(path))
    for key in ("name", "license", "seed", "runs"):
        if getattr(manifest, key) != identity.recipe[key]:
            raise UserError(f"{path}: {key} is not the one of its recipe; generate the set again")
    if sum(manifest.status.values()) != manifest.runs:
        raise UserError(f"{path}: status counts other than {manifest.runs} runs; generate the set again")
    return manifest.model_copy(update={"identity": identity})


def hashed_files(layout: Layout) -> list[Path]:
    """The files whose sha256 the manifest holds, in its order."""
    folders = [*layout.shards(), *layout.section_shards(), *sorted((layout.root / FOLDERS["mcap"]).glob("*.mcap"))]
    return [path for path in (layout.card, layout.croissant, layout.runs, *folders) if path.exists()]


def derived_files(layout: Layout) -> list[Path]:
    """The files that the manifest lists without a hash."""
    return sorted((layout.root / FOLDERS["rrd"]).glob("*.rrd"))


def _entry(path: Path, root: Path) -> FileEntry:
    return FileEntry(path=path.relative_to(root).as_posix(), bytes=path.stat().st_size, sha256=sha256_of(path))
