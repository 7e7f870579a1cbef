from collections.abc import Callable

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.labels import Motion
from rubgen.labels.motion.chaos import chaos_indicator
from rubgen.labels.motion.classify import motion
from rubgen.labels.motion.clusters import cluster_distances, cluster_period, late_distances, settles, stray
from rubgen.labels.motion.decision import Indicators, MotionClass, combined, decide
from rubgen.solver.response import Response

Respond = Callable[..., Response]
TURN = np.arange(500)
GOLDEN = (np.sqrt(5) - 1) / 2
CHAOTIC = MotionClass(motion=Motion.CHAOTIC, period=None)
QUASI = MotionClass(motion=Motion.QUASI_PERIODIC, period=None)
STATIC = MotionClass(motion=Motion.STATIC, period=None)


def period(k: int) -> MotionClass:
    return MotionClass(motion=Motion.PERIOD_1 if k == 1 else Motion.PERIOD_K, period=k)


def section(*columns: np.ndarray) -> np.ndarray:
    """Points (turns, 1, values), of the size of the part's motion."""
    return np.stack(columns, axis=1)[:, None, :]


def classify(points: np.ndarray) -> MotionClass:
    distances = late_distances(points)
    period = cluster_period(distances)
    seen = Indicators(period=period, stray=stray(distances, period), growth=chaos_indicator(points), exponent=None)
    return decide(seen)


def logistic(r: float, count: int = 500) -> np.ndarray:
    x, orbit = 0.3, []
    for _ in range(count + 1000):
        x = r * x * (1 - x)
        orbit.append(x)
    return np.array(orbit[1000:])


def henon() -> np.ndarray:
    x, y, orbit = 0.1, 0.1, []
    for _ in range(700):
        x, y = 1 - 1.4 * x * x + y, 0.3 * x
        orbit.append((x, y))
    return np.array(orbit[200:])


def test_chaotic_maps_are_chaotic() -> None:
    assert classify(section(logistic(4.0))) == CHAOTIC
    assert classify(section(*henon().T)) == CHAOTIC


@pytest.mark.parametrize("r", [3.575, 3.58, 3.59, 3.6])
def test_chaos_in_bands_that_are_visited_in_turn_is_chaotic(r: float) -> None:
    # Exponents 0.09, 0.11, 0.14, 0.18 a step; the periodic part hides them from a plain 0-1 test.
    assert classify(section(logistic(r))) == CHAOTIC


@pytest.mark.parametrize(("r", "k"), [(2.9, 1), (3.2, 2), (3.5, 4), (3.55, 8), (3.84, 3), (3.74, 5)])
def test_periodic_windows_of_the_logistic_map(r: float, k: int) -> None:
    assert classify(section(logistic(r))) == period(k)


@pytest.mark.parametrize("rotation", [GOLDEN, np.sqrt(2) - 1, 0.0123, 0.003, 0.334, 0.5003, 1 / 17, 1 / 16 + 1e-4])
def test_a_closed_curve_is_quasi_periodic(rotation: float) -> None:
    # 0.003 turns the point by 2 % of its radius only: neighbours coincide, the curve does not.
    phase = 2 * np.pi * rotation * TURN
    assert classify(section(np.cos(phase), np.sin(phase))) == QUASI


def test_two_frequencies_are_quasi_periodic() -> None:
    slow = 2 * np.pi * 0.031 * TURN
    points = section(np.cos(2 * np.pi * GOLDEN * TURN) + 0.3 * np.cos(slow), np.sin(2 * np.pi * GOLDEN * TURN))
    assert classify(points) == QUASI


@pytest.mark.parametrize("k", [1, 2, 3, 7, 16])
@pytest.mark.parametrize("noise", [0.0, 1e-9])
def test_points_that_come_back_are_periodic(k: int, noise: float) -> None:
    cycle = np.random.default_rng(k).standard_normal((k, 4))
    points = cycle[TURN % k] + noise * np.random.default_rng(0).standard_normal((500, 4))
    assert classify(points[:, None, :]) == period(k)


def test_period_1_with_rounding_noise_is_not_chaotic() -> None:
    noise = 1e-15 * np.random.default_rng(0).standard_normal((500, 3))
    assert classify((1.0 + noise)[:, None, :]) == period(1)


def test_what_is_left_of_a_transient_does_not_hide_the_fixed_point() -> None:
    decay = 1e-2 * np.exp(-np.log(100) * TURN / 150)  # settled to 1e-2, and another 1e-2 every 150 turns
    points = section(1 + decay * np.cos(2.1 * TURN), decay * np.sin(2.1 * TURN))
    assert classify(points) == period(1)


def test_an_unstable_orbit_that_is_being_left_is_not_periodic() -> None:
    growth = 9e-3 * np.exp((TURN - 499) / 40)
    points = section(1 + growth * np.cos(2 * np.pi * GOLDEN * TURN), growth * np.sin(2 * np.pi * GOLDEN * TURN))
    assert cluster_distances(points[250:], 1).max() < 0.01
    assert classify(points).motion is not Motion.PERIOD_1


def test_one_rare_excursion_is_not_period_1() -> None:
    points = np.ones((500, 1, 2))
    points[400] += 0.1
    assert classify(points).motion is not Motion.PERIOD_1


def narrow_band(noise: np.ndarray, decay: float) -> np.ndarray:
    """Displacement of a lightly damped oscillator that is kicked once a turn; its correlation lasts 1 / decay turns."""
    state, out = 0.0 + 0.0j, []
    for kick in noise:
        state = state * np.exp(-decay + 0.9j) + kick
        out.append(state.real)
    return np.array(out)


def test_chaos_that_shakes_a_lightly_damped_blade_makes_the_blisk_chaotic(respond: Respond) -> None:
    # By itself the blade looks regular: within the test's N / 10 = 50 turns it does not forget its phase.
    kicks = logistic(4.0, 1000) - 0.5
    tip = 1e-4 * narrow_band(kicks, 1 / 150)[500:]
    assert classify(section(tip / 1e-4)).motion is Motion.QUASI_PERIODIC
    blisk = np.zeros((500, 114))
    blisk[:, 3 * 5 + 1] = tip
    blisk[:, 108] = 1e-6 * kicks[500:]
    casing = np.ones((500, 11))
    assert motion(respond(blisk=blisk, casing=casing, casing_velocity=casing)).blisk == CHAOTIC
    shaken = 1 + 0.1 * kicks[500:, None] * np.ones(11)
    blisk[:, 108] = 0
    parts = motion(respond(blisk=blisk, casing=shaken, casing_velocity=shaken))
    assert (parts.blisk, parts.casing) == (CHAOTIC, CHAOTIC)


def test_chaos_that_died_out_in_the_first_half_does_not_count() -> None:
    phase = 2 * np.pi * GOLDEN * TURN
    transient = np.where(TURN < 200, 3.0, 0.0) * logistic(4.0)
    assert classify(section(np.cos(phase) + transient)) == QUASI
    assert classify(section(np.cos(phase) + 3.0 * logistic(4.0))) == CHAOTIC


def test_without_contact_the_casing_is_static_and_the_blisk_period_1(respond: Respond) -> None:
    parts = motion(respond(contact=False))
    assert (parts.blisk, parts.casing, parts.system) == (period(1), STATIC, period(1))


def test_casing_may_be_chaotic_while_the_blisk_is_period_1(respond: Respond) -> None:
    casing = 1e-4 * logistic(4.0)[:, None] * np.ones(11)
    parts = motion(respond(casing=casing, casing_velocity=1000 * casing))
    assert (parts.blisk, parts.casing, parts.system) == (period(1), CHAOTIC, CHAOTIC)


def test_an_offset_as_large_as_the_motion_does_not_hide_it(respond: Respond) -> None:
    wobble = 1e-4 * logistic(4.0)[:, None] * np.ones(11)
    parts = motion(respond(casing=1e-4 + wobble, casing_velocity=100 * wobble))
    assert parts.casing == CHAOTIC


@pytest.mark.parametrize(("size", "expected"), [(0.02, period(1)), (0.06, CHAOTIC)])
def test_what_is_40_db_below_the_motion_does_not_count(size: float, expected: MotionClass) -> None:
    # The logistic map at r = 4 has rms 1 / sqrt(8) about its mean, so 0.02 of it is -43 dB, 0.06 is -33 dB.
    assert classify(1 + size * section(logistic(4.0))) == expected


def test_casing_that_came_to_rest_is_static(respond: Respond) -> None:
    ringing = np.exp(-TURN / 8.0)[:, None] * np.ones(11)
    assert motion(respond(casing=1e-5 * ringing, casing_velocity=1e-2 * ringing)).casing == STATIC
    assert motion(respond(casing=np.full((500, 11), 1e-5), casing_velocity=np.ones((500, 11)))).casing == period(1)


@pytest.mark.parametrize(("size", "expected"), [(0.05, CHAOTIC), (0.002, period(1))])
def test_one_chattering_tip_counts_from_one_per_cent_of_the_orbit(
    respond: Respond, size: float, expected: MotionClass
) -> None:
    blisk = np.zeros((500, 114))
    blisk[:, 3 * 17] = size * 3e-4 * logistic(4.0)
    casing = np.ones((500, 11))
    assert motion(respond(blisk=blisk, casing=casing, casing_velocity=casing)).blisk == expected


def test_tips_chatter_only_where_disk_centre_and_casing_repeat(respond: Respond) -> None:
    tip, centre = np.zeros((500, 114)), np.zeros((500, 114))
    tip[:, 3 * 17] = 0.05 * 3e-4 * logistic(4.0)
    centre[:, 108] = 0.05 * 3e-4 * logistic(4.0)
    still, irregular = np.ones((500, 11)), 1 + logistic(4.0)[:, None] * np.ones(11)

    def chatter(blisk: np.ndarray, casing: np.ndarray) -> bool:
        return motion(respond(blisk=blisk, casing=casing, casing_velocity=casing)).tip_chatter

    assert chatter(tip, still)
    assert not chatter(tip, irregular)
    assert not chatter(tip + centre, still)
    assert not chatter(np.zeros((500, 114)), still)


def test_period_of_the_system_is_the_least_common_multiple(respond: Respond) -> None:
    blisk = np.zeros((500, 114))
    blisk[:, 108] = 1e-4 * np.array([0.0, 0.4, 0.1, 0.7, 0.9, 0.2])[TURN % 6]
    casing = np.array([1.0, 2.0, 4.0, 5.0])[TURN % 4][:, None] * np.ones(11)
    parts = motion(respond(blisk=blisk, casing=casing, casing_velocity=casing))
    assert (parts.blisk, parts.casing, parts.system) == (period(6), period(4), period(12))


def test_motion_is_the_less_regular_of_the_two() -> None:
    undecided = MotionClass(motion=Motion.UNDECIDED, period=None)
    order = [STATIC, period(1), period(3), QUASI, undecided, CHAOTIC]
    for i, first in enumerate(order[1:], start=1):
        for j, second in enumerate(order):
            assert combined(first, second).motion is order[max(i, j)].motion
    assert combined(period(3), STATIC).period == 3
    assert combined(period(3), QUASI).period is None


def test_fewer_than_32_turns_are_refused(respond: Respond) -> None:
    with pytest.raises(UserError, match=r"record_turns = 31: .*at least 32"):
        motion(respond(turns=31))
    assert motion(respond(turns=32, contact=False)).system == period(1)


@pytest.mark.parametrize(
    ("decay_turns", "start", "expected"),
    [(80, 1.0, True), (80, 0.05, False), (1e6, 1.0, False)],  # a transient, one below the scale, a torus
)
def test_a_motion_settles_while_its_transient_is_above_the_scale(decay_turns, start, expected) -> None:
    points = section(1 + start * np.exp(-TURN / decay_turns) * np.cos(2 * np.pi * GOLDEN * TURN), 0 * TURN)
    assert settles(late_distances(points)) is expected
    assert settles(late_distances(section(logistic(4.0)))) is False
    assert settles(late_distances(points[:32])) is False


def test_a_motion_that_settles_is_not_quasi_periodic() -> None:
    torus = {"period": None, "stray": 0.1, "growth": 0.0, "exponent": None}
    assert decide(Indicators(**torus)).motion is Motion.QUASI_PERIODIC
    assert decide(Indicators(**torus, settling=True)).motion is Motion.UNDECIDED
