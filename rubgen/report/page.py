"""Make one HTML page about a data set, for `rubgen report DIR`."""

from __future__ import annotations

import base64
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from rubgen.brief import in_shell
from rubgen.dataset.checking.verify import verify
from rubgen.dataset.reading.open import DataSet
from rubgen.dataset.reading.replaying import find_replay
from rubgen.errors import UserError, write_problems
from rubgen.format_names import FORMAT_NAMES
from rubgen.formats import format_of
from rubgen.io.files import write_durably
from rubgen.labels.labels import Motion
from rubgen.progress import count
from rubgen.report.interactive import interactive_figures, packed_library
from rubgen.scenario.vary import PARAMETERS
from rubgen.viz.colors import MOTION_COLORS
from rubgen.viz.figures.data_set import dataset_overview, varied_keys
from rubgen.viz.figures.run import waveform_orders
from rubgen.viz.figures.snapshot import picture
from rubgen.viz.replay import Replay

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

EXAMPLES, MOST_FAILED = 6, 30
DPI = 90
"""A low resolution: a page takes about a megabyte. All colours are kept, because they show the classes."""
RUBGEN = """import rubgen

data = rubgen.open("DIR")
runs = data.runs
signal = data.signals("RUN")["CHANNEL"]"""


def write_report(directory: Path, path: Path) -> None:
    """Write the page of the data set in `directory` to `path`, as one file that needs no other files.

    An existing file is replaced. The page shows the content of the set, balance of classes, coverage of parameters,
    failed runs and reasons, up to six examples with pictures, the channels, how to load it, and its checks. Raises
    UserError where there is no finished data set, no good run, no example that can be read, or the file cannot be
    written.
    """
    html = render_report(directory)
    with write_problems(path):
        write_durably(path, lambda part: part.write_text(html, encoding="utf-8"))


def render_report(directory: Path) -> str:
    """Compose the HTML of the page of the data set in `directory`. Raises UserError as `write_report` does."""
    data = DataSet(directory)
    good = data.ok
    if good.empty:
        raise UserError(
            f"{directory}: no run is good, so there is nothing to show; see `rubgen info {in_shell(directory)}`"
        )
    replays = _replays(directory, example_runs(good))
    first = next(iter(replays.values()))
    environment = Environment(loader=PackageLoader("rubgen.report", "."), autoescape=True, undefined=StrictUndefined)
    identity = data.manifest.identity
    return environment.get_template("report.html.j2").render(
        name=data.manifest.name,
        machine=", ".join(dict.fromkeys(machine["name"] for machine in identity.machines)),
        runs=len(data.runs),
        good=len(good),
        rubbing=int(good["rub"].sum()),
        seconds=f"{first.seconds:g}",
        rate=f"{first.recording.sample_rate_hz:,.0f}",
        seed=", ".join(str(recipe["seed"]) for recipe in identity.recipes),
        version=identity.packages["rubgen"],
        license=data.manifest.license,
        classes=_classes(good),
        overview=as_data_url(dataset_overview(data.runs)),
        parameters=_parameters(good, identity.recipes),
        failed=data.runs[data.runs["status"] != "ok"].head(MOST_FAILED).reset_index().to_dict("records"),
        failed_more=max(0, len(data.runs) - len(good) - MOST_FAILED),
        examples=[_example(data.row(run_id), replay) for run_id, replay in replays.items()],
        interactive=interactive_figures(list(replays.values())),
        library=packed_library(),
        channels=list(first.recording.channels.values()),
        loading=[{"name": name, "code": code} for name, code in loading(data, first).items()],
        problems=verify(directory),
        files=len(data.manifest.files),
    )


def _replays(directory: Path, examples: list[str]) -> dict[str, Replay]:
    """Return the examples that can be read. The page's checks name a damaged file. Raises UserError without any."""
    replays, problem = dict[str, Replay](), UserError(f"{directory}: no example can be read")
    for done, run_id in enumerate(examples):
        count(done, len(examples))
        try:
            replays[run_id] = find_replay(directory, run_id).replay
        except UserError as error:
            problem = error
    if not replays:
        raise problem
    return replays


def example_runs(good: pd.DataFrame) -> list[str]:
    """Choose up to six runs to show. Returns their names. `good` is the table of the runs with status ok.

    First the run with the largest impulse of each class of motion is taken, then a run without contact. The rest are
    the runs with the largest impulse that remain.
    """
    by_impulse = good.sort_index().sort_values("contact_impulse_per_turn_n_s", ascending=False, kind="stable")
    hardest = [by_impulse.index[by_impulse["motion"] == motion.value][:1] for motion in Motion]
    free = by_impulse.index[~by_impulse["rub"].astype(bool)][:1]
    candidates = [str(run_id) for group in (*hardest, free, by_impulse.index) for run_id in group]
    return list(dict.fromkeys(candidates))[:EXAMPLES]


def as_data_url(figure: Figure) -> str:
    """Return a figure as PNG in a data URL."""
    picture = io.BytesIO()
    figure.savefig(picture, dpi=DPI, format="png", metadata={"Software": None})
    return f"data:image/png;base64,{base64.b64encode(picture.getvalue()).decode('ascii')}"


def _classes(good: pd.DataFrame) -> list[dict[str, Any]]:
    rows = []
    for motion in Motion:
        mine = good[good["motion"] == motion.value]
        if len(mine):
            percent = f"{100 * len(mine) / len(good):.1f}"
            rows.append(
                {"name": motion.value, "count": len(mine), "percent": percent, "color": MOTION_COLORS[motion],
                 "rub": int(mine["rub"].sum())}
            )  # fmt: skip
    return rows


def _parameters(good: pd.DataFrame, recipes: list[dict[str, Any]]) -> list[dict[str, str]]:
    meaning = {entry.key: ", ".join(filter(None, (entry.meaning, entry.unit.strip("1")))) for entry in PARAMETERS}
    return [
        {
            "key": key,
            "meaning": meaning[key],
            "least": f"{good[key].min():.5g}",
            "largest": f"{good[key].max():.5g}",
            "drawn": " or ".join(dict.fromkeys(_drawn(recipe.get("vary", {}).get(key)) for recipe in recipes)),
        }
        for key in varied_keys(good)
    ]


def _drawn(distribution: object) -> str:
    """Write a distribution as in the recipe, with short numbers."""
    if isinstance(distribution, dict):
        return ", ".join(f"{key} {_drawn(value)}" for key, value in distribution.items() if value is not None)
    if isinstance(distribution, list):
        return f"[{', '.join(map(_drawn, distribution))}]"
    return f"{distribution:.6g}" if isinstance(distribution, float) else str(distribution)


def _example(row: dict[str, Any], replay: Replay) -> dict[str, str]:
    impulse = float(row["contact_impulse_per_turn_n_s"])
    contact = f"{impulse:.3g} N s a turn on {int(row['blades_touched'])} blades" if row["rub"] else "no contact"
    has_motion = replay.frames is not None and replay.frames.time.size
    figure = picture(replay) if has_motion else waveform_orders(replay, next(iter(replay.recording.channels)))
    return {
        "run_id": row["run_id"],
        "motion": row["motion"],
        "text": f"{float(row['speed_rpm']):,.0f} rev/min, {contact}; {replay.headline}",
        "picture": as_data_url(figure),
    }


def loading(data: DataSet, replay: Replay) -> dict[str, str]:
    """Return Python code that loads the set, by the name of the library: rubgen and the libraries of the set's formats.

    In the code, RUN and CHANNEL are replaced by the run of `replay` and its first channel. DIR stays: the reader
    replaces it by the directory of the set.
    """
    formats = data.manifest.identity.recipe["output"]["formats"]
    ways = {"rubgen": RUBGEN}
    for name in FORMAT_NAMES:
        ways |= format_of(name).ways if name in formats else {}
    channel, run_id = next(iter(replay.recording.channels)), replay.scenario.run_id
    return {name: code.replace("CHANNEL", channel).replace("RUN", run_id) for name, code in ways.items()}
