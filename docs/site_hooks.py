"""Tables and pictures of the site: where cells may break, which tables stack on a phone, pictures that open alone.

Cells never break between a number and its error, and break in long names after _, / and a dot.
"""

import re

STACKED = {"cause", "class", "expected", "found with zeng2019", "labels", "main cause", "meaning", "metric", "reason"}
STACKED |= {"measured quantity", "result", "test", "unknowable"}
"""A table of four columns or more with one of these stacks its cells on a phone: the column holds text."""


def on_page_markdown(markdown: str, **_: object) -> str:
    """Keep `0.50 ± 0.02` in a table together."""
    return re.sub(r"^\|.*$", _with_errors, markdown, flags=re.MULTILINE)


def on_page_content(html: str, **_: object) -> str:
    """Let names break in cells, name the column in each cell of a table that stacks, let a click open a picture."""
    html = re.sub(r"<td[^>]*>.*?</td>", _with_breaks, html, flags=re.DOTALL)
    html = re.sub(r"<table>.*?</table>", _stacked, html, flags=re.DOTALL)
    return re.sub(r'(<a [^>]*>\s*)?<img [^>]*?src="([^"]+)"[^>]*>', _opened, html)


def _with_errors(row: re.Match[str]) -> str:
    return re.sub(r" (±|\+-) (?=\d)", "\u00a0\\1\u00a0", row[0])


def _with_breaks(cell: re.Match[str]) -> str:
    return re.sub(
        r"(?<=<code>)[^<]+(?=</code>)", lambda name: re.sub(r"(_|/|\.(?=[a-zA-Z]))(?=.)", r"\1<wbr>", name[0]), cell[0]
    )


def _opened(picture: re.Match[str]) -> str:
    return picture[0] if picture[1] else f'<a href="{picture[2]}" title="Open the picture">{picture[0]}</a>'


def _stacked(table: re.Match[str]) -> str:
    names = [re.sub(r"<[^>]+>", "", name).strip() for name in re.findall(r"<th[^>]*>(.*?)</th>", table[0], re.DOTALL)]
    if names[:2] != ["argument", "meaning"] and (len(names) < 4 or not STACKED & set(names)):
        return table[0]
    return re.sub(r"<tr>.*?</tr>", lambda row: _named(row[0], names), table[0], flags=re.DOTALL).replace(
        "<table>", "<table data-stack>"
    )


def _named(row: str, names: list[str]) -> str:
    columns = iter(names)
    return re.sub(r"<td", lambda _: f'<td data-column="{next(columns)}"', row)
