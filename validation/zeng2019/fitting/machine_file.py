"""The machine that the search found, as the TOML file of a preset."""

from __future__ import annotations

import re
from importlib.resources import files

from validation.zeng2019.fitting.candidate import Candidate, machine_of
from validation.zeng2019.size import AS_COMPUTED, MACHINE

HEAD = """\
#:schema ../../../schemas/machine.schema.json
# The machine of Zeng et al. (2019), doi 10.1016/j.ast.2019.105481, as the paper discretised it. It is for comparison
# with the paper, never for data: `[contact] surface = "chords"` belongs to it, so every node of the casing's mesh hits
# the tips. `make zeng2019-fit` found it. See docs/zeng2019-fit.md and docs/preset-zeng2019.md.
"""


def toml_of(candidate: Candidate) -> str:
    """The preset's TOML with the candidate's values, under its name. Friction is no part of it."""
    machine = machine_of(candidate)
    springs = f"{machine.casing.radial_support_stiffness_n_per_m:.6g}"
    values = {
        "name": f'"{AS_COMPUTED}"',
        "unbalance_kg_m": f"{machine.unbalance_kg_m:.5g}",
        "width_m": f"{machine.casing.width_m:.6g}",
        "clearance_m": f"{machine.casing.clearance_m:.5g}",
        "radial_support_stiffness_n_per_m": springs,
        "circumferential_support_stiffness_n_per_m": springs,
        "lateral": f"{candidate.damping:g}",
        "tilt": f"{candidate.damping:g}",
    }
    preset = (files("rubgen.machine") / "presets" / f"{MACHINE}.toml").read_text(encoding="utf-8")
    text = HEAD + preset[preset.index("name = ") :]
    for key, value in values.items():
        text, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
        if count != 1:
            raise ValueError(f"{MACHINE}.toml: {key} stands there {count} times, once was expected")
    return text
