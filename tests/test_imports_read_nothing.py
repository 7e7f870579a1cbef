"""Importing any module of the package opens no file but Python's own: what is read, is read when it is asked for."""

import subprocess
import sys

IMPORTS = """
import importlib, importlib.util, pkgutil, sys
import rubgen
opened = []
folder = rubgen.__path__[0]
def note(event, arguments):
    if event == "open" and str(arguments[0]).startswith(folder) and not str(arguments[0]).endswith((".py", ".pyc")):
        opened.append(str(arguments[0]))
sys.addaudithook(note)
names = [module.name for module in pkgutil.walk_packages(rubgen.__path__, "rubgen.")]
if importlib.util.find_spec("torch") is None:
    names.remove("rubgen.torch")
for name in names:
    importlib.import_module(name)
print(len(names), *opened)
"""


def test_importing_every_module_reads_no_file():
    done = subprocess.run([sys.executable, "-c", IMPORTS], capture_output=True, text=True, check=True)
    count, *opened = done.stdout.split()
    assert int(count) > 150
    assert opened == []
