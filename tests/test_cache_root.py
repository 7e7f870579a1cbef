"""One variable moves every cache; a folder that cannot be used costs a line and time, never the work."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from rubgen import cache_root
from rubgen.cache_root import CACHE_VARIABLE, FOLDERS, cache_folder, problem_of, read_cached, wanted_root, write_cached
from rubgen.errors import RubgenWarning

NAMED = rf"{CACHE_VARIABLE} names another folder"
NOBODY = 65534


@pytest.fixture(autouse=True)
def forgetful(monkeypatch):
    """Nothing settled or said before."""
    monkeypatch.setenv(CACHE_VARIABLE, "")
    cache_root._say_once.cache_clear()
    cache_root._settled_root.cache_clear()
    yield
    cache_root._say_once.cache_clear()


def test_the_variable_moves_kernels_and_blisks(tmp_path, monkeypatch):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "here"))
    assert [cache_folder(name) for name in FOLDERS] == [tmp_path / "here" / name for name in FOLDERS]
    assert all((tmp_path / "here" / name).is_dir() for name in FOLDERS)


def test_an_empty_variable_is_none():
    assert wanted_root().name == "rubgen"


def below_a_file(root: Path) -> Path:
    root.write_text("")
    return root / "x"


def a_folder_is_a_file(root: Path) -> Path:
    root.mkdir()
    (root / "reduction").write_text("")
    return root


def of_another_user(root: Path) -> Path:
    if os.geteuid() != 0:
        pytest.skip("only root can give a folder away")
    root.mkdir()
    os.chown(root, NOBODY, NOBODY)
    return root


def open_to_all(root: Path) -> Path:
    (root / "kernels").mkdir(parents=True)
    (root / "kernels").chmod(0o777)
    return root


def of_no_user(_root: Path) -> Path:
    return Path("~no-such-user-of-this-machine/cache")


BAD = [below_a_file, a_folder_is_a_file, of_another_user, open_to_all, of_no_user]


@pytest.mark.parametrize("make", BAD)
def test_an_unusable_folder_is_replaced_with_one_line(make, tmp_path, monkeypatch):
    monkeypatch.setenv(CACHE_VARIABLE, str(make(tmp_path / "cache")))
    with pytest.warns(RubgenWarning, match=NAMED) as said:
        folder, other = map(cache_folder, FOLDERS)
    assert len(said) == 1
    assert other.parent == folder.parent
    assert folder.is_dir()
    assert folder.parent.stat().st_mode & 0o077 == 0
    assert os.environ[CACHE_VARIABLE] == str(folder.parent)  # for the workers


def test_where_no_temporary_folder_can_be_made_nothing_is_kept(tmp_path, monkeypatch):
    def no_room(**_how):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setenv(CACHE_VARIABLE, str(below_a_file(tmp_path / "file")))
    monkeypatch.setattr(cache_root.tempfile, "mkdtemp", no_room)
    with pytest.warns(RubgenWarning, match="nothing is kept.*" + NAMED):
        assert cache_folder("kernels") is None


def test_workers_use_the_temporary_folder_which_ends_with_its_process(tmp_path):
    look = (
        "import os, subprocess, sys\n"
        "from rubgen.cache_root import cache_folder\n"
        "print(cache_folder('kernels'), flush=True)\n"
        "if len(sys.argv) == 2: subprocess.run([sys.executable, '-c', sys.argv[1], sys.argv[1], 'child'], check=True)"
    )
    environment = os.environ | {CACHE_VARIABLE: str(below_a_file(tmp_path / "file"))}
    done = subprocess.run(
        [sys.executable, "-c", look, look], capture_output=True, text=True, check=True, env=environment
    )
    own, of_child = done.stdout.splitlines()
    assert own == of_child
    assert not Path(own).parent.exists()
    assert done.stderr.count(CACHE_VARIABLE) == 1


def test_a_usable_folder_has_no_problem(tmp_path):
    assert problem_of(tmp_path / "a" / "b") == ""


def test_a_file_is_given_back_whole_or_not_at_all(tmp_path, monkeypatch):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    path = tmp_path / "deeper" / "file"
    assert read_cached(path) is None
    write_cached(path, b"content")
    good = path.read_bytes()
    assert read_cached(path) == b"content"
    for bad in (b"", good[:5], good[:-1], good + b"x", bytes([good[0] ^ 1]) + good[1:], good[:-1] + b"\0", b"content"):
        cache_root._say_once.cache_clear()
        path.write_bytes(bad)
        with pytest.warns(RubgenWarning, match="damaged.*" + NAMED):
            assert read_cached(path) is None


def test_a_file_of_another_user_is_not_believed(tmp_path):
    if os.geteuid() != 0:
        pytest.skip("only root can give a file away")
    write_cached(tmp_path / "file", b"content")
    os.chown(tmp_path / "file", NOBODY, NOBODY)
    with pytest.warns(RubgenWarning, match=NAMED):
        assert read_cached(tmp_path / "file") is None


def test_a_pipe_in_the_place_of_a_file_is_replaced(tmp_path):
    os.mkfifo(tmp_path / "x")
    with pytest.warns(RubgenWarning, match="damaged"):
        assert read_cached(tmp_path / "x") is None
    write_cached(tmp_path / "x", b"content")
    assert read_cached(tmp_path / "x") == b"content"


def test_a_folder_in_the_place_of_a_file_costs_one_line(tmp_path):
    (tmp_path / "x").mkdir()
    assert read_cached(tmp_path / "x") is None
    with pytest.warns(RubgenWarning, match=NAMED) as said:
        write_cached(tmp_path / "x", b"content")
    assert len(said) == 1
    assert list(tmp_path.rglob("*")) == [tmp_path / "x"]


def test_a_full_disk_costs_one_line(tmp_path, monkeypatch):
    def full(_path, _content):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.warns(RubgenWarning, match="No space left on device.*" + NAMED) as said:
        [write_cached(tmp_path / name, b"content") for name in "ab"]
    assert len(said) == 1
    assert list(tmp_path.iterdir()) == []
