"""The command `rubgen simulate`: one run, its labels, its file."""

import math
from collections.abc import Iterator
from inspect import signature
from pathlib import Path
from typing import Any

from rubgen.brief import counted
from rubgen.cli.commands.replaying import Showing, show
from rubgen.cli.mistakes import meant
from rubgen.cli.printing import check_new_file, print_json, print_pairs, say
from rubgen.errors import UserError, warn
from rubgen.format_names import FORMAT_NAMES
from rubgen.formats import format_of
from rubgen.labels import Labels
from rubgen.labels.faults import fault_labels
from rubgen.labels.headline import headline
from rubgen.labels.labels import Motion
from rubgen.labels.registry import LABELS
from rubgen.labels.to_json import labels_to_json
from rubgen.machine.faults.registry import FAULTS
from rubgen.machine.load import file_named
from rubgen.output import save
from rubgen.pipeline import Run, simulate
from rubgen.progress import step
from rubgen.scenario import Scenario, make_scenario
from rubgen.scenario.faults import FAULT_KEYS, keys_of_kind, kind_of
from rubgen.scenario.vary import varied_values
from rubgen.solver import Status
from rubgen.solver.linear.reach import no_rub_warning
from rubgen.units import rev_per_min
from rubgen.viz.replay import replay_of

LABEL_NAMES = (*(label.name for label in LABELS), "contact_force_orders", "blisk_x_orders")
"""Labels that are null in JSON where a run failed."""
MOST_ZONES = 4
"""Number of zones that are listed one by one."""


def simulate_command(
    options: dict[str, Any], out: Path | None, *, replay: bool = False, force: bool = False, as_json: bool
) -> int:
    """Simulate one run and print its labels. With `out` also write a file, with `replay` also show the run.

    - options: the parameters of `make_scenario` by name, from the command line. Its entry `fault_keys` has the values
      of the faults, as texts by their keys.
    - out: file to write, in the format of its ending, or None.
    - replay: show the run in the viewer at the end.
    - force: replace an existing file.
    - as_json: print every label as JSON instead of a summary.

    Returns the exit code 1 where the run failed, else 0. A run that failed is not written and not shown.
    """
    if replay:
        Showing().check()
    if out:
        check_new_file("--out", out, tuple(sorted(f".{name}" for name in FORMAT_NAMES)), force=force)
    scenario = _scenario(options)
    text = no_rub_warning([scenario])
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
    """Return status, parameters and labels by name."""
    return {
        "status": run.response.status.code,
        "reason": run.response.reason,
        **varied_values(run.scenario),
        "steps_per_turn": run.response.steps_per_turn,
        "settle_turns": run.response.settle_turns,
        "record_turns": run.response.record_turns,
        **dict.fromkeys(LABEL_NAMES),
        **(labels_to_json(run.labels) if run.labels else {}),
        **fault_labels(run.scenario, run.response),
    }


def _scenario(options: dict[str, Any]) -> Scenario:
    keys = list(signature(make_scenario).parameters)[:-1]
    return make_scenario(**{key: options[key] for key in keys}, **_fault_keys(options["fault_keys"], options))


def _fault_keys(given: dict[str, str], options: dict[str, Any]) -> dict[str, Any]:
    """Return the values of faults by their keys. Raises UserError for an option that is no key of a fault either."""
    found: dict[str, Any] = {}
    for name, text in given.items():
        key = name.replace("-", "_")
        if key not in FAULT_KEYS:
            hint = meant(f"--{name}", [_as_option(each) for each in (*options, *FAULT_KEYS)])
            for kind in options["fault"] or ():
                if kind in FAULTS:
                    hint += f" the fault {kind} has {', '.join(map(_as_option, keys_of_kind(kind)))};"
            raise UserError(f"--{name}: unknown option of rubgen simulate;{hint} see rubgen simulate --help")
        try:
            found[key] = float(text)
        except ValueError:
            found[key] = text
    return found


def _as_option(key: str) -> str:
    return f"--{key.replace('_', '-')}"


def run_summary(run: Run) -> Iterator[tuple[str, str]]:
    """Yield the main facts of a run as pairs of name and text: machine, speeds, contact, motion, orders."""
    yield "run", _course_of_run(run)
    if run.response.status is not Status.OK:
        yield "failed", f"{run.response.status.value}; {run.response.reason}"
    for fault in run.scenario.machine.faults:
        about = fault.SEVERITY
        value = f"{fault.severity:.4g}" if about.unit == "1" else f"{fault.severity:.4g} {about.unit}"
        yield "fault", f"{kind_of(fault)}: {about.meaning} {value}"
    if run.labels is not None:
        yield "headline", headline(labels_to_json(run.labels), run.scenario.operation.profile)
        yield from _contact(run.labels, grows=run.response.grows)
        if run.response.grows and run.labels.rub:
            onset = float(run.response.events.start_step.min() * run.response.dt)
            yield "first touch", f"{onset:.4g} s after the start of the record"
        yield from _motion(run.labels)
        yield from _speeds(run.labels)


def _course_of_run(run: Run) -> str:
    operation, response = run.scenario.operation, run.response
    speed = f"{rev_per_min(operation.speed_rad_per_s):,.6g} rev/min"
    if operation.profile != "steady":
        speed = f"{operation.profile} from {speed}"
    if operation.end_speed_rpm is not None:
        speed += f" to {operation.end_speed_rpm:,.6g} rev/min"
    turns = f"{response.record_turns} turns after {response.settle_turns} to settle"
    return f"{run.scenario.machine.name}, {speed}, {turns}, {response.steps_per_turn} steps a turn"


def _contact(labels: Labels, *, grows: bool) -> Iterator[tuple[str, str]]:
    amounts = labels.amounts
    penetration = amounts.free_penetration
    when = " at the start of the record" if grows else ""  # a fault that grows changes it
    if not labels.rub:
        yield "rub", "no"
        if penetration is not None:
            yield "smallest gap", f"{-penetration * 1e6:.4g} µm without contact{when}"
        return
    touched, zones = counted(labels.blades_touched, "blade"), f"{labels.contact_zones} {_zones_word(labels)}"
    yield "rub", f"yes, {amounts.extent.value}: {touched}, {zones}"
    yield "contact zones", _zones(labels)
    yield "contact duty", f"{100 * labels.contact_duty:.3g} % of the time"
    yield "impulse", f"{labels.impulse_per_turn:.4g} N s a turn"
    if amounts.severity is not None:
        yield "severity", f"{amounts.severity:.3g}, mean contact force over the blisk's weight"
    if penetration is not None:
        yield "penetration", f"{penetration * 1e6:.4g} µm, had there been no contact{when}"
    if amounts.friction_work:
        yield "friction work", f"{amounts.friction_work:.4g} J a turn"


def _zones_word(labels: Labels) -> str:
    shape = {None: "", True: ", symmetric", False: ", not symmetric"}[labels.contact_zones_symmetric]
    return f"{'zone' if labels.contact_zones == 1 else 'zones'}{shape}"


def _zones(labels: Labels) -> str:
    """Return centre and width of each zone, in degrees on the casing from +X."""
    zones = zip(labels.contact_zone_centres, labels.contact_zone_widths, strict=True)
    texts = [f"{math.degrees(centre):.1f}° ({math.degrees(width):.1f}° wide)" for centre, width in zones]
    more = f" and {len(texts) - MOST_ZONES} more" if len(texts) > MOST_ZONES else ""
    return ", ".join(texts[:MOST_ZONES]) + more


def _motion(labels: Labels) -> Iterator[tuple[str, str]]:
    parts = f"blisk {labels.motion_blisk.value}, casing {labels.motion_casing.value}"
    period = f", period {labels.period}" if labels.motion is Motion.PERIOD_K else ""
    yield "motion", f"{labels.motion.value}{period}, confidence {labels.motion_confidence:.2f} ({parts})"
    if labels.whirl:
        yield "whirl", f"{labels.whirl.direction.value}, index {labels.whirl.index:+.2f} of -1 to 1"
    if labels.lyapunov:
        yield "exponent", f"{labels.lyapunov.per_turn:+.4g} ± {labels.lyapunov.error:.1g} 1/turn, largest Lyapunov"
    if labels.orders_present:
        yield "orders", f"{_ranges(labels.orders_present)} x speed, in the casing's acceleration"


def _ranges(orders: tuple[int, ...]) -> str:
    """Write rising numbers, runs of three or more as `4 to 9`."""
    runs: list[list[int]] = []
    for order in orders:
        if runs and order == runs[-1][-1] + 1:
            runs[-1].append(order)
        else:
            runs.append([order])
    return ", ".join(f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs)


def _speeds(labels: Labels) -> Iterator[tuple[str, str]]:
    """Yield where rub begins and ends as the speed changes, and how often the motion changes.

    A rub of the first or of the last turns has its onset or end outside of the record.
    """
    history = labels.history
    if history is None:
        return
    before, after = history.changes[0].rub, history.changes[-1].rub
    yield "onset of rub", "before the record" if before else _rpm(history.onset_speed)
    yield "end of rub", "none, it goes on at the end of the record" if after else _rpm(history.end_of_rub_speed)
    yield "changes", f"{len(history.changes) - 1} of rub or motion over the record"


def _rpm(speed: float | None) -> str:
    return "none" if speed is None else f"{rev_per_min(speed):,.5g} rev/min"
