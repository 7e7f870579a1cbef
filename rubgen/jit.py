"""The decorators for compiled kernels, and the cache of compiled kernels.

Numba's own cache is not used, for three reasons. It checks only the file of the compiled function, and misses a change
in a kernel of another file. Where it cannot write, it silently writes beside the sources. It unpickles any file. Here
the name of a folder depends on all sources of compiled code, and a file is read only where its SHA-256 is right.
"""

import hashlib
import os
import pickle
import sys
from collections.abc import Callable, Sequence
from functools import cache, cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any, Concatenate, ParamSpec, TypeVar, cast

import numba
import numba.core.caching
import numba.core.codegen
import numba.core.compiler
import numba.core.registry
import numpy as np

from rubgen.cache_root import cache_folder, read_cached, write_cached

P = ParamSpec("P")
R = TypeVar("R")
PACKAGE = Path(__file__).parent
core: Any = numba.core
"""Private to numba. Therefore pyproject.toml bounds the version of numba."""
caching: Any = core.caching
LAST_COMPILED = "turn_kernels.run_turns-*.nbc"
"""The kernel that calls all others of a run."""


@cache
def kernel_key() -> str:
    """Return a hash of everything that determines compiled kernels, except the processor. It names their cache folder.

    It covers sources of kernels and laws, Python, numba, llvmlite, numpy and numba's environment variables. The number
    of threads, which workers set, is left out. Numba's own index distinguishes processors.
    """
    made_by = [sys.version, numba.__version__, version("llvmlite"), np.__version__]
    settings = sorted(
        item for item in os.environ.items() if item[0].startswith("NUMBA_") and item[0] != "NUMBA_NUM_THREADS"
    )
    digest = hashlib.sha256(repr((made_by, settings)).encode())
    laws = PACKAGE.rglob("*_laws/*.py")
    for source in [*sorted(PACKAGE.rglob("*_kernels.py")), *sorted(laws), Path(__file__)]:
        digest.update(source.relative_to(PACKAGE).as_posix().encode())
        digest.update(source.read_bytes())
    return digest.hexdigest()[:16]


def kernels_are_compiled() -> bool:
    """Return whether all kernels of this code were compiled before, so that a run need not wait for the compiler.

    The sign is LAST_COMPILED in the cache. The result is True too where numba's compiler is switched off.
    """
    config: Any = numba.config
    folder = cache_folder("kernels")
    return bool(config.DISABLE_JIT) or (folder is not None and any((folder / kernel_key()).rglob(LAST_COMPILED)))


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile `function` with numba, without the GIL and without fastmath, and store it in the cache `kernels`.

    Kernels are in files named `*_kernels.py`. They take only arrays, scalars and tuples of these, and never raise: a
    division by zero is inf or NaN. `NUMBA_DISABLE_JIT=1` runs them as plain Python.
    """
    return _compiled(function)


def allocation_free_kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile `function` as `kernel` does, for inner loops. It does not compile where it would allocate memory.

    Without allocation numba counts no references. With array fields in named tuples, counting takes a third of a step
    of the solver.
    """
    return _compiled(function, _nrt=False)


def inlined_kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile `function` as `allocation_free_kernel` does, into its callers.

    A call passes every field of every named tuple, 100 to 300 words. That takes longer than a short kernel itself.
    """
    return _compiled(function, _nrt=False, inlined=True)


def switch(functions: Sequence[Callable[P, R]]) -> Callable[Concatenate[int, P], R]:
    """Make an `inlined_kernel` that calls one of `functions`. Its first argument is the number of the function.

    The functions are plain Python in files of a room `*_laws`; they take the other arguments. A call costs a comparison
    of integers for each function before the called one. A number beyond the last function calls the last function.
    """
    first: Any = inlined_kernel(functions[0])
    others: Any = switch(functions[1:]) if len(functions) > 1 else None

    def only(_number: int, *arguments: Any) -> Any:
        return first(*arguments)

    def chosen(number: int, *arguments: Any) -> Any:
        return first(*arguments) if number == 0 else others(number - 1, *arguments)

    choice = _compiled(chosen if others else only, kept=False, _nrt=False, inlined=True)
    return cast("Callable[Concatenate[int, P], R]", choice)


def _compiled(function: Callable[P, R], *, kept: bool = True, inlined: bool = False, **options: bool) -> Callable[P, R]:
    """Return the kernel; not `kept` in the cache where it encloses others, whose names differ between processes."""
    config: Any = numba.config
    if config.DISABLE_JIT:
        return function
    return cast("Callable[P, R]", _Kernel(function, kept=kept, inlined=inlined, **options))


class _Kernel(core.registry.CPUDispatcher):  # type: ignore[misc]
    """A kernel that is compiled twice: to machine code where Python calls it, to LLVM code for kernels that call it.

    Most kernels are only called by others. Numba would make machine code of each of them, with all that it calls, and
    two wrappers that have a copy of it. That took most of the time.
    """

    def __init__(self, function: Callable[..., Any], *, kept: bool, inlined: bool, **options: bool) -> None:
        always: dict[str, Any] = {"nopython": True, "error_model": "numpy", "no_cfunc_wrapper": True} | options
        super().__init__(function, targetoptions=always | {"nogil": True})
        called = always | {"forceinline": inlined, "no_cpython_wrapper": True}
        self._called = _CalledKernel(function, targetoptions=called, pipeline_class=_CalledCompiler)
        if kept:
            self._cache = _KernelCache(function)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Compile for a kernel that calls this one. Numba would compile `f(0)` and `f(n)` apart; here they are one."""
        return self._called.get_call_template([core.types.unliteral(each) for each in args], kws)

    def get_overload(self, sig: Any) -> Any:
        """Return the key of what was compiled for a caller."""
        return self._called.get_overload(sig)


class _CalledKernel(core.registry.CPUDispatcher):  # type: ignore[misc]
    """A kernel as other kernels call it. Python cannot call it."""

    def add_overload(self, cres: Any) -> None:
        """Store the LLVM code for these types."""
        self.overloads[tuple(cres.signature.args)] = cres


class _CalledCompiler(core.compiler.Compiler):  # type: ignore[misc]
    """Makes LLVM code, and no machine code."""

    def compile_extra(self, func: Callable[..., Any]) -> Any:
        """Return numba's result, with a key in place of the machine code; callers find the LLVM code by it."""
        context, key = self.state.targetctx, object()
        self.state.flags.no_compile = True
        self.state.library = _CalledLibrary(context.codegen(), func.__qualname__)
        result = super().compile_extra(func)
        context.insert_user_function(key, result.fndesc, [result.library])
        return result._replace(entry_point=key)


class _CalledLibrary(core.codegen.JITCodeLibrary):  # type: ignore[misc]
    """LLVM code of a kernel and of what it calls. Its functions are simplified; loops are optimised in the caller."""

    def _optimize_final_module(self) -> None:
        passes, builder = self._codegen._module_pass_manager(
            opt=0, cost="cheap", loop_vectorize=False, slp_vectorize=False
        )
        passes.run(self._final_module, builder)

    def _finalize_final_module(self) -> None:
        self._finalized = True


class _KernelCache(caching.NullCache):  # type: ignore[misc]
    """Numba's cache in rubgen's folder, which is found when a kernel is first called.

    Without a folder there is no cache.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    @cached_property
    def _cache(self) -> Any:
        folder = cache_folder("kernels")
        return caching.NullCache() if folder is None else _FolderCache(self._function, folder / kernel_key())

    @property
    def cache_path(self) -> Any:
        """Numba's name for the folder."""
        return self._cache.cache_path

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the kernel compiled for these types, or None."""
        return self._cache.load_overload(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Store the compiled kernel."""
        self._cache.save_overload(sig, data)


class _FolderCache(caching.FunctionCache):  # type: ignore[misc]
    """Numba's logic of keys and signatures, over files with a checksum."""

    def __init__(self, function: Callable[..., Any], folder: Path) -> None:
        self._name, self._py_func = repr(function), function
        self._impl = _Implementation(function, folder)
        locator = self._impl.locator
        self._cache_path = locator.get_cache_path()
        self._cache_file = _SealedFiles(self._cache_path, self._impl.filename_base, locator.get_source_stamp())
        self.enable()


class _Implementation(caching.CompileResultCacheImpl):  # type: ignore[misc]
    """Numba's conversion of compiled code into bytes. The folder is rubgen's, whatever numba's settings are."""

    def __init__(self, function: Callable[..., Any], folder: Path) -> None:
        source = Path(function.__code__.co_filename)
        self._lineno = function.__code__.co_firstlineno
        self._locator = _Locator(function, source, folder)
        self._filename_base = self.get_filename_base(f"{source.stem}.{function.__qualname__}", sys.abiflags)


class _Locator(caching._SourceFileBackedLocatorMixin, caching._CacheLocator):  # type: ignore[misc]
    def __init__(self, function: Callable[..., Any], source: Path, folder: Path) -> None:
        self._py_file, self._lineno = str(source), function.__code__.co_firstlineno
        inside = source.is_relative_to(PACKAGE)  # the key stands for these sources, wherever they are installed
        room = source.relative_to(PACKAGE).parent if inside else self.get_suitable_cache_subpath(str(source))
        self._cache_path = str(folder / room)

    def get_cache_path(self) -> str:
        return self._cache_path

    def ensure_cache_path(self) -> None:
        """Do nothing: the folder is made when a file is written."""


class _SealedFiles(caching.IndexDataCacheFile):  # type: ignore[misc]
    """Index and data, each after its SHA-256. The data contain the kernel and types for which they were compiled."""

    def save(self, key: Any, data: Any) -> None:
        super().save(key, (self._owner(key), data))

    def load(self, key: Any) -> Any:
        """Return the data of `key`; None where another process has just written other types into that file."""
        owner, data = super().load(key) or (None, None)
        return data if owner == self._owner(key) else None

    def _owner(self, key: Any) -> Any:
        return self._index_name, self._source_stamp, key

    def _load_index(self) -> Any:
        content = read_cached(Path(self._index_path))
        stamp, overloads = (None, {}) if content is None else pickle.loads(content)  # noqa: S301  # our own, whole
        return overloads if stamp == self._source_stamp else {}

    def _save_index(self, overloads: Any) -> None:
        write_cached(Path(self._index_path), self._dump((self._source_stamp, overloads)))

    def _load_data(self, name: str) -> Any:
        content = read_cached(Path(self._data_path(name)))
        return None if content is None else pickle.loads(content)  # noqa: S301  # our own, whole

    def _save_data(self, name: str, data: Any) -> None:
        write_cached(Path(self._data_path(name)), self._dump(data))
