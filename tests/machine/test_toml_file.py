"""TOML files as other systems and hands write them: each works, or is refused in one line that says what to do."""

import os

import pytest

from rubgen.errors import UserError
from rubgen.machine import load_machine
from rubgen.machine.load import PRESETS
from rubgen.machine.toml_file import MOST_BYTES, read_toml, toml_path
from rubgen.scenario import load_recipe
from rubgen.sensors.load import SETS, load_sensor_set

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
    "UTF-16 without mark": (
        GOOD.encode("utf-16-be"),
        "holds bytes that are zero, as texts in UTF-16 or UTF-32 do",
    ),
    "UTF-32": (GOOD.encode("utf-32"), "a text file in UTF-32; save it in UTF-8"),
    "UTF-32, big end first": (b"\0\0\xfe\xff" + GOOD.encode("utf-32-be"), "a text file in UTF-32; save it in UTF-8"),
    "Latin 1": (GOOD.encode() + 'c = "é"'.encode("latin-1"), "not a text file in UTF-8 (line 3); save it in UTF-8"),
    "too large": (b"#" * (MOST_BYTES + 1), "has 1,048,577 bytes; give a TOML file of at most 1,048,576"),
    "deep lists": (b"a = " + b"[" * 2000 + b"]" * 2000, "tables or lists in one another without end"),
    "long integer": (b"a = " + b"9" * 5000, "an integer of thousands of digits; numbers have 64 bits, shorten it"),
    "decimal comma": (
        b"a = 1\nclearance_m = 0,35",
        "line 2 is not TOML, clearance_m = 0,35: decimals have a point, write 0.35",
    ),
    "decimal comma in a table": (b"a = { mean = 0,1, std = 3 }", "decimals have a point, write 0.1"),
    "path of Windows": (b'a = "C:\\Users\\me\\m.toml"', "a path with backslashes stands in single quotes"),
    "another path of Windows": (b'machine = "..\\mine.toml"', "a path with backslashes stands in single quotes"),
    "no end": (b"a = ", "line 1 is not TOML, a =: write key = value, texts in quotes"),
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


LINES = {
    "name = d": "a text stands in quotes",
    'name = "d': "close the text with the quotes",
    "name = “d”": "quotes are straight",
    "seed : 3": "write key = value",
    "seed = True": "write true or false, in small letters",
    "seed = null": "leave the key out",
    "seed = 5 rpm": "give one number alone",
    "seed = 10 000": "give one number alone",
    "seed = 6,500": "thousands have no comma, write 6500",
    "seed = 07": "no zero in front",
    "seed = .5": "digits on both sides of its point",
    "seed = (1, 2)": "a list stands in square brackets",
    "seed = [1; 2]": "close the list with ]",
    "seed = { a = 1 ": "close the table with }",
    "seed = { a = 1, }": "none at its end",
    "// words": "a comment begins with #",
    "[vary": "a table begins with its name in square brackets",
    "a = 2": "is given twice; keep one of them",
}


@pytest.mark.parametrize("line", LINES)
def test_a_line_that_is_not_toml_is_shown_with_what_to_write(line, tmp_path):
    (tmp_path / "a.toml").write_text(f"a = 1\n{line}\n")
    text = refusal(tmp_path / "a.toml")
    assert text.startswith(f"{tmp_path / 'a.toml'}: line 2 is not TOML, {line.strip()}: ")
    assert LINES[line] in text


def test_a_file_of_another_kind_is_called_by_its_kind(tmp_path):
    (tmp_path / "r.toml").write_text('name = "a"\nruns = 1\nmachine = "zeng2019"\n')
    with pytest.raises(UserError, match=r"r.toml: this is a recipe, no machine; give the TOML file of a machine"):
        load_machine("r.toml", tmp_path)
    with pytest.raises(UserError, match=r"zeng2019.toml: this is a machine, no recipe"):
        load_recipe(PRESETS / "zeng2019.toml")
    with pytest.raises(UserError, match=r"rig.toml: this is a sensor set, no recipe"):
        load_recipe(SETS / "rig.toml")


def test_a_missing_file_is_named_with_its_key(tmp_path):
    with pytest.raises(UserError, match=r"machine = 'm.toml': .*m.toml: there is no such file; check the path"):
        load_machine("m.toml", tmp_path)
    with pytest.raises(UserError, match=r"sensors.set = '\$HOME/s.toml': .* are not replaced, write ~"):
        load_sensor_set("$HOME/s.toml", tmp_path)


def test_values_for_a_kind_that_no_sensor_has(tmp_path):
    text = 'name = "s"\n[kinds.torque]\nnoise = 1\n[[sensors]]\nname = "p"\nkind = "contact_force"\n'
    (tmp_path / "s.toml").write_text(text)
    with pytest.raises(UserError, match=r"s.toml: kinds.torque: the set has no sensor of this kind; add one or remove"):
        load_sensor_set("s.toml", tmp_path)


@pytest.mark.parametrize("bore", ["0.25", "60"])
def test_a_bore_beyond_the_rim(bore, tmp_path):
    text = (PRESETS / "zeng2019.toml").read_text().replace("bore_radius_m = 0.06", f"bore_radius_m = {bore}")
    (tmp_path / "m.toml").write_text(text)
    with pytest.raises(UserError, match=rf"disk: bore_radius_m = {bore} must be below rim_radius_m = 0.25; change one"):
        load_machine("m.toml", tmp_path)
