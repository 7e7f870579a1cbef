from dataclasses import replace

import pytest

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import Reduction

STIFFER = 4e3
"""Factor of the moduli of the nearly rigid blisk, the largest that a material may have; deviations fall with it."""


@pytest.fixture(scope="session")
def rigid():
    """The preset with a nearly rigid blisk: a Jeffcott rotor."""

    def stiff(part):
        material = replace(part.material, youngs_modulus_pa=STIFFER * part.material.youngs_modulus_pa)
        return replace(part, material=material)

    machine = load_machine("zeng2019")
    return reduce(replace(machine, disk=stiff(machine.disk), blades=stiff(machine.blades)), Reduction())
