"""Blades of different stiffness in the reduced model: other machines, the full model, and turned patterns."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from rubgen.fem.blisk import assemble_blisk
from rubgen.fem.constraints import factorize, on_springs, support_stiffness
from rubgen.machine import Mistuning
from rubgen.reduction import cache, reduce
from rubgen.reduction.blisk import reduce_blisk
from rubgen.scenario import Reduction
from rubgen.units import rad_per_s

PATTERN = (0.05, -0.03, 0.01)


def mistuned(machine, pattern):
    return replace(machine, blades=replace(machine.blades, mistuning=Mistuning(pattern=tuple(pattern))))


def drawn(machine, seed):
    return replace(machine, blades=replace(machine.blades, mistuning=Mistuning(relative_std=0.02, seed=seed)))


def reduced(machine, reduction):
    return reduce_blisk(machine.disk, machine.blades, machine.disk_support, reduction)


@pytest.fixture(scope="module")
def scattered(preset):
    """The preset with 2 % of standard deviation, reduced."""
    return reduce(drawn(preset, 3), Reduction())


def test_no_deviation_has_the_bits_of_equal_blades(small):
    systems = [reduce(m, Reduction()).at_speed(700.0) for m in (small, mistuned(small, [0.0] * 3))]
    for name in ("M", "C", "K", "force", "tip_static", "casing_modes"):
        assert getattr(systems[0], name).tobytes() == getattr(systems[1], name).tobytes()


@pytest.mark.parametrize(("name", "speeds"), [("preset", [0.0]), ("small", [0.0, 700.0])])
def test_a_uniform_deviation_is_another_youngs_modulus_of_the_blades(name, speeds, request):
    # Not the preset at speed: its cluster of 36 blade modes makes the eigenvalues themselves uncertain by 1e-9.
    machine = request.getfixturevalue(name)
    material = replace(machine.blades.material, youngs_modulus_pa=0.96 * machine.blades.material.youngs_modulus_pa)
    other = reduce(replace(machine, blades=replace(machine.blades, material=material)), Reduction(disk_modes=3))
    found = reduce(mistuned(machine, [-0.04] * machine.blades.count), Reduction(disk_modes=3))
    for speed in speeds:
        np.testing.assert_allclose(found.blisk_frequencies_hz(speed), other.blisk_frequencies_hz(speed), rtol=1e-9)
    static, expected = (m.at_speed(700.0).tip_static for m in (found, other))
    np.testing.assert_allclose(static, expected, atol=1e-9 * expected.max())
    assert found.at_speed(700.0).force.tobytes() == other.at_speed(700.0).force.tobytes()


@pytest.mark.parametrize("speed", [0.0, 700.0])
def test_a_turned_pattern_has_the_same_frequencies_and_its_unbalance_turns(small, speed):
    first, turned = (reduce(mistuned(small, np.roll(PATTERN, k)), Reduction()) for k in (0, 1))
    found, expected = turned.blisk_frequencies_hz(speed), first.blisk_frequencies_hz(speed)
    np.testing.assert_allclose(found, expected, rtol=1e-8)
    assert np.abs(found / reduce(small, Reduction()).blisk_frequencies_hz(speed) - 1).max() > 1e-3
    if speed:
        U = np.array([m.blisk.growth.unbalance(speed) @ [1, 1j] for m in (first, turned)])
        assert U[1] == pytest.approx(U[0] * np.exp(2j * np.pi / 3), rel=1e-6)
        tips = [m.at_speed(speed).tip_static for m in (first, turned)]
        np.testing.assert_allclose(tips[1], np.roll(tips[0], 1, axis=0), atol=1e-8 * tips[0].max())


def test_all_modes_kept_give_the_full_mistuned_blisk_back(small):
    machine, springs = mistuned(small, PATTERN), support_stiffness(small.disk_support)
    full = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
    blisk = reduced(machine, Reduction(blade_modes=6, disk_modes=135, blisk_modes=193))
    K = blisk.K + blisk.centre.T @ (springs[:, None] * blisk.centre)
    found = eigh(blisk.M, K, eigvals_only=True)[::-1][:150]
    exact = eigh(full.M.toarray(), on_springs(full.K, springs).toarray(), eigvals_only=True)[::-1][:150]
    np.testing.assert_allclose(found, exact, rtol=1e-8)


def test_few_modes_are_as_near_to_the_full_model_as_with_equal_blades(small):
    """The basis of rest serves blades that differ as well: upper bounds, the first nine frequencies within 1 %."""
    springs = support_stiffness(small.disk_support)
    errors = []
    for machine in (small, mistuned(small, PATTERN)):
        full = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
        blisk = reduced(machine, Reduction())
        K = blisk.K + blisk.centre.T @ (springs[:, None] * blisk.centre)
        compliances = [(full.M.toarray(), on_springs(full.K, springs).toarray()), (blisk.M, K)]
        exact, found = (1 / np.sqrt(eigh(*pencil, eigvals_only=True)[::-1][:9]) for pencil in compliances)
        errors.append(found / exact - 1)
    assert np.min(errors) > -1e-9
    assert np.max(errors[1]) < 1.1 * np.max(errors[0]) < 0.011


@pytest.mark.parametrize(("rpm", "growth_error", "load_error"), [(1000, 1e-9, 1e-8), (15000, 1e-8, 5e-5)])
def test_each_tips_growth_and_the_unbalance_of_it_are_the_full_models(preset, scattered, rpm, growth_error, load_error):
    """Growth with O_d held, and what the reduced model adds under the load that held it, against direct solutions."""
    machine, speed, springs = scattered.machine, rad_per_s(rpm), support_stiffness(preset.disk_support)
    full = assemble_blisk(machine.disk, machine.blades, machine.disk_support)
    K = (on_springs(full.K, springs) + speed**2 * (full.K_sigma - full.S)).tocsr()
    tips = full.tips[:, :3]
    held = np.concatenate([[0, 0], factorize(K[2:, 2:]).solve(speed**2 * full.f_c[2:])])
    free = factorize(K).solve(speed**2 * full.f_c)
    system, scale = scattered.at_speed(speed), np.abs(free[tips]).max()
    np.testing.assert_allclose(system.tip_static, held[tips], atol=growth_error * scale)
    assert np.ptp(system.tip_static[:, 0]) > 0.01 * scale
    force = system.force.copy()
    force[system.centre] -= speed**2 * machine.unbalance_kg_m
    q = np.linalg.solve(scattered.stiffness(speed), force[: system.casing_start])
    assert np.abs(free[tips] - held[tips]).max() > 20 * load_error * np.abs(free[:2]).max()
    moved = system.tip_static + q[: system.centre].reshape(-1, 3)
    np.testing.assert_allclose(moved, free[tips], atol=load_error * scale)
    np.testing.assert_allclose(q[system.centre : system.centre + 2], free[:2], rtol=2e-2)


def test_the_cache_tells_patterns_and_seeds_apart(small, tmp_path, monkeypatch):
    monkeypatch.setenv("RUBGEN_CACHE_DIR", str(tmp_path))
    modes = Reduction(blade_modes=1, disk_modes=1, blisk_modes=1)
    machines = [small, mistuned(small, PATTERN), mistuned(small, PATTERN[::-1]), drawn(small, 1), drawn(small, 2)]
    taken = [cache.cached_blisk(m.disk, m.blades, m.disk_support, modes) for m in machines]
    assert len(list(cache.cache_folder("reduction").glob("*.blisk"))) == len(machines)
    assert len({blisk.K.tobytes() for blisk in taken}) == len(machines)
    again = cache.cached_blisk(small.disk, machines[1].blades, small.disk_support, modes)
    assert again.growth.moment.any()
    assert again.growth.moment.tobytes() == taken[1].growth.moment.tobytes()
