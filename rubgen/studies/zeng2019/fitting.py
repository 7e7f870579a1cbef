"""`rubgen reproduce zeng2019 --fit`: the search computed, its evidence written."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from rubgen.io.durable import write_durably
from rubgen.studies.zeng2019.computing import Progress, compute, cores
from rubgen.studies.zeng2019.search import (
    FITTED,
    PREDICTED,
    PRESET,
    RECORD,
    SETTLE,
    Candidate,
    Score,
    best,
    candidates,
    score,
    toml_of,
)
from rubgen.studies.zeng2019.store import Store

QUICK_THIN = 15
FOLDER, PAGE, MACHINE_FILE = "fit", "fit.md", "zeng2019-fitted.toml"
READ: dict[str, Callable[[Candidate], float]] = {
    "lateral and tilt damping": lambda one: one.damping,
    "casing mass, times the lightest reading": lambda one: one.mass,
    "friction": lambda one: one.friction,
}


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """What `fit` left behind: the page with the evidence, the machine, and how many candidates were run now."""

    page: Path
    machine: Path
    made: int
    best: Score


def fit(
    out: Path | str,
    *,
    quick: bool = False,
    workers: int | None = None,
    progress: Progress = lambda _done, _all: None,
) -> Fitted:
    """Search the grid of unknowns and write `out/fit`: page, `fit.json`, the machine found.

    Resumable like `reproduce`; raises the same.
    """
    tried, store = candidates(QUICK_THIN if quick else 1), Store(Path(out))
    with store.claimed():
        made = compute([one.piece for one in tried], store, workers or cores(), progress)
        scores = [score(one, store) for one in tried]
        folder = Path(out) / FOLDER
        folder.mkdir(exist_ok=True)
        found = best(scores)
        _write(folder / MACHINE_FILE, toml_of(found.candidate))
        _write(folder / "fit.json", json.dumps([asdict(one) for one in scores], indent=1) + "\n")
        _write(folder / PAGE, page(scores))
    return Fitted(page=folder / PAGE, machine=folder / MACHINE_FILE, made=made, best=found)


def page(scores: Sequence[Score]) -> str:
    """The evidence as Markdown: the best, the preset, and how well each unknown is determined."""
    found, preset = best(scores), next(one for one in scores if one.candidate == PRESET)
    what = (
        f"{len(scores)} candidates, {len(FITTED)} runs each for the fit (classes of the regions II, III and V) and "
        f"{len(PREDICTED)} more for what it predicts (sweeps of both supports), {SETTLE} turns to settle and {RECORD} "
        "to judge. Unbalance and clearance follow from the damping by onset and end of rubbing, springs from the mass "
        "by the casing's frequencies."
    )
    how = (
        "How well each is determined: the best share of fitted words with each value, all others free. A value that "
        "does not lower it is not excluded."
    )
    parts = [
        "# Fit of what is not published",
        what,
        _table(
            ("", "damping", "casing mass", "friction", "words borne out, fitted", "predicted"),
            [_row("best", found), _row("preset", preset)],
        ),
        how,
        *(_profile(name, read, scores) for name, read in READ.items()),
    ]
    return "\n\n".join(parts) + "\n"


def _row(name: str, one: Score) -> list[str]:
    values = (one.candidate.damping, one.candidate.mass, one.candidate.friction)
    return [name, *(f"{value:g}" for value in values), f"{100 * one.fitted:.0f} %", f"{100 * one.predicted:.0f} %"]


def _profile(name: str, read: Callable[[Candidate], float], scores: Sequence[Score]) -> str:
    rows = []
    for value in sorted({read(one.candidate) for one in scores}):
        top = best([one for one in scores if read(one.candidate) == value])
        rows.append([f"{value:g}", f"{100 * top.fitted:.0f} %", f"{100 * top.predicted:.0f} %"])
    return _table((name, "best share fitted", "predicted by it"), rows)


def _table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    return "\n".join(f"| {' | '.join(line)} |" for line in [header, ["---"] * len(header), *rows])


def _write(path: Path, text: str) -> None:
    write_durably(path, lambda part: part.write_text(text, encoding="utf-8"))
