from collections.abc import Callable

import numpy as np
import pytest

from rubgen.labels.harmonics import SECOND_ORDER_FLOOR, harmonics
from rubgen.solver.response import Response

Respond = Callable[..., Response]


def wave(orders: dict[float, float], turns: int = 100, steps: int = 256) -> np.ndarray:
    """Sum of amplitude * cos(order theta + order), theta = 0 at the last step."""
    theta = 2 * np.pi * np.arange(1 - turns * steps, 1) / steps
    return sum((a * np.cos(k * theta + k) for k, a in orders.items()), np.zeros(theta.size))


def test_peak_amplitudes_shares_and_dominant_order(respond: Respond) -> None:
    given = {1.0: 4.0, 2.0: 3.0, 5.0: 2.0, 10.0: 1.0}
    found = harmonics(respond(taps={"support_force_x": wave(given) + 7.0}))
    expected = np.array([given.get(float(k), 0.0) for k in range(1, 11)])
    assert found.amplitudes["support_force_x"] == pytest.approx(expected, abs=1e-9)
    assert found.even_share["support_force_x"] == pytest.approx((9 + 1) / 30)
    assert found.odd_share["support_force_x"] == pytest.approx((16 + 4) / 30)
    assert found.dominant_order["support_force_x"] == 1


def test_a_signal_between_orders_is_none_of_them(respond: Respond) -> None:
    found = harmonics(respond(taps={"blisk_x": wave({2.37: 1.0, 3.0: 0.01})}))
    assert found.amplitudes["blisk_x"] == pytest.approx(0.01 * np.eye(10)[2], abs=1e-9)


def test_impulses_twice_a_turn_have_even_orders_of_twice_their_mean(respond: Respond) -> None:
    force = np.zeros(100 * 256)
    force[10::128] = 256.0  # two single steps a turn
    found = harmonics(respond(taps={"contact_force": force}))
    assert found.amplitudes["contact_force"] == pytest.approx(2 * force.mean() * np.array([0, 1] * 5), abs=1e-9)
    assert found.even_share["contact_force"] == pytest.approx(1.0)


def test_no_signal_has_no_shares_and_no_dominant_order(respond: Respond) -> None:
    found = harmonics(respond(taps={"contact_force": np.zeros(25600)}, contact=False))
    assert np.isnan(found.even_share["contact_force"])
    assert np.isnan(found.odd_share["contact_force"])
    assert found.dominant_order["contact_force"] == 0


def noise(rms: float) -> np.ndarray:
    return rms * np.random.default_rng(0).standard_normal(25600)


@pytest.mark.parametrize(
    ("acceleration", "expected"),
    [
        (wave({2.0: 10.0}), True),
        (wave({2.0: 10.0}) + noise(20.0), True),  # a line of noise has about 20 * sqrt(pi / n) = 0.2
        (wave({2.0: 1.0}) + noise(20.0), False),  # 14 dB above it
        (wave({1.0: 10.0, 3.0: 10.0}), False),
        (wave({2.0: 0.9 * SECOND_ORDER_FLOOR}), False),
        (wave({2.0: 1.1 * SECOND_ORDER_FLOOR}), True),
        (wave({2.2: 10.0, 2.03: 5.0}), False),
    ],
)
def test_has_2fr_needs_a_line_above_its_neighbourhood_and_the_floor(
    respond: Respond, acceleration: np.ndarray, expected: bool
) -> None:
    assert harmonics(respond(taps={"casing_acc_0": acceleration})).has_2fr is expected


def test_lines_within_a_twentieth_of_order_2_are_left_out_of_the_neighbourhood(respond: Respond) -> None:
    sidebands = {2 + 0.01 * k: 5.0 for k in [-5, -4, -3, -2, -1, 1, 2, 3, 4, 5]}
    assert harmonics(respond(taps={"casing_acc_0": wave({2.0: 10.0} | sidebands)})).has_2fr


def test_only_the_last_100_turns_count(respond: Respond) -> None:
    late = wave({2.0: 3.0})
    early = np.concatenate([wave({1.0: 50.0}, turns=37)[:-99], late])
    long, short = (harmonics(respond(taps={"casing_acc_0": tap})) for tap in (early, late))
    assert np.array_equal(long.amplitudes["casing_acc_0"], short.amplitudes["casing_acc_0"])


def test_a_short_record_is_taken_whole_and_a_short_tail_refused(respond: Respond) -> None:
    found = harmonics(respond(turns=40, taps={"casing_acc_0": wave({2.0: 3.0}, turns=60)}))
    assert found.amplitudes["casing_acc_0"][1] == pytest.approx(3.0)
    with pytest.raises(ValueError, match="shorter"):
        harmonics(respond(taps={"casing_acc_0": wave({2.0: 3.0}, turns=99)}))
