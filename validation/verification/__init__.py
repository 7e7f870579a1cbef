"""One table of independent checks: what rubgen computes beside closed forms, literature and other methods.

Each group is a module with a TITLE, a docstring that says where its tolerances come from, and `rows()`.
"""

from __future__ import annotations

import importlib
import inspect

from validation.verification.report import Group

_MODULES = (
    "elements.beams",
    "elements.twisted_blades",
    "elements.plates",
    "elements.spinning_disks",
    "elements.rings",
    "rotors.rotors",
    "rotors.reduction",
    "rotors.uneven_supports",
    "rotors.squeeze_film",
    "rotors.turning_frame",
    "rotors.linear_faults",
    "rotors.growing_faults",
    "sensors.bearing_defects",
    "rotors.loose_support",
    "rotors.oil_whirl",
    "rotors.cracked_shaft",
    "rotors.blade_faults",
    "contact.integrator",
    "contact.bouncing_bar",
    "contact.impact_oscillator",
    "contact.annular_rub",
    "contact.misaligned_rub",
    "contact.surface_options",
    "contact.blade_passing",
    "chaos.chaos_indicators",
    "chaos.lyapunov_exponents",
    "chaos.exponent_errors",
    "preset",
)


GROUPS = {path.rpartition(".")[2]: path for path in _MODULES}
"""Module of each group by its name."""


def check(name: str) -> Group:
    """The rows of the group of that name, computed now."""
    module = importlib.import_module(f"{__name__}.{GROUPS[name]}")
    return Group(module.TITLE, _body(inspect.getdoc(module) or ""), list(module.rows()))


def _body(docstring: str) -> str:
    """A docstring without its first line, which is the title in other words."""
    return docstring.partition("\n")[2].strip()
