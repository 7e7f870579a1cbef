"""The remedy for a line that is not TOML, from the line itself. The parser's own messages are for programmers."""

import re

from rubgen.machine.sentences import DECIMAL_COMMA

BACKSLASH = re.compile(r'"[^"]*\\[^"]*"')
CURVED_QUOTES = re.compile("[“”„‘’«»]")
SWITCH = re.compile(r"true|false|yes|no|on|off", re.IGNORECASE)
NOTHING = re.compile(r"none|null|nil|nan\w+", re.IGNORECASE)
COMMENTS = ("//", "/*", ";", "--", "%")
TWICE = ("Cannot ", "Duplicate ")
UNCLOSED = {
    "Unclosed array": "close the list with ], with a comma between its values",
    "Unclosed inline table": "close the table with }, with a comma between its values",
}


def remedy(line: str, error: str) -> str:
    """What to write instead of the line; `error` is the message of the parser."""
    value = line.partition("=")[2].strip()
    return _of_whole_line(line.strip(), value, error) or _of_value(value) or "write key = value, texts in quotes"


def _of_whole_line(line: str, value: str, error: str) -> str:
    if BACKSLASH.search(value):
        return "a path with backslashes stands in single quotes, 'C:\\folder\\file.toml', or is written with /"
    if error.startswith(TWICE):
        return "this key or table is given twice; keep one of them"
    if CURVED_QUOTES.search(line):
        return "quotes are straight, \"text\" or 'text'"
    if line.startswith(COMMENTS):
        return "a comment begins with #"
    if line.startswith("["):
        return "a table begins with its name in square brackets, [name]"
    if "=" not in line:
        return "write key = value"
    return next((words for start, words in UNCLOSED.items() if error.startswith(start)), "")


def _of_value(value: str) -> str:
    comma = DECIMAL_COMMA.search(value)
    if comma:
        thousands = f", thousands have no comma, write {comma[1]}{comma[2]}" if len(comma[2]) == 3 else ""
        return f"decimals have a point, write {comma[1]}.{comma[2]}{thousands}"
    if SWITCH.fullmatch(value):
        return "write true or false, in small letters"
    if NOTHING.fullmatch(value):
        return "leave the key out"
    if value.startswith(('"', "'")):
        return "close the text with the quotes that it begins with, and write nothing behind it"
    if "(" in value:
        return "a list stands in square brackets, [1, 2]"
    if value.startswith("{"):
        return "a table in braces stands in one line, with a comma between its values and none at its end"
    return _of_number(value) or ('a text stands in quotes, "text"' if value[:1].isalpha() else "")


def _of_number(value: str) -> str:
    if re.match(r"[-+]?\.\d", value) or re.match(r"[-+]?\d+\.(\D|$)", value):
        return "a number has digits on both sides of its point, 0.5 or 5.0"
    if re.match(r"[-+]?0\d", value):
        return "a number has no zero in front"
    return "give one number alone; its unit stands in the name of the key" if re.match(r"[-+]?\d", value) else ""
