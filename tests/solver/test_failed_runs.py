"""What is wrong with the machinery must come out as a status, with a reason, and never as data."""

import numpy as np
import pytest

from rubgen.arrays import frozen
from rubgen.scenario import ContactLaw
from rubgen.solver import Status
from rubgen.solver.integrate import Integration, integrate
from rubgen.solver.scheme.step_kernels import has_diverged
from rubgen.solver.speed.driver import SteadyDriver
from rubgen.solver.speed.start import closing_ramp, rub_free_stepper
from rubgen.solver.wants import Wants


@pytest.fixture
def integration(small_system, operation):
    system = small_system(speed=500.0)
    driver = SteadyDriver(rub_free_stepper(system, ContactLaw(friction=0.1), 256), 40)
    return Integration(driver, system, operation(system, record_turns=5), Wants())


def set_model(integration, **fields):
    """Give the run another model."""
    integration.stepper.model = frozen(integration.stepper.model._replace(**fields))


def test_a_wrong_mass_in_the_book_breaks_the_energy_identity(integration):
    energy = integration.stepper.model.energy
    set_model(integration, energy=energy._replace(M=energy.M._replace(entries=energy.M.entries * (1 + 1e-6))))
    integration.run()
    assert integration.status is Status.ENERGY
    assert "above 1e-08 after turn" in integration.reason


def test_a_damping_work_that_is_left_out_breaks_the_energy_identity(integration):
    energy = integration.stepper.model.energy
    nothing = frozen(energy.damping._replace(entries=np.zeros_like(energy.damping.entries)))
    set_model(integration, energy=energy._replace(damping=nothing))
    integration.run()
    assert integration.status is Status.ENERGY


def test_a_compliance_that_pulls_has_no_contact_force(integration):
    model = integration.stepper.model
    set_model(integration, tip_compliance=-model.tip_compliance, casing_compliance=-model.casing_compliance)
    integration.run()
    assert integration.status is Status.CONTACT_UNSOLVED
    assert "in turn" in integration.reason


def test_a_state_that_is_not_a_number_ends_the_run(integration):
    q = integration.stepper.coordinates.now.copy()
    q[-1] = np.nan
    integration.stepper.set_coordinates(q, q)
    integration.run()
    assert integration.status is Status.DIVERGED


@pytest.mark.parametrize(("share", "beyond"), [(0.0249, False), (-0.0249, False), (0.0251, True), (-0.0251, True)])
def test_a_fortieth_of_the_tip_radius_is_the_limit_of_tips_and_of_the_casings_nodes(small_system, share, beyond):
    system = small_system()
    stepper = rub_free_stepper(system, ContactLaw(), 256)
    start, size = system.casing_start, share * system.tip_radius

    def diverged(q):
        return has_diverged(stepper.model.surface, stepper.model.laws, q, start, system.n_blades)

    for direction in range(3):
        tip = np.zeros(start + system.n_casing)
        tip[3 * 4 + direction] = size
        assert diverged(tip) is beyond
    # Modes 0 and 1 shift the ring as a whole along X and Y: half of each is a node displacement of `size`, although
    # the sum of the modes' reaches is far more.
    ring = np.zeros(start + system.n_casing)
    ring[start : start + 2] = size / np.sqrt(2) / system.casing_modes[0, 0, 0]
    assert np.hypot(*(system.casing_modes[7] @ ring[start:])) == pytest.approx(abs(size))
    assert diverged(ring) is beyond


def test_coupling_of_blisk_and_casing_by_a_matrix_is_refused(small_system, operation):
    system = small_system()
    system.K[0, -1] = 1.0
    with pytest.raises(ValueError, match="contact alone"):
        integrate(system, operation(system), ContactLaw())


def test_the_margin_of_candidates_changes_no_result(small_system):
    ends = []
    for margin in (1e-5, 1e-12, 5e-4):
        stepper = rub_free_stepper(small_system(speed=500.0), ContactLaw(friction=0.1), 256)
        stepper.model = stepper.model._replace(laws=stepper.model.laws._replace(margin=margin))
        impulse = 0.0
        for turn in range(10):
            code = stepper.run_turn(5e-4 * closing_ramp((turn + np.arange(-1, 257) / 256) / 6))[0]
            assert code == 0
            impulse += stepper.result.summary[0]
        ends.append(np.append(stepper.coordinates.now / np.abs(stepper.coordinates.now).max(), impulse))
    assert ends[0][-1] > 1
    np.testing.assert_allclose(ends[1], ends[0], atol=1e-9)
    np.testing.assert_allclose(ends[2], ends[0], atol=1e-9)
