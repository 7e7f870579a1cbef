"""What only reads imports no kernel and no compiler: it works where nothing can be compiled or kept."""

import subprocess
import sys

READERS = [
    "rubgen.dataset.reading.open",
    "rubgen.dataset.checking.verify",
    "rubgen.dataset.checking.relabel",
    "rubgen.dataset.reading.replaying",
    "rubgen.cli.commands.inspecting",
    "rubgen.cli.commands.starting",
    "rubgen.cli.commands.drawing",
    "rubgen.report.page",
    "rubgen.cli.commands.featuring",
    "rubgen.cli.commands.exporting",
    "rubgen.cli.commands.scoring",
    "rubgen.viz.rerun",
    "rubgen.dataset.making.generate",  # the parent of workers: they compile
]
LOOK = """
import importlib, sys
for module in sys.argv[1:]:
    importlib.import_module(module)
    print(module, [m for m in sys.modules if m.split('.')[0] in ('numba', 'llvmlite') or m.endswith('_kernels')])
"""


def test_a_reader_imports_no_kernel():
    done = subprocess.run([sys.executable, "-c", LOOK, *READERS], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [f"{module} []" for module in READERS]
