"""The command `rubgen regenerate`: one run made again from the manifest."""

from pathlib import Path

from rubgen.cli.printing import check_new_file, print_json, say
from rubgen.dataset.remaking.regenerate import Regenerated, regenerate
from rubgen.format_names import FORMAT_NAMES
from rubgen.progress import shown

MOST_NAMED = 6


def regenerate_command(directory: Path, run_id: str, out: Path | None, *, force: bool, as_json: bool) -> int:
    """Simulate a run again and print where it differs from the stored run. `out` is a file for the run, or None.

    With `force` an existing `out` is replaced. With `as_json` the differences are printed as JSON. Returns the exit
    code 1 where a label differs by more than other versions or another processor explain, or where a bit differs with
    the same versions; else 0.
    """
    if out is not None:
        check_new_file("--out", out, tuple(f".{name}" for name in FORMAT_NAMES), force=force)
    with shown(not as_json and None):
        done = regenerate(directory, run_id)
    if out is not None:
        done.run.save(out)
    wrong = bool(done.moved or (done.different and not done.versions))
    if as_json:
        print_json(
            {
                "run": run_id,
                "same": not done.different,
                "ok": not wrong,
                "versions": {name: list(each) for name, each in done.versions.items()},
                "different": done.different,
                "moved": done.moved,
            }
        )
    else:
        _tell(run_id, done)
    return int(wrong)


def _tell(run_id: str, done: Regenerated) -> None:
    for name, (then, now) in done.versions.items():
        say(f"{name}: {then} made the set, {now} is installed")
    if not done.different:
        say(f"{run_id}: equal to the bit")
    for table, columns in sorted(done.different.items()):
        say(f"{run_id}: {table}: other bits in {_few(columns)}")
    if done.moved:
        say(f"{run_id}: labels differ by more than other versions or another processor explain: {_few(done.moved)}")
    elif done.different:
        say(f"{run_id}: same class of motion, labels within the tolerance for other versions and processors")


def _few(names: list[str]) -> str:
    more = len(names) - MOST_NAMED
    return ", ".join(names[:MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
