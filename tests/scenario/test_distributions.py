import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError
from scipy import stats

from rubgen.scenario.distributions import Distribution

ADAPTER = TypeAdapter(Distribution)
GRID = (np.arange(4000) + 0.5) / 4000


def drawn(table):
    return np.array([ADAPTER.validate_python(table).quantile(u) for u in GRID])


def test_number_fixes():
    assert set(drawn(3)) == {3.0}


@pytest.mark.parametrize(
    ("table", "law"),
    [
        ({"uniform": [2, 5]}, stats.uniform(2, 3)),
        ({"log_uniform": [1e4, 1e6]}, stats.loguniform(1e4, 1e6)),
        ({"normal": {"mean": 1.0, "std": 0.5, "min": 0.2, "max": 1.4}}, stats.truncnorm(-1.6, 0.8, 1.0, 0.5)),
    ],
)
def test_quantiles_are_those_of_scipy(table, law):
    np.testing.assert_allclose(drawn(table), law.ppf(GRID), rtol=1e-9)


def test_choice_draws_each_value_equally_often():
    values, counts = np.unique(drawn({"choice": [3, 1, 2, 2.5]}), return_counts=True)
    assert values.tolist() == [1, 2, 2.5, 3]
    assert counts.tolist() == [1000] * 4


def test_normal_outside_its_range_stays_within_it():
    values = drawn({"normal": {"mean": 1.3, "std": 0.1, "min": 0.0, "max": 1.0}})
    assert 0.0 <= values.min() < values.max() <= 1.0


@pytest.mark.parametrize("ends", [(-1.0, 40.0), (-40.0, 1.0), (0.1, 0.7)])
def test_the_ends_of_a_normal_density_stay_within_its_range(ends):
    """Beyond eight deviations the share below rounds to 1, whose quantile is infinite."""
    law = ADAPTER.validate_python({"normal": {"mean": 0.0, "std": 1.0, "min": ends[0], "max": ends[1]}})
    for u in (0.0, np.nextafter(1.0, 0.0)):
        assert ends[0] <= law.quantile(u) <= ends[1]


@pytest.mark.parametrize(("mean", "std"), [(9.0, 0.1), (1e300, 1.0), (-1e300, 1.0), (0.5, 1e300), (0.5, 1e5)])
def test_normal_that_hardly_reaches_its_range_is_refused(mean, std):
    with pytest.raises(ValidationError, match="hardly a value from min = 0 to max = 1; change mean or std, or write"):
        ADAPTER.validate_python({"normal": {"mean": mean, "std": std, "min": 0.0, "max": 1.0}})


@pytest.mark.parametrize(
    "table", [3.5, {"uniform": [2, 5]}, {"choice": [1, 2]}, {"normal": {"mean": 1, "std": 1, "min": 0, "max": 2}}]
)
def test_written_and_read_again(table):
    distribution = ADAPTER.validate_python(table)
    assert ADAPTER.validate_python(ADAPTER.dump_python(distribution, mode="json")) == distribution
