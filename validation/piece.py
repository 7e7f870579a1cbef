"""A piece of computation that is worth keeping: a function, its arguments, the arrays that it gives."""

from __future__ import annotations

import ast
import hashlib
import inspect
import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np

from rubgen.scenario import Scenario
from rubgen.scenario.plain import scenario_dict
from validation.sensitivity.kept import code_digest

Arrays = dict[str, np.ndarray[Any, Any]]


@dataclass(frozen=True)
class Piece:
    """`make(*arguments)`: a function of a module, and numbers, texts or a scenario that it takes."""

    make: Callable[..., Arrays]
    arguments: tuple[object, ...] = ()

    @property
    def key(self) -> str:
        """Hash of the arguments, of everything between a machine and its labels, and of the module of `make`.

        Comments and layout of the code do not count.
        """
        given = [scenario_dict(a) if isinstance(a, Scenario) else a for a in self.arguments]
        what = [_physics(), _source(self.make), self.make.__qualname__, given]
        return hashlib.sha256(json.dumps(what, sort_keys=True).encode()).hexdigest()[:24]


Found = Callable[[Piece], Arrays]
"""Gives the arrays of a piece that has been made."""


@cache
def _physics() -> str:
    return code_digest()


@cache
def _source(make: Callable[..., Arrays]) -> str:
    module = inspect.getmodule(make)
    if not isinstance(module, ModuleType):
        raise TypeError(f"{make!r}: a piece needs a function of a module")
    return hashlib.sha256(ast.dump(ast.parse(inspect.getsource(module))).encode()).hexdigest()
