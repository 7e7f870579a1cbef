"""The Python of the README works as it is written, each block in a session of its own."""

import re
import runpy
from pathlib import Path

import pytest

import rubgen

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.split("\n")[2][:30])
def test_each_block_works(block, shown_set, rub_run, tmp_path, monkeypatch):
    """`rubgen.simulate` gives a run at once, and the viewer stays closed; all else is what a user gets."""
    asked, shown = [], []
    monkeypatch.setattr(rubgen, "simulate", lambda scenario: asked.append(scenario) or rub_run)
    monkeypatch.setattr("rubgen.output.replay", lambda run, **_how: shown.append(run))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "demo").symlink_to(shown_set)
    (tmp_path / "block.py").write_text(block, encoding="utf-8")
    runpy.run_path(str(tmp_path / "block.py"))
    if asked:
        assert (asked[0].operation.speed_rpm, shown) == (8500, [rub_run])
        assert (tmp_path / "run.mcap").stat().st_size > 10_000


def test_both_ways_are_shown():
    assert len(BLOCKS) == 2
