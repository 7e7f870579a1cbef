"""The casing's ring on its springs.

The preset's casing without ovality, with 180 nodes; frequencies in rad/s. Inextensional theory needs springs that
are soft compared with E A / R^2: here 5 and 3 N/m a node, 1e-6 of it. The polygon of 180 straight elements differs
from the circle in bending stiffness and length by at most (2 pi / 180)^2 / 4 = 3e-4, hence the tolerance of 5e-4.
This error falls with the square of the element length, which is observed.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np
from scipy.linalg import eigh

from rubgen.arrays import FloatArray
from rubgen.fem.casing import assemble_casing
from rubgen.machine import Machine, load_machine
from validation.verification.row import Row, relative, within

TITLE = "Rings"
MODES = 11
HIGHEST_ORDER = 20


def ring(radial: float, tangential: float, nodes: int = 180, ovality: float = 0.0, lobes: int = 2) -> Machine:
    """The preset with another casing: springs in N/m at each node."""
    preset = load_machine("zeng2019")
    casing = dataclasses.replace(
        preset.casing,
        ovality_m=ovality,
        lobes=lobes,
        nodes=nodes,
        radial_support_stiffness_n_per_m=radial,
        circumferential_support_stiffness_n_per_m=tangential,
    )
    return dataclasses.replace(preset, casing=casing)


def ring_frequencies(machine: Machine) -> FloatArray:
    """Lowest eleven frequencies of the casing in rad/s, ascending."""
    model = assemble_casing(machine)
    squares = eigh(model.K.toarray(), model.M.toarray(), eigvals_only=True, subset_by_index=[0, MODES - 1])
    return np.asarray(np.sqrt(squares))


def ring_theory(machine: Machine, order: int, *, extensible: bool) -> float:
    """Frequency in rad/s of a thin circular ring on an elastic foundation; k_r and k_t per metre of arc.

    Inextensional: omega^2 = [E I n^2 (n^2 - 1)^2 / R^4 + k_r n^2 + k_t] / [rho A (n^2 + 1)]. Extensible: the lower root
    of the energies E A (v' + w)^2 / R^2 and E I (w'' - v')^2 / R^4.
    """
    c, n = machine.casing, order
    R = machine.casing_mean_radius_m + c.thickness_m / 2
    E, area, inertia = c.material.youngs_modulus_pa, c.width_m * c.thickness_m, c.width_m * c.thickness_m**3 / 12
    mass, per_arc = c.material.density_kg_per_m3 * area, c.nodes / (2 * np.pi * R)
    k_r = per_arc * c.radial_support_stiffness_n_per_m
    k_t = per_arc * c.circumferential_support_stiffness_n_per_m
    if not extensible:
        bend = E * inertia * n**2 * (n**2 - 1) ** 2 / R**4
        return float(np.sqrt((bend + k_r * n**2 + k_t) / (mass * (n**2 + 1))))
    membrane, bend = E * area / R**2, E * inertia / R**4
    cross = membrane * n + bend * n**3
    K = np.array([[membrane + bend * n**4 + k_r, cross], [cross, (membrane + bend) * n**2 + k_t]])
    return float(np.sqrt(np.linalg.eigvalsh(K)[0] / mass))


def by_order(machine: Machine, *, extensible: bool) -> list[tuple[int, float, float]]:
    """(order, theory, found) of the orders that the lowest modes have: order 0 stands once, the others twice."""
    theory = sorted((ring_theory(machine, n, extensible=extensible), n) for n in range(HIGHEST_ORDER))
    found, rank, matched = ring_frequencies(machine), 0, []
    for expected, n in theory:
        if rank >= MODES:
            break
        matched.append((n, expected, float(found[rank])))
        rank += 1 if n == 0 else 2
    return sorted(matched)


def order_three(nodes: int) -> float:
    """Frequency of order 3 in rad/s on springs of 100 N/m a node of 180, as much per length for other meshes."""
    stiffness = 100.0 * 180 / nodes
    return float(ring_frequencies(ring(stiffness, stiffness, nodes))[5])


def rows() -> Iterator[Row]:
    """Inextensional and extensible rings, mass, order of convergence."""
    soft = ring(5.0, 3.0)
    for n, expected, found in by_order(soft, extensible=False):
        yield relative(f"ring on soft springs: order {n}, rad/s", "inextensional ring (Love)", expected, found, 5e-4)
    stiff = ring(5e4, 2e5)
    for n, expected, found in by_order(stiff, extensible=True):
        yield relative(f"ring on stiff springs: order {n}, rad/s", "extensible ring, 2 x 2", expected, found, 5e-4)
    f = [order_three(nodes) for nodes in (60, 120, 240)]
    order = float(np.log2((f[0] - f[1]) / (f[1] - f[2])))
    yield within("ring: observed order of the frequency", "polygon against circle, order 2", 2.0, order, 0.05)
    yield from inertia(ring(5e4, 5e4, ovality=20e-3, lobes=3))


def inertia(machine: Machine) -> Iterator[Row]:
    """Mass and polar inertia of a lobed ring."""
    model = assemble_casing(machine)
    c, theta = machine.casing, 2 * np.pi * np.arange(4096) / 4096
    r = machine.casing_mean_radius_m + c.thickness_m / 2 - c.ovality_m / 2 * np.cos(c.lobes * theta)
    ds = np.hypot(r, c.lobes * c.ovality_m / 2 * np.sin(c.lobes * theta)) * 2 * np.pi / 4096
    line = c.material.density_kg_per_m3 * c.width_m * c.thickness_m
    x, y = model.nodes_xy.T
    shift, turn = np.column_stack([0 * x + 1, 0 * x, 0 * x]).ravel(), np.column_stack([-y, x, 0 * x + 1]).ravel()
    source = "integral over the smooth centre line"
    yield relative("three-lobed ring: mass, kg", source, line * ds.sum(), shift @ model.M @ shift, 1e-4)
    polar = line * float((r**2 * ds).sum())
    yield relative("three-lobed ring: polar inertia, kg m2", source, polar, turn @ model.M @ turn, 3e-4)
