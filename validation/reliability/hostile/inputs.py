"""Hostile inputs by kind, each from its seed, given to the reader that meets it first."""

from __future__ import annotations

import hashlib
import json
import shutil
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import duckdb  # noqa: F401 - else one case pays for its import
import numpy as np

import rubgen
from rubgen.dataset.layout import Layout
from rubgen.errors import UserError
from rubgen.machine import load_machine
from rubgen.scenario import load_recipe
from rubgen.sensors.load import load_sensor_set
from validation.reliability.hostile.documents import json_bytes, mutated, toml_text
from validation.reliability.hostile.mcap import hostile_mcap
from validation.reliability.hostile.parquet import hostile_parquet

PACKAGE = Path(rubgen.__file__).parent
SHARES = {"recipe": 40, "machine": 25, "sensors": 20, "manifest": 9, "mcap": 4, "parquet": 2}
"""Of a hundred inputs; those that cost more are fewer."""
READ = "right"
REPLAY_EVERY = 50


def kind_of(seed: int) -> str:
    """The kind of input of this seed: mixed, so that any stretch of seeds has all kinds."""
    place = seed * 37 % 100
    for kind, share in SHARES.items():
        if place < share:
            return kind
        place -= share
    raise ValueError(seed)


@dataclass
class Inputs:
    """Valid documents, and a folder for what is made of them. `directory` is a finished set, which stays as it is."""

    directory: Path
    folder: Path

    def tried(self, seed: int) -> str:
        """Make the input of this seed and read it."""
        generator = np.random.default_rng(seed)
        kind = kind_of(seed)
        attempts: dict[str, Callable[[np.random.Generator], None]] = {
            "recipe": self._recipe, "machine": self._machine, "sensors": self._sensors,
            "manifest": self._manifest, "mcap": self._mcap, "parquet": self._parquet,
        }  # fmt: skip
        try:
            attempts[kind](generator)
        except UserError:
            raise
        except Exception as error:
            error.add_note(f"in a hostile {kind}")
            raise
        return READ

    @cached_property
    def _recipes(self) -> list[Any]:
        paths = sorted((PACKAGE / "scenario" / "recipes").glob("*.toml"))
        return [tomllib.loads(path.read_text(encoding="utf-8")) for path in paths]

    @cached_property
    def _machines(self) -> list[Any]:
        paths = sorted((PACKAGE / "machine" / "presets").glob("*.toml"))
        return [tomllib.loads(path.read_text(encoding="utf-8")) for path in paths]

    @cached_property
    def _sensor_sets(self) -> list[Any]:
        paths = sorted((PACKAGE / "sensors" / "sets").glob("*.toml"))
        return [tomllib.loads(path.read_text(encoding="utf-8")) for path in paths]

    @cached_property
    def _manifest_there(self) -> Any:
        return json.loads((self.directory / "manifest.json").read_text(encoding="utf-8"))

    @cached_property
    def _copy(self) -> Path:
        shutil.rmtree(self.folder / "copy", ignore_errors=True)  # of a process that died
        return Path(shutil.copytree(self.directory, self.folder / "copy"))

    def _write(self, name: str, document: Any) -> Path:
        path = self.folder / name
        path.write_bytes(toml_text(document).encode(errors="surrogatepass"))
        return path

    def _recipe(self, generator: np.random.Generator) -> None:
        recipe = mutated(_any(self._recipes, generator), generator)
        loaded = load_recipe(self._write("recipe.toml", recipe))
        loaded.scenario(loaded.runs - 1, screened=False)

    def _machine(self, generator: np.random.Generator) -> None:
        path = self._write("machine.toml", mutated(_any(self._machines, generator), generator))
        load_machine(str(path))
        self._with(machine=str(path))

    def _sensors(self, generator: np.random.Generator) -> None:
        path = self._write("sensors.toml", mutated(_any(self._sensor_sets, generator), generator))
        load_sensor_set(str(path))
        self._with(sensors={"set": str(path)})

    def _with(self, **values: Any) -> None:
        """A recipe that names this machine or these sensors, as far as the check before any run."""
        load_recipe(self._write("with.toml", {**self._recipes[0], **values}))

    def _manifest(self, generator: np.random.Generator) -> None:
        """The digest fits, so that the content is believed."""
        content = json_bytes(mutated(self._manifest_there, generator))
        self._seal(content)
        try:
            read_all(self._copy)
            rubgen.verify(self._copy)
        finally:
            self._seal((self.directory / "manifest.json").read_bytes())

    def _seal(self, content: bytes) -> None:
        (self._copy / "manifest.json").write_bytes(content)
        (self._copy / "manifest.json.sha256").write_text(f"{hashlib.sha256(content).hexdigest()}  manifest.json\n")

    def _mcap(self, generator: np.random.Generator) -> None:
        from rubgen.dataset.reading.replaying import find_replay
        from rubgen.io.mcap import check_mcap

        path = self.folder / "run.mcap"
        path.write_bytes(hostile_mcap(Layout(self.directory).export("mcap", "run-000000"), generator))
        check_mcap(path)
        replay = find_replay(path).replay
        if generator.integers(REPLAY_EVERY) == 0:
            from rubgen.viz.rerun import write_replay

            write_replay(replay, self.folder / "run.rrd")

    def _parquet(self, generator: np.random.Generator) -> None:
        """One Parquet file of the set with other content, and a manifest that believes it."""
        name = _any(
            [entry["path"] for entry in self._manifest_there["files"] if entry["path"].endswith(".parquet")], generator
        )
        path = self._copy / name
        hostile_parquet(self.directory / name, path, generator)
        content = path.read_bytes()
        entries = [
            {**entry, "bytes": len(content), "sha256": hashlib.sha256(content).hexdigest()}
            if entry["path"] == name
            else entry
            for entry in self._manifest_there["files"]
        ]
        self._seal(json_bytes({**self._manifest_there, "files": entries}))
        try:
            rubgen.verify(self._copy)
            read_all(self._copy)
        finally:
            shutil.copy(self.directory / name, path)
            self._seal((self.directory / "manifest.json").read_bytes())


def read_all(directory: Path) -> None:
    """Every way to read a set that needs no simulation; each may refuse in one line."""
    from rubgen.dataset.checking.relabel import relabel
    from rubgen.dataset.reading.replaying import find_runs, scenario_of

    data = rubgen.open(directory)
    ways: tuple[Callable[[], object], ...] = (
        lambda: data.units,
        lambda: data.runs.to_json(),
        lambda: len(data.ok),
        lambda: data.signals("run-000000"),
        lambda: list(data.each_channel(data.channels[0])),
        lambda: find_runs(data, "rub OR speed_rpm > 0"),
        lambda: scenario_of(data, "run-000001"),
        lambda: relabel(directory),
    )
    refused = 0
    for way in ways:
        try:
            way()
        except UserError as error:
            refused += "\n" not in str(error)
    if refused == len(ways):
        raise UserError("all refused")


def _any(values: list[Any], generator: np.random.Generator) -> Any:
    return values[generator.integers(len(values))]
