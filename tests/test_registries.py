"""What one adds as one file and one line: every file of such a room is registered, and no other module knows it."""

from pathlib import Path
from typing import get_args

import pytest

import rubgen
from rubgen.format_names import FORMAT_NAMES
from rubgen.machine.faults.registry import FAULTS
from rubgen.machine.support_laws.disk_support import LAWS
from rubgen.scenario.contact_laws.contact_law import NORMAL_LAWS
from rubgen.sensors.registry import AnySensor

PACKAGE = Path(rubgen.__file__).parent
ROOMS = {
    "formats": [f"rubgen.formats.{name}" for name in FORMAT_NAMES],
    "machine/faults": [kind.__module__ for kind in FAULTS.values()],
    "machine/support_laws": [law.__module__ for law in LAWS],
    "scenario/contact_laws": [law.__module__ for law in NORMAL_LAWS],
    "sensors/kinds": [kind.__module__ for kind in get_args(get_args(AnySensor)[0])],
}
BASES = {"__init__", "format", "fault", "law", "registry", "disk_support", "contact_law"}
"""The files of these rooms with a base class or a registry."""


@pytest.mark.parametrize("room", ROOMS)
def test_every_file_of_a_room_is_registered(room):
    files = {f"rubgen.{room.replace('/', '.')}.{path.stem}" for path in (PACKAGE / room).glob("*.py")}
    assert len(ROOMS[room]) == len(set(ROOMS[room]))
    assert {each for each in files if each.rpartition(".")[2] not in BASES} == set(ROOMS[room])


@pytest.mark.parametrize(
    ("room", "registries"),
    [
        ("formats", set()),
        ("machine/faults", {"machine/faults/registry.py"}),
        ("scenario/contact_laws", {"scenario/contact_laws/contact_law.py"}),
    ],
)
def test_only_the_registry_knows_a_file(room, registries):
    importers = {
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        for module in ROOMS[room]
        if f"from {module} import" in path.read_text(encoding="utf-8")
    }
    assert importers == registries
