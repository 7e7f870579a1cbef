"""Say where lines of tables may break: never between a number and its error, in long names after _, / and a dot."""

import re


def on_page_markdown(markdown: str, **_: object) -> str:
    """Keep `0.50 ± 0.02` in a table together."""
    return re.sub(r"^\|.*$", _with_errors, markdown, flags=re.MULTILINE)


def on_page_content(html: str, **_: object) -> str:
    """Let names and paths in the cells of tables break after an underscore, a slash or a dot."""
    return re.sub(r"<td[^>]*>.*?</td>", _with_breaks, html, flags=re.DOTALL)


def _with_errors(row: re.Match[str]) -> str:
    return re.sub(r" (±|\+-) (?=\d)", "\u00a0\\1\u00a0", row[0])


def _with_breaks(cell: re.Match[str]) -> str:
    return re.sub(
        r"(?<=<code>)[^<]+(?=</code>)", lambda name: re.sub(r"(_|/|\.(?=[a-zA-Z]))(?=.)", r"\1<wbr>", name[0]), cell[0]
    )
