"""An interrupt ends a command in one line, whatever swallows the exception on the way."""

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import rubgen
from rubgen.cli.interrupts import terminable


def swallow(signal_number):
    """What compiled code does with an exception that it cannot pass on; then it fails by itself."""
    try:
        os.kill(os.getpid(), signal_number)
        time.sleep(5)  # not for ever, where no handler is there
    except KeyboardInterrupt:
        pass
    raise RuntimeError("no compiled object yet")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_what_fails_after_an_interrupt_is_the_interrupt(number):
    with pytest.raises(KeyboardInterrupt), terminable():
        swallow(number)


def test_without_an_interrupt_errors_stay_what_they_are():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(RuntimeError, match="no compiled"), terminable():
        raise RuntimeError("no compiled object yet")
    assert signal.getsignal(signal.SIGTERM) is before


def test_in_another_thread_signals_are_left_alone():
    done = []

    def work():
        with terminable():
            done.append(signal.getsignal(signal.SIGTERM))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done == [signal.getsignal(signal.SIGTERM)]


@pytest.mark.parametrize("where", ["an import", "a callback", "a print"])
def test_an_interrupt_that_is_swallowed_ends_the_command_in_one_line(where):
    # The module that the command imports first swallows the signal, as pandas and llvmlite do.
    fails = "raise AttributeError('partially initialized module')"
    calls = {
        "an import": f"os.kill(os.getpid(), signal.SIGINT)\n    except KeyboardInterrupt:\n        {fails}",
        "a callback": f"ctypes.CFUNCTYPE(None)(lambda: os.kill(os.getpid(), signal.SIGINT))()\n        {fails}\n"
        "    finally: pass",
        # as numpy's import_array does
        "a print": f"ctypes.pythonapi.PyRun_SimpleString(b'os.kill(os.getpid(), signal.SIGINT)')\n        {fails}\n"
        "    finally: pass",
    }[where]
    code = (
        "import ctypes, os, signal, sys\nfrom rubgen import cli\nfrom rubgen.cli import run\n"
        f"def main(arguments):\n    try:\n        {calls}\nrun.main = main\ncli.main(['info', 'x'])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (130, "rubgen: interrupted\n")


def test_a_command_imports_no_other_module_before_it_handles_an_interrupt():
    # -S: what Python's own start imports differs from place to place
    code = "import sys; sys.path.insert(0, sys.argv[1]); before = {*sys.modules}; import rubgen.cli; "
    code += "print(*sorted({*sys.modules} - before))"
    root = str(Path(rubgen.__file__).parent.parent)
    done = subprocess.run([sys.executable, "-S", "-c", code, root], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) <= {"__future__", "rubgen", "rubgen.cli"}
