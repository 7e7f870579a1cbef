from dataclasses import replace

import pytest

from rubgen.machine import load_machine
from rubgen.machine.mass import blisk_mass
from rubgen.reduction import reduce
from rubgen.scenario import Reduction


def test_the_mass_from_sizes_is_that_of_the_mesh():
    machine = load_machine("zeng2019")
    assert blisk_mass(machine) == pytest.approx(reduce(machine, Reduction()).blisk_mass, rel=1e-3)


def test_a_disk_of_even_thickness_without_blades_worth_naming():
    machine = load_machine("zeng2019")
    disk = replace(machine.disk, bore_thickness_m=0.05, rim_thickness_m=0.05)
    blades = replace(machine.blades, length_m=1e-7)
    ring = 3.141592653589793 * (0.25**2 - 0.06**2) * 0.05 * 7850
    assert blisk_mass(replace(machine, disk=disk, blades=blades)) == pytest.approx(ring, rel=1e-6)
