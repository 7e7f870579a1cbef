"""A cracked blade, a blade that has lost a piece of its tip, and a blade that is lost as a whole.

Frequencies are compared with the full finite-element model at rest, in which the stiffness of one blade, or the mass at
one tip, is changed in its matrices, or from which one blade is cut. The machine has few elements and seven blades, and
its reduction stiffens the first bending by 6e-4. In the preset, whose disk is stiff, the cracked blade's line stands
near sqrt(1 - loss) times that of the family; the root's flexibility gives 0.3 %. The unbalance of the lost mass moves
the disk as a rigid body. The unbalance of a whole blade is the integral over its profile.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rubgen.arrays import FloatArray
from rubgen.fem.blisk import BliskModel, assemble_blisk
from rubgen.fem.constraints import rim_joint
from rubgen.machine import BladeRow, Machine, load_machine
from rubgen.machine.faults.cracked_blade import CrackedBlade
from rubgen.machine.faults.lost_blade import LostBlade
from rubgen.machine.faults.lost_tip import LostTip
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from rubgen.solver.linear.rub_free import rub_free_motion
from validation.full_blisk import blisk_frequencies
from validation.verification.row import Row, relative

TITLE = "Cracked blade, lost tip and lost blade"
BLADES, BLADE, MODES = 7, 2, 14
BENT = 12
"""Modes of the machine without a blade up to the axial one. The reduction stiffens higher ones of any machine."""
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


def without_blade(model: BliskModel) -> BliskModel:
    """The full model from whose matrices one blade is cut, with its joint at the rim."""
    joint = rim_joint(model.angles[[BLADE]], model.rim[[BLADE]], model.roots[[BLADE]], model.M.shape[0])
    blade = np.arange(model.roots[BLADE, 0], model.tips[BLADE, 5] + 1)
    left = np.setdiff1d(np.arange(model.M.shape[0]), blade)
    K = (model.K - model.penalty * (joint.T @ joint)).tocsr()
    return replace(model, K=K[left][:, left], M=model.M.tocsr()[left][:, left])


def first_moment(blades: BladeRow, rim: float) -> float:
    """Mass times radius of a blade in kg m: the integral of rho chord thickness r over its length."""
    chord = np.poly1d([blades.tip_chord_m - blades.root_chord_m, blades.root_chord_m])
    thickness = np.poly1d([blades.tip_thickness_m - blades.root_thickness_m, blades.root_thickness_m])
    whole = np.polyint(chord * thickness * np.poly1d([blades.length_m, rim]))
    return float(blades.material.density_kg_per_m3 * blades.length_m * (whole(1.0) - whole(0.0)))


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
    yield from lost_blade_rows(machine, full)


def lost_blade_rows(machine: Machine, full: BliskModel) -> Iterator[Row]:
    """The lines that a lost blade splits off in the small machine, and all lines of rotor and first bending."""
    lines = blisk_frequencies(without_blade(full), machine.disk_support, MODES)
    own = reduce(replace(machine, faults=(LostBlade(blade=BLADE),)), FINE).blisk_frequencies_hz()[:MODES]
    name, source = "lost blade: frequencies of the blisk, Hz,", "full model without the blade"
    yield relative(f"{name} the upper one of the split rotor pair", source, lines[1], own[1], 1e-4)
    yield relative(f"{name} the one between the families", source, lines[8], own[8], 1e-3)
    worst = int(np.argmax(np.abs(own / lines - 1)[:BENT]))
    yield relative(f"{name} the worst of the first {BENT}", source, lines[worst], own[worst], 1e-3)


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
    cases = (
        (LostTip(lost_kg=LOST, blade=9), "lost tip, 4 g of blade 9", LOST * preset.tip_radius_m),
        (LostBlade(blade=9), "lost blade, number 9", first_moment(preset.blades, preset.disk.rim_radius_m)),
    )
    for fault, name, unbalance in cases:
        yield from unbalance_rows(replace(preset, unbalance_kg_m=0.0, faults=(fault,)), name, unbalance)


def unbalance_rows(machine: Machine, name: str, unbalance: float) -> Iterator[Row]:
    """Where the disk centre stands at a slow speed, with an unbalance in kg m opposite to blade 9 alone."""
    speed, model = 80.0, reduce(machine, Reduction())
    system = model.at_speed(speed)
    centre = rub_free_motion(system).at(0.0)[system.centre : system.centre + 2] @ np.array([1, 1j])
    mass, k = model.blisk_mass, float(model.springs[0])
    z = -unbalance * speed**2 / complex(k - mass * speed**2, model.dampers[0] * speed)
    source = "m r Omega^2 / (k - M Omega^2 + i c Omega), opposite to the blade"
    for part, exact, moved in (("along", (z * 1j).imag, centre.imag), ("across", (z * 1j).real, centre.real)):
        yield relative(f"{name}: place of the disk centre {part} it, m", source, exact, moved, 2e-3)


def rows() -> Iterator[Row]:
    """Frequencies and unbalance."""
    yield from frequency_rows()
    yield from preset_rows()
