"""A stop at any moment leaves a directory in which the same call goes on, and another recipe is refused."""

import errno
import os
import shutil
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest
from filelock import FileLock

import rubgen
from rubgen.dataset.checking.inventory import size_findings, unlisted_files
from rubgen.dataset.layout import Layout
from rubgen.dataset.making import generate as generating
from rubgen.dataset.making.claim import check_same
from rubgen.dataset.making.keep import Keeper
from rubgen.dataset.manifest import Identity
from rubgen.errors import RubgenError, RubgenWarning, UserError

pytestmark = pytest.mark.long

RECIPE = {"name": "fake", "runs": 2, "machine": "zeng2019", "output": {"signal_seconds": 0.1, "formats": ["mcap"]}}
OPERATIONS = ("mkdir", "rename", "replace", "fsync", "unlink", "rmdir")
"""Of `os`: what makes something durable, or removes it."""
ENOUGH = 200


class Stopped(BaseException):
    """A kill or a power cut: nobody catches it."""


@pytest.fixture(autouse=True)
def fake_simulate(short_records, make_synthetic_run, monkeypatch):
    template = make_synthetic_run(seconds=0.1)
    monkeypatch.setattr("rubgen.pipeline.simulate", lambda scenario: replace(template, scenario=scenario))
    monkeypatch.setattr(generating, "warm_up", lambda *_: [])
    monkeypatch.setattr(generating, "size_findings", _with_strays)


def _with_strays(layout, manifest):
    return [*size_findings(layout, manifest), *unlisted_files(layout, manifest)]


def make(out, **changes):
    return rubgen.generate({**RECIPE, **changes}, out, workers=1)


def tree(directory):
    files = [path for path in sorted(directory.rglob("*")) if path.is_file()]
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files}


def stop_at(patch, number, error):
    """Raise `error` in place of the durable operation with that number and of all that follow; counts them."""
    calls = []

    def stopping(name):
        true = getattr(os, name)

        def call(*arguments, **keywords):
            calls.append(name)
            if len(calls) >= number:
                raise error
            return true(*arguments, **keywords)

        patch.setattr(os, name, call)

    for name in OPERATIONS:
        stopping(name)
    return calls


@pytest.mark.parametrize(
    ("error", "seen", "first"),
    [
        (Stopped(), Stopped, 1),
        (OSError(errno.ENOSPC, "No space left on device"), UserError, 2),
    ],
    ids=["kill", "full disk"],
)
def test_a_stop_at_every_durable_operation_is_made_good(tmp_path, monkeypatch, error, seen, first):
    """A kill at the first, third, ... operation and a full disk at those between; `make faults` has both at all."""
    make(tmp_path / "whole")
    whole, number, stopped = tree(tmp_path / "whole"), first - 2, True
    while stopped and number < ENOUGH:
        number += 2
        out = tmp_path / f"set-{number}"
        with monkeypatch.context() as patch:
            calls = stop_at(patch, number, error)
            with suppress(seen):
                make(out)
            stopped = len(calls) >= number
        begun = (out / ".staging").exists()
        if begun or (out / "manifest.json.sha256").exists():
            with pytest.raises(UserError, match=r"another recipe \(name = 'fake', asked for 'other'\)"):
                make(out, name="other")
        make(out)
        assert tree(out) == whole, f"stopped at operation {number}, {calls[number - 1 :][:1]}"
    assert 50 < number < ENOUGH


@pytest.mark.parametrize(
    "debris",
    [
        [".staging.lock"],
        [".staging.part/runs/", ".staging.part/identity.json"],
        [".staging/runs/", ".staging/sections/", ".staging/lock", "sections/"],
        [".staging/identity.part.json", ".staging/lock"],
        [".DS_Store", "lost+found/", "Thumbs.db", "desktop.ini", "._x"],
    ],
)
def test_what_a_stop_or_the_system_leaves_is_no_content(tmp_path, debris):
    for name in debris:
        path = tmp_path / "set" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if name.endswith("/"):
            path.mkdir(exist_ok=True)
        else:
            path.write_bytes(b"")
    assert make(tmp_path / "set").made == 2


@pytest.mark.parametrize("name", [".staging/letter.txt", "truth/letter.txt", ".staging/runs/run-000000.parquet", "a/"])
def test_what_may_be_somebodys_is_refused_and_left(tmp_path, name):
    path = tmp_path / "set" / name
    path.parent.mkdir(parents=True)
    if name.endswith("/"):
        path.mkdir()
    else:
        path.write_bytes(b"dear")
    before = tree(tmp_path)
    with pytest.raises(UserError, match="not empty and no data set of rubgen"):
        make(tmp_path / "set")
    assert tree(tmp_path) == before


def test_a_third_generator_in_the_first_moments_is_told_to_wait(tmp_path, monkeypatch):
    """While the first holds the lock and has written no identity yet."""
    seen = []
    true = Path.rename

    def others(path, target):
        for name in ("fake", "other"):
            with pytest.raises(UserError, match="another rubgen is writing there; wait for it") as said:
                make(tmp_path / "set", name=name)
            seen.append(said)
        return true(path, target)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "rename", others)
        assert make(tmp_path / "set").made == 2
    assert len(seen) == 2


def test_who_comes_while_the_set_is_finished_verifies_it(tmp_path, monkeypatch):
    """The set is not there at the first look, and is when the lock is ours."""
    make(tmp_path / "whole")
    true = Path.mkdir

    def finish(path, *arguments, **keywords):
        monkeypatch.setattr(Path, "mkdir", true)
        shutil.copytree(tmp_path / "whole", tmp_path / "set")
        return true(path, *arguments, **keywords)

    monkeypatch.setattr(Path, "mkdir", finish)
    assert make(tmp_path / "set").made == 0
    assert tree(tmp_path / "set") == tree(tmp_path / "whole")


def test_a_mistake_before_the_first_run_leaves_nothing(tmp_path, monkeypatch):
    def refuse(*_):
        raise UserError("not this machine")

    with monkeypatch.context() as patch:
        patch.setattr(generating, "warm_up", refuse)
        with pytest.raises(UserError, match="not this machine"):
            make(tmp_path / "set")
        assert not (tmp_path / "set").exists()
        (tmp_path / "set").mkdir()
        with pytest.raises(UserError, match="not this machine"):
            make(tmp_path / "set")
        assert not list((tmp_path / "set").iterdir())
    assert make(tmp_path / "set", name="mended").made == 2


def test_links_and_files_as_out(tmp_path):
    (tmp_path / "target").mkdir()
    (tmp_path / "link").symlink_to("target")
    assert make(tmp_path / "link").made == 2
    (tmp_path / "nowhere").symlink_to("gone")
    with pytest.raises(UserError, match="nowhere: is a link to gone, which is not there; give another directory"):
        make(tmp_path / "nowhere")
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises(UserError, match="loop: is a link to loop, which is not there"):
        make(tmp_path / "loop")
    (tmp_path / "file").write_text("x")
    with pytest.raises(UserError, match=r"file/set: cannot be written \(Not a directory\)"):
        make(tmp_path / "file/set")
    with pytest.raises(UserError, match="has a NUL character in it; give another directory"):
        make(f"{tmp_path}/a\0b")


@pytest.mark.parametrize("error", [OSError(errno.ENOLCK, "No locks available"), NotImplementedError("no flock")])
def test_a_file_system_without_locks_has_a_lock_file(tmp_path, monkeypatch, error):
    true = FileLock.acquire

    def acquire(lock, *arguments, **keywords):
        if lock.lock_file.endswith(".staging.lock"):
            raise error
        return true(lock, *arguments, **keywords)

    monkeypatch.setattr(FileLock, "acquire", acquire)
    with pytest.warns(RubgenWarning, match=r"no file locks there \(.+\); .staging.lock.soft is made instead"):
        assert make(tmp_path / "set").made == 2
    assert not list((tmp_path / "set").glob(".staging*"))
    (tmp_path / "other").mkdir()
    (tmp_path / "other/.staging.lock.soft").write_text("1\nelsewhere\n")
    with pytest.raises(UserError, match="another rubgen is writing there"), pytest.warns(RubgenWarning):
        make(tmp_path / "other")


def test_a_damaged_identity_says_so_and_deletes_nothing(tmp_path, monkeypatch):
    monkeypatch.setattr(Keeper, "begin", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        make(tmp_path / "set")
    Layout(tmp_path / "set").identity.write_text('{"recipe": {')
    with pytest.raises(UserError, match=r"identity\.json: damaged \(.+\), so nothing tells what the runs there are"):
        make(tmp_path / "set")


def test_what_was_kept_and_is_lost_or_damaged_since_is_made_again(tmp_path, monkeypatch):
    make(tmp_path / "whole")

    def stop(*_):
        raise KeyboardInterrupt

    for where, spoil in (("close_shard", "mcap/0000/run-000001.mcap"), ("close_shard", ".staging/kept/*/*.kept")):
        with monkeypatch.context() as patch:
            patch.setattr(f"rubgen.dataset.making.plan.{where}", stop)
            with pytest.raises(KeyboardInterrupt):
                make(tmp_path / "set")
        (path,) = list((tmp_path / "set").glob(spoil))[-1:]
        path.write_bytes(path.read_bytes()[:-1]) if "kept" in spoil else path.unlink()
        assert make(tmp_path / "set").made == 1
        assert tree(tmp_path / "set") == tree(tmp_path / "whole")
        shutil.rmtree(tmp_path / "set")


@pytest.mark.parametrize("spoil", ["runs", "sections", "closed"])
def test_a_closed_shard_that_lost_a_file_is_made_again(tmp_path, monkeypatch, spoil):
    make(tmp_path / "whole")
    with monkeypatch.context() as patch:
        patch.setattr(generating, "finish_set", lambda *_, **__: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            make(tmp_path / "set")
    (path,) = (tmp_path / "set/.staging" / spoil).iterdir()
    path.write_bytes(b"{}") if spoil == "closed" else path.unlink()
    with pytest.raises(RubgenError, match="give the same command again, it makes this shard anew"):
        make(tmp_path / "set")
    assert make(tmp_path / "set").made == 2
    assert tree(tmp_path / "set") == tree(tmp_path / "whole")


def test_what_differs_is_told_of_several_machines_and_of_the_sensors_of_a_split(tmp_path):
    def identity(*widths, noise=0):
        machines = [{"name": f"m{number}", "width": width} for number, width in enumerate(widths)]
        split_sensors = {"other": {"noise": noise}}
        return Identity(recipe={"runs": 4}, machine=machines, sensors={}, packages={}, split_sensors=split_sensors)

    for asked, difference in (
        (identity(1, 3), r"machine\.m1\.width = 2, asked for 3"),
        (identity(1, 2, noise=5), r"split_sensors\.other\.noise = 0, asked for 5"),
    ):
        with pytest.raises(UserError, match=rf"holds the output of another recipe \({difference}\)"):
            check_same(Layout(tmp_path), identity(1, 2), asked)


def test_another_recipe_is_told_by_the_name_of_the_sensor_that_differs(tmp_path):
    """Not by its place, which a sensor that is added before it changes."""

    def identity(*sensors):
        return Identity(recipe={"runs": 4}, machine={}, sensors={"sensors": list(sensors)}, packages={})

    x, y = {"name": "x", "range": [0, 1]}, {"name": "y", "range": [0, 2]}
    check_same(Layout(tmp_path), identity(x, y), identity(x, y))
    for asked, difference in (
        (identity(x, y | {"range": [0, 3]}), r"sensors\.sensors\.y\.range = \[0, 2\], asked for \[0, 3\]"),
        (identity({"name": "new"}, x, y), r"sensors\.sensors\.new\.name = None, asked for 'new'"),
    ):
        with pytest.raises(UserError, match=rf"holds the output of another recipe \({difference}\)"):
            check_same(Layout(tmp_path), identity(x, y), asked)
