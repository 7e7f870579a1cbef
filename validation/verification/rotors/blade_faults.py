"""A cracked blade, and a blade that has lost a piece of its tip.

Frequencies are compared with the full finite-element model at rest, in which the stiffness of one blade, or the mass at
one tip, is changed in its matrices. The machine has few elements and seven blades, and its reduction stiffens the first
bending by 6e-4. In the preset, whose disk is stiff, the cracked blade's line stands near sqrt(1 - loss) times that of
the family; the root's flexibility gives 0.3 %. The unbalance of the lost mass moves the disk as a rigid body.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.blisk import BliskModel, assemble_blisk
from rubgen.machine import Machine, load_machine
from rubgen.machine.faults.cracked_blade import CrackedBlade
from rubgen.machine.faults.lost_tip import LostTip
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from rubgen.solver.linear.rub_free import rub_free_motion
from validation.full_blisk import blisk_frequencies
from validation.verification.row import Row, relative

TITLE = "Cracked blade and lost tip"
BLADES, BLADE, MODES = 7, 2, 14
LOSS, LOST = 0.25, 4e-3
BENDING = (100.0, 200.0)
FINE = Reduction(blade_modes=6, disk_modes=12, blisk_modes=12)


def small() -> Machine:
    """The preset with seven blades and few elements."""
    whole = load_machine("zeng2019")
    disk = replace(whole.disk, radial_elements=1, circumferential_elements=BLADES)
    return replace(whole, disk=disk, blades=replace(whole.blades, count=BLADES, elements=6))


def with_soft_blade(model: BliskModel) -> BliskModel:
    """The full model with a share of one blade's own stiffness taken off."""
    K, blade = model.K.tolil(), slice(model.roots[BLADE, 0], model.tips[BLADE, 5] + 1)
    K[blade, blade] = K[blade, blade].toarray() - LOSS * model.beam.K
    return replace(model, K=K.tocsr())


def with_light_tip(model: BliskModel) -> BliskModel:
    """The full model with a mass taken off the translations of one tip."""
    M = model.M.tolil()
    for place in model.tips[BLADE, :3]:
        M[place, place] = M[place, place] - LOST
    return replace(model, M=M.tocsr())


def odd_line(frequencies: FloatArray, family: FloatArray) -> float:
    """The frequency in the range of the first bending that is farthest from all of the family."""
    bending = frequencies[(frequencies > BENDING[0]) & (frequencies < BENDING[1])]
    return float(bending[np.argmax(np.abs(bending[:, None] - family).min(axis=1))])


def frequency_rows() -> Iterator[Row]:
    """The line of the odd blade in the small machine, beside the full model."""
    machine = small()
    full = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
    family = blisk_frequencies(full, machine.disk_support, MODES)
    cracked, lost = CrackedBlade(stiffness_loss=LOSS, blade=BLADE), LostTip(lost_kg=LOST, blade=BLADE)
    cases = (
        ("cracked blade, 25 % softer", with_soft_blade(full), replace(machine, faults=(cracked,))),
        ("lost tip, 4 g", with_light_tip(full), replace(machine, faults=(lost,))),
    )
    for name, model, faulty in cases:
        expected = odd_line(blisk_frequencies(model, machine.disk_support, MODES), family)
        found = odd_line(reduce(faulty, FINE).blisk_frequencies_hz()[:MODES], family)
        yield relative(f"{name}: its line in the blisk's frequencies, Hz", "full model", expected, found, 1e-3)


def preset_rows() -> Iterator[Row]:
    """The cracked blade's line in the preset, and where the disk centre stands at a slow speed without a piece."""
    preset = load_machine("zeng2019")
    cracked = replace(preset, faults=(CrackedBlade(stiffness_loss=0.2, blade=5),))
    family = reduce(preset, Reduction()).blisk_frequencies_hz()
    line = reduce(cracked, Reduction()).blisk_frequencies_hz()
    blades = family[(family > 150) & (family < 160)]
    found = float(line[(line > 130) & (line < 150)][np.argmin(np.abs(line[(line > 130) & (line < 150)] - 141))])
    source = "sqrt(1 - loss) of the family"
    yield relative("preset, blade 20 % softer: its line, Hz", source, np.sqrt(0.8) * blades.mean(), found, 1e-2)
    speed = 80.0
    lost = replace(preset, unbalance_kg_m=0.0, faults=(LostTip(lost_kg=LOST, blade=9),))
    model = reduce(lost, Reduction())
    system = model.at_speed(speed)
    centre = rub_free_motion(system).at(0.0)[system.centre : system.centre + 2] @ np.array([1, 1j])
    mass, k = model.blisk_mass, float(model.springs[0])
    z = -LOST * preset.tip_radius_m * speed**2 / complex(k - mass * speed**2, model.dampers[0] * speed)
    source = "m r Omega^2 / (k - M Omega^2 + i c Omega), opposite to the blade"
    for part, exact, moved in (("along", (z * 1j).imag, centre.imag), ("across", (z * 1j).real, centre.real)):
        yield relative(f"lost tip, 4 g of blade 9: place of the disk centre {part} it, m", source, exact, moved, 2e-3)


def rows() -> Iterator[Row]:
    """Frequencies and unbalance."""
    yield from frequency_rows()
    yield from preset_rows()
