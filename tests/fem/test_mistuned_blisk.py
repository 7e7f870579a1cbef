"""Blades of different stiffness in the full model, against other machines and first-order perturbation."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from rubgen.fem.blisk import assemble_blisk
from rubgen.fem.constraints import on_springs, support_stiffness
from rubgen.machine import Mistuning, load_machine
from validation.full_blisk import blisk_frequencies

MATRICES = ("M", "G", "K", "K_apart", "S", "K_sigma")
BLADES = 7
ANGLE = 2 * np.pi * np.arange(BLADES) / BLADES
EPS = 1e-6


@pytest.fixture(scope="module")
def machine():
    whole = load_machine("zeng2019")
    disk = replace(whole.disk, radial_elements=1, circumferential_elements=BLADES)
    return replace(whole, disk=disk, blades=replace(whole.blades, count=BLADES, elements=2))


def assemble(machine, pattern=None):
    mistuning = None if pattern is None else Mistuning(pattern=tuple(pattern))
    return assemble_blisk(machine.disk, replace(machine.blades, mistuning=mistuning), machine.disk_support)


def test_no_deviation_has_the_bits_of_equal_blades(machine):
    tuned, zero = assemble(machine), assemble(machine, np.zeros(BLADES))
    for name in MATRICES:
        np.testing.assert_array_equal(getattr(zero, name).toarray(), getattr(tuned, name).toarray())


def test_a_uniform_deviation_is_another_youngs_modulus_of_the_blades(machine):
    material = machine.blades.material
    stiff = replace(material, youngs_modulus_pa=1.07 * material.youngs_modulus_pa)
    other = assemble(replace(machine, blades=replace(machine.blades, material=stiff)))
    found = assemble(machine, [0.07] * BLADES)
    for name in MATRICES:
        X = getattr(other, name).toarray()
        np.testing.assert_allclose(getattr(found, name).toarray(), X, atol=1e-12 * np.abs(X).max())
    supports = machine.disk_support
    np.testing.assert_allclose(
        blisk_frequencies(found, supports, 20), blisk_frequencies(other, supports, 20), rtol=1e-9
    )


def test_only_the_stiffness_of_that_blade_differs(machine):
    tuned, found = assemble(machine), assemble(machine, [0, 0, 0.1, 0, 0, 0, 0])
    for name in MATRICES:
        X, Y = getattr(tuned, name).toarray(), getattr(found, name).toarray()
        if name in ("K", "K_apart"):
            blade = slice(found.roots[2, 0], found.tips[2, 5] + 1)
            Y[blade, blade] -= 0.1 * tuned.beam.K
        np.testing.assert_allclose(Y, X, atol=1e-10 * np.abs(X).max())


@pytest.fixture(scope="module")
def soft(machine):
    """The same with a thin disk, whose coupling parts the blades' modes by diameters."""
    thin = replace(machine.disk, bore_thickness_m=0.012, rim_thickness_m=0.008)
    return replace(machine, disk=thin)


@pytest.fixture(scope="module")
def equal(soft):
    model = assemble(soft)
    return *modes_of(soft, model), model


def modes_of(machine, model, count=42):
    """The lowest omega of the full model at rest on its supports, ascending, and their mass-normalised modes."""
    K, n = on_springs(model.K, support_stiffness(machine.disk_support)).toarray(), len(model.f_c)
    compliance, modes = eigh(model.M.toarray(), K, subset_by_index=[n - count, n - 1])
    return 1 / np.sqrt(compliance[::-1]), modes[:, ::-1] / np.sqrt(compliance[::-1])


def doublets(omega):
    return np.flatnonzero(np.diff(omega[:41]) < 1e-9 * omega[:40])


def diameters_of(mode, model):
    return np.abs(np.fft.rfft(mode[model.tips[:, :3]], axis=0)).max(axis=1).argmax()


def test_a_turned_pattern_has_the_same_frequencies(soft, equal):
    pattern = 0.05 * np.sin(1 + ANGLE**2)
    first, turned = (modes_of(soft, assemble(soft, np.roll(pattern, k)))[0] for k in (0, 3))
    np.testing.assert_allclose(turned, first, rtol=1e-9)
    assert np.abs(first / equal[0] - 1).max() > 1e-3
    other = modes_of(soft, assemble(soft, np.roll(pattern, 1) * [1, 1, 1, -1, 1, 1, 1]))[0]
    assert np.abs(other / first - 1).max() > 1e-4


@pytest.mark.parametrize("pattern", [np.cos(2 * ANGLE), np.cos(4 * ANGLE), np.cos(6 * ANGLE), np.sin(1 + ANGLE**2)])
def test_a_pattern_shifts_and_splits_doublets_as_perturbation_theory_says(soft, equal, pattern):
    """On a doublet Phi omega^2 becomes omega^2 + eig(sum_k delta_k Phi_k^T K_k Phi_k), to first order."""
    omega, modes, model = equal
    found, _ = modes_of(soft, assemble(soft, EPS * pattern))
    pairs = doublets(omega)
    assert len(pairs) >= 16
    for k in pairs:
        blades = modes[model.disk_size :, k : k + 2].reshape(BLADES, -1, 2)
        D = np.einsum("k,kia,ij,kjb->ab", EPS * pattern, blades, model.beam.K, blades)
        expected = np.linalg.eigvalsh(D) / (2 * omega[k] ** 2)
        # Other pairs are 2e-3 or more away: second order is below 1e-3 of EPS.
        np.testing.assert_allclose(found[k : k + 2] / omega[k] - 1, expected, atol=3e-4 * EPS)


@pytest.mark.parametrize("diameters", [1, 2, 3])
def test_doublets_split_by_twice_their_diameters_as_far_as_all_blades_together_shift_them(soft, equal, diameters):
    """The pattern eps cos(2 n theta_k) splits the doublets of n diameters and no others, without a mode of the model.

    Blades that all bend alike have the energies cos^2 n theta_k and sin^2 n theta_k in the two modes of a doublet. They
    weigh the pattern with +-1/2: omega (1 +- eps s / 4) with s the blades' share of the energy. A uniform deviation eps
    brings omega (1 + eps s / 2), as much as the two modes part.
    """
    omega, modes, model = equal
    split, _ = modes_of(soft, assemble(soft, EPS * np.cos(2 * diameters * ANGLE)))
    uniform, _ = modes_of(soft, assemble(soft, [EPS] * BLADES))
    pairs = [k for k in doublets(omega) if omega[k] < 2 * np.pi * 200]  # the blades' first bending
    assert [diameters_of(modes[:, k], model) for k in pairs] == [1, 2, 3, 1]
    for k in pairs:
        gap, shift = (split[k + 1] - split[k]) / omega[k], uniform[k] / omega[k] - 1
        assert shift > 0.1 * EPS
        expected = shift if diameters_of(modes[:, k], model) == diameters else 0
        assert gap == pytest.approx(expected, abs=3e-4 * EPS)
