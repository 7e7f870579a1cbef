"""Check whether a machine can be reduced as asked, from its numbers alone, before anything is built."""

from __future__ import annotations

import numpy as np

from rubgen.machine import Machine
from rubgen.machine.mesh import disk_nodes, node_problem, pitch_problem
from rubgen.machine.quantities import MOST_MODES
from rubgen.scenario.costs import memory_problem
from rubgen.scenario.scenario import Reduction


def reduction_problem(machine: Machine, reduction: Reduction) -> str | None:
    """Return the first reason why the machine cannot be reduced, with key, value and remedy; None where it can be."""
    return (
        pitch_problem(machine.disk, machine.blades)
        or node_problem(machine.casing)
        or _modes_problem(machine, reduction)
        or casing_problem(machine, reduction.casing_modes)
        or memory_problem(machine, reduction)
    )


def casing_problem(machine: Machine, modes: int) -> str | None:
    """Return why the casing cannot have `modes` modes, with key, value and remedy; None where it can.

    There must be at least one mode, and no more than the casing's degrees of freedom, three a node. The modes must
    carry the circumferential order of its lobes in full (`carried_orders`).
    """
    lobes, most = machine.casing.lobes, 3 * machine.casing.nodes
    if not 1 <= modes <= most:
        return f"reduction.casing_modes = {modes}: a ring of {machine.casing.nodes} nodes has {most}; give 1 to {most}"
    carried = carried_orders(machine, modes)
    if lobes in carried:
        return None
    enough = next((n for n in range(modes, min(most, MOST_MODES) + 1) if lobes in carried_orders(machine, n)), None)
    orders = f"the orders {carried[0]} to {carried[-1]}" if carried else "no order in full"
    remedy = f"raise reduction.casing_modes to {enough}" if enough else "take less stiff springs of the casing"
    return f"casing.lobes = {lobes}: {modes} casing modes carry {orders}; take another number of lobes, or {remedy}"


def carried_orders(machine: Machine, modes: int) -> tuple[int, ...]:
    """Return the circumferential orders that the first `modes` modes of the casing carry in full, ascending.

    Modes are ranked by the frequency of the thin inextensible circular ring on an elastic foundation: omega_n^2 = [E I
    n^2 (n^2 - 1)^2 / R^4 + k_r n^2 + k_t] / [rho A (n^2 + 1)]. k_r and k_t are the radial and tangential stiffness of
    the springs per length. Order 0 has one mode, every other order two. With k_t <= k_r the result is 0 to (modes - 1)
    // 2. Stiffer tangential springs raise the low orders.
    """
    casing = machine.casing
    order = np.arange(max(modes, 1) + 2)
    radius, inertia = machine.casing_mean_radius_m, casing.width_m * casing.thickness_m**3 / 12
    bending = casing.material.youngs_modulus_pa * inertia * order**2 * (order**2 - 1) ** 2 / radius**4
    per_length = casing.nodes / (2 * np.pi * radius)
    springs = casing.radial_support_stiffness_n_per_m * order**2 + casing.circumferential_support_stiffness_n_per_m
    ranked = np.argsort((bending + per_length * springs) / (order**2 + 1), kind="stable")
    taken = np.cumsum(np.where(ranked == 0, 1, 2)) <= modes
    return tuple(sorted(int(n) for n in ranked[taken]))


def _modes_problem(machine: Machine, reduction: Reduction) -> str | None:
    """Return the problem of more modes than DoFs with mass between the masters.

    A node of a blade has six such DoFs, a node of the disk five (no drilling).
    """
    blades = machine.blades
    available = {
        "blade_modes": 6 * (blades.elements - 1),
        "disk_modes": 5 * (disk_nodes(machine.disk) - blades.count),
        "blisk_modes": 4 + reduction.disk_modes + blades.count * (15 + reduction.blade_modes),
    }
    for key, most in available.items():
        if getattr(reduction, key) > most:
            return f"reduction.{key} = {getattr(reduction, key)}: this mesh has {most}; lower it, or take more elements"
    return None
