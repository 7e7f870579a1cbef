"""The preset against what is published of its machine.

Frequencies and their tolerances are the acceptance values of the project: 0.5 % for the reduced blisk, 2 % for the
full one, 0.1 % for the casing. Seven unknown dimensions were fitted to six blisk frequencies, and three to eleven
casing frequencies. So these rows support the form of the model, not the geometry. Unbalance and clearance were
fitted to onset and end of rubbing. Nothing was fitted to the critical speed, the critical stiffness of the
supports, mass, inertia, growth or the response to unbalance. "Independent model" is another program with a Mindlin
disk and Timoshenko blades. Its own mesh of the disk and its own fit account for differences of up to 1 %.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from rubgen.fem.blisk import assemble_blisk, rigid_motions
from rubgen.fem.casing import assemble_casing
from rubgen.machine import Damping, Machine, load_machine
from rubgen.machine.published import BLISK_HZ, CASING_HZ
from rubgen.reduction import ReducedModel, reduce
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s
from validation.full_blisk import blisk_frequencies
from validation.onset import END_OF_RUB_RPM, tip_growth
from validation.verification.row import Row, relative, within

TITLE = "The preset"
PAPER = "Zeng et al. 2019"
INDEPENDENT = "independent model"
UNDAMPED = Damping(lateral=0, tilt=0, axial=0, torsion=0, blade=0, casing=0)
FULL_DOF, REDUCED_DOF = 15021, 125
CRITICAL_SPEED_RPM = (8100.0, 8910.0)  # the range that the paper calls near the critical speed
GROWTH_UM = {6720.0: 109.6, 10000.0: 242.8, 15000.0: 546.6}
RESPONSE = {(1e8, 6720.0): 1.19e-2, (1e8, 10000.0): -3.70e-2, (6.75e8, 10000.0): 2.01e-3}


def on_lateral_springs(machine: Machine, stiffness: float) -> Machine:
    """The machine on other lateral springs, N/m."""
    return replace(machine, disk_support=replace(machine.disk_support, lateral_stiffness_n_per_m=stiffness))


def critical_stiffness(machine: Machine, rpm: float) -> float:
    """Lateral stiffness in N/m at which that speed is the critical one."""

    def excess(stiffness: float) -> float:
        return reduce(on_lateral_springs(machine, stiffness), Reduction()).critical_speed_rpm - rpm

    return float(brentq(excess, 1.0e8, 1.6e8, rtol=1e-6))


def unbalance_response(machine: Machine, stiffness: float, rpm: float) -> float:
    """Displacement of O_d towards the unbalance in m per kg m, undamped."""
    undamped = replace(on_lateral_springs(machine, stiffness), unbalance_kg_m=1.0, damping=UNDAMPED)
    system = reduce(undamped, Reduction()).at_speed(rad_per_s(rpm))
    return float(np.linalg.solve(system.K, system.force)[system.centre])


def onset_rpm(machine: Machine) -> float:
    """Speed at which the tips of the rub-free motion just meet the casing."""
    return float(brentq(lambda rpm: tip_growth(machine, rpm) - machine.casing.clearance_m, 5000.0, 8000.0, rtol=1e-6))


def end_of_rub_stiffness(machine: Machine) -> float:
    """Lateral stiffness above which the tips clear the casing at 10,000 rev/min, N/m."""

    def overlap(stiffness: float) -> float:
        return tip_growth(on_lateral_springs(machine, stiffness), END_OF_RUB_RPM) - machine.casing.clearance_m

    return float(brentq(overlap, 3e8, 1e9, rtol=1e-6))


def rows() -> Iterator[Row]:
    """Size, frequencies, critical speed, growth, unbalance, onset and end of rub, mass."""
    machine = load_machine("zeng2019")
    model = reduce(machine, Reduction())
    yield within("preset: full model, DoFs (3 less: 180 casing nodes, not 181)", PAPER, FULL_DOF, model.full_dof, 3)
    yield within("preset: reduced model, DoFs", PAPER, REDUCED_DOF, model.reduced_dof, 0)
    yield from frequencies(machine, model)
    low, high = CRITICAL_SPEED_RPM
    critical = model.critical_speed_rpm
    middle, half = (low + high) / 2, (high - low) / 2
    yield within("preset: critical speed, rev/min", f"{PAPER}: 8,100 to 8,910", middle, critical, half)
    yield relative("preset: critical speed, rev/min (independent)", INDEPENDENT, 8785.0, critical, 2e-3)
    stiffness = critical_stiffness(machine, 10000.0)
    quantity = "preset: lateral stiffness critical at 10,000 rev/min, N/m"
    yield relative(quantity, f"{INDEPENDENT}; {PAPER}: 1.3e8", 1.296e8, stiffness, 1e-2)
    for rpm, growth in GROWTH_UM.items():
        found = 1e6 * model.at_speed(rad_per_s(rpm)).tip_static[:, 0].mean()
        yield relative(f"preset: steady growth at {rpm:g} rev/min, um", INDEPENDENT, growth, found, 3e-3)
    for (spring, rpm), response in RESPONSE.items():
        quantity = f"preset: response of O_d at {rpm:g} rev/min on {spring:g} N/m, m per kg m"
        yield relative(quantity, INDEPENDENT, response, unbalance_response(machine, spring, rpm), 1e-2)
    yield within("preset: onset of rub, rev/min", f"{PAPER}: 6,660 to 6,780 (fitted)", 6720.0, onset_rpm(machine), 60.0)
    quantity, source = "preset: rub ends at 10,000 rev/min, N/m", f"{PAPER}: 5.45e8 to 6.75e8 (fitted)"
    yield within(quantity, source, 6.1e8, end_of_rub_stiffness(machine), 0.65e8)


def frequencies(machine: Machine, model: ReducedModel) -> Iterator[Row]:
    """Of the reduced blisk, the full one, the casing; and the masses."""
    full = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
    of_full = blisk_frequencies(full, machine.disk_support, max(BLISK_HZ))
    of_reduced = model.blisk_frequencies_hz()
    for mode, hz in BLISK_HZ.items():
        yield relative(f"preset: blisk mode {mode}, reduced, Hz", PAPER, hz, of_reduced[mode - 1], 5e-3)
    for mode, hz in BLISK_HZ.items():
        yield relative(f"preset: blisk mode {mode}, full model, Hz", PAPER, hz, of_full[mode - 1], 2e-2)
    for mode, (hz, found) in enumerate(zip(CASING_HZ, model.casing_frequencies_hz, strict=True), start=1):
        yield relative(f"preset: casing mode {mode}, Hz", PAPER, hz, found, 1e-3)
    R = rigid_motions(full)
    inertia = np.einsum("ij,ij->j", R, full.M @ R)[[0, 3, 5]]
    names = ("mass, kg", "diametral inertia, kg m2", "polar inertia, kg m2")
    for name, expected, found in zip(names, (117.7, 2.10, 4.09), inertia, strict=True):
        yield relative(f"preset: blisk {name}", INDEPENDENT, expected, found, 1e-2)
    shift = np.tile([1.0, 0.0, 0.0], machine.casing.nodes)
    casing_mass = shift @ assemble_casing(machine).M @ shift
    yield within("preset: casing mass, kg", "chosen: five times the thinnest reading", 6.95, casing_mass, 0.02)
