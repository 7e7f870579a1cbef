import pytest

from rubgen.dataset.files import is_system_file


@pytest.mark.parametrize(
    "name", [".DS_Store", "lost+found", "Thumbs.db", "thumbs.db", "Desktop.ini", "._run-000001.mcap", ".Trash-1000"]
)
def test_what_systems_leave_is_no_content(name):
    assert is_system_file(name)


@pytest.mark.parametrize("name", ["letter.txt", "run-000001.mcap", ".staging", "DS_Store", ".hidden", "found"])
def test_anything_else_is(name):
    assert not is_system_file(name)
