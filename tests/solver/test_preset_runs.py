"""What the published machine does, from the real reduced model."""

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Operation, Reduction
from rubgen.solver import Status
from rubgen.solver.integrate import integrate


@pytest.fixture(scope="module")
def model():
    return reduce(load_machine("zeng2019"), Reduction())


def run(model, rpm, friction=0.0, settle_turns=60, record_turns=100):
    operation = Operation(speed_rpm=rpm, settle_turns=settle_turns, record_turns=record_turns)
    return integrate(model.at_speed(operation.speed_rad_per_s), operation, ContactLaw(friction=friction))


def test_no_contact_at_6660_and_the_casing_at_rest(model):
    response = run(model, 6660.0)
    assert response.status is Status.OK
    assert not response.impulse_per_turn.any()
    assert not response.section_q[:, -11:].any()
    np.testing.assert_allclose(response.section_q - response.section_q[0], 0, atol=1e-13)


def test_two_zones_at_6900_with_all_losses_negative(model):
    response = run(model, 6900.0, friction=0.1)
    assert response.status is Status.OK
    assert np.all(response.impulse_per_turn > 0)
    events = response.events
    at_minor_axis = np.abs(np.sin(events.angle)) < 0.35
    assert at_minor_axis.all()
    for side in (1, -1):
        assert events.impulse[side * np.cos(events.angle) > 0].sum() > 0.2 * events.impulse.sum()
    allowed = 1e-8 * response.energy.absolute_work
    assert events.normal_loss.max() <= allowed
    assert events.friction_loss.max() <= allowed
    assert response.energy.normal_loss < 0
    assert response.energy.residual <= 1e-8


def test_rubbing_has_begun_at_6780(model):
    response = run(model, 6780.0, settle_turns=80)
    assert response.status is Status.OK
    assert np.all(response.impulse_per_turn > 0)


def test_the_number_of_blas_threads_changes_no_bit(model):
    runs = []
    for threads in (1, 2):
        with threadpool_limits(threads):
            runs.append(run(model, 6900.0, friction=0.1, settle_turns=40, record_turns=10))
    np.testing.assert_array_equal(runs[0].section_q, runs[1].section_q)
    np.testing.assert_array_equal(runs[0].taps["contact_force"], runs[1].taps["contact_force"])
