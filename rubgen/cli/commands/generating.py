"""The commands `rubgen generate`, `resense`, `merge` and `push`: progress for people, a summary for programs."""

import dataclasses
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from shutil import which

from rubgen.brief import counted, in_shell
from rubgen.cli.interrupts import terminable
from rubgen.cli.printing import print_json, say
from rubgen.dataset.making.generate import Generated, generate
from rubgen.dataset.making.outcome import finished_runs
from rubgen.dataset.making.resense import resense
from rubgen.dataset.merging.merge import merge
from rubgen.dataset.remote.making import RemoteMaking
from rubgen.dataset.remote.push import push
from rubgen.formats import run_formats
from rubgen.io.places import is_url
from rubgen.progress import shown


@dataclass(frozen=True, kw_only=True)
class Work:
    """Which runs are made and by which workers; the fields are parameters of `rubgen.generate`."""

    workers: int | None
    scheduler: str | None
    shard: str | None
    finish: bool


def generate_command(recipe: Path | None, out: Path, runs: int | None, work: Work, *, as_json: bool) -> int:
    """Generate a data set and print a summary. Parameters, with the fields of `work`, are as in `rubgen.generate`.

    Errors are as there. With `as_json` the summary is JSON, and no progress is shown. Returns the exit code 1 where no
    run of the set is ok, else 0. For a part of a set (`work.shard`) it is always 0. After Ctrl-C it prints how to
    continue and returns 130.
    """
    made = partial(generate, recipe, out, runs=runs, progress=not as_json, **dataclasses.asdict(work))
    kept_in = RemoteMaking(str(out), work.shard or "").layout.root if is_url(out) else out
    return _made_in(out, made, kept_in, as_json=as_json)


def resense_command(directory: Path, sensors: str, out: Path, workers: int | None, *, as_json: bool) -> int:
    """Make a data set again with other sensors and print a summary. Parameters and errors are as in `resense`.

    With `as_json` the summary is JSON, and no progress is shown. Returns the exit code 1 where no run of the set is ok,
    else 0. After Ctrl-C it prints how to continue and returns 130.
    """
    made = partial(resense, directory, sensors, out, workers=workers, progress=not as_json)
    return _made_in(out, made, out, as_json=as_json)


def merge_command(directories: Sequence[Path], out: Path, *, as_json: bool) -> int:
    """Merge data sets and print a summary. Parameters and errors are as in `rubgen.merge`.

    With `as_json` the summary is JSON, and no progress is shown. Returns the exit code 1 where no run of the set is ok,
    else 0. After Ctrl-C it prints how to continue and returns 130.
    """
    return _made_in(out, partial(merge, directories, out, progress=not as_json), out, as_json=as_json)


def push_command(directory: Path, url: str, *, as_json: bool) -> int:
    """Copy a finished data set to a URL and print the number of files copied. Returns the exit code 0.

    With `as_json` the number is printed as JSON. After Ctrl-C it prints how to continue and returns 130. Errors are as
    in `push`.
    """
    try:
        with terminable(), shown(not as_json and None):
            files = push(directory, url)
    except KeyboardInterrupt:
        sys.stderr.write("rubgen: interrupted; files so far are there: the same command copies the rest\n")
        return 130
    if as_json:
        print_json({"directory": str(directory), "url": url, "files": files})
    else:
        say(f"{url}: complete, {counted(files, 'file')} copied; read it: rubgen.open({url!r})")
    return 0


def _made_in(out: Path, make: Callable[[], Generated], kept_in: Path, *, as_json: bool) -> int:
    try:
        with terminable():
            made = make()
    except KeyboardInterrupt:
        sys.stderr.write(
            f"rubgen: interrupted; kept in {out}: {counted(finished_runs(kept_in), 'finished run')}; "
            "the same command makes the rest\n"
        )
        return 130
    _report(made, as_json=as_json)
    if made.part or "ok" in made.status:
        return 0
    sys.stderr.write(
        f"rubgen: {made.directory}: no run is ok; the reason of each: rubgen info {in_shell(made.directory)}\n"
    )
    return 1


def _report(made: Generated, *, as_json: bool) -> None:
    if as_json:
        print_json(dataclasses.asdict(made) | {"directory": str(made.directory)})
        return
    if made.part:
        say(f"{made.directory}: part {made.part}: {made.made} new; after the last part: --finish in place of --shard")
        return
    for line in (*_what_was_made(made), *_ways_to_look(made.directory)):
        say(line)


def _what_was_made(made: Generated) -> Iterator[str]:
    """Yield counts of runs, rub and classes, then each kind of failure with its shortest reason."""
    outcome = made.outcome
    status = ", ".join(f"{made.status[name]} {name}" for name in sorted(made.status, key=lambda name: name != "ok"))
    done = "nothing to do, all files are there" if made.verified else f"{made.made} new"
    yield f"{made.directory}: {counted(made.runs, 'run')}, {done}: {status}; {outcome.rub} rub, {outcome.no_rub} do not"
    if outcome.motion:
        yield f"  motion: {', '.join(f'{count} {name}' for name, count in outcome.motion.items())}"
    for failure in outcome.failures:
        yield f"  {failure.count} {failure.status}, such as {failure.run_id}: {failure.reason}"


def _ways_to_look(directory: Path) -> Iterator[str]:
    """Yield the places of the files, and the commands that show them."""
    tables = "runs.parquet, signals/: parameters, labels, signals"
    if not (directory / "signals").is_dir():  # neither without the format parquet
        tables = "runs.parquet: parameters, labels"
    yield f"  {directory}/{tables}; for pandas, polars, datasets"
    for each in run_formats():
        folder = min((directory / each.name).glob("*"), default=directory)
        first = min(folder.glob(f"*{each.suffix}"), default=None)
        if first and each.look:
            yield f"  {each.look.format(folder=folder, first=in_shell(first), rerun=_command('rerun'))}"
    yield f"  count classes:  {_command('rubgen')} info {in_shell(directory)}"
    if not is_url(directory):
        yield f"  check it all:   {_command('rubgen')} verify {in_shell(directory)}"
    yield f"  {directory}/README.md tells what every column means and how to load it"


def _command(name: str) -> str:
    """Return the call of a program of this environment: its name where the shell finds it, else its path."""
    return name if which(name) else in_shell(os.path.relpath(Path(sys.executable).with_name(name)))
