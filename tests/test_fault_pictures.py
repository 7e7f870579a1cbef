import importlib.util
from dataclasses import fields
from pathlib import Path

from rubgen.machine.faults.registry import FAULTS
from rubgen.scenario.vary import KEYS

ROOT = Path(__file__).parents[1]


def test_every_fault_has_a_picture_in_the_documents():
    spec = importlib.util.spec_from_file_location("fault_pictures", ROOT / "docs" / "fault_pictures.py")
    pictures = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(pictures)
    assert set(pictures.FAULTS) == set(FAULTS)
    for kind, values in pictures.FAULTS.items():
        assert set(values) <= {field.name for field in fields(FAULTS[kind])} | set(KEYS)
    shown = "".join((ROOT / "docs" / page).read_text() for page in ("faults-laws.md", "surroundings.md"))
    for name in (*pictures.FAULTS, *pictures.SURROUNDINGS):
        assert f"](pictures/{name}.png)" in shown
        assert (ROOT / "docs" / "pictures" / f"{name}.png").is_file()
