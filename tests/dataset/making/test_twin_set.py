"""A set with twins: the same noise and surroundings in both runs of a pair, and one column that differs."""

import numpy as np
import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.scenario.surroundings import SURROUNDINGS
from rubgen.scenario.vary import KEYS

RECIPE = {
    "name": "twins",
    "seed": 5,
    "runs": 4,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [9000, 10000]}, "clearance_m": 2e-3, "friction": {"uniform": [0.0, 0.02]}},
    "surroundings": {"background_m_per_s2": {"log_uniform": [1, 300]}, "runout_m": {"uniform": [1e-6, 6e-6]}},
    "twins": {"friction": 0.1},
    "simulation": {"settle_turns": 60, "record_turns": 100},
    "output": {"formats": ["parquet"], "signal_seconds": 0.05},
}


@pytest.fixture(scope="module")
def twins(module_with_short_records, tmp_path_factory):
    """A set whose runs do not rub: friction changes nothing that a sensor feels."""
    directory = tmp_path_factory.mktemp("twins") / "set"
    with pytest.warns(rubgen.errors.RubgenWarning, match="no blade can reach"):
        rubgen.generate(RECIPE, directory, workers=1)
    return rubgen.open(directory)


def test_one_column_of_a_pair_differs(twins):
    runs = twins.runs
    of_slots = runs["twin_of"].notna().to_numpy().reshape(2, 2)
    assert of_slots.sum(axis=1).tolist() == [1, 1]
    columns = [*KEYS, *(each.key for each in SURROUNDINGS), "seed", "split", "machine_id"]
    for twin, partner in runs["twin_of"].dropna().items():
        differ = [name for name in columns if runs.loc[twin, name] != runs.loc[partner, name]]
        assert differ == ["friction"]
    assert rubgen.verify(twins.layout.root) == []


@pytest.mark.parametrize("table", ["signals", "truth", "windows", "sections"])
def test_no_file_beside_the_runs_tells_of_a_twin(twins, table):
    (path,) = twins.layout.root.glob(f"{table}/*.parquet")
    assert "twin_of" not in pq.read_schema(path).names


def test_noise_and_surroundings_of_a_pair_are_the_same_bits(twins):
    for channel in twins.channels:
        first, twin, other, _ = (twins.signals(run_id, [channel])[channel] for run_id in twins)
        np.testing.assert_array_equal(first, twin)
        assert channel == "contact_force" or not np.array_equal(first, other)
