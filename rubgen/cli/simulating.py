"""`rubgen simulate`: one run, its labels, its file."""

from inspect import signature
from pathlib import Path
from typing import Any

from rubgen.cli.new_file import check_new_file
from rubgen.cli.printing import print_json, print_pairs, say
from rubgen.cli.replaying import Showing, show
from rubgen.cli.run_summary import run_summary
from rubgen.errors import warn
from rubgen.format_names import FORMAT_NAMES
from rubgen.formats import format_of
from rubgen.labels.registry import LABELS
from rubgen.labels.to_json import labels_to_json
from rubgen.machine.load import file_named
from rubgen.output import save
from rubgen.pipeline import Run, simulate
from rubgen.progress import step
from rubgen.scenario import Scenario, make_scenario
from rubgen.scenario.vary import varied_values
from rubgen.solver import Status
from rubgen.solver.linear.reach import no_rub
from rubgen.viz.replay import replay_of

LABEL_NAMES = (*(label.name for label in LABELS), "contact_force_orders", "blisk_x_orders")
"""Labels that programs find as null where a run failed."""


def simulate_command(
    options: dict[str, Any], out: Path | None, *, replay: bool = False, force: bool = False, as_json: bool
) -> int:
    """Simulate, print, write and show; 1 where the run failed."""
    if replay:
        Showing().check()
    if out:
        check_new_file("--out", out, tuple(sorted(f".{name}" for name in FORMAT_NAMES)), force=force)
    scenario = _scenario(options)
    text = no_rub([scenario])
    if text:
        warn(text)
    with file_named(options["machine"]):
        run = simulate(scenario)
    good = run.response.status is Status.OK
    if as_json:
        print_json(_all_labels(run))
    else:
        print_pairs(dict(run_summary(run)))
    if out and good:
        with step("write the file"):
            save(run, out, named=f"--out {out}")
        if not as_json:
            say(f"written        {out}: {out.stat().st_size / 1e6:.2g} MB, {format_of(out.suffix[1:]).about}")
    if out and not good and not as_json:
        say(f"not written    {out}: a run that failed has no signals")
    if replay and good:
        show(replay_of(run), Showing())
    return 0 if good else 1


def _all_labels(run: Run) -> dict[str, object]:
    """Status, parameters and labels by name."""
    return {
        "status": run.response.status.code,
        "reason": run.response.reason,
        **varied_values(run.scenario),
        "steps_per_turn": run.response.steps_per_turn,
        "settle_turns": run.response.settle_turns,
        "record_turns": run.response.record_turns,
        **dict.fromkeys(LABEL_NAMES),
        **(labels_to_json(run.labels) if run.labels else {}),
    }


def _scenario(options: dict[str, Any]) -> Scenario:
    return make_scenario(**{key: options[key] for key in signature(make_scenario).parameters})
