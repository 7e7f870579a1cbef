"""A piece of computation that is worth keeping: a function, its arguments, the arrays that it returns."""

from __future__ import annotations

import ast
import hashlib
import inspect
import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

import rubgen
from rubgen.scenario import Scenario
from rubgen.scenario.scenario import scenario_dict

Arrays = dict[str, np.ndarray[Any, Any]]
PACKAGE = Path(rubgen.__file__).parent
APART = ("cli", "report", "dataset", "output.py", "io", "viz", "sensors", "progress.py", "brief.py", "errors.py")
"""What of the package changes no label: all else lies between a machine and its labels."""
MOTION_LABELS = "labels/motion"
"""What changes no response, beside APART."""


@dataclass(frozen=True)
class Piece:
    """`make(*arguments)`: a function of a module, and numbers, texts or a scenario that it takes.

    `apart` names a part of the package that `make` does not use.
    """

    make: Callable[..., Arrays]
    arguments: tuple[object, ...] = ()
    apart: str = ""

    @cached_property
    def key(self) -> str:
        """Hash of the arguments, of everything between a machine and its labels, and of the module of `make`.

        Comments and layout of the code do not count.
        """
        given = [scenario_dict(a) if isinstance(a, Scenario) else a for a in self.arguments]
        what = [physics(PACKAGE, self.apart), _source(self.make), self.make.__qualname__, given]
        return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()[:24]


Found = Callable[[Piece], Arrays]
"""Returns the arrays of a piece that has been made."""


@cache
def physics(package: Path, apart: str = "") -> str:
    """Hash of the syntax trees of everything between a machine and its labels, without the folder `apart`."""
    digest = hashlib.sha256()
    for source in sorted(package.rglob("*.py")):
        path = source.relative_to(package)
        if path.parts[0] not in APART and not (apart and path.is_relative_to(apart)):
            digest.update(_tree(source.read_text(encoding="utf-8")))
    return digest.hexdigest()


@cache
def _source(make: Callable[..., Arrays]) -> str:
    module = inspect.getmodule(make)
    if not isinstance(module, ModuleType):
        raise TypeError(f"{make!r}: a piece needs a function of a module")
    return hashlib.sha256(_tree(inspect.getsource(module))).hexdigest()


def _tree(source: str) -> bytes:
    return ast.dump(ast.parse(source)).encode()
