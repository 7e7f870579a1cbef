"""Runs of the preset with a casing that rubgen itself does not make: fewer shapes, or an odd number of nodes."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
from scipy.linalg import eigh

from rubgen.arrays import IntArray
from rubgen.fem.casing import assemble_casing
from rubgen.reduction import reduce
from rubgen.reduction.model import SpinningSystem
from rubgen.scenario import Scenario
from rubgen.solver.integrate import integrate
from validation.piece import Arrays
from validation.zeng2019.models.mode_shapes import nodal_diameters
from validation.zeng2019.runs.outcome import outcome

ODD_NODES = 181


def even_shapes_only(scenario: Scenario) -> Arrays:
    """The outcome without the casing's modes of odd circumferential order."""
    system = _system(scenario)
    radial_and_tangential = _polar(system.casing_modes)
    kept = np.flatnonzero(nodal_diameters(radial_and_tangential) % 2 == 0)
    return _outcome(_with_casing_modes(system, kept), scenario)


def odd_nodes(scenario: Scenario) -> Arrays:
    """The outcome with 181 casing nodes, the springs shared among them."""
    machine = scenario.machine
    share = machine.casing.nodes / ODD_NODES
    casing = replace(
        machine.casing,
        nodes=ODD_NODES,
        radial_support_stiffness_n_per_m=machine.casing.radial_support_stiffness_n_per_m * share,
        circumferential_support_stiffness_n_per_m=machine.casing.circumferential_support_stiffness_n_per_m * share,
    )
    system = _system(scenario)
    model = assemble_casing(replace(machine, casing=casing), any_nodes=True)
    count = system.n_casing
    squares, vectors = eigh(model.K.toarray(), model.M.toarray(), subset_by_index=[0, count - 1])
    K, C = system.K.copy(), system.C.copy()
    first = system.casing_start
    omega = np.sqrt(squares)
    K[first:, first:], C[first:, first:] = np.diag(squares), np.diag(2 * machine.damping.casing * omega)
    modes = vectors.reshape(-1, 3, count)[:, :2]
    return _outcome(replace(system, K=K, C=C, casing_modes=np.ascontiguousarray(modes)), scenario)


def _system(scenario: Scenario) -> SpinningSystem:
    return reduce(scenario.machine, scenario.reduction).at_speed(scenario.operation.speed_rad_per_s)


def _with_casing_modes(system: SpinningSystem, kept: IntArray) -> SpinningSystem:
    """The system with these of its casing modes."""
    rows = np.concatenate([np.arange(system.casing_start), system.casing_start + kept])
    M, C, K = (np.ascontiguousarray(matrix[np.ix_(rows, rows)]) for matrix in (system.M, system.C, system.K))
    modes = np.ascontiguousarray(system.casing_modes[:, :, kept])
    return replace(system, M=M, C=C, K=K, force=system.force[rows], casing_modes=modes, n_casing=len(kept))


def _polar(modes: np.ndarray) -> np.ndarray:
    """Radial and tangential displacement (nodes, 2, modes) of modes given along X and Y."""
    angle = 2 * np.pi * np.arange(len(modes)) / len(modes)
    c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
    x, y = modes[:, 0], modes[:, 1]
    return np.stack([c * x + s * y, c * y - s * x], axis=1)


def _outcome(system: SpinningSystem, scenario: Scenario) -> Arrays:
    found = outcome(integrate(system, scenario.operation, scenario.contact))
    return {field.name: np.asarray(getattr(found, field.name)) for field in fields(found)}
