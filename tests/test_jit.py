"""Compiled kernels are those of today's source, whatever lies in the cache."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import rubgen
from rubgen import cache_root
from rubgen.cache_root import CACHE_VARIABLE
from rubgen.errors import RubgenWarning
from rubgen.jit import inlined_kernel, kernel, kernel_key, kernels_are_compiled

PACKAGE = Path(rubgen.__file__).parent
CALLED = "from rubgen.jit import kernel\n@kernel\ndef called(x: float) -> float:\n    return x + 1.0\n"
CALLING = (
    "from rubgen.called_kernels import called\nfrom rubgen.jit import kernel\n"
    "@kernel\ndef calling(x: float) -> float:\n    return 10.0 * called(x)\n"
)
CALL = [sys.executable, "-c", "from rubgen.calling_kernels import calling; print(calling(2.0))"]


@pytest.fixture
def functions(tmp_path, monkeypatch):
    """Two plain functions of one file, and an empty cache."""
    source = tmp_path / "some_kernels.py"
    source.write_text("def double(x):\n    return 2.0 * x\n\n\ndef treble(x):\n    return 3.0 * x\n")
    spec = importlib.util.spec_from_file_location("some_kernels", source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setitem(sys.modules, "some_kernels", module)
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    cache_root._say_once.cache_clear()
    return module


def run(function):
    """Its value at 1, and whether it came from the cache."""
    compiled = kernel(function)
    value = compiled(1.0)
    return value, bool(compiled.stats.cache_hits)


def files(tmp_path: Path, name: str, ending: str) -> Path:
    (found,) = (tmp_path / "cache").rglob(f"some_kernels.{name}-*.{ending}")
    return found


def test_a_kernel_is_compiled_once(functions):
    assert [run(functions.double), run(functions.double)] == [(2.0, False), (2.0, True)]


def test_python_and_another_kernel_can_call_the_same_kernel(functions):
    double = kernel(functions.double)

    @kernel
    def quadruple(x):
        return double(double(x))

    assert [quadruple(1.5), double(1.5), quadruple(2)] == [6.0, 3.0, 8.0]


def test_an_inlined_kernel_can_be_called_from_python(functions):
    assert inlined_kernel(functions.double)(1.5) == 3.0


def test_a_number_in_the_source_and_others_are_compiled_once(functions):
    double = kernel(functions.double)

    @kernel
    def both(n):
        return double(0) + double(n)

    assert both(3) == 6.0
    assert len(double._called.overloads) == 1


@pytest.mark.parametrize("ending", ["nbi", "nbc"])
@pytest.mark.parametrize("damage", ["empty", "cut", "flipped", "pickle"])
def test_a_damaged_file_is_made_anew(functions, tmp_path, ending, damage):
    run(functions.double)
    path = files(tmp_path, "double", ending)
    good = path.read_bytes()
    middle = len(good) // 2
    flipped = good[:middle] + bytes([good[middle] ^ 1]) + good[middle + 1 :]
    path.write_bytes({"empty": b"", "cut": good[:middle], "flipped": flipped, "pickle": good[32:]}[damage])
    with pytest.warns(RubgenWarning, match=CACHE_VARIABLE) as said:
        assert run(functions.double) == (2.0, False)
    assert len(said) == 1
    assert run(functions.double) == (2.0, True)


def test_code_of_another_kernel_is_not_run(functions, tmp_path):
    run(functions.double)
    run(functions.treble)
    files(tmp_path, "double", "nbc").write_bytes(files(tmp_path, "treble", "nbc").read_bytes())
    assert run(functions.double) == (2.0, False)


def test_settings_of_numba_have_kernels_of_their_own(monkeypatch):
    kernel_key.cache_clear()
    before = kernel_key()
    kernel_key.cache_clear()
    monkeypatch.setenv("NUMBA_OPT", "0")
    other = kernel_key()
    kernel_key.cache_clear()
    assert before != other


def test_workers_with_one_thread_share_the_kernels(monkeypatch):
    kernel_key.cache_clear()
    before = kernel_key()
    kernel_key.cache_clear()
    monkeypatch.setenv("NUMBA_NUM_THREADS", "1")
    assert kernel_key() == before


def test_kernels_import_only_kernels():
    """The key is made of the sources of kernels: nothing else of rubgen may enter what they compile."""
    allowed = ("rubgen.jit", "rubgen.arrays")  # and registries in rooms of laws, which the key covers
    for source in PACKAGE.rglob("*_kernels.py"):
        for line in source.read_text(encoding="utf-8").splitlines():
            if line.lstrip().startswith(("from rubgen", "import rubgen")):
                module = line.split()[1]
                assert module in allowed or module.endswith("_kernels") or "_laws." in module, f"{source}: {line}"


@pytest.fixture
def small_package(tmp_path):
    """A copy of rubgen with two kernels, one of which calls the other."""
    package = tmp_path / "source" / "rubgen"
    package.mkdir(parents=True)
    for name in ("__init__", "arrays", "cache_root", "errors", "jit", "progress"):
        shutil.copy(PACKAGE / f"{name}.py", package)
    (package / "called_kernels.py").write_text(CALLED)
    (package / "calling_kernels.py").write_text(CALLING)
    return package


@pytest.mark.parametrize("writable", [True, False])
def test_a_change_in_a_called_kernel_is_seen(small_package, tmp_path, writable):
    (tmp_path / "file").write_text("")
    cache = tmp_path / ("cache" if writable else "file/x")
    environment = os.environ | {
        CACHE_VARIABLE: str(cache), "PYTHONPATH": str(small_package.parent), "PYTHONDONTWRITEBYTECODE": "1",
    }  # fmt: skip

    def said():
        return subprocess.run(CALL, env=environment, cwd=tmp_path, capture_output=True, text=True, check=True)

    before = set(small_package.rglob("*"))
    assert said().stdout == "30.0\n"
    (small_package / "called_kernels.py").write_text(CALLED.replace("x + 1.0", "x - 1.0"))
    last = said()
    assert last.stdout == "10.0\n"
    assert last.stderr.count(CACHE_VARIABLE) == (0 if writable else 1)
    assert set(small_package.rglob("*")) == before


def test_the_same_sources_in_another_place_share_the_kernels(small_package, tmp_path):
    cache = tmp_path / "cache"

    def compiled(package):
        environment = os.environ | {CACHE_VARIABLE: str(cache), "PYTHONPATH": str(package.parent)}
        done = subprocess.run(CALL, env=environment, cwd=tmp_path, capture_output=True, text=True, check=True)
        assert done.stdout == "30.0\n"
        return {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb?")}

    first = compiled(small_package)
    assert len(first) == 2  # index and code of the kernel that Python calls; what it calls is in it
    other = shutil.copytree(small_package.parent, tmp_path / "other") / "rubgen"
    shutil.rmtree(small_package)
    assert compiled(other) == first


def test_kernels_are_compiled_when_the_last_one_is(monkeypatch, tmp_path):
    """A compilation that was stopped has left most of the files."""
    from rubgen.solver.scheme.turn_kernels import run_turns

    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    assert run_turns.__name__ == "run_turns"
    for name, compiled in (("step_kernels.advance-262", False), ("turn_kernels.run_turns-165", True)):
        cache_root.write_cached(tmp_path / "kernels" / kernel_key() / "solver" / f"{name}.py311.1.nbc", b"code")
        assert kernels_are_compiled() is compiled
