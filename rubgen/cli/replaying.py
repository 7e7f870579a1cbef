"""`rubgen replay`: a run in the viewer, in the browser, or as a file or picture."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rubgen.cli.printing import say
from rubgen.errors import UserError
from rubgen.viz.replay import Replay

HOST = "127.0.0.1"
OPENING_TRIES = 100
SCREENS = ("DISPLAY", "WAYLAND_DISPLAY")


@dataclass(frozen=True, kw_only=True)
class Showing:
    """How a replay is shown: as files where any is named, else in the viewer or, with `web`, in the browser."""

    save: Path | None = None
    gif: Path | None = None
    png: Path | None = None
    time: float | None = None
    web: bool = False
    full: bool = False

    def check(self) -> None:
        """Raise UserError, before any work, where a file exists or cannot be, or there is nothing to show it with."""
        for option, path, ending in (
            ("--save", self.save, ".rrd"),
            ("--gif", self.gif, ".gif"),
            ("--png", self.png, ".png"),
        ):
            if path is not None:
                check_new_file(option, path, (ending,))
        if self.time is not None and self.png is None:
            raise UserError(f"--time {self.time:g}: goes with --png FILE; name the file")
        if not (self.save or self.gif or self.png or self.web) and not has_screen():
            raise UserError(
                "there is no screen for the viewer (DISPLAY is not set); give --save FILE.rrd, --web, --png or --gif"
            )


def replay_command(source: Path, run_id: str | None, where: str | None, showing: Showing) -> int:
    """Find the run, say what there is to know of it, and show it."""
    showing.check()
    from rubgen.dataset.replaying import find_replay

    found = find_replay(source, run_id, where)
    for remark in found.remarks:
        sys.stderr.write(f"rubgen: {remark}\n")
    show(found.replay, showing)
    return 0


def show(replay: Replay, showing: Showing) -> None:
    """Write the files that are asked for, or open the viewer and wait until it is closed."""
    from rubgen.viz.rerun import write_replay

    try:
        if showing.save:
            write_replay(replay, showing.save, full=showing.full)
            say(f"{showing.save}: open it with: rerun {showing.save}")
        _write_pictures(replay, showing)
        if not (showing.save or showing.gif or showing.png):
            with tempfile.TemporaryDirectory(prefix="rubgen-") as folder:
                path = Path(folder) / f"{replay.scenario.run_id}.rrd"
                write_replay(replay, path, full=showing.full)
                _open(path, _first_moment(replay), web=showing.web)
    except OSError as error:
        raise UserError(
            f"{error.filename or 'file'}: cannot be written ({error.strerror or error}); choose another place"
        ) from None


def _first_moment(replay: Replay) -> float:
    """Where the turns about the hardest touch begin."""
    frames = replay.frames
    if frames is None or not frames.dense.any():
        return replay.hardest_touch
    return float(frames.time[frames.dense == 1][0])


def _write_pictures(replay: Replay, showing: Showing) -> None:
    if not (showing.gif or showing.png):
        return
    from rubgen.viz.figures.style import save_png
    from rubgen.viz.snapshot import picture, write_gif

    def attempt(make: Callable[[], None]) -> None:
        try:
            make()
        except ValueError as error:
            raise UserError(str(error)) from None

    if showing.png:
        png = showing.png
        attempt(lambda: save_png(picture(replay, showing.time), png))
        say(str(png))
    if showing.gif:
        gif = showing.gif
        attempt(lambda: write_gif(replay, gif))
        say(str(gif))


def _open(path: Path, moment: float, *, web: bool) -> None:
    """Rerun's viewer at a moment (s), or its web viewer for this machine alone, until it is closed."""
    with socket.socket() as free:
        free.bind((HOST, 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "rerun", str(path), "--hide-welcome-screen", "--bind", HOST, "--port", str(port)]
    if web:
        say("close it with Ctrl-C")
    with subprocess.Popen([*command, "--web-viewer"] if web else command) as viewer:  # noqa: S603 - our own interpreter
        try:
            if not web:
                _go_to(moment, port, viewer)
            code = viewer.wait()
        except KeyboardInterrupt:
            viewer.terminate()
            viewer.wait()
            return
    if code != 0:
        raise UserError(f"the viewer ended with {code}; give --save FILE.rrd and open that file elsewhere")


def _go_to(moment: float, port: int, viewer: subprocess.Popen[bytes]) -> None:
    """Put the cursor there, as a file cannot say where it begins; a viewer that does not answer is left as it is."""
    from rerun.experimental import ViewerClient

    for _ in range(OPENING_TRIES):
        if viewer.poll() is not None:
            return
        try:
            client = ViewerClient.connect(f"rerun+http://{HOST}:{port}/proxy")
            state = client.get_state()
            if state.views and not state.loading:
                client.set_time("time", duration=moment, play_state="playing")
                return
        except (ConnectionError, RuntimeError, ValueError):
            pass
        time.sleep(0.2)


def has_screen() -> bool:
    """Whether a window can be opened; other systems than Linux have one."""
    return not sys.platform.startswith("linux") or any(os.environ.get(name) for name in SCREENS)


def check_new_file(option: str, path: Path, endings: tuple[str, ...]) -> None:
    """Raise UserError for a file that exists, a folder that does not, or a name with another ending."""
    if path.suffix not in endings:
        raise UserError(f"{option} {path}: unknown kind of file; end the name in {' or '.join(endings)}")
    if path.exists():
        raise UserError(f"{option} {path}: exists already; delete it or choose another name")
    if not path.parent.is_dir():
        raise UserError(f"{option} {path}: there is no directory {path.parent}; make it first")
