"""TOML files as other systems and hands write them: each works, or is refused in one line that says what to do."""

import os

import pytest

from rubgen.errors import UserError
from rubgen.machine.toml_file import MOST_BYTES, read_toml, toml_path

GOOD = 'a = 1\nb = "x"\n'


def refusal(path):
    with pytest.raises(UserError) as caught:
        read_toml(path)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    "content",
    [GOOD.encode("utf-8-sig"), GOOD.replace("\n", "\r\n").encode(), GOOD.replace("\n", "\r").encode()],
    ids=["byte order mark", "lines of Windows", "lines of old Macs"],
)
def test_texts_of_other_systems_are_read(tmp_path, content):
    (tmp_path / "a.toml").write_bytes(content)
    assert read_toml(tmp_path / "a.toml") == {"a": 1, "b": "x"}


def test_the_home_stands_for_its_sign(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "a.toml").write_text(GOOD)
    assert toml_path("~/a.toml", tmp_path / "elsewhere") == tmp_path / "a.toml"
    assert read_toml(toml_path("~/a.toml"))["a"] == 1
    assert str(toml_path("~nobody-of-this-name/a.toml")) == "~nobody-of-this-name/a.toml"


BAD_BYTES = {
    "UTF-16": (GOOD.encode("utf-16"), "a text file in UTF-16; save it in UTF-8"),
    "UTF-16 without mark": (GOOD.encode("utf-16-be"), "holds bytes that are zero, as texts in UTF-16 do; save it in"),
    "Latin 1": (GOOD.encode() + 'c = "é"'.encode("latin-1"), "not a text file in UTF-8 (line 3); save it in UTF-8"),
    "too large": (b"#" * (MOST_BYTES + 1), "has 1,048,577 bytes; give a TOML file of at most 1,048,576"),
    "deep lists": (b"a = " + b"[" * 2000 + b"]" * 2000, "tables or lists in one another without end"),
    "long integer": (b"a = " + b"9" * 5000, "an integer of thousands of digits; numbers have 64 bits, shorten it"),
    "decimal comma": (b"a = 1\nclearance_m = 0,35", "(at line 2, column 16)); decimals have a point, write 0.35"),
    "decimal comma in a table": (b"a = { mean = 0,1, std = 3 }", "decimals have a point, write 0.1"),
    "path of Windows": (b'a = "C:\\Users\\me\\m.toml"', "a path with backslashes stands in single quotes"),
    "another path of Windows": (b'machine = "..\\mine.toml"', "a path with backslashes stands in single quotes"),
    "no end": (b"a = ", "not TOML (Invalid value (at end of document)); mend the line that is named"),
}


@pytest.mark.parametrize("case", BAD_BYTES.values(), ids=BAD_BYTES.keys())
def test_what_cannot_be_read_says_how_to_mend_it(tmp_path, case):
    content, message = case
    (tmp_path / "a.toml").write_bytes(content)
    text = refusal(tmp_path / "a.toml")
    assert text.startswith(f"{tmp_path / 'a.toml'}: ")
    assert message in text


def test_what_is_no_file_is_not_opened(tmp_path):
    os.mkfifo(tmp_path / "fifo.toml")
    (tmp_path / "loop.toml").symlink_to(tmp_path / "loop.toml")
    assert "it is no regular file; give a TOML file" in refusal(tmp_path / "fifo.toml")
    assert "it is no regular file; give a TOML file" in refusal("/dev/zero")
    assert "it is a directory; give a TOML file" in refusal(tmp_path)
    assert "there is no such file; check the path" in refusal(tmp_path / "none.toml")
    assert "there is no such file; check the path" in refusal(tmp_path / "fifo.toml" / "a.toml")
    assert "cannot be read (" in refusal(tmp_path / "loop.toml")
    assert "cannot be read (" in refusal("a" * 5000)


def test_a_file_of_a_gigabyte_is_refused_by_its_first_bytes(tmp_path):
    with (tmp_path / "big.toml").open("wb") as file:
        file.truncate(2**30)
    assert "has 1,073,741,824 bytes" in refusal(tmp_path / "big.toml")


@pytest.mark.parametrize("path", ["a\0b.toml", "C:\temp\new.toml"], ids=["NUL", "escapes that TOML knows"])
def test_a_path_with_control_characters_is_shown_in_quotes(path):
    text = refusal(path)
    assert text.startswith(f"{path!r}: a path has no control characters; in TOML write a path with backslashes in sing")
