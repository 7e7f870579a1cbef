"""Standard streams that a shell, a service or a scheduler has closed."""

import os
import subprocess
import sys

import pytest

from rubgen.cli.printing import say

COMMAND = [sys.executable, "-c", "from rubgen.cli import main; main(['modes', 'no-such-machine'])"]
OPENED = """
import os, sys
from rubgen.cli import _open_streams
_open_streams()
numbers = [os.open(sys.argv[1], os.O_WRONLY | os.O_CREAT) for _ in range(2)]
print("text", flush=True)
sys.exit(0 if min(numbers) > 2 else 9)
"""


@pytest.mark.parametrize("closed", [(0,), (1,), (2,), (0, 1, 2)])
def test_a_closed_stream_costs_no_traceback_and_no_file(closed, tmp_path):
    def close():
        for number in closed:
            os.close(number)

    done = subprocess.run(COMMAND, capture_output=True, text=True, preexec_fn=close, check=False)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert ("no such preset" in done.stderr) is (2 not in closed)
    command = [sys.executable, "-c", OPENED, tmp_path / "file"]
    assert subprocess.run(command, capture_output=True, preexec_fn=close, check=False).returncode == 0
    assert (tmp_path / "file").read_bytes() == b""


@pytest.mark.parametrize("name", ["red\x1b[31m", "new\nline", "bell\a"])
def test_a_name_with_control_characters_stays_one_line_that_no_terminal_obeys(run, tmp_path, capsys, name):
    code, _, told = run("info", str(tmp_path / name))
    assert code == 2
    say(f"{name}: 1.5 µm, 90° ± 1")
    for text in (told, capsys.readouterr().out):
        assert text.removesuffix("\n").isprintable()
    assert text.endswith(": 1.5 µm, 90° ± 1\n")


@pytest.mark.parametrize("buffered", [True, False])
@pytest.mark.parametrize("arguments", ["list", "list --json", "--help", "plan --help", "completion zsh", "modes none"])
def test_a_reader_that_goes_ends_a_command_without_a_word(arguments, buffered):
    code = "import sys; from rubgen.cli import main; main(sys.argv[1:])"
    reading, writing = os.pipe()
    os.close(reading)
    streams = {"stdout": writing, "stderr": writing if arguments == "modes none" else subprocess.PIPE}
    command = [sys.executable, *([] if buffered else ["-u"]), "-c", code, *arguments.split()]
    done = subprocess.run(command, **streams, text=True, check=False)
    os.close(writing)
    assert (done.stderr or "", done.returncode) == ("", 141)
