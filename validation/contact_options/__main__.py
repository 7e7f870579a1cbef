"""`python -m validation.contact_options [--quick]`: runs, figures, `docs/contact-options.md`.

With `--quick`, one case, two speeds and short records, everything goes to `out/contact-options-quick/`.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rubgen.pipeline import Run, simulate
from rubgen.reduction import reduce
from rubgen.scenario import Scenario
from rubgen.viz.figures import save_png
from validation.contact_options.blade_shortening import soft_draw_in
from validation.contact_options.chords import artefact
from validation.contact_options.figures import chords_figure, liner_figure
from validation.contact_options.matched import (
    FIGURE_RPM,
    MATCHED,
    ONSETS,
    SMOOTH,
    SPEEDS_RPM,
    SURFACES,
    compared,
    matched_section,
    scenario,
)
from validation.contact_options.page import chords_section, page
from validation.contact_options.runs import HEAVY_RPM, OPTIONS, heavy_scenario, option_scenario, read
from validation.sensitivity.cases import CASES

QUICK_SETTLE, QUICK_RECORD = 60, 64


def main(arguments: Sequence[str], folder: Path) -> int:
    """Run everything; paths start from `folder`."""
    parser = argparse.ArgumentParser(prog="python -m validation.contact_options")
    parser.add_argument("--quick", action="store_true", help="little and short, into out/contact-options-quick")
    quick = parser.parse_args(arguments).quick
    out = folder / ("out/contact-options-quick" if quick else "docs")
    out.mkdir(parents=True, exist_ok=True)
    cases, speeds = (list(CASES)[:1], HEAVY_RPM[-2:]) if quick else (list(CASES), HEAVY_RPM)
    options = [
        read(case, option, _run(option_scenario(case, option), quick=quick)) for case in cases for option in OPTIONS
    ]
    heavy = [read("heavy", "none", _run(heavy_scenario(speed), quick=quick)) for speed in speeds]
    speeds_on_chords, ends = (SPEEDS_RPM[-4:-3], ONSETS[:1]) if quick else (SPEEDS_RPM, ONSETS)
    runs = [compared(one, _run(scenario(one, rpm), quick=quick)) for rpm in speeds_on_chords for one in SURFACES]
    onsets = [compared(one, _run(scenario(one, *end), quick=quick)) for end in ends for one in SURFACES]
    preset = option_scenario(cases[0], "none")
    system = reduce(preset.machine, preset.reduction).at_speed(preset.operation.speed_rad_per_s)
    hits = artefact(system)
    shown = {run.surface: run for run in runs if run.speed_rpm == FIGURE_RPM}
    save_png(chords_figure(hits, shown[SMOOTH], shown[MATCHED]), out / "contact-options-chords.png")
    save_png(liner_figure(options), out / "contact-options-liner.png")
    factor = soft_draw_in(preset.machine.blades, preset.machine.disk.rim_radius_m)
    chords = chords_section(hits, matched_section(runs, onsets))
    text = page(options, heavy, chords, factor)
    (out / "contact-options.md").write_text(text, encoding="utf-8")
    return 0


def _run(asked: Scenario, *, quick: bool) -> Run:
    if quick:
        operation = replace(asked.operation, settle_turns=QUICK_SETTLE, record_turns=QUICK_RECORD)
        asked = replace(asked, operation=operation, signal_seconds=0.2)
    run = simulate(asked)
    motion = run.labels.motion if run.labels else run.response.reason
    sys.stdout.write(f"{asked.operation.speed_rpm:6.0f} rev/min, {asked.contact}: {motion}\n")
    sys.stdout.flush()
    return run


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
