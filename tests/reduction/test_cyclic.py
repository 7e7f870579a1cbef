"""One sector of the disk for all, against the full sparse path."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from rubgen.fem.blisk import assemble_blisk
from rubgen.fem.constraints import support_stiffness
from rubgen.fem.disk import annular_mesh, assemble_disk
from rubgen.fem.shell import shell_inertia, shell_stiffness
from rubgen.machine import Mistuning
from rubgen.reduction.blisk import _turning, reduce_blisk
from rubgen.scenario import Reduction

TOLERANCE = 1e-8
MATRICES = ("M", "K", "G", "A")


def machines(preset):
    return {
        "preset": (preset.disk, preset.blades),
        "17 blades": (
            replace(preset.disk, circumferential_elements=34, radial_elements=3),
            replace(preset.blades, count=17, elements=6, length_m=0.2),
        ),
        "mistuned": (
            replace(preset.disk, circumferential_elements=48, radial_elements=4),
            replace(preset.blades, count=24, elements=6, mistuning=Mistuning(relative_std=0.03, seed=1)),
        ),
        "two blades": (
            replace(preset.disk, circumferential_elements=12, radial_elements=3),
            replace(preset.blades, count=2, elements=4),
        ),
    }


@pytest.fixture(scope="module", params=["preset", "17 blades", "mistuned", "two blades"])
def both(request, preset):
    """The blisk by way of one sector and by the whole disk, and its masters."""
    disk, blades = machines(preset)[request.param]
    paths = (reduce_blisk(disk, blades, preset.disk_support, Reduction(), cyclic=cyclic) for cyclic in (True, False))
    return *paths, slice(0, 3 * blades.count + 2)


def on_springs(blisk, preset):
    T = blisk.centre
    return blisk.K + T.T @ (support_stiffness(preset.disk_support)[:, None] * T)


@pytest.mark.parametrize("name", MATRICES)
def test_matrices_of_the_masters_agree(both, name):
    one, other, masters = both
    a, b = getattr(one, name)[masters, masters], getattr(other, name)[masters, masters]
    assert np.abs(a - b).max() <= TOLERANCE * np.abs(b).max()


def test_frequencies_agree(both, preset):
    squares = [eigh(on_springs(blisk, preset), blisk.M, eigvals_only=True) for blisk in both[:2]]
    np.testing.assert_allclose(squares[0], squares[1], rtol=TOLERANCE)


@pytest.mark.parametrize("hertz", [50.0, 333.0])
def test_what_the_masters_answer_to_a_force_agrees(both, preset, hertz):
    """With Coriolis and centrifugal terms: modes of equal frequency may be turned, the answer may not."""
    omega, speed = 2 * np.pi * hertz, 1000.0
    answers = [
        np.linalg.inv(on_springs(b, preset) + speed**2 * b.A + 2j * omega * speed * b.G - (1 + 0.01j) * omega**2 * b.M)[
            both[2], both[2]
        ]
        for b in both[:2]
    ]
    assert np.abs(answers[0] - answers[1]).max() <= 1e-6 * np.abs(answers[1]).max()


def test_recovery_of_centre_and_growth_agree(both):
    one, other, masters = both
    for a, b in ((one.centre, other.centre), (one.roots, other.roots)):
        assert np.abs(a - b)[..., masters].max() <= TOLERANCE * np.abs(b).max()
    np.testing.assert_allclose(one.growth.at(1000.0), other.growth.at(1000.0), rtol=1e-12)


def test_turned_elements_are_those_integrated_one_by_one(preset):
    mesh = annular_mesh(replace(preset.disk, circumferential_elements=12, radial_elements=3))
    alone, material = replace(mesh, around=1), preset.disk.material
    pairs = [(shell_stiffness(each, material), shell_inertia(each, material)) for each in (mesh, alone)]
    matrices = [(K, inertia.M, inertia.G, inertia.S) for K, inertia in pairs]
    for turned, own in zip(*matrices, strict=True):
        assert abs(turned - own).max() <= 1e-12 * abs(own).max()


def test_a_turn_by_one_blade_moves_the_disk_onto_itself(preset):
    disk, blades = machines(preset)["17 blades"]
    turning, plate = _turning(disk, blades), assemble_disk(disk)
    place, n = turning.place[1], len(turning.place[1])
    Q = np.zeros((6 * n, 6 * n))
    for node in range(n):
        Q[6 * place[node] : 6 * place[node] + 6, 6 * node : 6 * node + 6] = turning.rotation[1]
    K = np.zeros((6 * n, 6 * n))
    K[6:, 6:] = plate.K.toarray()
    np.testing.assert_allclose(Q @ K @ Q.T, K, rtol=0, atol=1e-12 * np.abs(K).max())
    rim = assemble_blisk(disk, blades, preset.disk_support).rim[:, 0] // 6
    assert [int(turning.place[k, rim[0]]) for k in range(blades.count)] == rim.tolist()
