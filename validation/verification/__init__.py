"""One table of independent checks: what rubgen computes beside closed forms, literature and other methods.

Each group is a module with a TITLE, a docstring that says where its tolerances come from, and `rows()`.
"""

from __future__ import annotations

import importlib
import inspect

from validation.verification.report import Group

GROUPS = (
    "beams",
    "twisted_blades",
    "plates",
    "spinning_disks",
    "rings",
    "rotors",
    "reduction",
    "uneven_supports",
    "squeeze_film",
    "turning_frame",
    "integrator",
    "bouncing_bar",
    "impact_oscillator",
    "annular_rub",
    "misaligned_rub",
    "surface_options",
    "chaos_indicators",
    "lyapunov_exponents",
    "exponent_errors",
    "preset",
)


def check(name: str) -> Group:
    """The rows of the group of that name, computed now."""
    module = importlib.import_module(f"{__name__}.{name}")
    return Group(module.TITLE, _body(inspect.getdoc(module) or ""), list(module.rows()))


def _body(docstring: str) -> str:
    """A docstring without its first line, which is the title in other words."""
    return docstring.partition("\n")[2].strip()
