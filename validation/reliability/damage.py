"""One damage in one file of a finished set: `rubgen verify` finds it, every reader is right or says one line."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

import numpy as np

from validation.reliability.guarded import GOOD, outcomes
from validation.reliability.processes import start
from validation.reliability.rows import Row, timed
from validation.reliability.sets import Truth, undisturbed

FORMATS = ("parquet", "mcap", "rrd")
SHOW_EVERY, COMMAND_EVERY = 41, 31
"""Every so many cases is drawn as a replay and a report, and is given to the command line."""
MEMORY = 4 * 1024**3
"""Rerun reserves much more than it uses."""
Change = Callable[[bytes, np.random.Generator], bytes]


def flipped(content: bytes, generator: np.random.Generator) -> bytes:
    """One bit, at the ends as often as in the middle: there stands what describes the rest."""
    data = bytearray(content)
    data[_place(len(data), generator)] ^= 1 << int(generator.integers(8))
    return bytes(data)


def cut(content: bytes, generator: np.random.Generator) -> bytes:
    """What a copy that was stopped leaves."""
    return content[: int(generator.integers(len(content)))]


def zeroed(content: bytes, generator: np.random.Generator) -> bytes:
    """A block that was never written."""
    start, length = _place(len(content), generator), int(generator.choice([1, 16, 512, 4096]))
    return content[:start] + bytes(len(content[start : start + length])) + content[start + length :]


def _place(length: int, generator: np.random.Generator) -> int:
    near = int(generator.integers(0, min(length, 2048)))
    return [near, length - 1 - near, int(generator.integers(0, length))][generator.integers(3)]


def damage_rows(tries: int) -> Iterator[Row]:
    """Single bits, and coarser damage, equally often in every kind of file."""
    with undisturbed(FORMATS) as truth:
        target = Target(truth)
        yield _row(target, "one flipped bit in a file of a set", [flipped], tries)
        yield _row(target, "a file cut, zeroed or swapped", [cut, zeroed, "swapped"], tries)


def _row(target: Target, name: str, changes: list[Change | str], tries: int) -> Row:
    row = Row(name)
    with timed(row):
        for case, outcome in outcomes(partial(target.tried, changes), range(tries), memory=MEMORY):
            row.tries += 1
            if outcome not in GOOD:
                column = outcome.partition(":")[0]
                row.fail(column if column in ("missed", "differing") else "tracebacks", f"case {case}: {outcome}")
    return row


@dataclass
class Target:
    """The set that is damaged, and what it says undamaged."""

    truth: Truth

    @cached_property
    def files(self) -> list[Path]:
        """One file of each kind after another, so that kinds are hit equally often."""
        found = sorted(path for path in self.truth.directory.rglob("*") if path.is_file())
        kinds = {
            str(path.parent) + path.suffix + (path.name if path.parent == self.truth.directory else ""): path
            for path in found
        }
        return list(kinds.values())

    @cached_property
    def said(self) -> dict[str, object]:
        """All that readers give of the whole set."""
        return readings(self.truth.directory)

    def tried(self, changes: list[Change | str], case: int) -> str:
        """Damage, look, mend; gives the outcome."""
        self.said  # noqa: B018 - read before any damage
        generator = np.random.default_rng(case)
        path, change = self.files[case % len(self.files)], changes[case // len(self.files) % len(changes)]
        whole = path.read_bytes()
        damaged = self._swapped(path) if isinstance(change, str) else change(whole, generator)
        if damaged == whole:
            return "right"
        try:
            path.write_bytes(damaged)
            return self._look(case, path)
        finally:
            path.write_bytes(whole)

    def _swapped(self, path: Path) -> bytes:
        """The content of another run, or else of another file."""
        others = sorted(other for other in path.parent.iterdir() if other.is_file() and other != path)
        same = [other for other in others if other.suffix == path.suffix]
        return (same or others or [self.truth.recipe])[0].read_bytes()

    def _look(self, case: int, path: Path) -> str:
        if not _found(self.truth.directory):
            return f"missed: {path.relative_to(self.truth.directory)}"
        if case % COMMAND_EVERY == 1:
            process = start(["verify", str(self.truth.directory)], self.truth.folder / "verify.log")
            if process.end() not in (1, 2) or "Traceback" in process.output:
                return f"verify ends with {process.code}: {process.output[-200:]!r}"
        if case % SHOW_EVERY == SHOW_EVERY - 1:
            _shown(self.truth.directory, self.truth.folder / "shown")
        wrong = [name for name, value in readings(self.truth.directory).items() if value not in (None, self.said[name])]
        return f"differing: {path.name}: {', '.join(wrong)}" if wrong else "right"


def _found(directory: Path) -> bool:
    import rubgen
    from rubgen.errors import UserError

    try:
        return bool(rubgen.verify(directory))
    except UserError:
        return True


def readings(directory: Path) -> dict[str, object]:
    """What each reader gives, as bytes; None where it says one line, or says what is lost."""
    import rubgen

    readers: dict[str, Callable[[], object]] = {"runs": lambda: rubgen.open(directory).runs.to_json()}
    for run_id in ("run-000000", "run-000001"):
        readers[f"signals of {run_id}"] = partial(_signals, directory, run_id)
        readers[f"replay of {run_id}"] = partial(_replay, directory, run_id)
    readers["labels again"] = partial(_labels, directory)
    return {name: _or_one_line(read) for name, read in readers.items()}


def _or_one_line(read: Callable[[], object]) -> object:
    from rubgen.errors import UserError

    try:
        return read()
    except UserError as error:
        if "\n" in str(error):
            raise
        return None


def _signals(directory: Path, run_id: str) -> object:
    import rubgen

    return {name: values.tobytes() for name, values in rubgen.open(directory).signals(run_id).items()}


def _replay(directory: Path, run_id: str) -> object:
    from rubgen.dataset.reading.replaying import find_replay

    found = find_replay(directory, run_id)
    channels = found.replay.recording.channels.items()
    return None if found.remarks else {name: channel.values.tobytes() for name, channel in channels}


def _labels(directory: Path) -> object:
    from rubgen.dataset.checking.relabel import relabel

    return None if relabel(directory).differences else True


def _shown(directory: Path, place: Path) -> None:
    """Pages and replays are made, or refused in one line."""
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    for number, words in enumerate(
        (
            ["report", str(directory), "--out", str(place / "page.html")],
            ["replay", str(directory), "run-000001", "--save", str(place / "run.rrd")],
        )
    ):
        process = start(words, place / f"{number}.log")
        if process.end() not in (0, 2) or "Traceback" in process.output:
            raise RuntimeError(f"{words[0]} ends with {process.code}: {process.output[-300:]!r}")
