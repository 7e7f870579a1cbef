"""The whole page at a size for tests: every section computes, judges and draws."""

import json
from dataclasses import replace

from validation.zeng2019 import reproduce
from validation.zeng2019.sections import SECTIONS
from validation.zeng2019.size import QUICK

TINY = replace(
    QUICK, settle_turns=50, record_turns=100, thin=30, speed_thin=60, campbell_step=5000, full_speeds=(0.0,), samples=2
)
FEWEST = 110
"""The page has so many statements at least; fewer were lost on the way."""


def test_every_section_is_computed_judged_and_drawn(tmp_path):
    made = reproduce(tmp_path, size=TINY, workers=1)
    statements = json.loads((tmp_path / "statements.json").read_text(encoding="utf-8"))
    assert len(statements) == sum(made.verdicts.values()) >= FEWEST
    assert {one["figure"] for one in statements} == {section.name for section in SECTIONS}
    assert all(one["found"] for one in statements)
    assert len({one["statement"] for one in statements}) >= FEWEST - 8  # zones and motion are asked of three sweeps
    text, pictures = made.page.read_text(encoding="utf-8"), sorted(tmp_path.glob("zeng2019-*.png"))
    assert all(f"({picture.name})" in text and picture.stat().st_size < 300_000 for picture in pictures)
    assert len(pictures) >= 19
    assert "nan" not in text.replace("resonan", "")
    assert reproduce(tmp_path, size=TINY, workers=1).made == 0
