"""Orders of a channel that ends before the label's window does: no false alarm for any motion, wrong ones found."""

import numpy as np
import pytest

from rubgen.dataset.checking.channel_check import ORDER_TOLERANCE, order_amplitudes, order_problems
from rubgen.dataset.checking.consistency import signal_problems
from rubgen.measurement.shaft import arrival_times, pulse_channel
from rubgen.scenario import Sensing
from rubgen.sensors.kinds.once_per_rev import OncePerRev
from rubgen.sensors.kinds.torque import Torque
from rubgen.sensors.sensor_set import SensorSet

RATE, SPEED_RPM, TURNS, LATE = 25600.0, 6222.958874423057, 110, 26


def blows(rng):
    """Blows of any strength, some in each turn, over the record's samples (n,)."""
    samples = round(TURNS * RATE * 60 / SPEED_RPM)
    force = np.zeros(samples)
    force[rng.integers(0, samples, 4 * TURNS)] = rng.exponential(200.0, 4 * TURNS) ** 1.5
    return force


def row_of(force):
    """Labels of the force as it is, before any filter."""
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


@pytest.mark.parametrize(("rate", "unseen", "seen"), [(2000.0, 8, 7), (600.0, 3, 2)])
def test_orders_beyond_the_pass_band_are_not_compared(rate, unseen, seen):
    """2,000 Hz pass 781 Hz: 7 orders of 6,223 rev/min; 600 Hz pass 2."""
    turns = np.arange(round(TURNS * rate * 60 / SPEED_RPM)) * SPEED_RPM / 60 / rate
    channel = 300 + 400 * np.cos(2 * np.pi * turns)
    row = row_of(channel) | {"sample_rate_hz": rate}
    amplitudes = order_amplitudes(channel[-round(100 * rate * 60 / SPEED_RPM) :], SPEED_RPM / 60 / rate)
    for order, found in ((unseen, 0), (seen, 1)):
        orders = amplitudes.copy()
        orders[order - 1] = 200.0
        told = problems(row | {"contact_force_orders": orders.tolist()}, channel)
        assert len(told) == found
        assert all(text.startswith(f"contact_force_orders: order {order} is 200, ") for text in told)


@pytest.mark.parametrize(("rate", "lost", "found"), [(1000.0, 30, 0), (12_500.0, 0, 0), (12_500.0, 30, 1)])
def test_pulses_are_counted_where_the_rate_shows_each(rate, lost, found):
    """A notch of 30 degrees shows at 12 samples a turn; at 1,000 Hz and 6,223 rev/min there are 9.6."""
    sensing = Sensing(
        set=SensorSet(name="s", sensors=(OncePerRev(name="pulse"), Torque(name="torque", unit="kN m"))),
        sample_rate_hz=rate,
    )
    speed = 2 * np.pi * SPEED_RPM / 60
    times, angles = arrival_times(1.0, speed, 2.0), 1.0 + speed * np.arange(round(2 * rate)) / rate
    pulses = pulse_channel(angles).values
    pulses[: round(lost * 60 / SPEED_RPM * rate)] = 0
    row = {"speed_rpm": SPEED_RPM, "sample_rate_hz": rate, "once_per_rev_s": times, "change_times_s": []}
    told = list(signal_problems(row, {"pulse": pulses, "torque": np.zeros_like(pulses)}, sensing))
    assert len(told) == found
    assert all(text.startswith("pulse has ") for text in told)
