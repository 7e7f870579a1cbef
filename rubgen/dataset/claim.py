"""Whose an output directory is: empty, ours and unfinished, ours and finished, or not ours."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout
from pydantic import ValidationError

from rubgen.dataset.files import remove_parts, write_json
from rubgen.dataset.layout import FOLDERS, Layout
from rubgen.dataset.manifest import Identity, read_manifest
from rubgen.errors import UserError
from rubgen.io.durable import sync_directory


def finished(layout: Layout, identity: Identity) -> bool:
    """Whether the directory already holds this very data set; UserError where it holds something else."""
    root = layout.root
    if root.exists() and not root.is_dir():
        raise UserError(f"--out {root}: is a file; give a new or empty directory")
    if layout.manifest.exists() and layout.digest.exists():
        _check_same(layout, read_manifest(layout).identity, identity)
        return True
    if layout.identity.exists():
        _check_same(layout, _read_identity(layout.identity), identity, versions=True)
    elif root.exists() and any(root.iterdir()):
        raise UserError(f"--out {root}: not empty and no data set of rubgen; give a new or empty directory")
    return False


@contextmanager
def claimed(layout: Layout, identity: Identity) -> Iterator[None]:
    """Hold the directory for this process, with its folders made and what was left half-written removed."""
    for folder in (layout.root, layout.sections, layout.staging / "runs", layout.staging / "sections"):
        folder.mkdir(parents=True, exist_ok=True)
    lock = FileLock(layout.staging / "lock", timeout=0)
    try:
        with lock:
            for kind in identity.recipe["output"]["formats"]:
                (layout.root / FOLDERS.get(kind, "data")).mkdir(exist_ok=True)
            remove_parts(layout.root)
            if not layout.identity.exists():
                write_json(layout.identity, identity.model_dump(mode="json"))
            sync_directory(layout.root)
            yield
    except Timeout:
        raise UserError(
            f"--out {layout.root}: another rubgen is writing there; wait for it or choose another"
        ) from None


def _read_identity(path: Path) -> Identity:
    try:
        return Identity.model_validate(json.loads(path.read_text(encoding="utf-8")))
    except (OSError, ValueError, ValidationError):
        raise UserError(f"{path}: cannot be read; delete this data set and generate it again") from None


def _check_same(layout: Layout, there: Identity, asked: Identity, *, versions: bool = False) -> None:
    if not there.same_recipe(asked):
        key, old, new = _first_difference(there, asked)
        raise UserError(
            f"--out {layout.root}: holds the output of another recipe ({key} = {old!r}, asked for {new!r}); "
            "give another directory"
        )
    if versions and there.packages != asked.packages:
        names = sorted(name for name in asked.packages if there.packages.get(name) != asked.packages[name])
        name = names[0] if names else "packages"
        raise UserError(
            f"--out {layout.root}: begun with {name} {there.packages.get(name)}, now it is {asked.packages.get(name)}; "
            "finish it with the old version or give another directory"
        )


def _first_difference(there: Identity, asked: Identity) -> tuple[str, object, object]:
    for part in ("recipe", "machine", "sensors"):
        old, new = _flat(getattr(there, part)), _flat(getattr(asked, part))
        for key in [*new, *old]:
            if old.get(key) != new.get(key):
                return key if part == "recipe" else f"{part}.{key}", old.get(key), new.get(key)
    return "recipe", None, None


def _flat(values: dict[str, object], prefix: str = "") -> dict[str, object]:
    flat: dict[str, object] = {}
    for key, each in values.items():
        value = _by_name(each) if isinstance(each, list) else each
        flat |= _flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return flat


def _by_name(listed: list[object]) -> object:
    """A list of tables by their names or numbers; any other list as it is."""
    tables = [each for each in listed if isinstance(each, dict)]
    return {str(each.get("name", i)): each for i, each in enumerate(tables)} if len(tables) == len(listed) else listed
