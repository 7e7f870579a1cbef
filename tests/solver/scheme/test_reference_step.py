import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from rubgen import make_scenario
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.solver.speed.start import rub_free_stepper
from rubgen.units import rad_per_s
from validation.reference_step import ReferenceStepper, differentiation_matrix

pytestmark = pytest.mark.long


def compare_turns(system, friction, steps, turns, opening, settle=6, restitution=0.0):
    """Largest relative differences over one turn each, restarted from the reference, and touching steps."""
    stepper = rub_free_stepper(system, ContactLaw(friction=friction, restitution=restitution), steps)
    reference = ReferenceStepper(system, friction, steps, restitution=restitution)
    for turn in range(settle):
        stepper.run_turn(np.full(steps + 2, opening * (1 - turn / settle)))
    reference.before, reference.now = stepper.coordinates.before.copy(), stepper.coordinates.now.copy()
    start, worst, touched = system.casing_start, 0.0, 0
    for _ in range(turns):
        reference.set_state(reference.before, reference.now)
        stepper.set_coordinates(reference.before, reference.now)
        assert stepper.run_turn()[0] == 0
        blades = np.array([reference.step(s) for s in range(steps)])
        assert np.count_nonzero(blades) == stepper.result.summary[1]
        for part in (slice(0, start), slice(start, None)):
            size = np.abs(reference.now[part]).max()
            worst = max(worst, np.abs(stepper.coordinates.now[part] - reference.now[part]).max() / size)
        touched += np.count_nonzero(blades)
    return worst, touched


@pytest.mark.parametrize(
    ("lobes", "speed", "friction"), [(2, 400.0, 0.1), (2, 500.0, 0.0), (3, 400.0, 0.1), (3, 350.0, 0.3)]
)
def test_fifty_turns_restarted_from_plain_numpy(small_system, lobes, speed, friction):
    """Period-1 with two lobes, irregular with three."""
    with threadpool_limits(1):
        system = small_system(lobes=lobes, speed=speed)
        worst, touched = compare_turns(system, friction, 256, 50 if lobes == 3 else 10, 5e-4)
    assert touched > 1000
    assert worst < 1e-6


@pytest.mark.parametrize(
    ("rpm", "support", "friction"),
    [(10000.0, 2e8, 0.1), (6900.0, 1e8, 0.1), (6900.0, 1e8, 0.0), (8700.0, 1e8, 0.15)],
    ids=["period-1", "chaotic", "no friction", "much friction"],
)
def test_the_preset_agrees_with_plain_numpy(rpm, support, friction):
    """Five turns each; `make bench` holds 50 turns of the first two and of heavy rub to the same bound."""
    scenario = make_scenario("zeng2019", speed_rpm=rpm, disk_support_stiffness_n_per_m=support)
    system = reduce(scenario.machine, Reduction()).at_speed(rad_per_s(rpm))
    with threadpool_limits(1):
        worst, touched = compare_turns(system, friction, 1024, 5, 2e-4)
    assert touched > 50
    assert worst < 1e-6


@pytest.mark.parametrize("restitution", [0.3, 0.9])
def test_restitution_agrees_with_plain_numpy(small_system, restitution):
    worst, touched = compare_turns(small_system(speed=500.0), 0.1, 256, 10, 5e-4, restitution=restitution)
    assert touched > 200
    assert worst < 1e-6


@pytest.mark.parametrize("case", ["gravity", "springs", "dampers", "film", "loads", "all"])
def test_turning_forces_agree_with_plain_numpy(small_system, turning, case):
    """Matrices made anew and inverted in every step, against two equations beside those of a constant A."""
    system = turning(small_system(speed=500.0, uneven_blade=0.05 if case == "all" else 0.0), case)
    worst, touched = compare_turns(system, 0.1, 256, 5, 5e-4)
    assert touched > 200
    assert worst < 1e-6


def test_the_differentiation_matrix_is_exact_for_low_orders():
    t = 2 * np.pi * np.arange(24) / 24
    np.testing.assert_allclose(differentiation_matrix(24) @ np.cos(5 * t), -5 * np.sin(5 * t), atol=1e-12)
