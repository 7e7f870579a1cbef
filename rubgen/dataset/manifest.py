"""The manifest: what a data set is made from, and the sha256 of what it holds."""

from __future__ import annotations

import json
import platform
from importlib.metadata import version
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError

from rubgen.dataset.files import json_text, sha256_of, write_text
from rubgen.dataset.layout import FOLDERS, Layout
from rubgen.errors import UserError
from rubgen.machine import Machine
from rubgen.scenario import Recipe
from rubgen.scenario.sensors import SensorSet

PACKAGES = ("rubgen", "numpy", "scipy", "numba", "llvmlite", "pyarrow", "mcap", "protobuf", "zstandard", "rerun-sdk")
_STRICT = ConfigDict(extra="forbid", frozen=True)


class FileEntry(BaseModel):
    """A file whose bytes follow from the recipe."""

    model_config = _STRICT
    path: str
    bytes: int
    sha256: str


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
    status: dict[str, int]
    identity: Identity
    files: tuple[FileEntry, ...]
    derived: tuple[str, ...]

    def listed(self, folder: str) -> list[str]:
        """The paths below `folder` of the set, in order: what the set consists of, whatever else lies there."""
        names = [*(entry.path for entry in self.files), *self.derived]
        return sorted(name for name in names if name.startswith(f"{folder}/"))


def identity_of(recipe: Recipe) -> Identity:
    """The identity of the data set that this recipe makes with the installed packages."""
    packages = {name: version(name) for name in PACKAGES} | {"python": platform.python_version()}
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
    """The manifest of a finished set; UserError where there is none, or it is damaged."""
    try:
        content = layout.manifest.read_bytes()
        digest = layout.digest.read_text(encoding="ascii").split()
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(
            f"{layout.root}: no finished data set of rubgen ({error}); give the directory of `rubgen generate`"
        ) from None
    if digest[:1] != [sha256_of(layout.manifest)]:
        raise UserError(f"{layout.manifest}: its digest is not the one in {layout.digest.name}; generate the set again")
    try:
        return Manifest.model_validate(json.loads(content))
    except (ValidationError, ValueError) as error:
        raise UserError(
            f"{layout.manifest}: not a manifest of rubgen ({_one_line(error)}); generate it again"
        ) from None


def hashed_files(layout: Layout) -> list[Path]:
    """The files whose sha256 the manifest holds, in its order."""
    folders = [*layout.shards(), *layout.section_shards(), *sorted((layout.root / FOLDERS["mcap"]).glob("*.mcap"))]
    return [path for path in (layout.card, layout.croissant, layout.runs, *folders) if path.exists()]


def derived_files(layout: Layout) -> list[Path]:
    """The files that the manifest lists without a hash."""
    return sorted((layout.root / FOLDERS["rrd"]).glob("*.rrd"))


def _entry(path: Path, root: Path) -> FileEntry:
    return FileEntry(path=path.relative_to(root).as_posix(), bytes=path.stat().st_size, sha256=sha256_of(path))


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())[:200]
