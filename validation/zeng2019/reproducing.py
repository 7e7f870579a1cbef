"""The whole: what is asked for is computed, judged and written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from rubgen.dataset.files import write_text
from rubgen.dataset.making.workers import usable_cores
from rubgen.errors import UserError
from rubgen.io.files import write_durably
from validation.rows import Row, write_rows
from validation.store import Progress, Store
from validation.zeng2019.drawing.style import png
from validation.zeng2019.fitting.evidence import read_evidence
from validation.zeng2019.fitting.page import ROOMS
from validation.zeng2019.fitting.page import page as page_of_the_fit
from validation.zeng2019.page import PAGE, Drawn, Judged, html, pages
from validation.zeng2019.section import Section
from validation.zeng2019.sections import SECTIONS
from validation.zeng2019.size import FULL, MACHINES, QUICK, Size, sizes

FIT_PAGE = "zeng2019-fit.md"


@dataclass(frozen=True, kw_only=True)
class Reproduced:
    """What `reproduce` left behind: the page, how many pieces were made now, and how often each verdict was given.

    `verdicts` counts the paper's statements with the preset.
    """

    page: Path
    made: int
    verdicts: dict[str, int]


def reproduce(
    out: Path | str,
    *,
    figure: str | None = None,
    quick: bool = False,
    every: int = 1,
    size: Size | None = None,
    workers: int | None = None,
    progress: Progress = lambda _done, _all: None,
) -> Reproduced:
    """Compute what the paper shows, judge its statements, write the page into `out`.

    `every` takes every so many-th speed: 1 steps by 30 rev/min, 4 by 120. `figure` asks for one section; its page goes
    to `out/figure-N`. Sections that are `compared` are judged with all of MACHINES. Pieces of computation are kept in
    `out/pieces`: the same call after an interruption makes the rest. Writes `zeng2019*.md` with their pictures,
    `zeng2019.html` (one file) and `statements.json`; for all figures also the page of the search, from its kept
    results. Raises UserError for an unknown figure, and for an `out` that is not ours or cannot be written.
    """
    chosen, size = sections_of(figure), size or (QUICK if quick else replace(FULL, speed_thin=every))
    store = Store(Path(out))
    with store.claimed():
        pieces = [piece for section in chosen for one in _sizes(section, size) for piece in section.pieces(one)]
        pieces += ROOMS.values() if figure is None else ()
        made = store.compute(pieces, workers or usable_cores(), progress)
        judged = [judge(section, size, store) for section in chosen]
        folder = Path(out) if figure is None else Path(out) / f"figure-{chosen[0].name}"
        folder.mkdir(exist_ok=True)
        page = write(judged, size, folder)
        if figure is None:
            write_text(folder / FIT_PAGE, page_of_the_fit(read_evidence(), store))
    return Reproduced(page=page, made=made, verdicts=_count(judged))


def sections_of(figure: str | None) -> Sequence[Section]:
    """All sections, or the one of that name; UserError where there is none."""
    if figure is None:
        return SECTIONS
    chosen = [section for section in SECTIONS if figure in (section.name, *section.also)]
    if not chosen:
        names = ", ".join(name for section in SECTIONS for name in (section.name, *section.also))
        raise UserError(f"--figure {figure}: there is no such figure; choose from {names}")
    return chosen


def _sizes(section: Section, size: Size) -> list[Size]:
    return list(sizes(size).values()) if section.compared else [size]


def judge(section: Section, size: Size, store: Store) -> Judged:
    """The section with its verdicts, by machine, and pictures, of the preset."""
    drawn = [
        Drawn(name=f"{PAGE}-{section.name}{'abcdef'[i]}.png", caption=caption, png=png(figure))
        for i, (caption, figure) in enumerate(section.figures(size, store).items())
    ]
    own, *others = (tuple(section.statements(one, store)) for one in _sizes(section, size))
    return Judged(section=section, statements=own, others=tuple(others), drawn=tuple(drawn))


def write(judged: Sequence[Judged], size: Size, folder: Path) -> Path:
    """Write page, pictures and statements into `folder`; gives the Markdown's path."""
    for picture in (picture for each in judged for picture in each.drawn):
        _write_png(folder / picture.name, picture.png)
    write_rows(folder / "statements.json", statement_rows(judged, size))
    write_text(folder / f"{PAGE}.html", html(judged, size))
    for name, text in pages(judged, size).items():
        write_text(folder / name, text)
    return folder / f"{PAGE}.md"


def statement_rows(judged: Sequence[Judged], size: Size) -> list[Row]:
    """Rows of `figure`, `machine`, a Statement's fields, and `command`; the machines of a section one after another."""
    return [
        {"figure": each.section.name, "machine": machine, **asdict(one), "command": each.section.command + size.option}
        for each in judged
        for machine, statements in zip(MACHINES, (each.statements, *each.others), strict=False)
        for one in statements
    ]


def _write_png(path: Path, png: bytes) -> None:
    write_durably(path, lambda part: part.write_bytes(png))


def _count(judged: Sequence[Judged]) -> dict[str, int]:
    verdicts = [one.verdict for each in judged for one in each.statements if not one.apart]
    kinds = ["agrees within" if verdict.startswith("agrees within") else verdict for verdict in verdicts]
    return {kind: kinds.count(kind) for kind in ("agrees", "agrees within", "differs", "unknowable")}
