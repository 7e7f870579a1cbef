"""Progress of steps that take long: a bar on a terminal, a line in a notebook, else one line a minute.

Nothing is shown outside of a block `with shown()`. Worker processes have no such block, so they stay silent.
"""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

Report = Callable[[int, int], None]
"""Takes the number of finished parts and the number of all parts."""

SOON_S = 1.0
"""A step that ends within this time is not shown."""
EVERY_S = 60.0
"""Time between two lines where there is no terminal."""
COMPILING = "simulate (the kernels are compiled first, once, in about a minute)"
_NOTEBOOK = "ipykernel"


class Show(Protocol):
    """The interface of functions that show a step to the user, one step at a time."""

    def __call__(self, text: str, unit: str, *, long: bool) -> AbstractContextManager[Report]:
        """Show `text` while the block runs; yield a function that takes the progress. A `long` step shows at once."""
        ...


_showing: ContextVar[Show | None] = ContextVar("showing", default=None)
_counting: ContextVar[Report] = ContextVar("counting", default=lambda _done, _total: None)


@contextmanager
def step(text: str, unit: str = "", *, long: bool = False) -> Iterator[None]:
    """Show `text` while the block runs, if a surrounding block `with shown()` allows it.

    A step within a step is not shown.

    - `unit`: name of the parts that `count` reports, such as "turns"
    - `long`: show the step at once, not after SOON_S; for steps known to take more than a few seconds
    """
    show = _showing.get()
    around = show(text, unit, long=long) if show else nullcontext(_nothing)
    showing = _showing.set(None)
    try:
        with around as report:
            counting = _counting.set(report)
            try:
                yield
            finally:
                _counting.reset(counting)
    finally:
        _showing.reset(showing)


def count(done: int, total: int) -> None:
    """Report that `done` of `total` parts of the surrounding `step` are finished.

    Outside of a `step` nothing is done.
    """
    _counting.get()(done, total)


@contextmanager
def shown(wanted: bool | None = None) -> Iterator[None]:
    """Show the steps of the block on stderr.

    If `wanted` is None, they are shown only on a terminal or in a notebook; True shows them in a file too. False, or
    None elsewhere, changes nothing: what a surrounding `shown` allows is still shown.
    """
    show = _way(wanted)
    token = _showing.set(show) if show else None
    try:
        yield
    finally:
        if token:
            _showing.reset(token)


def _way(wanted: bool | None) -> Show | None:
    if wanted is False:
        return None
    if sys.stderr is not None and sys.stderr.isatty():
        return _bar
    if _NOTEBOOK in sys.modules:
        return partial(_written, SOON_S, "\r{:<78}", f"\r{'':<78}\r")
    return partial(_written, EVERY_S, "rubgen: {}\n", "") if wanted else None


def _nothing(_done: int, _total: int) -> None:
    """Report nothing."""


@contextmanager
def _bar(text: str, unit: str, *, long: bool) -> Iterator[Report]:
    """Show a bar on the terminal; it disappears when the step ends."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = SpinnerColumn(), TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[state]}")
    bar = Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True)
    task = bar.add_task(text, total=None, state="")
    so_far = _SoFar(text, unit)

    def report(done: int, total: int) -> None:
        so_far.done, so_far.total = done, total
        bar.update(task, completed=done, total=total, state=so_far.state())

    timer = threading.Timer(0.0 if long else SOON_S, bar.start)
    timer.daemon = True
    timer.start()
    try:
        yield report
    finally:
        timer.cancel()
        timer.join()
        bar.stop()


@dataclass
class _SoFar:
    """The state of a step."""

    text: str
    unit: str
    done: int = 0
    total: int = 0
    start: float = field(default_factory=lambda: time.monotonic())
    first: int | None = None
    """Parts that were finished before the step began; they took no time of it."""

    def state(self) -> str:
        """Return "3 of 10 turns, about 5 s left": finished parts, all parts, and the time left at the rate so far."""
        if not self.total:
            return ""
        if self.first is None:
            self.first = self.done
        counted = f"{self.done:,} of {self.total:,} {self.unit}".rstrip()
        new = self.done - self.first
        if not new or self.done >= self.total:
            return counted
        left = (self.total - self.done) * (time.monotonic() - self.start) / new
        return f"{counted}, about {_duration(left)} left"

    def line(self) -> str:
        """Return the text of the step, its state and the time since its start."""
        passed = time.monotonic() - self.start
        parts = [self.state(), f"{_duration(passed)} so far" if passed > SOON_S else ""]
        return ": ".join(filter(None, (self.text, ", ".join(filter(None, parts)))))


@contextmanager
def _written(every: float, line: str, end: str, text: str, unit: str, *, long: bool) -> Iterator[Report]:
    """Write `line` to stderr every `every` seconds, a long step at once too, and `end` when the step ends.

    A thread writes: the step may report nothing for a long time. In a notebook the line is rewritten and then cleared.
    """
    so_far = _SoFar(text, unit)
    ended = threading.Event()
    stream = sys.stderr

    def report(done: int, total: int) -> None:
        so_far.done, so_far.total = done, total
        so_far.state()

    def tell() -> None:
        while not ended.wait(every):
            stream.write(line.format(so_far.line()))
            stream.flush()

    if long:
        stream.write(line.format(so_far.line()))
        stream.flush()
    thread = threading.Thread(target=tell, daemon=True)
    thread.start()
    try:
        yield report
    finally:
        ended.set()
        thread.join()
        stream.write(end)


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{max(1, round(seconds))} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
