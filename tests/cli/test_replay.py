"""`rubgen replay`: what it shows, what it writes, and what it refuses in one line."""

import dataclasses
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest
from PIL import Image
from rerun.chunk import RrdReader

from rubgen.io.mcap import write_mcap
from rubgen.viz import viewer
from rubgen.viz.replay import replay_of


@pytest.fixture(scope="module")
def mcap_file(rub_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("replay") / "run.mcap"
    write_mcap(rub_run, path)
    return path


def entities(path):
    return {chunk.entity_path for chunk in RrdReader(path).stream().to_chunks()}


def test_an_mcap_file_is_saved_as_a_replay(run, mcap_file, tmp_path):
    code, out, _ = run("replay", str(mcap_file), "--save", str(tmp_path / "a run.rrd"))
    assert (code, out) == (0, f"{tmp_path}/a run.rrd: open it with: rerun '{tmp_path}/a run.rrd'\n")
    expected = {
        "/machine/casing/ring",
        "/machine/rotor/blades",
        "/orbit/plane/path",
        "/contact/map",
        "/labels/scenario",
    }
    assert expected <= entities(tmp_path / "a run.rrd")


def test_pictures_need_no_screen(run, mcap_file, tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr("rubgen.viz.figures.snapshot.GIF_FRAMES", 3)
    files = tmp_path / "run.png", tmp_path / "run.gif"
    code, _, _ = run("replay", str(mcap_file), "--png", str(files[0]), "--time", "0.1", "--gif", str(files[1]))
    assert code == 0
    with Image.open(files[0]) as png, Image.open(files[1]) as gif:
        assert np.unique(np.asarray(png.convert("L"))).size > 20
        assert gif.n_frames == 3
    assert files[0].stat().st_size < 300_000


def test_force_replaces_files(run, mcap_file, tmp_path):
    for name in ("a.rrd", "a.png"):
        (tmp_path / name).write_bytes(b"mine")
    files = "--save", str(tmp_path / "a.rrd"), "--png", str(tmp_path / "a.png")
    assert run("replay", str(mcap_file), *files)[0] == 2
    assert run("replay", str(mcap_file), *files, "--force")[0] == 0
    assert min((tmp_path / name).stat().st_size for name in ("a.rrd", "a.png")) > 1000
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.png", "a.rrd"]


def test_a_damaged_file_is_shown_and_its_loss_told(run, mcap_file, tmp_path):
    data = bytearray(mcap_file.read_bytes())
    data[len(data) // 3] ^= 1
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)
    code, _, err = run("replay", str(damaged), "--save", str(tmp_path / "run.rrd"))
    assert code == 0
    assert "is damaged; lost: everything between" in err
    assert (tmp_path / "run.rrd").exists()


class MadeViewer:
    """Stands where the viewer's process would: it keeps its command and what the recording holds, and ends at once."""

    started: ClassVar[list[tuple[list[str], set[str]]]] = []
    code = 0

    def __init__(self, command):
        self.started.append((command[1:], entities(command[3])))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def poll(self):
        return self.code

    wait = poll


@pytest.fixture
def made_viewer(monkeypatch):
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(viewer.subprocess, "Popen", MadeViewer)
    monkeypatch.setattr(MadeViewer, "started", [])
    return MadeViewer


@pytest.mark.parametrize("web", [(), ("--web",)])
def test_the_viewer_gets_the_recording(run, mcap_file, made_viewer, web):
    assert run("replay", str(mcap_file), *web)[0] == 0
    ((command, shown),) = made_viewer.started
    assert command[:2] == ["-m", "rerun"]
    assert command[command.index("--bind") + 1] == "127.0.0.1"
    assert "/machine/rotor" in shown
    assert ("--web-viewer" in command) == bool(web)


@pytest.mark.parametrize("there", [True, False])
def test_a_viewer_that_cannot_be_executed_is_one_line(run, mcap_file, monkeypatch, tmp_path, there):
    program = tmp_path / "rerun"
    if there:
        program.write_text("no program")
    monkeypatch.setenv("RERUN_CLI_PATH", str(program))
    code, _, err = run("replay", str(mcap_file), "--web")
    assert (code, err.count("\n")) == (2, 1)
    assert f"{program}: the viewer's program {'may not be executed' if there else 'is not there'}; " in err


def test_a_process_that_cannot_be_started_is_one_line(run, mcap_file, monkeypatch):
    monkeypatch.setattr(viewer.sys, "executable", "/nowhere/python")
    code, _, err = run("replay", str(mcap_file), "--web")
    assert (code, err.count("\n")) == (2, 1)
    assert "the viewer cannot be started (/nowhere/python: No such file or directory); give --save" in err


def test_a_simulated_run_is_shown_straight_away(run, rub_run, made_viewer, monkeypatch):
    monkeypatch.setattr("rubgen.cli.commands.simulating.simulate", lambda _: rub_run)
    assert run("simulate", "--replay")[0] == 0
    ((_, shown),) = made_viewer.started
    assert {"/machine/rotor", "/orbit/plane/path"} <= shown


def test_a_run_is_not_simulated_where_it_could_not_be_shown(run, monkeypatch):
    for name in viewer.SCREENS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("rubgen.cli.commands.simulating.simulate", lambda _: pytest.fail("simulated"))
    code, _, err = run("simulate", "--replay")
    assert (code, err.count("\n")) == (2, 1)
    assert "no screen for the viewer" in err


class MadeClient:
    """Stands where the link to the viewer would: it answers at the third try and keeps where the cursor was put."""

    tries = 0
    put: ClassVar[list[tuple[str, float, str]]] = []

    @classmethod
    def connect(cls, url):
        cls.tries += 1
        if cls.tries == 1:
            raise ConnectionError("nobody there yet")
        assert url.startswith("rerun+http://127.0.0.1:")
        return cls()

    def get_state(self):
        return SimpleNamespace(views=["one"], loading=["a file"] if self.tries == 2 else [])

    def set_time(self, timeline, *, duration, play_state):
        self.put.append((timeline, duration, play_state))


def test_the_viewer_begins_at_the_turns_about_the_hardest_touch(run, rub_run, mcap_file, made_viewer, monkeypatch):
    monkeypatch.setattr("rerun.experimental.ViewerClient", MadeClient)
    monkeypatch.setattr(viewer.time, "sleep", lambda _: None)
    monkeypatch.setattr(made_viewer, "poll", lambda _: None)
    assert run("replay", str(mcap_file))[0] == 0
    frames = replay_of(rub_run).frames
    assert MadeClient.put == [("time", pytest.approx(frames.time[frames.dense == 1][0]), "playing")]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("none",), "none: cannot be read"),
        (("{mcap}", "run-000001", "--save", "{tmp}/a.rrd"), "is one run, not a data set"),
        (("{mcap}", "--save", "{tmp}/there.rrd"), "exists already; choose another name, or replace it with --force"),
        (("{mcap}", "--save", "{tmp}/a.mcap"), "end the name in .rrd"),
        (("{mcap}", "--save", "{tmp}/no/a.rrd"), "there is no directory"),
        (("{mcap}", "--png", "{tmp}/a.png", "--time", "9"), "lies outside the recording; give 0 to 0.3"),
        (("{mcap}", "--time", "0.1"), "goes with --png FILE"),
        (("{mcap}", "--web", "--save", "{tmp}/a.rrd"), "--web: opens the browser where no file is named; leave it out"),
        (("{mcap}", "--full", "--png", "{tmp}/a.png"), "--full: goes with the viewer or --save FILE; leave it out"),
        (("{mcap}",), "give --save FILE.rrd, --web, --png or --gif"),
        (("{tmp}/there.rrd", "--save", "{tmp}/a.rrd"), "for the Rerun viewer alone; open it with: rerun"),
        (("{tmp}/none.rrd", "--save", "{tmp}/a.rrd"), "none.rrd: cannot be read (No such file or directory)"),
        (("{tmp}", "--save", "{tmp}/a.rrd"), "no finished data set of rubgen"),
    ],
)
def test_mistakes_are_named_in_one_line(run, mcap_file, tmp_path, monkeypatch, arguments, message):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    (tmp_path / "there.rrd").write_bytes(b"")
    filled = [each.format(mcap=mcap_file, tmp=tmp_path) for each in arguments]
    if filled == ["none"]:
        filled += ["--save", str(tmp_path / "a.rrd")]
    code, out, err = run("replay", *filled)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert message in err
    assert [path.name for path in tmp_path.iterdir()] == ["there.rrd"]


def test_a_file_without_motion_has_no_picture(run, rub_run, tmp_path):
    bare = dataclasses.replace(rub_run, response=dataclasses.replace(rub_run.response, track=None))
    write_mcap(bare, tmp_path / "bare.mcap")
    code, _, err = run("replay", str(tmp_path / "bare.mcap"), "--png", str(tmp_path / "a.png"))
    assert code == 2
    assert "holds no motion, only signals" in err


def test_a_viewer_that_fails_is_told(run, mcap_file, made_viewer, monkeypatch):
    monkeypatch.setattr(made_viewer, "code", 1)
    code, _, err = run("replay", str(mcap_file))
    assert code == 2
    assert "the viewer ended with 1; give --save FILE.rrd" in err
