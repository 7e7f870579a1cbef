"""The page, as Markdown beside its pictures and as one HTML file."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape

from validation.markdown import folded, table
from validation.zeng2019.changes import changed, tally
from validation.zeng2019.differences import Experiment, cause_of
from validation.zeng2019.fitting.evidence import read_evidence
from validation.zeng2019.meanings import MEANINGS
from validation.zeng2019.remarks import (
    CHANGES,
    CHANGES_TEXT,
    DIFFERENCES,
    DIFFERENCES_TEXT,
    EVERY_REMARK,
    INTRODUCTION,
    QUICK_REMARK,
    TITLE,
    rules,
)
from validation.zeng2019.section import Section
from validation.zeng2019.size import AS_COMPUTED, MACHINE, QUICK, Size
from validation.zeng2019.statement import DIFFERS, Statement

PAGE = "zeng2019"
PARTS = {
    "modes": "modes and frequencies (figures 6 to 9)",
    "speed": "the sweep of the speed (figures 10 and 11)",
    "regions": "regions of the speed (figures 12 to 16)",
    "disk-support": "stiffness of the disk's support (figures 17 to 19)",
    "casing-support": "stiffness of the casing's support (figures 20 and 21)",
    "conclusions": "friction, conclusions and causes",
}
"""The parts of the page by the ending of their file names."""
LAST_FIGURE = {"modes": 9, "speed": 11, "regions": 16, "disk-support": 19, "casing-support": 21}
DIFFERING = "differences"
POINTER = f"[The first page]({PAGE}.md) names the machines, the rules of the verdicts and the counts."
STYLE = (
    "body{font:15px/1.5 sans-serif;max-width:72em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;width:100%;font-size:13px}td,th{border-top:1px solid #ddd;padding:.3em .5em;"
    "text-align:left;vertical-align:top}img{max-width:100%}code{background:#f4f4f4}"
    ".differs{color:#d55e00}.agrees{color:#009e73}.unknowable{color:#8c8c8c}"
)
HEADER = ("statement", "verdict", "found")
COMPARED_HEADER = ("statement", MACHINE, AS_COMPUTED, f"found with {MACHINE}", f"found with {AS_COMPUTED}")
DIFFERENCE_HEADER = ("figure", "statement", MACHINE, AS_COMPUTED, "main cause", "experiment")
CHANGE_HEADER = ("figure", "statement", "before", "after", "reason")
VERDICTS = ("agrees", "agrees within", "differs", "unknowable")
COUNT_HEADER = ("statements", "agrees", "agrees within X", "differs", "unknowable", "all")
HEADER_BY_FIGURE = f"by figure, {MACHINE}"
Rows = Sequence[Sequence[str]]


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A picture: file name, caption, PNG."""

    name: str
    caption: str
    png: bytes


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A section with its verdicts and pictures; `others` are the statements with each further machine."""

    section: Section
    statements: tuple[Statement, ...]
    others: tuple[tuple[Statement, ...], ...] = ()
    drawn: tuple[Drawn, ...]

    def other(self, machine: int, one: Statement) -> Statement | None:
        """The same statement with the further machine of that number; None where it was not asked."""
        found = self.others[machine] if self.others else ()
        return next((each for each in found if each.statement == one.statement), None)


def pages(judged: Sequence[Judged], size: Size) -> dict[str, str]:
    """The pages as Markdown by file name, beside their pictures: one for a single section, else one for each part."""
    if len(judged) == 1:
        return {f"{PAGE}.md": _joined([*_head(judged, size), *_sections(judged, size), *_ending(judged)])}
    parts = {part: [each for each in judged if part_of(each.section.name) == part] for part in PARTS}
    links = "\n".join(f"- [{title}]({PAGE}-{part}.md)" for part, title in [*PARTS.items(), (DIFFERING, DIFFERENCES)])
    made = {f"{PAGE}.md": _joined([*_head(judged, size), f"## The parts\n\n{links}"])}
    for part, found in parts.items():
        made[f"{PAGE}-{part}.md"] = _joined([f"# {TITLE}: {PARTS[part]}", POINTER, *_sections(found, size)])
    made[f"{PAGE}-{DIFFERING}.md"] = _joined([f"# {TITLE}: what differs, and why", POINTER, *_ending(judged)])
    return made


def part_of(name: str) -> str:
    """The part of the pages that has the section of that name."""
    number = int(name) if name.isdecimal() else 99
    return next((part for part, last in LAST_FIGURE.items() if number <= last), "conclusions")


def _joined(parts: Sequence[str]) -> str:
    return "\n\n".join(parts) + "\n"


def _head(judged: Sequence[Judged], size: Size) -> list[str]:
    counts = [table(COUNT_HEADER, _by_kind(judged)), table((HEADER_BY_FIGURE, *COUNT_HEADER[1:]), _by_figure(judged))]
    return [f"# {TITLE}", *_introduction(size), *counts]


def _sections(judged: Sequence[Judged], size: Size) -> list[str]:
    parts = []
    for each in judged:
        parts += [f"## {each.section.title}", each.section.text, f"    {each.section.command}{size.option}"]
        parts += [f"![{picture.caption}]({picture.name})\n\n*{picture.caption}.*" for picture in each.drawn]
        header, rows = _statements(each)
        parts.append(table(header, rows))
    return parts


def _ending(judged: Sequence[Judged]) -> list[str]:
    parts = []
    for title, text, tables in _closing(judged):
        parts += [f"## {title}", text, *(_closing_table(header, rows) for header, rows in tables if rows)]
    return parts


def _closing_table(header: Sequence[str], rows: Rows) -> str:
    made = table(header, rows)
    return folded(f"{len(rows)} statements whose verdict changed", made) if header is CHANGE_HEADER else made


def html(judged: Sequence[Judged], size: Size) -> str:
    """The page as one HTML file with its pictures in it."""
    parts = [f"<h1>{escape(TITLE)}</h1>", *(f"<p>{_inline(text)}</p>" for text in _introduction(size))]
    parts.append(_html_table(COUNT_HEADER, _by_kind(judged)))
    parts.append(_html_table((HEADER_BY_FIGURE, *COUNT_HEADER[1:]), _by_figure(judged)))
    for each in judged:
        parts += [f"<h2>{escape(each.section.title)}</h2>", f"<p>{_inline(each.section.text)}</p>"]
        parts.append(f"<p><code>{escape(each.section.command + size.option)}</code></p>")
        parts += [_figure(picture) for picture in each.drawn]
        parts.append(_html_table(*_statements(each)))
    for title, text, tables in _closing(judged):
        parts += [f"<h2>{title}</h2>", f"<p>{_inline(text)}</p>"]
        parts += [_html_table(header, rows) for header, rows in tables if rows]
    body = "\n".join(parts)
    head = f'<meta charset="utf-8"><title>{escape(TITLE)}</title><style>{STYLE}</style>'
    return f"<!doctype html><html><head>{head}</head><body>{body}</body></html>\n"


def _introduction(size: Size) -> list[str]:
    remark = [QUICK_REMARK] if size.name == QUICK.name else [EVERY_REMARK] if size.speed_thin > 1 else []
    return [*INTRODUCTION.split("\n\n"), *remark, *rules(size).split("\n\n")]


def _statements(each: Judged) -> tuple[Sequence[str], Rows]:
    if not each.others:
        return HEADER, [(one.statement, _verdict(one), _found(one)) for one in each.statements]
    rows = []
    for one in each.statements:
        other = each.other(0, one)
        told = (_verdict(other), other.found) if other else ("not asked", "")
        rows.append((one.statement, _verdict(one), told[0], _found(one), told[1]))
    return COMPARED_HEADER, rows


def _verdict(one: Statement) -> str:
    return one.verdict + (" (fitted)" if one.used_for_fitting else f" ({one.apart})" if one.apart else "")


def _found(one: Statement) -> str:
    eye = f"By {one.other_bound}: `{one.by_eye}`" if one.by_eye and one.by_eye != one.verdict else ""
    return ". ".join(part.rstrip(".") for part in (one.found, eye, one.why) if part)


def _closing(judged: Sequence[Judged]) -> list[tuple[str, str, list[tuple[Sequence[str], Rows]]]]:
    """Title, text and tables of what ends the page: causes of the differences; the tally before and after."""
    rows, counts = _differences(judged)
    verdicts = {(each.section.title, one.statement): one for each in judged for one in each.statements}
    causes: list[tuple[Sequence[str], Rows]] = [
        (("main cause", "meaning", "statements"), counts),
        (DIFFERENCE_HEADER, rows),
    ]
    parts = [(DIFFERENCES, DIFFERENCES_TEXT, causes)]
    if len(judged) > 1:
        moved: list[tuple[Sequence[str], Rows]] = [(COUNT_HEADER, tally(verdicts)), (CHANGE_HEADER, changed(verdicts))]
        parts.append((CHANGES, CHANGES_TEXT, moved))
    return parts


def _differences(judged: Sequence[Judged]) -> tuple[Rows, Rows]:
    """Each of the paper's statements that differs with the preset, and how often each cause is named."""
    search, experiments, rows = read_evidence(), _experiments(judged), []
    for each, one in _counted(judged):
        if one.verdict != DIFFERS:
            continue
        chords, twin = each.other(0, one), each.other(1, one)
        cause = cause_of(one, chords, twin, search, experiments)
        title = each.section.title.split(":")[0]
        told = _verdict(chords) if chords else "the same blisk" if part_of(each.section.name) == "modes" else "not run"
        rows.append((title, one.statement, _verdict(one), told, cause.name, cause.experiment))
    counts = [(name, meaning, str(sum(row[4] == name for row in rows))) for name, meaning in MEANINGS.items()]
    return rows, counts


def _experiments(judged: Sequence[Judged]) -> list[Experiment]:
    """The experiments about statements of the paper."""
    return [
        Experiment(section=each.section.name, preset=one, chords=each.other(0, one))
        for each in judged
        for one in each.statements
        if one.about
    ]


def _counted(judged: Sequence[Judged]) -> Iterator[tuple[Judged, Statement]]:
    """The paper's own statements, with their sections."""
    return ((each, one) for each in judged for one in each.statements if not one.apart)


def _by_kind(judged: Sequence[Judged]) -> Rows:
    """The tally of the preset; and of both machines over the sections that are run with both."""
    every = [one for _, one in _counted(judged)]
    both = [one for each, one in _counted(judged) if each.others]
    chords = [one for each in judged if each.others for one in each.others[0] if not one.apart]
    groups = [(MACHINE, every), (f"{MACHINE}, compared figures", both), (f"{AS_COMPUTED}, compared figures", chords)]
    return [
        _counts(f"{name}: {kind}", [one for one in ones if one.used_for_fitting == fitted])
        for name, ones in groups
        if ones
        for kind, fitted in (("predictions", False), ("used for fitting", True))
    ]


def _by_figure(judged: Sequence[Judged]) -> Rows:
    counted = {each.section.title: [one for one in each.statements if not one.apart] for each in judged}
    return [_counts(title, ones) for title, ones in counted.items() if ones]


def _counts(name: str, chosen: Sequence[Statement]) -> list[str]:
    return [name, *(str(sum(_kind(one) == kind for one in chosen)) for kind in VERDICTS), str(len(chosen))]


def _kind(one: Statement) -> str:
    return "agrees within" if one.verdict.startswith("agrees within") else one.verdict


def _figure(picture: Drawn) -> str:
    data = b64encode(picture.png).decode()
    caption = escape(picture.caption)
    return f'<p><img alt="{caption}" src="data:image/png;base64,{data}"><br><em>{caption}.</em></p>'


def _html_table(header: Sequence[str], rows: Rows) -> str:
    """A table whose cells that begin with a verdict are coloured by it."""
    lines = ["".join(f"<th>{escape(cell)}</th>" for cell in header)]
    for row in rows:
        kinds = (cell.split()[0] if cell.startswith(VERDICTS) else "" for cell in row)
        lines.append("".join(f'<td class="{kind}">{_inline(cell)}</td>' for kind, cell in zip(kinds, row, strict=True)))
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def _inline(text: str) -> str:
    """Escaped text with code between backticks."""
    parts = escape(text).split("`")
    return "".join(f"<code>{part}</code>" if i % 2 else part for i, part in enumerate(parts))
