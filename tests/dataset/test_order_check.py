"""Orders of a channel that ends before the label's window does: no false alarm for any motion, wrong ones found."""

import numpy as np
import pytest

from rubgen.dataset.order_check import ORDER_TOLERANCE, order_amplitudes, order_problems

RATE, SPEED_RPM, TURNS, LATE = 25600.0, 6222.958874423057, 110, 26


def blows(rng):
    """Blows of any strength, some in each turn, over the record's samples (n,)."""
    samples = round(TURNS * RATE * 60 / SPEED_RPM)
    force = np.zeros(samples)
    force[rng.integers(0, samples, 4 * TURNS)] = rng.exponential(200.0, 4 * TURNS) ** 1.5
    return force


def row_of(force):
    label = order_amplitudes(force[-round(100 * RATE * 60 / SPEED_RPM) :], SPEED_RPM / 60 / RATE)
    return {
        "record_turns": TURNS,
        "speed_rpm": SPEED_RPM,
        "sample_rate_hz": RATE,
        "signal_start_s": 0.0,
        "contact_force_orders": label.tolist(),
    }


def problems(row, force):
    return list(order_problems(row, "contact_force", force.astype(np.float32), 5.0, 3.05))


def test_blows_at_the_unseen_end_are_no_contradiction():
    rng, beyond = np.random.default_rng(5), 0
    for _ in range(40):
        force = blows(rng)
        row, seen = row_of(force), force[:-LATE]
        labels = np.array(row["contact_force_orders"])
        amplitudes = order_amplitudes(seen[-round(100 * RATE * 60 / SPEED_RPM) :], SPEED_RPM / 60 / RATE)
        beyond += np.abs(amplitudes - labels).max() > 0.1 * labels.max()
        assert problems(row, seen) == []
    assert beyond > 0  # by more than was allowed before


@pytest.mark.parametrize("factor", [0.97, 1.03])
def test_a_wrong_scale_of_a_motion_that_repeats_is_found(factor):
    turns = np.arange(round(TURNS * RATE * 60 / SPEED_RPM)) * SPEED_RPM / 60 / RATE
    force = 300 + 400 * np.cos(2 * np.pi * turns) + 100 * np.cos(2 * np.pi * 3 * turns + 1)
    row = row_of(force)
    assert problems(row, force[:-LATE]) == []
    assert factor not in (1 - ORDER_TOLERANCE, 1 + ORDER_TOLERANCE)
    found = problems(row, factor * force[:-LATE])
    assert len(found) == 1
    assert found[0].startswith("contact_force_orders: order 1 is 400, the channel gives")
