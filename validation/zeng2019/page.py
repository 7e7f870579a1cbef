"""The page, as Markdown beside its pictures and as one HTML file."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from validation.markdown import table
from validation.zeng2019.remarks import EVERY_REMARK, INTRODUCTION, MACHINES, QUICK_REMARK, TITLE, rules
from validation.zeng2019.section import Section
from validation.zeng2019.size import QUICK, Size
from validation.zeng2019.statement import Statement

STYLE = (
    "body{font:15px/1.5 sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;width:100%;font-size:13px}td,th{border-top:1px solid #ddd;padding:.3em .5em;"
    "text-align:left;vertical-align:top}img{max-width:100%}code{background:#f4f4f4}"
    ".differs{color:#d55e00}.agrees{color:#009e73}.unknowable{color:#8c8c8c}"
)
HEADER = ("statement", "verdict", "found")
VERDICTS = ("agrees", "agrees within", "differs", "unknowable")
COUNT_HEADER = ("statements", "agrees", "agrees within X", "differs", "unknowable", "all")
HEADER_BY_FIGURE = "by figure, all kinds"


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A picture: file name, caption, PNG."""

    name: str
    caption: str
    png: bytes


@dataclass(frozen=True, kw_only=True)
class Judged:
    """A section with its verdicts and pictures."""

    section: Section
    statements: tuple[Statement, ...]
    drawn: tuple[Drawn, ...]


def markdown(judged: Sequence[Judged], size: Size) -> str:
    """The page as Markdown; pictures are named as they stand beside it."""
    parts = [f"# {TITLE}", *_introduction(size), table(COUNT_HEADER, _by_kind(judged))]
    parts.append(table((HEADER_BY_FIGURE, *COUNT_HEADER[1:]), _by_figure(judged)))
    for each in judged:
        parts += [f"## {each.section.title}", each.section.text, f"    {each.section.command}{size.option}"]
        parts += [f"![{picture.caption}]({picture.name})\n\n*{picture.caption}.*" for picture in each.drawn]
        parts.append(table(HEADER, [_cells(one) for one in each.statements]))
    return "\n\n".join(parts) + "\n"


def html(judged: Sequence[Judged], size: Size) -> str:
    """The page as one HTML file with its pictures in it."""
    parts = [f"<h1>{escape(TITLE)}</h1>", *(f"<p>{_inline(text)}</p>" for text in _introduction(size))]
    parts.append(_count_html(COUNT_HEADER, _by_kind(judged)))
    parts.append(_count_html((HEADER_BY_FIGURE, *COUNT_HEADER[1:]), _by_figure(judged)))
    for each in judged:
        parts += [f"<h2>{escape(each.section.title)}</h2>", f"<p>{_inline(each.section.text)}</p>"]
        parts.append(f"<p><code>{escape(each.section.command + size.option)}</code></p>")
        parts += [_figure(picture) for picture in each.drawn]
        parts.append(_html_table(each.statements))
    body = "\n".join(parts)
    head = f'<meta charset="utf-8"><title>{escape(TITLE)}</title><style>{STYLE}</style>'
    return f"<!doctype html><html><head>{head}</head><body>{body}</body></html>\n"


def _introduction(size: Size) -> list[str]:
    remark = [QUICK_REMARK] if size.name == QUICK.name else [EVERY_REMARK] if size.speed_thin > 1 else []
    return [INTRODUCTION + MACHINES[size.machine], *remark, rules(size)]


def _cells(one: Statement) -> tuple[str, str, str]:
    kind = " (fitted)" if one.used_for_fitting else " (experiment)" if one.experiment else ""
    verdict = one.verdict + kind
    return one.statement, verdict, f"{one.found}. {one.why}".removesuffix(". ") if one.why else one.found


def _by_kind(judged: Sequence[Judged]) -> list[list[str]]:
    every = [one for each in judged for one in each.statements]
    return [
        _counts("predictions", [one for one in every if not (one.used_for_fitting or one.experiment)]),
        _counts("used for fitting", [one for one in every if one.used_for_fitting]),
        _counts("hypotheses about causes, by experiment", [one for one in every if one.experiment]),
    ]


def _by_figure(judged: Sequence[Judged]) -> list[list[str]]:
    return [_counts(each.section.title, each.statements) for each in judged]


def _counts(name: str, chosen: Sequence[Statement]) -> list[str]:
    return [name, *(str(sum(_kind(one) == kind for one in chosen)) for kind in VERDICTS), str(len(chosen))]


def _kind(one: Statement) -> str:
    return "agrees within" if one.verdict.startswith("agrees within") else one.verdict


def _figure(picture: Drawn) -> str:
    data = b64encode(picture.png).decode()
    caption = escape(picture.caption)
    return f'<p><img alt="{caption}" src="data:image/png;base64,{data}"><br><em>{caption}.</em></p>'


def _count_html(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = ["".join(f"<th>{escape(cell)}</th>" for cell in header)]
    lines += ["".join(f"<td>{escape(cell)}</td>" for cell in row) for row in rows]
    return f"<table>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"


def _html_table(statements: Sequence[Statement]) -> str:
    rows = ["".join(f"<th>{name}</th>" for name in HEADER)]
    for one in statements:
        texts = [_inline(cell) for cell in _cells(one)]
        rows.append(f'<td>{texts[0]}</td><td class="{one.verdict.split()[0]}">{texts[1]}</td><td>{texts[2]}</td>')
    return f"<table>{''.join(f'<tr>{row}</tr>' for row in rows)}</table>"


def _inline(text: str) -> str:
    """Escaped text with code between backticks."""
    parts = escape(text).split("`")
    return "".join(f"<code>{part}</code>" if i % 2 else part for i, part in enumerate(parts))
