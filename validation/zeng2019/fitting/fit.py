"""`python -m validation.zeng2019 --fit`: the search computed, its evidence written."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from pathlib import Path

from rubgen.dataset.files import write_text
from rubgen.dataset.making.workers import usable_cores
from validation.piece import Piece
from validation.rows import write_rows
from validation.store import Progress, Store
from validation.zeng2019.figures import figure10, figure16, figure17, figure18, figures12to15
from validation.zeng2019.fitting.page import page
from validation.zeng2019.fitting.score import Score, best, frictionless, score
from validation.zeng2019.fitting.search import DAMPING, candidates, room, toml_of
from validation.zeng2019.size import FULL, MACHINE, QUICK, Size
from validation.zeng2019.statement import Statement

QUICK_THIN = 15
FOLDER, PAGE, MACHINE_FILE = "fit", "zeng2019-fit.md", "zeng2019-fitted.toml"
COMPARED = (
    figure10.SECTION,
    *figures12to15.SECTIONS,
    figure16.SECTION,
    figure17.SECTION,
    figure18.SECTION,
)
"""Sections that are judged with both machines; most others hang on neither damping nor the casing's mass."""
COARSE = replace(FULL, speed_thin=8, thin=4)
"""Their sweeps: the speed by 240 rev/min, every fourth support, and the values that the paper names."""


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """What `fit` left behind: the page with the evidence, the machine, and how many pieces were made now."""

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
    """Search the grid of unknowns, judge statements with preset and result; `out/fit` gets page, `fit.json`, machine.

    Resumable like `reproduce`; raises the same.
    """
    tried, store = candidates(QUICK_THIN if quick else 1), Store(Path(out))
    rooms = {damping: Piece(room, (damping,)) for damping in DAMPING}
    with store.claimed():
        made = store.compute([*(one.piece for one in tried), *rooms.values()], workers or usable_cores(), progress)
        scores = [score(one, store) for one in tried]
        folder = Path(out) / FOLDER
        folder.mkdir(exist_ok=True)
        found = best(frictionless(scores))
        write_text(folder / MACHINE_FILE, toml_of(found.candidate))
        size = QUICK if quick else COARSE
        sizes = [replace(size, machine=name) for name in (MACHINE, str(folder / MACHINE_FILE))]
        asked = [piece for one in sizes for section in COMPARED for piece in section.pieces(one)]
        made += store.compute(asked, workers or usable_cores(), progress)
        judged = [_judged(one, store) for one in sizes]
        write_rows(folder / "fit.json", [asdict(one) for one in scores])
        spans = {damping: store(piece) for damping, piece in rooms.items()}
        write_text(folder / PAGE, page(scores, spans, judged, size))
    return Fitted(page=folder / PAGE, machine=folder / MACHINE_FILE, made=made, best=found)


def _judged(size: Size, store: Store) -> list[tuple[str, Statement]]:
    return [(section.title, one) for section in COMPARED for one in section.statements(size, store)]
