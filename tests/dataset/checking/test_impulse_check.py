"""The impulse of a force channel over whole turns: what its noise, steps and samples resolve, and not less."""

import numpy as np
import pytest
from scipy.stats import norm

from rubgen.dataset.checking.channel_check import (
    _adc_bias,
    impulse_problems,
    resolved_impulse,
    samples_per_turn,
    whole_turn_weights,
    windows_fit,
)
from rubgen.dataset.checking.consistency import label_problems, signal_problems
from rubgen.dataset.reading.recorded import row_signals
from rubgen.scenario import Sensing
from tests.whole_table import whole_table

RATE = 25600.0
NOISE, STEP = 5.0, 2e5 / 2**16


def row_of(speed_rpm, impulse=0.5, record_turns=100, start=0.0):
    windows = -(-record_turns // 16)
    return {
        "sample_rate_hz": RATE,
        "speed_rpm": speed_rpm,
        "steps_per_turn": 2048,
        "record_turns": record_turns,
        "signal_start_s": start,
        "contact_impulse_per_turn_n_s": impulse,
        "window_starts_s": [16 * window * 60 / speed_rpm for window in range(windows)],
        "window_impulse_per_turn_n_s": [impulse] * windows,
    }


def blows(row, seconds, phase):
    """Four blows of a sample and a half each turn, of the row's impulse together; no noise."""
    time = np.arange(round(seconds * RATE)) / RATE
    turn = 60 / row["speed_rpm"]
    from_blow = np.mod(time / turn * 4 + phase, 1.0) * turn / 4 * RATE  # samples
    from_blow -= turn / 8 * RATE
    shape = np.exp(-0.5 * (from_blow / 1.5) ** 2)
    return shape * row["contact_impulse_per_turn_n_s"] / 4 * RATE / (1.5 * np.sqrt(2 * np.pi))


def measured(signal, rng, noise=NOISE, step=STEP):
    return (np.rint((signal + rng.normal(0, noise, signal.size)) / step) * step).astype(np.float32)


@pytest.mark.parametrize("seconds", [0.05, 0.1, 0.3, 2.0])
@pytest.mark.parametrize("speed_rpm", [1500.0, 3777.7, 9111.1, 12000.0])
def test_no_good_channel_is_called_wrong_and_two_percent_are_found(speed_rpm, seconds):
    rng, row = np.random.default_rng(1), row_of(speed_rpm, record_turns=500)
    weights = whole_turn_weights(round(seconds * RATE), samples_per_turn(row))
    if weights is None:
        assert seconds * speed_rpm / 60 < 2
        assert list(impulse_problems(row, np.zeros(round(seconds * RATE), np.float32), NOISE, STEP)) == []
        return
    wrong = row_of(speed_rpm, impulse=0.51, record_turns=500)
    for phase in rng.uniform(size=25):
        force = measured(blows(row, seconds, phase), rng)
        assert list(impulse_problems(row, force, NOISE, STEP)) == []
        if resolved_impulse(row, weights, NOISE, STEP) < 0.005:
            assert "contact_impulse_per_turn_n_s is 0.51, the channel gives" in next(
                impulse_problems(wrong, force, NOISE, STEP)
            )


def test_images_that_the_anti_alias_filter_lets_pass_are_no_contradiction():
    """Blows have images of twice their mean at each multiple of the sample rate; the filter leaves 85 dB less."""
    seconds, row = 4.0, row_of(6000.0, record_turns=400)
    images = row["steps_per_turn"] / samples_per_turn(row)
    mean = row["contact_impulse_per_turn_n_s"] * row["speed_rpm"] / 60
    force = np.full(round(seconds * RATE), mean * (1 + images * 2 * 10 ** (-85 / 20)))
    assert list(impulse_problems(row, force, 0.0, 1e-12)) == []
    assert list(impulse_problems(row, 1.01 * force, 0.0, 1e-12)) != []


def test_a_plain_mean_over_all_samples_would_be_wrong_by_more():
    row = row_of(9111.1)
    weights = whole_turn_weights(1280, samples_per_turn(row))
    off = [[abs(w @ blows(row, 0.05, p) * 60 / 9111.1 - 0.5) for w in (weights, np.full(1280, 1 / 1280))] for p in
           np.linspace(0, 1, 50)]  # fmt: skip
    ours, plain = np.max(off, axis=0)
    assert ours < 4 / (np.pi**2 * samples_per_turn(row) * 6) * 0.5
    assert plain > 20 * ours


def test_weights_scatter_as_stated():
    rng, weights = np.random.default_rng(2), whole_turn_weights(2560, 151.7)
    means = [weights @ measured(np.full(2560, 37.0), rng) for _ in range(2000)]
    assert np.std(means) == pytest.approx(np.sqrt((NOISE**2 + STEP**2 / 12) * weights @ weights), rel=0.06)


@pytest.mark.parametrize("share", [0.0, 0.1, 0.3, 0.5])
def test_the_bias_of_steps_is_bounded(share):
    edges = np.arange(-20, 20) + 0.5
    worst = 0.0
    for x in np.linspace(0, 0.5, 101, endpoint=False):
        mean = edges[0] - 0.5 + norm.sf(edges, x, max(share, 1e-12)).sum()
        worst = max(worst, abs(mean - x))
    assert worst <= _adc_bias(share * STEP, STEP) / STEP <= 2 * worst


def test_a_transient_at_the_beginning_is_no_contradiction():
    row = row_of(9000.0, record_turns=160, start=96 * 60 / 9000)
    row["window_impulse_per_turn_n_s"] = [2.0, *[0.5] * 9]
    row["contact_impulse_per_turn_n_s"] = 0.65
    rng = np.random.default_rng(3)
    force = measured(blows(row_of(9000.0), 0.3, 0.3), rng)
    assert list(impulse_problems(row, force, NOISE, STEP)) == []
    assert list(impulse_problems(row, (1.02 * force).astype(np.float32), NOISE, STEP)) != []


def test_turns_that_scatter_are_no_contradiction():
    rng = np.random.default_rng(4)
    row = row_of(9000.0, record_turns=480)
    turns = 0.5 * (1 + 0.05 * rng.standard_normal(480))
    row["window_impulse_per_turn_n_s"] = turns.reshape(30, 16).mean(axis=1).tolist()
    row["contact_impulse_per_turn_n_s"] = float(turns.mean())
    steady = blows(row_of(9000.0), 480 * 60 / 9000, 0.01)
    force = steady * np.repeat(turns / 0.5, np.diff(np.round(np.arange(481) * samples_per_turn(row)).astype(int)))
    for first in range(0, 400, 40):
        start = round(first * samples_per_turn(row))
        part = {**row, "signal_start_s": start / RATE}
        assert list(impulse_problems(part, measured(force[start : start + 1280], rng), NOISE, STEP)) == []


@pytest.fixture(scope="module")
def rub_row(small_set):
    table = whole_table(small_set.directory)
    rows = [(row, row_signals(table, i)) for i, row in enumerate(table.to_pylist())]
    row, signals = next((row, signals) for row, signals in rows if row["rub"])
    return row | {"motion": "period-1", "motion_blisk": "period-1", "motion_casing": "period-1"}, signals


@pytest.mark.parametrize("off", [0.98, 1.02])
def test_a_label_that_is_two_percent_off_is_found_in_a_run(off, rub_row):
    row, signals = rub_row
    wrong = row | {"contact_impulse_per_turn_n_s": off * row["contact_impulse_per_turn_n_s"]}
    assert windows_fit(row)
    assert "contact_impulse_per_turn_n_s and its windows" in list(label_problems(wrong))
    lists = ("blade_impulses_per_turn_n_s", "window_impulse_per_turn_n_s")
    together = wrong | {name: [off * value for value in row[name]] for name in lists}
    assert not any("impulse" in problem for problem in label_problems(together))
    assert list(signal_problems(row, signals, Sensing())) == []
    found = list(signal_problems(together, signals, Sensing()))
    assert [text for text in found if text.startswith("contact_impulse_per_turn_n_s is ")] == found != []


def test_windows_of_another_number_do_not_fit(rub_row):
    row, _ = rub_row
    assert not windows_fit(row | {"window_impulse_per_turn_n_s": row["window_impulse_per_turn_n_s"][1:]})
