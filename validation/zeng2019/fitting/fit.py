"""`python -m validation.zeng2019 --fit`: the search computed, its evidence, page and machine written."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rubgen.dataset.files import write_text
from rubgen.dataset.making.workers import usable_cores
from validation.store import Progress, Store
from validation.zeng2019.fitting.candidate import Candidate
from validation.zeng2019.fitting.evidence import scores_of, write_evidence
from validation.zeng2019.fitting.machine_file import toml_of
from validation.zeng2019.fitting.page import ROOMS, page
from validation.zeng2019.fitting.score import Score, as_computed, best
from validation.zeng2019.fitting.search import SURFACE, around, grid

QUICK_THIN = 20
FOLDER, PAGE, MACHINE_FILE, EVIDENCE_FILE = "fit", "zeng2019-fit.md", "zeng2019-as-computed.toml", "found.json"


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """What `fit` left behind: page, machine file, and how many pieces were made now; `best` is the machine's score."""

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
    """Run the grid of `search`, then what is around the best of each surface; `out/fit` gets page, evidence, machine.

    Resumable like `reproduce`; raises the same.
    """
    store, thin, many = Store(Path(out)), QUICK_THIN if quick else 1, workers or usable_cores()
    with store.claimed():
        tried = grid()[::thin]
        made = store.compute([*(one.piece for one in tried), *ROOMS.values()], many, progress)
        for surface in SURFACE:
            found = _best_on(surface, tried, store)
            more = around(found)[::thin] if found else []
            made += store.compute([one.piece for one in more], many, progress)
            tried += more
        seen = {one: store(one.piece) for one in tried}
        scores, folder = scores_of(seen), Path(out) / FOLDER
        folder.mkdir(exist_ok=True)
        write_evidence(folder / EVIDENCE_FILE, seen)
        chosen = as_computed(scores)
        write_text(folder / MACHINE_FILE, toml_of(chosen.candidate))
        write_text(folder / PAGE, page(scores, store))
    return Fitted(page=folder / PAGE, machine=folder / MACHINE_FILE, made=made, best=chosen)


def _best_on(surface: str, tried: list[Candidate], store: Store) -> Candidate | None:
    """The best candidate of the grid on that surface; None where a thinned grid has none."""
    scores = scores_of({one: store(one.piece) for one in tried if one.surface == surface})
    return best(scores).candidate if scores else None
