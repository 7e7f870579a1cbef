"""The reduction of one component, and the two steps, against the unreduced matrices."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.linalg import eigh, solve

from rubgen.errors import UserError
from rubgen.fem.blisk import assemble_blisk
from rubgen.fem.constraints import factorize, on_springs, support_stiffness
from rubgen.reduction import craig_bampton as module
from rubgen.reduction.blisk import reduce_blisk
from rubgen.reduction.craig_bampton import craig_bampton
from rubgen.scenario import Reduction
from rubgen.scenario.checks.reducible import reduction_problem


def chain(n):
    """Masses 1..n on a chain of springs, fixed at its first end."""
    K = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    return sp.csr_array(np.diag(np.arange(1.0, n + 1))), sp.csr_array(1e3 * K)


def test_statics_of_loaded_masters_are_exact():
    M, K = chain(12)
    masters = np.array([11, 4])
    V = craig_bampton(M, K, masters, 2)
    load = np.zeros(12)
    load[masters] = [3.0, -1.0]
    found = V @ solve(V.T @ K @ V, V.T @ load)
    np.testing.assert_allclose(found, solve(K.toarray(), load), rtol=1e-12)


@pytest.mark.parametrize("modes", [0, 1, 3, 6])
def test_frequencies_are_upper_bounds_and_fall_with_every_mode(modes):
    M, K = chain(12)
    exact = eigh(K.toarray(), M.toarray(), eigvals_only=True)

    def reduced(count):
        V = craig_bampton(M, K, np.array([11, 4]), count)
        return eigh(V.T @ K @ V, V.T @ M @ V, eigvals_only=True)

    assert np.all(reduced(modes) >= exact[: 2 + modes] * (1 - 1e-12))
    assert np.all(reduced(modes + 1)[: 2 + modes] <= reduced(modes) * (1 + 1e-12))
    assert reduced(modes + 1)[0] < reduced(modes)[0]


def test_fixed_modes_are_mass_normalised_at_rest_on_masters_and_signed():
    M, K = chain(12)
    V = craig_bampton(M, K, np.array([0, 5]), 4)
    modes = V[:, 2:]
    np.testing.assert_allclose(modes.T @ M @ modes, np.eye(4), atol=1e-12)
    assert np.all(modes[[0, 5]] == 0)
    assert np.all(modes[np.abs(modes).argmax(axis=0), range(4)] > 0)


def test_sparse_and_dense_solutions_span_the_same_motion(monkeypatch):
    M, K = chain(60)
    masters = np.array([59, 7])
    dense = craig_bampton(M, K, masters, 5)
    monkeypatch.setattr(module, "DENSE_LIMIT", 0)
    np.testing.assert_allclose(craig_bampton(M, K, masters, 5), dense, atol=1e-10)


def test_more_modes_than_masses_are_refused():
    M, K = chain(6)
    massless = M.toarray()
    massless[3, 3] = 0.0
    with pytest.raises(UserError, match="5 modes of a component that has 4; give at most 4"):
        craig_bampton(sp.csr_array(massless), K, np.array([0]), 5)


@pytest.mark.parametrize(("key", "most"), [("blade_modes", 6), ("disk_modes", 135)])
def test_modes_that_a_mesh_does_not_have_are_refused_before_it_is_built(small, key, most):
    # The reduction itself finds the same number: it refuses one more, and keeps these in the test below.
    text = reduction_problem(small, Reduction(**{key: most + 1}))
    assert text.startswith(f"reduction.{key} = {most + 1}: this mesh has {most}; ")
    assert reduction_problem(small, Reduction(**{key: most})) is None
    with pytest.raises(UserError, match=f"{most + 1} modes of a component that has {most}; "):
        reduce_blisk(small.disk, small.blades, small.disk_support, Reduction(**{key: most + 1}))


def test_all_modes_kept_give_the_full_blisk_back(small):
    # Interior DoFs with mass: blade 6; disk 162 less 27 drilling ones; second step all that is left.
    support = small.disk_support
    full = assemble_blisk(small.disk, small.blades, support)
    every = Reduction(blade_modes=6, disk_modes=135, blisk_modes=193)
    reduced = reduce_blisk(small.disk, small.blades, support, every)
    springs = support_stiffness(support)
    compliance = eigh(full.M.toarray(), on_springs(full.K, springs).toarray(), eigvals_only=True)[::-1]
    K = reduced.K + reduced.centre.T @ (springs[:, None] * reduced.centre)
    found = eigh(reduced.M, K, eigvals_only=True)[::-1]
    assert len(found) == np.count_nonzero(compliance > 1e-13 * compliance[0]) == 204
    # 150 modes reach to 62 kHz; above them lie the penalties, where round-off grows with frequency squared.
    np.testing.assert_allclose(found[:150], compliance[:150], rtol=1e-8)


def test_all_modes_kept_give_the_centrifugal_and_coriolis_terms_back(small):
    full = assemble_blisk(small.disk, small.blades, small.disk_support)
    every = Reduction(blade_modes=6, disk_modes=135, blisk_modes=193)
    reduced = reduce_blisk(small.disk, small.blades, small.disk_support, every)
    springs, speed, frequency = support_stiffness(small.disk_support), 800.0, 2000.0
    # Receptance at a tip: (K - w^2 M + 2 i w Omega G + Omega^2 A)^-1, full against reduced.
    A = full.K_sigma - full.S
    dynamic = on_springs(full.K, springs) - frequency**2 * full.M + speed**2 * A
    dynamic = (dynamic + 2j * frequency * speed * full.G).tocsc()
    load = np.zeros(full.M.shape[0], complex)
    load[full.tips[1, 1]] = 1.0
    exact = sp.linalg.splu(dynamic).solve(load)[full.tips[:, :3]]
    K = reduced.K + reduced.centre.T @ (springs[:, None] * reduced.centre) + speed**2 * reduced.A
    small_load = np.zeros(len(K), complex)
    small_load[4] = 1.0
    found = solve(K - frequency**2 * reduced.M + 2j * frequency * speed * reduced.G, small_load)[:9].reshape(3, 3)
    np.testing.assert_allclose(found, exact, atol=1e-6 * np.abs(exact).max())


def test_two_step_reduction_is_exact_in_statics(small):
    # A force at a tip and one at O_d: masters of both steps, so their displacement is the full model's.
    support = small.disk_support
    full = assemble_blisk(small.disk, small.blades, support)
    reduced = reduce_blisk(small.disk, small.blades, support, Reduction(blade_modes=1, disk_modes=1, blisk_modes=1))
    springs = support_stiffness(support)
    load = np.zeros(full.M.shape[0])
    load[full.tips[2, 2]], load[0] = 1.0, -5.0
    exact = factorize(on_springs(full.K, springs)).solve(load)
    K = reduced.K + reduced.centre.T @ (springs[:, None] * reduced.centre)
    q = solve(K, np.eye(len(K))[8] - 5 * np.eye(len(K))[9])
    np.testing.assert_allclose(q[:9].reshape(3, 3), exact[full.tips[:, :3]], atol=1e-8 * np.abs(exact).max())
    np.testing.assert_allclose(reduced.centre @ q, exact[:6], atol=1e-8 * np.abs(exact).max())
