"""The whole page at a size for tests: every section computes, judges and draws."""

import json
from dataclasses import replace

import pytest

from validation.piece import Piece
from validation.zeng2019 import reproduce
from validation.zeng2019.conclusions import causes, conclusion1, conclusion2, friction
from validation.zeng2019.figures import figure16
from validation.zeng2019.figures.figure19 import SWEPT
from validation.zeng2019.models.mixed_frames import crossings_by_frame, points_by_frame
from validation.zeng2019.runs.cases import SUPPORT_RPM
from validation.zeng2019.sections import SECTIONS
from validation.zeng2019.size import MACHINES, QUICK

pytestmark = pytest.mark.long

TINY = replace(
    QUICK, settle_turns=40, record_turns=100, thin=60, speed_thin=120, campbell_step=5000, full_speeds=(0.0,), samples=1
)
FEWEST = 105
"""The page has so many statements at least; fewer were lost on the way."""


def test_every_section_is_computed_judged_and_drawn(tmp_path, monkeypatch):
    monkeypatch.setattr(conclusion1, "SPEEDS", (13000.0,))
    monkeypatch.setattr(conclusion2, "SPEEDS", (9500.0, 10500.0))
    monkeypatch.setattr(conclusion2, "LOBES", (2, 3))
    monkeypatch.setattr(causes, "FRAMES", Piece(crossings_by_frame, (SWEPT[::7], SUPPORT_RPM)))
    monkeypatch.setattr(causes, "POINTS", Piece(points_by_frame, (SWEPT[::7], SUPPORT_RPM)))
    monkeypatch.setattr(figure16, "LESS_AIR", (0, 4e-5))
    monkeypatch.setattr(friction, "SPEEDS", (7020.0, 11820.0))
    made = reproduce(tmp_path, size=TINY, workers=1)
    statements = json.loads((tmp_path / "statements.json").read_text(encoding="utf-8"))
    own = [one for one in statements if one["machine"] == MACHINES[0]]
    assert {one["machine"] for one in statements} == set(MACHINES)
    assert sum(not one["apart"] for one in own) == sum(made.verdicts.values()) >= FEWEST
    assert {one["figure"] for one in own} == {section.name for section in SECTIONS}
    assert all(one["found"] for one in statements)
    assert len({one["statement"] for one in own}) >= FEWEST
    assert made.page == tmp_path / "zeng2019.md"
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(tmp_path.glob("zeng2019*.md")))
    pictures = sorted(tmp_path.glob("zeng2019-*.png"))
    assert all(text.count(f"({picture.name})") == 1 and picture.stat().st_size < 300_000 for picture in pictures)
    assert len(pictures) >= 19
    assert "nan" not in text.replace("resonan", "")
    assert "| main cause | meaning | statements |" in text
    assert "| before, the paper's statements | 46 | 19 | 36 | 6 | 107 |" in text
    assert "not asked any more" not in text
    assert reproduce(tmp_path, figure=SECTIONS[0].name, size=TINY, workers=1).made == 0
