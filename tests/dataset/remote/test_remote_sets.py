"""Data sets at URLs: in memory://, and in a server that speaks S3 and is started here."""

import os
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import fsspec
import pytest

import rubgen
from rubgen.cli import main
from rubgen.dataset import shards
from rubgen.dataset.remote import store as stores
from rubgen.dataset.remote.push import push
from rubgen.io import places

SAMPLE = Path(__file__).parents[3] / "datasets" / "sample"
SERVER = """
import sys
from moto.moto_server.threaded_moto_server import ThreadedMotoServer
server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
server.start()
print(server.get_host_and_port()[1], flush=True)
sys.stdin.read()
"""
RECIPE = {
    "name": "small",
    "runs": 10,
    "machine": "zeng2019",
    "vary": {"free_penetration_m": -5e-5},
    "output": {"formats": ["parquet"], "signal_seconds": 0.1},
}


@pytest.fixture(scope="module")
def server():
    with subprocess.Popen(
        [sys.executable, "-c", SERVER],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as process:
        yield f"http://127.0.0.1:{process.stdout.readline().strip()}"
        process.stdin.close()


@pytest.fixture
def s3(server, monkeypatch):
    """The URL of an empty bucket."""
    for name, value in {"ENDPOINT_URL": server, "ACCESS_KEY_ID": "key", "SECRET_ACCESS_KEY": "hush"}.items():
        monkeypatch.setenv(f"AWS_{name}", value)
    monkeypatch.setenv("AWS_DEFAULT_REGION", "us-east-1")
    files = fsspec.filesystem("s3", skip_instance_cache=True)
    bucket = f"bucket-{os.urandom(4).hex()}"
    files.mkdir(bucket)
    fsspec.get_filesystem_class("s3").clear_instance_cache()
    return f"s3://{bucket}"


@pytest.fixture
def memory():
    """The URL of an empty place in memory."""
    yield "memory://place"
    fsspec.filesystem("memory").store.clear()


@pytest.fixture
def quick(monkeypatch, tmp_path):
    """Runs are refused at once, and a shard has four."""

    def refuse(scenario):
        raise rubgen.UserError(f"run {scenario.index} is made up")

    monkeypatch.setattr("rubgen.pipeline.simulate", refuse)
    monkeypatch.setattr(shards, "RUNS_PER_SHARD", 4)
    monkeypatch.setattr("rubgen.dataset.making.generate.warm_up", lambda *_: [])
    monkeypatch.setattr("rubgen.dataset.remote.making.cache_folder", lambda name: tmp_path / "cache" / name)
    monkeypatch.setattr("rubgen.dataset.remote.making.warn", lambda _text: None)


def contents(url):
    files, root = fsspec.url_to_fs(url)
    files.invalidate_cache()
    return {name.removeprefix(root).strip("/"): files.cat_file(name) for name in files.find(root)}


def tree(directory):
    files = [path for path in sorted(directory.rglob("*")) if path.is_file()]
    return {path.relative_to(directory).as_posix(): path.read_bytes() for path in files}


def called(*words):
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    return ended.value.code


def assert_same_runs(url):
    there, here = rubgen.open(url), rubgen.open(SAMPLE)
    assert there.runs.equals(here.runs)
    for run_id in here.ok.index:
        assert there.touches(run_id).equals(here.touches(run_id))
        for name, values in here.signals(run_id).items():
            assert (there.signals(run_id, [name])[name] == values).all()


def test_a_set_is_pushed_to_s3_and_read_there(s3, capsys):
    assert push(SAMPLE, f"{s3}/a/set") == 8
    assert contents(f"{s3}/a/set") == tree(SAMPLE)
    assert push(SAMPLE, f"{s3}/a/set/") == 0
    assert_same_runs(f"{s3}/a/set")
    assert called("info", f"{s3}/a/set") == 0
    assert "status         ok 4" in capsys.readouterr().out


def test_only_what_is_asked_for_is_read(memory, monkeypatch):
    push(SAMPLE, f"{memory}/set")
    read = []
    true = fsspec.get_filesystem_class("memory")._open

    def opened(self, path, *arguments, **options):
        read.append(path.removeprefix("/place/set/"))
        return true(self, path, *arguments, **options)

    monkeypatch.setattr(fsspec.get_filesystem_class("memory"), "_open", opened)
    data = rubgen.open(f"{memory}/set")
    assert set(read) <= {"manifest.json", "manifest.json.sha256"}
    assert len(data.ok) == 4
    assert "runs.parquet" in read
    assert not [name for name in read if name.startswith("signals/")]
    data.signals("run-000000", ["proximity_x"])
    assert [name for name in read if name.startswith("signals/")]
    assert not [name for name in read if name.startswith(("truth/", "windows/"))]


def test_features_and_exports_of_a_set_at_a_url_are_those_of_its_directory(memory, tmp_path):
    push(SAMPLE, f"{memory}/set")
    for place, name in ((f"{memory}/set", "there"), (str(SAMPLE), "here")):
        chosen = ["--channels", "proximity_x", "--out", str(tmp_path / name / "features.parquet")]
        (tmp_path / name).mkdir()
        assert called("features", place, "--set", "time", "--workers", "1", *chosen) == 0
        chosen[-1] = str(tmp_path / name / "export")
        assert called("export", place, "--format", "csv", *chosen) == 0
    assert len(tree(tmp_path / "here")) == 8
    assert tree(tmp_path / "there") == tree(tmp_path / "here")


class Stopped(BaseException):
    """A stop at any moment, as of Ctrl-C."""


def stop_after(monkeypatch, number):
    """Let the next puts stop the program after so many."""
    done = []
    true = stores.Store.put

    def put(self, file, name):
        if len(done) == number:
            raise Stopped
        done.append(name)
        true(self, file, name)

    monkeypatch.setattr(stores.Store, "put", put)
    return lambda: monkeypatch.setattr(stores.Store, "put", true)


def test_a_push_that_was_stopped_anywhere_goes_on_and_is_never_read_before(memory, monkeypatch):
    for number in range(11):
        url = f"{memory}/{number}"
        again = stop_after(monkeypatch, number)
        with pytest.raises(Stopped):
            push(SAMPLE, url)
        again()
        with pytest.raises(rubgen.UserError, match="no finished data set"):
            rubgen.open(url)
        assert push(SAMPLE, url) == 8 - min(max(number - 1, 0), 8)
        assert contents(url) == tree(SAMPLE)


def test_a_grown_set_replaces_the_smaller_one(memory, quick, monkeypatch, tmp_path):
    rubgen.generate(RECIPE, tmp_path / "set", workers=1)
    push(tmp_path / "set", f"{memory}/set")
    small = contents(f"{memory}/set")
    rubgen.generate(RECIPE, tmp_path / "set", runs=13, workers=1)
    again = stop_after(monkeypatch, 4)
    with pytest.raises(Stopped):
        push(tmp_path / "set", f"{memory}/set")
    again()
    with pytest.raises(rubgen.UserError, match="no finished data set"):
        rubgen.open(f"{memory}/set")
    push(tmp_path / "set", f"{memory}/set")
    assert contents(f"{memory}/set") == tree(tmp_path / "set") != small
    rubgen.generate(RECIPE, tmp_path / "small", workers=1)
    with pytest.raises(rubgen.UserError, match="holds 13 runs of this recipe, here are 10; it only grows"):
        push(tmp_path / "small", f"{memory}/set")


def test_a_set_is_made_at_s3_in_spite_of_stops_and_a_lost_folder(s3, quick, monkeypatch, tmp_path):
    rubgen.generate(RECIPE, tmp_path / "here", workers=1)
    url = f"{s3}/set"
    for number in (2, 7, 9):  # each time the marker, or one put of a shard more
        again = stop_after(monkeypatch, number)
        with pytest.raises(Stopped):
            rubgen.generate(RECIPE, url, workers=1)
        again()
        with pytest.raises(rubgen.UserError, match="it is unfinished"):
            rubgen.open(url)
    shutil.rmtree(tmp_path / "cache")
    made = rubgen.generate(RECIPE, url, workers=1)
    assert made.made < 10  # closed shards are there
    assert contents(url) == tree(tmp_path / "here")
    assert not list((tmp_path / "cache/sets").iterdir())
    assert rubgen.generate(RECIPE, url, workers=1).verified
    with pytest.raises(rubgen.UserError, match="it can only grow"):
        rubgen.generate(RECIPE, url, runs=3, workers=1)
    with pytest.raises(rubgen.UserError, match="rubgen push DIRECTORY s3://"):
        rubgen.generate(RECIPE, url, runs=30, workers=1)


@pytest.mark.parametrize("shard", [None, "1/2"])
def test_a_finished_set_at_a_url_that_lost_a_file_is_not_called_whole(memory, quick, shard, tmp_path):
    rubgen.generate(RECIPE, tmp_path / "set", workers=1)
    push(tmp_path / "set", f"{memory}/set")
    files = fsspec.filesystem("memory")
    files.pipe_file("/place/set/runs.parquet", b"cut")
    whole = (tmp_path / "set/runs.parquet").stat().st_size
    with pytest.raises(rubgen.UserError, match=rf"runs\.parquet: has 3 bytes, the manifest says {whole:,} \(1 problem"):
        rubgen.generate(RECIPE, f"{memory}/set", shard=shard, workers=1)
    files.rm_file("/place/set/sections/train-00000.parquet")
    advice = r"copy it again from a directory with this set: rubgen push DIRECTORY memory://place/set$"
    with pytest.raises(rubgen.UserError, match=rf"\(2 problems in all\); {advice}"):
        rubgen.generate(RECIPE, f"{memory}/set", shard=shard, workers=1)
    assert push(tmp_path / "set", f"{memory}/set") == 2
    assert rubgen.generate(RECIPE, f"{memory}/set", shard=shard, workers=1).verified


def test_parts_of_a_set_meet_at_the_url(memory, quick, tmp_path):
    rubgen.generate(RECIPE, tmp_path / "here", workers=1)
    for number in (2, 1, 3):
        rubgen.generate(RECIPE, f"{memory}/set", shard=f"{number}/3", workers=1)
    assert rubgen.generate(RECIPE, f"{memory}/set", finish=True, workers=1).made == 0
    assert contents(f"{memory}/set") == tree(tmp_path / "here")
    with pytest.raises(rubgen.UserError, match="the set has 3 shards, and parts at a URL cannot share one"):
        rubgen.generate(RECIPE, f"{memory}/other", shard="1/4", workers=1)


def test_what_is_at_the_url_already_is_left_alone(memory, quick, tmp_path):
    rubgen.generate(RECIPE, tmp_path / "set", workers=1)
    push(SAMPLE, f"{memory}/sample")
    before = contents(f"{memory}/sample")
    for write in (lambda url: push(tmp_path / "set", url), lambda url: rubgen.generate(RECIPE, url, workers=1)):
        with pytest.raises(rubgen.UserError, match="holds the output of another recipe"):
            write(f"{memory}/sample")
        assert contents(f"{memory}/sample") == before
        fsspec.filesystem("memory").pipe_file("/place/notes/mine.txt", b"mine")
        with pytest.raises(rubgen.UserError, match="not empty and no data set"):
            write(f"{memory}/notes")
        assert contents(f"{memory}/notes") == {"mine.txt": b"mine"}


def test_a_damaged_file_does_not_go_up(memory, tmp_path):
    shutil.copytree(SAMPLE, tmp_path / "set")
    with (tmp_path / "set/runs.parquet").open("r+b") as stream:
        stream.write(b"X")
    with pytest.raises(rubgen.UserError, match=r"runs.parquet: its sha256 is not the one in the manifest; mend it"):
        push(tmp_path / "set", f"{memory}/set")


def test_a_recipe_that_cannot_be_made_leaves_no_mark(memory, quick, monkeypatch):
    def impossible(*_):
        raise rubgen.UserError("impossible")

    monkeypatch.setattr("rubgen.dataset.making.generate.warm_up", impossible)
    with pytest.raises(rubgen.UserError, match="impossible"):
        rubgen.generate(RECIPE, f"{memory}/set", workers=1)
    assert contents(f"{memory}/set") == {}


@pytest.mark.parametrize(
    ("url", "said"),
    [
        ("nosuch://a/b", "nosuch://a/b: cannot be used (Unsupported filesystem: 'nosuch')"),
        ("s3://", "s3://: names no place in it; give a URL such as s3://bucket/set"),
        ("s3://me:hush@bucket/set", "s3://...: holds a name or a password; give them in the library's own way"),
        ("s3://not-there/set", "s3://not-there/set: cannot be used (The specified bucket does not exist)"),
        ("plain", "plain: is no URL of an object store; give one such as s3://bucket/set"),
    ],
)
def test_a_wrong_url_is_one_line(s3, capsys, url, said):
    assert called("push", str(SAMPLE), url) == 2
    errors = capsys.readouterr().err
    assert said in errors
    assert "Traceback" not in errors
    assert "hush" not in errors


def test_a_missing_library_is_one_line(monkeypatch):
    monkeypatch.setitem(sys.modules, "s3fs", None)
    monkeypatch.delitem(sys.modules["fsspec.registry"]._registry, "s3", raising=False)
    with pytest.raises(rubgen.UserError, match=r"its library is missing; install it: pip install 'rubgen\[remote\]'"):
        rubgen.open("s3://bucket/set")


def test_a_server_that_does_not_answer_is_one_line(s3, monkeypatch):
    monkeypatch.setattr(places, "PATIENCE_S", 0.3)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{silent.getsockname()[1]}")
        with pytest.raises(rubgen.UserError, match=r"its server does not answer within 0.3 s; check address"):
            rubgen.open(f"{s3}/set")


def test_a_server_that_refuses_is_one_line_with_the_url():
    with socket.create_server(("127.0.0.1", 0)) as there:
        url = f"http://127.0.0.1:{there.getsockname()[1]}/set"
    with pytest.raises(rubgen.UserError, match=rf"{url}: cannot be used \(Cannot connect .*\); give a place that "):
        rubgen.open(url)


def test_a_command_that_needs_a_directory_says_so(capsys):
    for command in ("repair", "verify"):
        assert called(command, "s3://bucket/set") == 2
        assert "s3://bucket/set: this command needs a directory" in capsys.readouterr().err


def test_what_needs_directories_says_so_and_writes_nothing(memory, tmp_path):
    url = f"{memory}/set"
    push(SAMPLE, url)
    before = contents(memory)
    for name, call in {
        "verify": lambda: rubgen.verify(url),
        "merge": lambda: rubgen.merge([url, SAMPLE], tmp_path / "out"),
        "resense": lambda: rubgen.resense(url, "rig", tmp_path / "out"),
    }.items():
        with pytest.raises(rubgen.UserError, match=f"^memory://place/set: {name} needs a directory; bring the files"):
            call()
    with pytest.raises(rubgen.UserError, match=r"^memory://place/new: merge needs a directory"):
        rubgen.merge([SAMPLE, tmp_path], f"{memory}/new")
    assert contents(memory) == before
    assert list(tmp_path.iterdir()) == []
