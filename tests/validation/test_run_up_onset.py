import pytest

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import Reduction
from validation.onset import tip_growth
from validation.run_up import predicted_onset, reach, run_up_onset


@pytest.fixture(scope="module")
def model():
    return reduce(load_machine("zeng2019"), Reduction())


def test_at_no_rate_the_reach_is_that_of_the_steady_motion(model):
    assert reach(model, 700.0, 0.0) == pytest.approx(
        tip_growth(model.machine, 700.0 * 30 / 3.141592653589793), rel=1e-9
    )


def test_the_first_touch_comes_within_the_delay_that_the_rate_explains(model):
    found = run_up_onset(model, 2000.0)
    assert found.predicted > predicted_onset(model, 0.0) + 3
    assert found.predicted < found.measured < found.latest
