"""Open Rerun's viewer for one replay, until it is closed, or start it on a catalog."""

import os
import socket
import subprocess
import sys
import tempfile
import time
from importlib.util import find_spec
from pathlib import Path

from rubgen.errors import UserError, os_reason
from rubgen.viz.replay import Replay

HOST = "127.0.0.1"
OPENING_TRIES = 100
PROGRAMS = ("rerun", "rerun.exe", "Rerun.app/Contents/MacOS/Rerun")
"""Paths of the viewer's program in the package rerun_cli on different systems."""
ELSEWHERE = "give --save FILE.rrd and open that file elsewhere"
SCREENS = ("DISPLAY", "WAYLAND_DISPLAY")


def open_viewer(replay: Replay, *, web: bool = False, full: bool = False) -> None:
    """Show a replay in Rerun's viewer, and return when the viewer is closed or interrupted (Ctrl+C).

    - web: show it in the browser, served to this computer only until interrupted.
    - full: with every sample and every touch.

    Raises UserError where the viewer cannot be started or ends with an error, OSError where its file cannot be written.
    """
    from rubgen.viz.rerun import write_replay

    with tempfile.TemporaryDirectory(prefix="rubgen-") as folder:
        path = Path(folder) / f"{replay.scenario.run_id}.rrd"
        write_replay(replay, path, full=full)
        _open(path, _first_moment(replay), web=web)


def has_screen() -> bool:
    """Return whether a window can be opened. It is known only on Linux; on other systems it is True."""
    return not sys.platform.startswith("linux") or any(os.environ.get(name) for name in SCREENS)


def _first_moment(replay: Replay) -> float:
    """Return the time of the first turn around the hardest touch, s."""
    frames = replay.frames
    if frames is None or not frames.dense.any():
        return replay.hardest_touch
    return float(frames.time[frames.dense == 1][0])


def _open(path: Path, moment: float, *, web: bool) -> None:
    """Open Rerun's viewer at a moment (s), or its web viewer for this machine only, until it is closed."""
    command, port = _command(str(path), web=web)
    with _started(command) as viewer:
        try:
            if not web:
                _go_to(moment, port, viewer)
            code = viewer.wait()
        except KeyboardInterrupt:
            viewer.terminate()
            viewer.wait()
            return
    if code != 0:
        raise UserError(f"the viewer ended with {code}; {ELSEWHERE}")


def start_viewer(source: str, *, web: bool) -> subprocess.Popen[bytes]:
    """Start Rerun's viewer, or with `web` its web viewer for this computer only, on the address `source`.

    Raises UserError where it cannot be started.
    """
    return _started(_command(source, web=web)[0])


def _command(source: str, *, web: bool) -> tuple[list[str], int]:
    """Return the command of a viewer that opens a file or an address, and the port at which it listens."""
    with socket.socket() as free:
        free.bind((HOST, 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-m", "rerun", source, "--hide-welcome-screen", "--bind", HOST, "--port", str(port)]
    return ([*command, "--web-viewer"] if web else command), port


def _started(command: list[str]) -> subprocess.Popen[bytes]:
    """Start the viewer. Raises UserError where its program is missing, cannot be executed, or does not start."""
    package = find_spec("rerun_cli")
    folder = Path(package.origin if package and package.origin else "rerun_cli/__init__.py").parent
    named = os.environ.get("RERUN_CLI_PATH")  # which rerun follows
    places = [Path(named)] if named else [folder / name for name in PROGRAMS]
    program = next((place for place in places if place.exists()), None)
    if program is None:
        raise UserError(f"{places[0]}: the viewer's program is not there; install rerun-sdk again, or {ELSEWHERE}")
    if not os.access(program, os.X_OK):
        raise UserError(f"{program}: the viewer's program may not be executed; make it executable, or {ELSEWHERE}")
    try:
        return subprocess.Popen(command)  # noqa: S603 - our own interpreter
    except OSError as error:
        raise UserError(f"the viewer cannot be started ({os_reason(error)}); {ELSEWHERE}") from None


def _go_to(moment: float, port: int, viewer: subprocess.Popen[bytes]) -> None:
    """Put the cursor at a moment, because a file cannot set it. A viewer that does not answer is ignored."""
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
