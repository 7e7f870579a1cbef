"""The commands `rubgen info`, `label`, `verify` and `repair`: content and state of a data set."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import rubgen
from rubgen.brief import counted
from rubgen.cli.printing import print_json, print_pairs, say
from rubgen.dataset.checking.inventory import Finding
from rubgen.dataset.checking.relabel import relabel
from rubgen.dataset.checking.verify import advice, findings
from rubgen.dataset.making.outcome import Unfinished, unfinished
from rubgen.errors import UserError
from rubgen.labels import Motion
from rubgen.progress import step

if TYPE_CHECKING:
    import pandas as pd


def info_command(directory: Path, *, as_json: bool) -> int:
    """Print the content of the data set in `directory`: runs by status, rub and motion, and reasons of failed runs.

    For an unfinished set, after an interrupted `generate`, the number of finished runs and how to continue are printed.
    With `as_json` the counts are printed as JSON, without the reasons. Returns the exit code 0. Raises UserError where
    the directory holds no data set.
    """
    begun = unfinished(directory)
    if begun is not None:
        return _tell_unfinished(directory, begun, as_json=as_json)
    data = rubgen.open(directory)
    runs = data.runs
    motions = [motion.value for motion in Motion]
    result: dict[str, object] = {
        "name": data.manifest.name,
        "runs": len(runs),
        "finished": True,
        "status": _counts(runs["status"]),
        "rub": _counts(runs["rub"], ("true", "false")),
        **{name: _counts(runs[name], motions) for name in ("motion", "motion_blisk", "motion_casing")},
    }
    (print_json if as_json else print_pairs)(result)
    if not as_json:
        for row in runs[runs["status"] != "ok"].itertuples():
            say(f"{row.Index}  {row.status}: {row.reason}")
    return 0


def _tell_unfinished(directory: Path, begun: Unfinished, *, as_json: bool) -> int:
    if as_json:
        print_json({"name": begun.name, "runs": begun.runs, "finished": False, "kept": begun.kept})
    else:
        say(f"{directory}: unfinished, {begun.kept} of {begun.runs} runs of the recipe {begun.name!r} are kept")
        say("  the command that began it makes the rest: rubgen generate [RECIPE.toml] --out ... with the same recipe")
    return 0


def verify_command(directory: Path, sample: int | None, *, repair: bool = False, as_json: bool) -> int:
    """Check the data set in `directory` and print its problems with their remedy.

    - sample: number of shards whose content is read; None reads all.
    - repair: then make files again, as `repair_command` does.
    - as_json: print problems and remedy as JSON.

    Returns the exit code 1 if a problem remains, else 0. Raises UserError for `sample` with `repair`.
    """
    if repair:
        if sample is not None:
            raise UserError(f"--sample {sample}: --repair reads all shards; leave out one of the two")
        return repair_command(directory, as_json=as_json, told=True)
    with step("verify"):
        found = findings(directory, sample=sample)
    return _tell(directory, found, {}, as_json=as_json)


def repair_command(directory: Path, *, as_json: bool, told: bool = False) -> int:
    """Make damaged or missing files again and print them, then the problems that remain.

    With `told` the problems before the repair are printed first, if any file was made again. With `as_json` all is
    printed as JSON. Returns the exit code 1 if a problem remains, else 0.
    """
    from rubgen.dataset.checking.repair import repair

    with step("repair"):
        done = repair(directory)
    found = [each.text for each in done.found]
    if not as_json:
        for text in found if told and done.made else ():
            say(text)
        for path in done.made:
            say(f"{path}: made again")
        if done.left and done.versions:
            name, (then, now) = next(iter(done.versions.items()))
            say(f"made with {name} {then}, now it is {now}: only the version that made the set makes its bytes again")
    more: dict[str, object] = {"made": list(done.made), **({"found": found} if told else {})}
    return _tell(directory, list(done.left), more, as_json=as_json)


def _tell(directory: Path, found: list[Finding], more: dict[str, object], *, as_json: bool) -> int:
    """Print the problems and the remedy. Returns the exit code 1 if there are any."""
    what_to_do = advice(directory, found) if found else ""
    if as_json:
        print_json({"ok": not found, **more, "problems": [each.text for each in found], "advice": what_to_do})
    elif found:
        for line in (*(each.text for each in found), what_to_do):
            say(line)
    else:
        say(f"{directory}: nothing wrong")
    return 1 if found else 0


def label_command(directory: Path, *, as_json: bool) -> int:
    """Compute the labels of a set again from its compact records, and print the labels that differ from runs.parquet.

    No file is changed. Numbers that differ only by rounding are equal. Labels of orders are left out. With `as_json`
    the differences are printed as JSON. Returns the exit code 1 if a label differs, else 0. Raises UserError as
    `relabel` does, such as for a set without compact records.
    """
    with step("make labels again"):
        done = relabel(directory)
    if as_json:
        differences = [dataclasses.asdict(each) for each in done.differences]
        print_json({"runs": done.runs, "labels": done.labels, "differences": differences})
    else:
        for each in done.differences:
            say(f"{each.run_id}  {each.label}: {each.stands} in runs.parquet, now {each.again}")
        same = "all as in runs.parquet" if not done.differences else f"{len(done.differences)} differ"
        made = f"{counted(done.labels, 'label')} of {counted(done.runs, 'run')} made again"
        say(f"{directory}: {made}, {same}; labels of orders left out")
    return 1 if done.differences else 0


def _counts(values: pd.Series[Any], expected: Iterable[str] = ()) -> dict[str, int]:
    """Count how often each value occurs, also expected ones that never occur. Failed runs are left out."""
    counts = values.dropna().astype(str).str.lower().value_counts()
    return {name: int(counts.get(name, 0)) for name in [*expected, *sorted(set(counts.index) - set(expected))]}
