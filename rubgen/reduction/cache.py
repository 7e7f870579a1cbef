"""Keep the reduced blisk in a cache on disk, under a hash of all its inputs and of its code."""

import hashlib
import io
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from filelock import FileLock

from rubgen.arrays import FloatArray
from rubgen.cache_root import cache_folder, read_cached, write_cached
from rubgen.machine import BladeRow, Disk, DiskSupport
from rubgen.machine.support_laws.disk_support import SUPPORT_LAWS
from rubgen.progress import step
from rubgen.reduction.blisk import ReducedBlisk, reduce_blisk
from rubgen.reduction.growth import CentrifugalGrowth
from rubgen.scenario import Reduction

_PACKAGE = Path(__file__).parents[1]
_ARRAYS = ("M", "K", "G", "A", "euler", "centre", "roots", "rigid_inertia")
_NUMBERS = ("blade_frequency", "full_size")
_GROWTH = ("K", "A", "f", "tips", "moment", "missing")
PATIENCE_S = 120.0
"""Longest wait for another process that makes the same blisk; it may have been stopped."""


def cached_blisk(
    disk: Disk, blades: BladeRow, support: DiskSupport, reduction: Reduction, missing: Sequence[int] = ()
) -> ReducedBlisk:
    """Return the reduced blisk from the cache, or make it with `reduce_blisk` and store it. The bits are the same.

    The parameters are as in `reduce_blisk`. Lateral stiffness and the number of casing modes do not affect the result,
    so runs that vary them share one file. A damaged file is made again. If nothing can be stored, each process makes
    the blisk itself. If several processes need the same blisk, one makes it, and the others wait. Those that have
    waited for PATIENCE_S make it too. Raises UserError as `reduce_blisk` does.
    """
    folder = cache_folder("reduction")
    if folder is None:
        return _made(disk, blades, support, reduction, missing)
    path = folder / f"{_key(disk, blades, support, reduction, missing)}.blisk"
    stored = _load(path)
    if stored is not None:
        return stored
    with _lock(path):
        stored = _load(path)
        if stored is None:
            stored = _made(disk, blades, support, reduction, missing)
            write_cached(path, _packed(stored))
    return stored


@contextmanager
def _lock(path: Path) -> Iterator[None]:
    """Let one process make the file at `path`. Where files cannot be locked in time, several make the same bytes."""
    lock = FileLock(path.with_suffix(".lock"), timeout=PATIENCE_S)
    try:
        lock.acquire()
    except (OSError, NotImplementedError):  # a Timeout is an OSError
        yield
        return
    try:
        yield
    finally:
        lock.release()


def _made(
    disk: Disk, blades: BladeRow, support: DiskSupport, reduction: Reduction, missing: Sequence[int]
) -> ReducedBlisk:
    with step("reduce the machine, once"):
        return reduce_blisk(disk, blades, support, reduction, missing)


def _key(disk: Disk, blades: BladeRow, support: DiskSupport, reduction: Reduction, missing: Sequence[int]) -> str:
    springs, modes = asdict(support), asdict(reduction)
    del modes["casing_modes"]
    lateral_keys = ("lateral_stiffness_n_per_m", "lateral_stiffness_anisotropy", "lateral_damping_anisotropy")
    for lateral in (*lateral_keys, *SUPPORT_LAWS):
        del springs[lateral]
    what = [asdict(disk), asdict(blades), [*missing], springs, modes, np.__version__, scipy.__version__]
    return hashlib.sha256(json.dumps(what, sort_keys=True).encode() + _digest_of_code(_PACKAGE)).hexdigest()[:32]


@cache
def _digest_of_code(package: Path) -> bytes:
    """Return a digest of all sources of a reduced blisk, read once in a process."""
    digest = hashlib.sha256()
    for folder in ("fem", "reduction", "machine"):
        for source in sorted((package / folder).glob("*.py")):
            digest.update(source.read_bytes())
    return digest.digest()


def _packed(blisk: ReducedBlisk) -> bytes:
    fields = {name: getattr(blisk, name) for name in _ARRAYS + _NUMBERS}
    fields |= {f"growth_{name}": getattr(blisk.growth, name) for name in _GROWTH}
    packed = io.BytesIO()
    np.savez(packed, allow_pickle=False, **fields)
    return packed.getvalue()


def _load(path: Path) -> ReducedBlisk | None:
    content = read_cached(path)
    if content is None:
        return None
    with np.load(io.BytesIO(content), allow_pickle=False) as file:
        return _restore({name: file[name] for name in file.files})


def _restore(file: Mapping[str, FloatArray]) -> ReducedBlisk:
    fields: dict[str, Any] = {name: file[name] for name in _ARRAYS}
    fields |= {"blade_frequency": float(file["blade_frequency"]), "full_size": int(file["full_size"])}
    return ReducedBlisk(growth=CentrifugalGrowth(**{name: file[f"growth_{name}"] for name in _GROWTH}), **fields)
