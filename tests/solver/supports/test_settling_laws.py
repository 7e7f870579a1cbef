"""Laws whose motion is not known before a run: it starts without them, settles longer, and is classified by itself."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rubgen.contact.geometry import casing_surface
from rubgen.labels.label import label
from rubgen.labels.labels import Motion
from rubgen.labels.motion.classify import motion
from rubgen.machine.support_laws.loose_spring import LooseSpring
from rubgen.machine.support_laws.whirling_film import WhirlingFilm
from rubgen.scenario import ContactLaw
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.rub_free import never_touches, rub_free_motion
from rubgen.solver.linear.stability import automatic_settle_turns, eigenvalues, slowest_decay, stable_step
from rubgen.solver.wants import Wants

OPEN = {"clearance": 5e-3}


@pytest.mark.parametrize(
    ("case", "shortcut"), [("gravity", True), ("crack", True), ("film", False), ("loose", False), ("whirl", False)]
)
def test_only_a_known_motion_may_be_repeated(small_system, turning, case, shortcut):
    system = turning(small_system(**OPEN), case)
    assert never_touches(system, casing_surface(system, ContactLaw()), -4e-3) is shortcut


@pytest.mark.parametrize("case", ["loose", "whirl"])
def test_a_run_starts_in_the_motion_without_the_law_and_settles_longer(small_system, turning, case):
    system = turning(small_system(**OPEN), case, gravity=9.81)
    without = turning(small_system(**OPEN), "gravity")
    np.testing.assert_array_equal(rub_free_motion(system).harmonics, rub_free_motion(without).harmonics)
    np.testing.assert_array_equal(eigenvalues(system), eigenvalues(without))
    decay = slowest_decay(without)
    assert automatic_settle_turns(system, 5, decay) == 5 + 3 * (automatic_settle_turns(without, 5, decay) - 5)


def test_the_stable_step_regards_how_much_a_law_stiffens(small_system, turning):
    system = small_system()
    law = WhirlingFilm(swirl_n_per_m=4e8, soft_n_per_m=4e8, scale_m=2e-4)
    stiffer = turning(system, "springs", stiffness=law.stiffening_n_per_m)
    assert stable_step(turning(system, "whirl", laws=(law,))) == stable_step(stiffer) < stable_step(system)


def test_a_crack_is_linear_so_a_run_keeps_its_motion(small_system, turning, operation):
    system = turning(small_system(**OPEN), "crack")
    run = integrate(system, operation(system, record_turns=40), ContactLaw(), Wants(repeats_free_turn=True))
    assert math.isfinite(run.free_penetration)
    assert motion(run).system.motion is Motion.PERIOD_1
    centre = slice(system.centre, system.centre + 2)
    expected = rub_free_motion(system, run.steps_per_turn).at(0.0)[centre]
    np.testing.assert_allclose(run.section_q[:, centre], np.tile(expected, (40, 1)), rtol=1e-9)


def test_a_crack_alone_bends_the_circle(small_system, turning):
    """Order 2 of the inertial frame is order 1 forward of the turning one, where nothing else of this machine acts."""
    system = turning(small_system(**OPEN), "crack")
    sag = rub_free_motion(turning(small_system(**OPEN), "gravity"))
    assert not np.any(np.abs(forward(sag)) > 1e-15)
    assert np.abs(forward(rub_free_motion(system))) > 1e-8


def forward(motion):
    """Circle of order 2, m."""
    return complex(motion.harmonics[1, 18:20] @ [1, 1j]) / 2


def test_a_whirl_without_contact_is_quasi_periodic(small_system, turning, operation):
    """Two frequencies that are not in a whole ratio, and a casing at rest."""
    law = WhirlingFilm(swirl_n_per_m=3e6, soft_n_per_m=5e6, scale_m=2e-4)
    system = turning(small_system(**OPEN, unbalance=1e-3), "whirl", laws=(law,))
    run = integrate(system, operation(system, record_turns=200), ContactLaw(), Wants(companion=True))
    assert run.contact_steps_per_turn.sum() == 0
    assert run.free_penetration == math.inf
    labels = label(run)
    assert (labels.rub, labels.motion_blisk, labels.motion_casing) == (False, Motion.QUASI_PERIODIC, Motion.STATIC)


def test_a_loose_support_without_contact_repeats_after_two_turns(small_system, turning, operation):
    system = turning(
        small_system(speed=1300.0, lateral_damping=0.05, unbalance=1e-4, **OPEN),
        "loose",
        laws=(LooseSpring(lost_n_per_m=4.8e6, gap_m=0.0, direction_rad=1.1),),
    )
    run = integrate(system, operation(system, record_turns=100), ContactLaw())
    assert run.contact_steps_per_turn.sum() == 0
    found = motion(run)
    assert (found.blisk.motion, found.blisk.period) == (Motion.PERIOD_K, 2)
    assert found.system.period == 2
    known = replace(run, free_penetration=-1e-3)
    assert motion(known).system.motion is Motion.PERIOD_1  # what was said of every run without contact
