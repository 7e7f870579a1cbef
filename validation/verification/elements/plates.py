"""Plates and annular disks at rest.

Frequencies of annular plates are omega a^2 sqrt(rho h / D) with nu = 0.3, clamped at b = 0.3 a and free at a. At
h/a = 0.1 the mesh of the preset's disk (7 x 72 elements) has an error below 1e-4. A Kirchhoff plate is the limit of
vanishing thickness. A Mindlin plate with a free edge approaches it with the first power of h, because its boundary
layer is as wide as h. So h/a = 0.005, 0.01 and 0.02 are extrapolated by a parabola. This uses 14 x 144 elements,
because thin narrow sectors need them (the error of 7 x 72 elements is 2e-3 there). The element converges with order
4, as observed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.linalg import eigh
from scipy.sparse.linalg import LinearOperator, eigsh

from rubgen.arrays import FloatArray, IntArray, SparseMatrix
from rubgen.fem.constraints import factorize
from rubgen.fem.disk import DiskModel, assemble_disk
from rubgen.fem.shell import shell_inertia, shell_stiffness
from rubgen.fem.shell_strains import ShellMesh
from rubgen.machine import Disk, Material
from validation.verification.row import Row, relative, within

TITLE = "Plates and annular disks"
STEEL = Material(youngs_modulus_pa=2.06e11, poisson_ratio=0.3, density_kg_per_m3=7850.0)
BORE = 0.3
KIRCHHOFF = (6.6604, 6.5523, 7.9565, 13.2757)
MINDLIN = (6.5178, 6.3173, 7.5538, 12.6929)
W, TH_X, TH_Y = 2, 3, 4


def annulus(bore: float, thickness: float, radial: int = 7, circumferential: int = 72) -> Disk:
    """A steel disk of even thickness, outer radius 1 m."""
    return Disk(
        material=STEEL,
        bore_radius_m=bore,
        rim_radius_m=1.0,
        bore_thickness_m=thickness,
        rim_thickness_m=thickness,
        radial_elements=radial,
        circumferential_elements=circumferential,
    )


def bending_stiffness(thickness: float) -> float:
    """D = E h^3 / (12 (1 - nu^2)) in N m."""
    return STEEL.youngs_modulus_pa * thickness**3 / 12 / (1 - STEEL.poisson_ratio**2)


def lowest(M: SparseMatrix, K: SparseMatrix, free: IntArray, count: int) -> FloatArray:
    """Lowest eigenvalues omega^2 (count,) of the free DoFs, ascending."""
    K, M = K[free][:, free], M[free][:, free]
    inverse = LinearOperator(K.shape, matvec=factorize(K).solve, dtype=np.float64)
    start = np.sin(1.0 + np.arange(len(free)))
    squares = eigsh(K, count, M, sigma=0.0, OPinv=inverse, v0=start, tol=1e-11, return_eigenvectors=False)
    return np.asarray(np.sort(squares))


def out_of_plane(model: DiskModel) -> IntArray:
    """DoFs w, th_x, th_y of a disk that is clamped at its bore."""
    nodes = np.arange(len(model.mesh.nodes))
    plate = (6 * nodes[:, None] + np.array([W, TH_X, TH_Y])).ravel()
    return np.setdiff1d(plate, (6 * model.bore[:, None] + np.arange(6)).ravel())


def annular_frequencies(thickness: float, radial: int = 7, circumferential: int = 72) -> FloatArray:
    """Scaled frequencies (4,) with 0 to 3 nodal diameters."""
    model = assemble_disk(annulus(BORE, thickness, radial, circumferential))
    squares = lowest(model.M, model.K, out_of_plane(model), 7)
    scaled: FloatArray = np.sqrt(squares * STEEL.density_kg_per_m3 * thickness / bending_stiffness(thickness))
    return scaled[[2, 0, 3, 5]]  # ascending: 1, 1, 0, 2, 2, 3, 3


def thin_limit() -> FloatArray:
    """The same (4,) extrapolated to vanishing thickness by a parabola through three."""
    thicknesses = np.array([0.005, 0.01, 0.02])
    frequencies = np.array([annular_frequencies(h, 14, 144) for h in thicknesses])
    limit: FloatArray = np.linalg.solve(np.vander(thicknesses, increasing=True), frequencies)[0]
    return limit


def square_mesh(elements: int, thickness: float) -> ShellMesh:
    """A unit square of elements x elements shells."""
    n = 2 * elements + 1
    numbers = -np.ones((n, n), dtype=np.int64)
    used = np.add.outer(np.arange(n) % 2, np.arange(n) % 2) < 2  # eight-node elements have no middle node
    numbers[used] = np.arange(np.count_nonzero(used))
    i, j = (2 * grid.ravel() for grid in np.meshgrid(np.arange(elements), np.arange(elements), indexing="ij"))
    around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    connectivity = np.stack([numbers[i + a, j + b] for a, b in around], axis=1)
    return ShellMesh(np.argwhere(used) / (n - 1), connectivity, lambda p: np.full(p.shape[:-1], thickness))


def clamped_centre_deflection(elements: int, thickness: float) -> float:
    """Deflection w D / (p a^4) at the centre of a clamped square plate under uniform pressure."""
    mesh = square_mesh(elements, thickness)
    K, M = shell_stiffness(mesh, STEEL), shell_inertia(mesh, STEEL).M
    load = np.zeros((len(mesh.nodes), 6))
    load[:, W] = 1.0
    pressure = M @ load.ravel() / (STEEL.density_kg_per_m3 * thickness)
    inside = np.flatnonzero(np.all((mesh.nodes > 0) & (mesh.nodes < 1), axis=1))
    free = (6 * inside[:, None] + np.arange(6)).ravel()
    q = np.zeros(K.shape[0])
    q[free] = factorize(K[free][:, free]).solve(pressure[free])
    centre = np.argmin(np.linalg.norm(mesh.nodes - 0.5, axis=1))
    return float(q[6 * centre + W] * bending_stiffness(thickness))


def navier_frequency(thickness: float) -> float:
    """First frequency (rad/s) of the simply supported unit square Mindlin plate, in closed form.

    w = sin sin; th_y = B cos sin, -th_x = B sin cos by symmetry: curvature energy 2 D a^2 B^2 per quarter area.
    """
    h, rho, a = thickness, STEEL.density_kg_per_m3, np.pi
    D, shear = bending_stiffness(h), 5 / 6 * STEEL.shear_modulus_pa * h
    K = np.array([[2 * shear * a**2, 2 * shear * a], [2 * shear * a, 2 * (shear + 2 * D * a**2)]])
    M = np.diag([rho * h, 2 * rho * h**3 / 12])
    return float(np.sqrt(eigh(K, M, eigvals_only=True)[0]))


def supported_frequency(elements: int, thickness: float) -> float:
    """First frequency (rad/s) of the unit square plate with w and the rotation along the edge held at its edges."""
    mesh = square_mesh(elements, thickness)
    K, M = shell_stiffness(mesh, STEEL), shell_inertia(mesh, STEEL).M
    side, end = (np.isin(mesh.nodes[:, i], (0.0, 1.0)) for i in (0, 1))
    free = np.zeros((len(mesh.nodes), 6), dtype=bool)
    free[:, [W, TH_X, TH_Y]] = np.column_stack([~(side | end), ~side, ~end])
    return float(np.sqrt(lowest(M, K, np.flatnonzero(free.ravel()), 1)[0]))


def rows() -> Iterator[Row]:
    """Square plates, then annular ones."""
    source = "Timoshenko, Woinowsky-Krieger: w D / (p a^4)"
    for thickness in (1e-3, 1e-5):
        quantity = f"clamped square plate, h/a = {thickness:g}: centre deflection"
        yield relative(quantity, source, 0.0012653, clamped_centre_deflection(16, thickness), 2e-3)
    thickness = 0.05
    exact = navier_frequency(thickness)
    f = [supported_frequency(n, thickness) for n in (6, 12, 24)]
    quantity = "simply supported square Mindlin plate, h/a = 0.05: first frequency, rad/s"
    yield relative(quantity, "Navier's solution in closed form", exact, f[2], 3e-6)
    order = float(np.log2((f[0] - exact) / (f[1] - exact)))
    yield within("shell: observed order of the frequency", "quadratic shell, order 4", 4.0, order, 0.15)
    source = "Mindlin plate by Bessel determinants, kappa = 5/6"
    for n, (expected, found) in enumerate(zip(MINDLIN, annular_frequencies(0.1), strict=True)):
        yield relative(f"annular plate, h/a = 0.1, {n} nodal diameters", source, expected, found, 2e-4)
    source = "Kirchhoff plate by Bessel determinants; Leissa 1969"
    for n, (expected, found) in enumerate(zip(KIRCHHOFF, thin_limit(), strict=True)):
        yield relative(f"annular plate, h -> 0, {n} nodal diameters", source, expected, found, 1e-4)
