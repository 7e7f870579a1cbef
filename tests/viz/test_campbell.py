"""The Campbell diagram of a model whose frequencies are known."""

from types import SimpleNamespace

import numpy as np
import pytest

from rubgen.viz.figures.machine import campbell

CRITICAL = 6000.0
HERTZ = np.array([70.0, 180.0, 400.0])


@pytest.fixture(scope="module", params=[2, 3])
def figure(request):
    """Two blisk frequencies: one falls to zero at the critical speed and rises again; one rises with the speed."""
    model = SimpleNamespace(
        critical_speed_rpm=CRITICAL,
        blisk_frequencies_hz=lambda speed: np.array([abs(CRITICAL * np.pi / 30 - speed), 300.0 + 0.1 * speed]),
        casing_frequencies_hz=HERTZ,
        machine=SimpleNamespace(casing=SimpleNamespace(lobes=request.param)),
    )
    return campbell(model), request.param


def test_points_stand_where_an_order_of_the_lobes_meets_a_casing_mode(figure):
    drawn, lobes = figure
    points = next(line for line in drawn.axes[1].lines if line.get_marker() == "o").get_xydata()
    assert len(points) > 5
    orders = points[:, 1] / (points[:, 0] / 60)
    np.testing.assert_allclose(orders, lobes * np.round(orders / lobes), rtol=1e-12)
    assert orders.min() == pytest.approx(lobes)
    assert set(np.round(points[:, 1], 9)) == set(HERTZ)


def test_lines_are_the_frequencies_and_touch_zero_at_the_critical_speed(figure):
    drawn, _ = figure
    first = next(line for line in drawn.axes[0].lines if len(line.get_xdata()) > 100)
    speeds, hertz = first.get_xydata().T
    np.testing.assert_allclose(hertz, abs(CRITICAL - speeds) * np.pi / 30, atol=1e-9)
    assert hertz.min() == pytest.approx(0.0, abs=1e-9)
    marked = next(line for line in drawn.axes[0].lines if line.get_linestyle() == "--")
    assert list(marked.get_xdata()) == [CRITICAL, CRITICAL]
