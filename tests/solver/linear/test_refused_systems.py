"""Bad input: one line that says what is wrong, before anything is integrated."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from rubgen.errors import UserError
from rubgen.scenario import ContactLaw
from rubgen.solver import Status
from rubgen.solver.integrate import integrate
from rubgen.solver.linear.stability import stable_step
from rubgen.solver.speed.start import rub_free_stepper


def changed(system, name, number, value):
    matrix = getattr(system, name).copy()
    matrix[number, number] = value
    return replace(system, **{name: matrix})


def grown(system, growth):
    return replace(system, tip_static=np.tile([growth, 0.0, 0.0], (system.n_blades, 1)))


CASES = {
    "no blades": (lambda s: replace(s, n_blades=0), "n_blades = 0: contact needs at least one blade; add"),
    "standstill": (lambda s: replace(s, speed=0.0), "speed = 0 rad/s: must be above 0; change"),
    "not a number": (lambda s: changed(s, "K", 4, np.nan), "K: holds a value that is not a finite number; correct"),
    "negative mass": (lambda s: changed(s, "M", 4, -0.05), "M of the blisk is negative, smallest eigenvalue -0.05: "),
    "singular mass": (lambda s: changed(s, "M", 4, 0.0), "M of the blisk is singular, smallest eigenvalue 0: every"),
    "casing without mass": (lambda s: changed(s, "M", -1, 0.0), "M of the casing is singular"),
    "blades longer than the casing is wide": (
        lambda s: replace(s, tip_radius=s.tip_radius + 3e-4),
        "clearance = -0.0002 m: blade tips of radius 0.2003 m pass the casing at rest, whose narrowest radius is",
    ),
    "blades that grow beyond the casing": (
        lambda s: grown(s, 2.2e-3),
        "blade tips grow by 0.0022 m and pass the casing everywhere, its widest gap at rest is 0.0021 m; lower the",
    ),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES.keys())
def test_a_system_that_makes_no_run_is_refused_in_one_line(case, small_system, operation):
    spoil, message = case
    system = small_system()
    with pytest.raises(UserError) as caught:
        integrate(spoil(system), operation(system), ContactLaw())
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_blades_that_grow_into_the_narrow_places_alone_make_a_run(small_system, operation):
    system = grown(small_system(), 3e-4)
    response = integrate(system, operation(system, record_turns=5, settle_turns=60), ContactLaw())
    assert response.status is Status.OK
    assert response.impulse_per_turn.all()


def test_a_speed_that_needs_millions_of_steps_a_turn_is_refused(small_system, operation):
    system = replace(small_system(), speed=1e-3)
    with pytest.raises(UserError, match=r"speed_rpm = 0.0095493: a stable step of .* s needs more than 4194304 steps"):
        integrate(system, operation(system), ContactLaw())


def test_a_step_above_the_stability_limit_is_refused_with_the_number_that_will_do(small_system):
    system = small_system()
    enough = int(2 * np.pi / system.speed / stable_step(system)) + 1
    with pytest.raises(UserError, match=rf"steps = {enough - 1}: .* take at least {enough} steps a turn"):
        rub_free_stepper(system, ContactLaw(), enough - 1)
    rub_free_stepper(system, ContactLaw(), enough)


def test_an_undamped_machine_at_its_critical_speed_is_refused(small_system, operation):
    def lateral_stiffness(speed):
        system = small_system(speed=speed, lateral_damping=0.0)
        blisk = slice(0, system.casing_start)
        return np.linalg.eigvalsh(system.K[blisk, blisk])[0]

    critical = brentq(lateral_stiffness, 500.0, 1200.0, xtol=1e-12)
    assert abs(lateral_stiffness(critical)) < 1e-6 * abs(lateral_stiffness(0.9 * critical))
    system = small_system(speed=critical, lateral_damping=0.0, clearance=5e-3)
    response = integrate(system, operation(system), ContactLaw())
    assert response.status is Status.UNSTABLE
    assert "largest real part of the eigenvalues" in response.reason
    assert "never dies, at a critical speed it grows without limit: add damping" in response.reason
    damped = small_system(speed=critical, clearance=5e-3)
    assert integrate(damped, operation(damped, record_turns=2, settle_turns=2), ContactLaw()).status is Status.OK


def test_an_undamped_casing_never_forgets(small_system, operation):
    system = small_system(casing_damping=0.0)
    response = integrate(system, operation(system), ContactLaw())
    assert response.status is Status.UNSTABLE
    assert "add damping" in response.reason
