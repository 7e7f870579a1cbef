"""The command `rubgen replay`: a run in the viewer, in the browser, or as a file or picture."""

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rubgen.brief import in_shell
from rubgen.cli.printing import check_new_file, say, write_file
from rubgen.errors import UserError
from rubgen.progress import step
from rubgen.viz.replay import Replay
from rubgen.viz.viewer import has_screen, open_viewer


@dataclass(frozen=True, kw_only=True)
class Showing:
    """The user's options for showing a replay.

    If a file is named (`save`, `gif`, `png`, `foxglove`), the replay is written. Else it is shown in the viewer or,
    with `web`, in the browser.
    """

    save: Path | None = None
    gif: Path | None = None
    png: Path | None = None
    foxglove: Path | None = None
    time: float | None = None
    web: bool = False
    full: bool = False
    force: bool = False

    @property
    def files(self) -> bool:
        """Whether any file is named."""
        return any((self.save, self.gif, self.png, self.foxglove))

    def check(self) -> None:
        """Check the options before any work.

        Raises UserError where a file exists and `force` is False, a file cannot be written, an option lacks its file or
        excludes another, or a viewer needs a screen and there is none.
        """
        for option, path, ending in (
            ("--save", self.save, ".rrd"),
            ("--gif", self.gif, ".gif"),
            ("--png", self.png, ".png"),
            ("--foxglove", self.foxglove, ".json"),
        ):
            if path is not None:
                check_new_file(option, path, (ending,), force=self.force)
        if self.time is not None and self.png is None:
            raise UserError(f"--time {self.time:g}: goes with --png FILE; name the file")
        if self.web and self.files:
            raise UserError("--web: opens the browser where no file is named; leave it out, or the files")
        if self.full and self.files and self.save is None:
            raise UserError("--full: goes with the viewer or --save FILE; leave it out, or name that file")
        if not (self.files or self.web) and not has_screen():
            raise UserError(
                "there is no screen for the viewer (DISPLAY is not set); give --save FILE.rrd, --web, --png or --gif"
            )


def replay_command(source: Path, run_id: str | None, where: str | None, showing: Showing) -> int:
    """Find a run as `find_replay` does, print the remarks on it to stderr, and `show` it. Returns the exit code 0.

    `source`, `run_id` and `where` are as in `find_replay`, `showing` are the user's options. Raises UserError as
    `find_replay` and `Showing.check` do, and where a file cannot be written.
    """
    showing.check()
    from rubgen.dataset.reading.replaying import find_replay

    found = find_replay(source, run_id, where)
    for remark in found.remarks:
        sys.stderr.write(f"rubgen: {remark}\n")
    show(found.replay, showing)
    return 0


def show(replay: Replay, showing: Showing) -> None:
    """Write the requested files, or open the viewer and wait until it is closed."""
    from rubgen.io.mcap.layout import foxglove_layout
    from rubgen.viz.rerun import write_replay

    if showing.save:
        write_file("--save", showing.save, lambda part: write_replay(replay, part, full=showing.full))
        say(f"{showing.save}: open it with: rerun {in_shell(showing.save)}")
    if showing.foxglove:
        text = json.dumps(foxglove_layout(replay.recording), indent=2)
        write_file("--foxglove", showing.foxglove, lambda part: part.write_text(f"{text}\n", encoding="utf-8"))
        say(f"{showing.foxglove}: in Foxglove, import this layout and open an MCAP file of the same sensors")
    _write_pictures(replay, showing)
    if not showing.files:
        if showing.web:
            say("close it with Ctrl-C")
        open_viewer(replay, web=showing.web, full=showing.full)


def _write_pictures(replay: Replay, showing: Showing) -> None:
    if not (showing.gif or showing.png):
        return
    from rubgen.viz.figures.snapshot import picture, write_gif
    from rubgen.viz.figures.style import save_png

    def attempt(option: str, path: Path, make: Callable[[Path], None]) -> None:
        write_file(option, path, make)
        say(str(path))

    if showing.png:
        attempt("--png", showing.png, lambda part: save_png(picture(replay, showing.time), part))
    if showing.gif:
        with step("draw the animation", "frames"):
            attempt("--gif", showing.gif, lambda part: write_gif(replay, part))
