"""`rubgen simulate`: one run, its labels, its file."""

from __future__ import annotations

from inspect import signature
from pathlib import Path
from typing import Any

from rubgen.cli.printing import print_json, print_pairs
from rubgen.cli.replaying import Showing, show
from rubgen.labels.plain import labels_dict
from rubgen.output import save, writer_of
from rubgen.pipeline import simulate
from rubgen.scenario import Scenario, make_scenario
from rubgen.scenario.vary import varied_values
from rubgen.solver import Status
from rubgen.viz.replay import replay_of

LABEL_NAMES = (
    "rub",
    "contact_duty",
    "contact_impulse_per_turn_n_s",
    "blades_touched",
    "contact_zones",
    "contact_zones_symmetric",
    "motion_blisk",
    "motion_casing",
    "motion",
    "motion_confidence",
    "period",
    "has_2fr",
    "lyapunov_per_turn",
    "lyapunov_error",
    "contact_force_orders",
    "blisk_x_orders",
)
"""What people are shown; programs get all labels."""


def simulate_command(options: dict[str, Any], out: Path | None, *, replay: bool = False, as_json: bool) -> int:
    """Simulate, print, write and show; 1 where the run failed."""
    if replay:
        Showing().check()
    if out:
        writer_of(out, f"--out {out}")
    run = simulate(_scenario(options))
    labels = labels_dict(run.labels) if run.labels else {}
    result: dict[str, object] = {
        "status": run.response.status.code,
        "reason": run.response.reason,
        **varied_values(run.scenario),
        "steps_per_turn": run.response.steps_per_turn,
        "settle_turns": run.response.settle_turns,
        "record_turns": run.response.record_turns,
    }
    if as_json:
        print_json(result | dict.fromkeys(LABEL_NAMES) | labels)
    else:
        print_pairs(result | {name: labels[name] for name in LABEL_NAMES if name in labels})
    if run.response.status is not Status.OK:
        return 1
    if out:
        save(run, out, named=f"--out {out}")
    if replay:
        show(replay_of(run), Showing())
    return 0


def _scenario(options: dict[str, Any]) -> Scenario:
    return make_scenario(**{key: options[key] for key in signature(make_scenario).parameters})
