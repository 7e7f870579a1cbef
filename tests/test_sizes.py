"""Sizes that keep the package readable."""

import ast
from pathlib import Path

import rubgen

PACKAGE = Path(rubgen.__file__).parent
FILES = sorted(PACKAGE.rglob("*.py"))
LISTS = {"faults", "kinds"}
"""Rooms that only list kinds, one file each. They may grow."""


def test_files_have_at_most_400_lines():
    assert len(FILES) > 300
    assert [path for path in FILES if len(path.read_text(encoding="utf-8").splitlines()) > 400] == []


def test_functions_have_at_most_70_lines_with_their_docstrings():
    long = [
        (path.relative_to(PACKAGE).as_posix(), node.name)
        for path in FILES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef) and node.end_lineno - node.lineno + 1 > 70
    ]
    assert long == []


def test_rooms_have_at_most_15_files():
    rooms = {path.parent for path in FILES if path.parent.name not in LISTS}
    assert len(rooms) > 30
    assert [room for room in rooms if len(list(room.glob("*.py"))) > 15] == []
