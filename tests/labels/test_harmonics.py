from collections.abc import Callable

import numpy as np
import pytest
from scipy.fft import rfft

from rubgen.labels.harmonics import FLOOR, FRACTIONS, TapOrders, harmonics
from rubgen.solver.response import Response

Respond = Callable[..., Response]


def wave(orders: dict[float, float], turns: int = 100, steps: int = 256) -> np.ndarray:
    """Sum of amplitude * cos(order theta + order), theta = 0 at the last step."""
    theta = 2 * np.pi * np.arange(1 - turns * steps, 1) / steps
    return sum((a * np.cos(k * theta + k) for k, a in orders.items()), np.zeros(theta.size))


def test_peak_amplitudes_shares_and_dominant_order(respond: Respond) -> None:
    given = {1.0: 4.0, 2.0: 3.0, 5.0: 2.0, 10.0: 1.0}
    found = harmonics(respond(taps={"support_force_x": wave(given) + 7.0}))["support_force_x"]
    expected = np.array([given.get(float(k), 0.0) for k in range(1, 21)])
    assert found.amplitudes == pytest.approx(expected, abs=1e-9)
    assert found.even_share == pytest.approx((9 + 1) / 30)
    assert found.odd_share == pytest.approx((16 + 4) / 30)
    assert found.dominant == 1
    assert found.floors.max() < 1e-9


def test_phases_count_from_the_start_of_a_turn(respond: Respond) -> None:
    theta = 2 * np.pi * np.arange(100 * 256) / 256  # the first value at theta = 0
    tap = 2 * np.cos(theta + 0.4) + np.sin(3 * theta) + np.cos(7 * theta - 3.0)
    found = harmonics(respond(taps={"blisk_x": tap}))["blisk_x"]
    assert found.phases[[0, 2, 6]] == pytest.approx([0.4, -np.pi / 2, -3.0], abs=1e-9)


def test_fractions_of_the_turning_frequency(respond: Respond) -> None:
    given = {1.0: 9.0, 1 / 3: 0.5, 2 / 3: 0.25, 1.5: 2.0, 2.5: 0.125, 0.618: 3.0}
    found = harmonics(respond(taps={"blisk_x": wave(given)}))["blisk_x"]
    expected = [given.get(float(fraction), 0.0) for fraction in FRACTIONS]
    # 0.618 is none of them; folding eight times leaves at most an eighth of a strange line, next to it less.
    strange = 0.618 * 12 % 1
    assert abs(strange - 0.416) < 1e-9
    assert found.fractional == pytest.approx(expected, abs=0.2)
    clean = harmonics(respond(taps={"blisk_x": wave({k: a for k, a in given.items() if k != 0.618})}))["blisk_x"]
    assert clean.fractional == pytest.approx(expected, abs=1e-9)


def test_blade_passing_and_its_sidebands(respond: Respond) -> None:
    found = harmonics(respond(taps={"tip_clearance_0": wave({36.0: 2.0, 37.0: 0.5, 34.0: 0.25})}))["tip_clearance_0"]
    assert found.blade_passing == pytest.approx([0.25, 0.0, 2.0, 0.5, 0.0], abs=1e-9)


def test_orders_above_half_the_step_rate_are_unknown(respond: Respond) -> None:
    tap = wave({3.0: 2.0, 5.0: 0.5}, steps=32)
    found = harmonics(respond(taps={"blisk_x": tap}, steps=32))["blisk_x"]
    assert found.amplitudes[:16] == pytest.approx([0, 0, 2, 0, 0.5, *[0] * 11], abs=1e-9)
    assert np.isnan([*found.amplitudes[16:], *found.phases[16:], *found.blade_passing, found.even_share]).all()
    assert found.dominant == 3
    assert found.present == (3, 5)


def test_even_and_odd_parts_of_the_casing_field(respond: Respond) -> None:
    # An even field is alike at 0 and 180 degrees, an odd one opposite.
    even, odd = wave({2.0: 3.0}), wave({3.0: 5.0})
    found = harmonics(respond(taps={"casing_acc_0": even + odd, "casing_acc_180": even - odd}))
    assert found["casing_even"].amplitudes == pytest.approx(3.0 * np.eye(20)[1], abs=1e-9)
    assert found["casing_odd"].amplitudes == pytest.approx(5.0 * np.eye(20)[2], abs=1e-9)
    assert "casing_even" not in harmonics(respond())


def test_floors_are_the_noise_around_each_order(respond: Respond) -> None:
    found = harmonics(respond(taps={"blisk_x": wave({3.0: 50.0}) + noise(1.0)}))["blisk_x"]
    # A line of white noise is a Rayleigh variable of median 2 sqrt(ln 2 / n).
    assert found.floors == pytest.approx(2 * np.sqrt(np.log(2) / 25600), rel=0.25)


def test_a_signal_between_orders_is_none_of_them(respond: Respond) -> None:
    found = harmonics(respond(taps={"blisk_x": wave({2.37: 1.0, 3.0: 0.01})}))["blisk_x"]
    assert found.amplitudes == pytest.approx(0.01 * np.eye(20)[2], abs=1e-9)


def test_impulses_twice_a_turn_have_even_orders_of_twice_their_mean(respond: Respond) -> None:
    force = np.zeros(100 * 256)
    force[10::128] = 256.0  # two single steps a turn
    found = harmonics(respond(taps={"contact_force": force}))["contact_force"]
    assert found.amplitudes == pytest.approx(2 * force.mean() * np.array([0, 1] * 10), abs=1e-9)
    assert found.even_share == pytest.approx(1.0)


@pytest.mark.parametrize("size", [0.0, 1e-165])  # squares of the second are zero: a casing that rests, nearly
def test_no_signal_has_no_shares_and_no_dominant_order(respond: Respond, size: float) -> None:
    found = harmonics(respond(taps={"contact_force": size * wave({2.0: 1.0})}, contact=False))["contact_force"]
    assert np.isnan(found.even_share)
    assert np.isnan(found.odd_share)
    assert found.dominant == 0
    assert found.present == ()


def noise(rms: float) -> np.ndarray:
    return rms * np.random.default_rng(0).standard_normal(25600)


@pytest.mark.parametrize(
    ("acceleration", "expected"),
    [
        (wave({2.0: 10.0}), True),
        (wave({2.0: 10.0}) + noise(20.0), True),  # a line of noise has about 20 * sqrt(pi / n) = 0.2
        (wave({2.0: 1.0}) + noise(20.0), False),  # 14 dB above it
        (wave({1.0: 10.0, 3.0: 10.0}), False),
        (wave({2.0: 0.9 * FLOOR}), False),
        (wave({2.0: 1.1 * FLOOR}), True),
        (wave({2.2: 10.0, 2.03: 5.0}), False),
    ],
)
def test_has_2fr_needs_a_line_above_its_neighbourhood_and_the_floor(
    respond: Respond, acceleration: np.ndarray, expected: bool
) -> None:
    assert (2 in harmonics(respond(taps={"casing_acc_0": acceleration}))["casing_acc_0"].present) is expected


def test_lines_within_a_twentieth_of_order_2_are_left_out_of_the_neighbourhood(respond: Respond) -> None:
    """Of all 100 lines beside order 2 half are strong, so their median is; of the 90 that count, 40 are."""
    sidebands = {2 + 0.01 * k: 5.0 for side in (-1, 1) for k in range(side, 26 * side, side)}
    assert harmonics(respond(taps={"casing_acc_0": wave({2.0: 10.0} | sidebands)}))["casing_acc_0"].present == (2,)


def test_only_the_last_100_turns_count(respond: Respond) -> None:
    late = wave({2.0: 3.0})
    early = np.concatenate([wave({1.0: 50.0}, turns=37)[:-99], late])
    long, short = (harmonics(respond(taps={"casing_acc_0": tap})) for tap in (early, late))
    assert np.array_equal(long["casing_acc_0"].amplitudes, short["casing_acc_0"].amplitudes)


NAMES = [f"support_force_{name}" for name in "abcdefg"]
"""More taps than are transformed together."""


def plain(tap: np.ndarray, turns: int = 100, steps: int = 256) -> TapOrders:
    """Compute the orders of one tap by itself, from the DFT of its last turns."""
    lines = 2 / tap.size * rfft(tap)[: 39 * turns]
    folded = tap[-96 * steps :].reshape(8, -1).mean(axis=0)
    beside = [*range(-50, -5), *range(6, 51)]
    whole = lines[turns : 21 * turns : turns]
    return TapOrders(
        amplitudes=np.abs(whole),
        phases=np.angle(whole),
        floors=np.array([np.median(np.abs(lines[[turns * k + j for j in beside]])) for k in range(1, 21)]),
        fractional=2 / folded.size * np.abs(rfft(folded))[[int(12 * fraction) for fraction in FRACTIONS]],
        blade_passing=np.abs(lines[34 * turns : 39 * turns : turns]),
    )


def test_taps_that_are_transformed_together_have_the_bits_of_each_alone(respond: Respond) -> None:
    random = np.random.default_rng(1)
    taps = {name: random.standard_normal(25600) for name in NAMES}
    found = harmonics(respond(taps=taps))
    assert list(found)[-len(NAMES) :] == NAMES
    for name, tap in taps.items():
        for field in TapOrders.__dataclass_fields__:
            assert np.array_equal(getattr(found[name], field), getattr(plain(tap), field)), field


def test_taps_that_repeat_exactly_have_the_orders_of_one_turn(respond: Respond) -> None:
    tap = np.tile(np.random.default_rng(2).standard_normal(256), 100)
    nearly = tap.copy()
    nearly[-1] *= 1 + 1e-15
    both = harmonics(respond(taps={"blisk_x": tap, "blisk_y": nearly}))
    found, other = both["blisk_x"], plain(tap)
    assert found.amplitudes == pytest.approx(other.amplitudes, rel=1e-12)
    assert found.phases == pytest.approx(other.phases, abs=1e-11)
    assert found.blade_passing == pytest.approx(other.blade_passing, rel=1e-12)
    assert found.fractional == pytest.approx(other.fractional, abs=1e-14)
    assert not found.floors.any()
    assert other.floors.max() < 1e-14
    assert both["blisk_y"].floors.all()


def test_a_short_record_is_taken_whole_and_a_short_tail_refused(respond: Respond) -> None:
    found = harmonics(respond(turns=40, taps={"casing_acc_0": wave({2.0: 3.0}, turns=60)}))
    assert found["casing_acc_0"].amplitudes[1] == pytest.approx(3.0)
    with pytest.raises(ValueError, match="shorter"):
        harmonics(respond(taps={"casing_acc_0": wave({2.0: 3.0}, turns=99)}))
