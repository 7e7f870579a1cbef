"""Windows of a steady run: when they are, how much they rub, and by which amplitudes."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.labels.windows import windows


def test_windows_of_a_steady_run(respond):
    """100 turns of 256 steps: six windows of 16 turns, one of four; rub in turns 10 to 19 and in the last one."""
    turn = 1 / 150.0
    response = respond(turns=100)
    impulse, steps = np.zeros(100), np.zeros(100, dtype=np.int64)
    impulse[10:20], steps[10:20], impulse[99], steps[99] = 0.5, 64, 2.0, 128
    found = windows(replace(response, impulse_per_turn=impulse, contact_steps_per_turn=steps))
    np.testing.assert_allclose(found.start, 16 * turn * np.arange(7))
    np.testing.assert_allclose(found.speed, np.full(7, 300 * np.pi))
    np.testing.assert_allclose(found.impulse, [6 * 0.5 / 16, 4 * 0.5 / 16, 0, 0, 0, 0, 2.0 / 4])
    np.testing.assert_allclose(found.duty, [6 / 4 / 16, 4 / 4 / 16, 0, 0, 0, 0, 0.5 / 4])


def test_even_and_odd_part_are_half_the_sum_and_half_the_difference_of_both_sides(respond):
    """Of complex amplitudes: sides in quarter phase have parts of equal size."""
    amplitudes = np.zeros((7, 2, 20), dtype=np.complex128)
    amplitudes[:, 0, 0], amplitudes[:, 1, 0] = 3.0, 4.0j
    amplitudes[:, 0, 1], amplitudes[:, 1, 1] = 2.0, 2.0
    taps = {name: np.zeros(25600) for name in ("casing_acc_0", "casing_acc_180")}
    orders = windows(replace(respond(turns=100, taps=taps), window_orders=amplitudes)).orders
    assert orders["casing_acc_0"].shape == (7, 20)
    assert orders["casing_even"][3, :3] == pytest.approx([2.5, 2.0, 0.0])
    assert orders["casing_odd"][3, :3] == pytest.approx([2.5, 0.0, 0.0])
