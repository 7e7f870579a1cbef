"""`python -m validation.run_up_motion`: the motion of windows of run-ups beside that of steady runs at their speed.

Runs are kept in `out/run-up-motion/`, so that the command goes on where it was stopped; the page goes to `docs/`.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from rubgen.dataset.making.workers import usable_cores
from rubgen.labels import Labels, Motion, label
from rubgen.labels.compact_record import response_of
from rubgen.progress import count
from rubgen.scenario import Scenario, make_scenario
from rubgen.scenario.vary import vary
from rubgen.units import rev_per_min
from validation.command import run_command
from validation.confusion.runs import SERIES, run
from validation.markdown import folded, table
from validation.piece import MOTION_LABELS, Found, Piece
from validation.store import Store

COMMAND = "python -m validation.run_up_motion"
CHOSEN = ("preset", "closer casing")
"""Series of `validation.confusion`."""
SPEEDS_RPM = tuple(float(speed) for speed in range(6900, 13000, 600))
START_RPM, END_RPM = 6400.0, 13000.0
DURATIONS_S = (29.0, 7.3)
"""Of the run-ups: 228 and 904 rev/min/s."""
DECIDED = (Motion.PERIOD_1, Motion.PERIOD_K, Motion.QUASI_PERIODIC, Motion.CHAOTIC)


@dataclass(frozen=True)
class Pair:
    """A steady run, and the window of a run-up about its speed."""

    series: str
    seconds: float
    speed_rpm: float
    steady: Motion
    window: Motion
    rub: bool
    """Whether blades touch in the steady run."""

    @property
    def verdict(self) -> str:
        """Whether the two agree on a class, one or both are undecided, or they contradict each other."""
        if Motion.UNDECIDED in (self.steady, self.window):
            return "undecided"
        return "agree" if self.steady is self.window else "contradict"


def steady_scenario(series: str, speed_rpm: float) -> Scenario:
    """A steady run of 500 turns of a series."""
    return vary(make_scenario("zeng2019"), {"speed_rpm": speed_rpm, **SERIES[series]})


def run_up_scenario(series: str, seconds: float) -> Scenario:
    """A run-up of a series that takes so long."""
    start = make_scenario("zeng2019", profile="run-up", speed_rpm=START_RPM, end_speed_rpm=END_RPM, duration_s=seconds)
    return vary(start, SERIES[series])


def piece(scenario: Scenario) -> Piece:
    """The run of a scenario; labels are made when it is read."""
    return Piece(run, (scenario,), apart=MOTION_LABELS)


def pairs(series: str, seconds: float, found: Found) -> list[Pair]:
    """Each steady run of a series beside the window of its run-up that has its speed."""
    windows = _labels(run_up_scenario(series, seconds), found).windows
    speeds = [rev_per_min(speed) for speed in windows.speed.tolist()]
    out = []
    for speed in SPEEDS_RPM:
        number = min(range(len(speeds)), key=lambda i: abs(speeds[i] - speed))
        steady = _labels(steady_scenario(series, speed), found)
        out.append(Pair(series, seconds, speed, steady.motion, windows.motion[number][0], steady.rub))
    return out


def stretches(series: str, seconds: float, found: Found) -> str:
    """What the windows of a run-up are called, from which speed on."""
    windows = _labels(run_up_scenario(series, seconds), found).windows
    speeds = iter(rev_per_min(speed) for speed in windows.speed.tolist())
    named = [(motion, [next(speeds) for _ in same]) for motion, same in groupby(each for each, _ in windows.motion)]
    return ", ".join(f"{motion.value} from {of[0]:,.0f}" for motion, of in named)


def page(every: Sequence[Pair], courses: dict[tuple[str, float], str]) -> str:
    """The page: how often they agree, each pair, the course of each run-up."""
    verdicts = [each.verdict for each in every]
    unseen = [motion.value for motion in DECIDED if not any(motion is each.steady for each in every)]
    limit = f"No steady run of these is {' or '.join(unseen)}: the page does not test these classes." if unseen else ""
    classes = [motion for motion in Motion if any(motion in (each.steady, each.window) for each in every)]
    count_of = Counter((each.steady, each.window) for each in every)
    counts = [[steady.value, *(str(count_of[steady, window]) for window in classes)] for steady in classes]
    rows = []
    for name in CHOSEN:
        for speed in SPEEDS_RPM:
            here = [each for each in every if (each.series, each.speed_rpm) == (name, speed)]
            rows.append([name, f"{speed:,.0f}", here[0].steady.value, *(each.window.value for each in here)])
    rates = [f"run-up, {_rate(seconds)}" for seconds in DURATIONS_S]
    each_speed = table(["series", "rev/min", "steady run", *rates], rows)
    listed = "\n".join(f"- {name}, {_rate(seconds)}: {text}." for (name, seconds), text in courses.items())
    return f"""# Motion in run-ups, beside steady runs

`{COMMAND}` makes this page. It compares the label of motion of a window of a run-up
([labels over time](labels/over-time.md)) with the label of a steady run of 500 turns at the speed of the window.

Of {len(every)} pairs {verdicts.count("agree")} agree on a class. In {verdicts.count("undecided")} one or both are
`undecided`. {verdicts.count("contradict")} contradict each other. Blades touch in {sum(each.rub for each in every)} of
the {len(every)} steady runs. {limit}

## How often they agree

Rows are steady runs, columns windows of run-ups.

{table(["steady", *(motion.value for motion in classes)], counts, numbers_from=1)}

## Each speed

{folded(f"{len(rows)} speeds: the steady run and each run-up", each_speed)}

## The course of each run-up

{listed}
"""


def _rate(seconds: float) -> str:
    return f"{(END_RPM - START_RPM) / seconds:,.0f} rev/min/s"


def _labels(scenario: Scenario, found: Found) -> Labels:
    return label(response_of(found(piece(scenario))))


def main(arguments: Sequence[str], folder: Path) -> int:
    """Make what is missing, compare, write; paths start from `folder`."""
    parser = argparse.ArgumentParser(prog="python -m validation.run_up_motion")
    parser.add_argument("--workers", type=int, default=usable_cores(), help="number of processes")
    given = parser.parse_args(arguments)
    store = Store(folder / "out/run-up-motion")

    def work() -> None:
        steady = [steady_scenario(name, speed) for name in CHOSEN for speed in SPEEDS_RPM]
        run_ups = [run_up_scenario(name, seconds) for name in CHOSEN for seconds in DURATIONS_S]
        with store.claimed():
            store.compute([piece(each) for each in (*run_ups, *steady)], given.workers, count)
            every = [each for name in CHOSEN for seconds in DURATIONS_S for each in pairs(name, seconds, store)]
            courses = {(name, seconds): stretches(name, seconds, store) for name in CHOSEN for seconds in DURATIONS_S}
            (folder / "docs/run-up-motion.md").write_text(page(every, courses), encoding="utf-8")
            sys.stdout.write(f"{len(every)} pairs, {sum(each.verdict == 'agree' for each in every)} agree on a class\n")

    return run_command("validation.run_up_motion", store.root, work)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], Path()))
