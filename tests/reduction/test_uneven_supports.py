"""What a machine's uneven supports, film and gravity become in the reduced system."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen import make_scenario
from rubgen.machine import SqueezeFilm
from rubgen.reduction import reduce
from rubgen.reduction.reduced import rigid_shifts
from rubgen.scenario import Reduction
from rubgen.solver.linear.rub_free import rub_free_motion
from rubgen.solver.linear.stability import stable_step

FILM = SqueezeFilm(radius_m=0.08, length_m=0.03, clearance_m=2e-3, viscosity_pa_s=0.02)


@pytest.fixture(scope="module")
def model(preset):
    support = replace(
        preset.disk_support,
        lateral_stiffness_anisotropy=0.2,
        lateral_damping_anisotropy=-0.5,
        squeeze_film=FILM,
    )
    return reduce(replace(preset, disk_support=support, gravity_m_per_s2=9.81), Reduction())


def test_the_system_has_what_the_machine_asks_for(preset, model):
    system = model.at_speed(700.0)
    forces = system.turning
    assert forces.stiffness == pytest.approx(0.2 * 1e8)
    assert forces.damping == pytest.approx(-0.5 * system.lateral_damping)
    assert forces.laws == (FILM,)
    assert system.lateral_stiffness == 1e8
    plain = reduce(preset, Reduction()).at_speed(700.0)
    assert plain.turning is None
    for name in ("M", "C", "K", "force"):
        np.testing.assert_array_equal(getattr(system, name), getattr(plain, name))


def test_the_weight_is_that_of_the_whole_blisk_and_strains_nothing(model):
    """The reduced basis holds lateral shifts exactly: they carry the whole mass and no elastic force."""
    blisk, weight = model.blisk, model.at_speed(700.0).turning.weight
    shifts = rigid_shifts(36, len(blisk.M))
    total = shifts.T @ weight[: len(blisk.M)]
    # Rounding against the penalty of the couplings.
    np.testing.assert_allclose(total, 9.81 * blisk.rigid_inertia[0] * np.eye(2), atol=1e-7 * total.max())
    assert np.abs(blisk.K @ shifts).max() < 1e-8 * np.abs(blisk.K).max()
    assert not weight[len(blisk.M) :].any()


def test_keys_of_vary_set_anisotropy_and_gravity():
    machine = make_scenario(support_anisotropy=-0.3, gravity_m_per_s2=9.81).machine
    assert machine.disk_support.lateral_stiffness_anisotropy == -0.3
    assert machine.gravity_m_per_s2 == 9.81


def test_the_preset_sags_by_its_weight_over_the_stiffness_along_y(model):
    system = replace(model.at_speed(700.0), force=np.zeros(125))
    forces = replace(system.turning, laws=(), damping=0.0)
    motion = rub_free_motion(replace(system, turning=forces))
    u = motion.at(0.0)[system.centre : system.centre + 2]
    sag = 9.81 * model.blisk.rigid_inertia[0] / (1e8 * (1 - 0.2))
    # Blades bend under their weight once per turn: an alternating load, which they follow with some lag.
    np.testing.assert_allclose(u, [0.0, -sag], atol=1e-3 * sag)


def test_uneven_supports_hardly_change_the_stable_step(preset, model):
    plain = stable_step(reduce(preset, Reduction()).at_speed(700.0))
    assert stable_step(model.at_speed(700.0)) == pytest.approx(plain, rel=1e-3)
