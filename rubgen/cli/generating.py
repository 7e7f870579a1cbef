"""`rubgen generate`: progress for people, a summary for programs."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import which
from types import FrameType

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, ProgressColumn, Task, TextColumn, TimeRemainingColumn
from rich.text import Text

from rubgen.cli.printing import print_json, say
from rubgen.dataset.generate import Generated, finished_runs, generate


class Rate(ProgressColumn):
    """Runs a minute, or whatever is counted."""

    def __init__(self, unit: str) -> None:
        super().__init__()
        self.unit = unit

    def render(self, task: Task) -> Text:
        """The rate so far, or dots before the first is done."""
        return Text(f"{60 * task.speed:.1f} {self.unit}/min" if task.speed else f"... {self.unit}/min")


def generate_command(recipe: Path | None, out: Path, runs: int | None, workers: int | None, *, as_json: bool) -> int:
    """Generate, and say what was made; a Ctrl-C says how to go on."""
    console = Console(stderr=True, quiet=as_json)
    try:
        with terminable(), shown_progress(console, "runs") as progress:
            made = generate(recipe, out, runs=runs, workers=workers, progress=progress)
    except KeyboardInterrupt:
        Console(stderr=True, soft_wrap=True).print(
            f"rubgen: interrupted; {finished_runs(out)} finished runs are kept in {out}: "
            "the same command makes the rest",
            highlight=False,
        )
        return 130
    _report(made, as_json=as_json)
    return 0


@contextmanager
def shown_progress(console: Console, unit: str) -> Iterator[Callable[[int, int], None]]:
    """A progress bar that appears with the first report: what is refused before shows its one line alone."""
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Rate(unit), TimeRemainingColumn())
    bar = Progress(*columns, console=console)
    task = bar.add_task(unit, total=None)

    def report(done: int, total: int) -> None:
        bar.start()
        bar.update(task, completed=done, total=total)

    try:
        yield report
    finally:
        if bar.live.is_started:
            bar.stop()


@contextmanager
def terminable() -> Iterator[None]:
    """A polite kill ends like Ctrl-C, and so does Ctrl-C where the shell has switched it off."""

    def interrupt(_signal: int, _frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    saved = {name: signal.signal(name, interrupt) for name in (signal.SIGTERM, signal.SIGINT)}
    try:
        yield
    finally:
        for name, handler in saved.items():
            signal.signal(name, handler)


def _report(made: Generated, *, as_json: bool) -> None:
    if as_json:
        print_json(
            {"directory": str(made.directory), "runs": made.runs, "made": made.made, "status": dict(made.status)}
        )
    elif made.made == 0:
        say(f"{made.directory}: complete and verified, {made.runs} runs; nothing to do")
    else:
        status = ", ".join(f"{count} {name}" for name, count in made.status.items())
        say(f"{made.directory}: {made.runs} runs ({status}), {made.made} of them new")
    if not as_json:
        for line in _ways_to_look(made.directory):
            say(line)


def _ways_to_look(directory: Path) -> Iterator[str]:
    """What stands where, and the command that shows it."""
    yield f"  {directory}/runs.parquet, data/: parameters, labels, signals; for pandas, polars, datasets"
    recordings = sorted((directory / "rrd").glob("*.rrd"))
    if recordings:
        yield f"  see a run:      {_command('rerun')} {recordings[0]}"
    if (directory / "mcap").is_dir():
        yield f"  for Foxglove:   {directory}/mcap/"
    yield f"  count classes:  {_command('rubgen')} info {directory}"
    yield f"  check it all:   {_command('rubgen')} verify {directory}"
    yield f"  {directory}/README.md tells what every column means and how to load it"


def _command(name: str) -> str:
    """How to call a program of this environment from here: by name where the shell finds it, else by path."""
    return name if which(name) else os.path.relpath(Path(sys.executable).with_name(name))
