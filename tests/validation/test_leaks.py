"""The leak test on small files of `signals/`: it is silent where nothing leaks, and finds each leak that is planted."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.stats import kstest

from rubgen.io.parquet.set_tables import signals_schema
from rubgen.scenario import parse_recipe
from validation.leaks import facts_of, verdict, zeros_among_near

RUNS = 96
RECIPE = {"name": "leaks", "runs": RUNS, "machine": "zeng2019", "output": {"signal_seconds": 0.007}}


def rows(rng):
    """Return runs of eight machines whose answers are coins, as dictionaries, and their schema."""
    schema = signals_schema(parse_recipe(RECIPE))
    found = []
    for number in range(RUNS):
        row = dict.fromkeys(schema.names)
        for field in schema:
            if pa.types.is_fixed_size_list(field.type):
                row[field.name] = rng.standard_normal(field.type.list_size).astype(np.float32).tolist()
        turn = 60 / rng.uniform(9000, 11000)
        row |= {"run_id": f"run-{number:06d}", "machine_id": f"machine{number % 24}", "split": "train", "seed": 0}
        row |= {"sample_rate_hz": 25600.0, "rub": bool(rng.integers(2)), "once_per_rev_s": [0.0, turn, 2 * turn]}
        found.append(row)
    return found, schema


def nothing(found, rng):
    return found


def order(found, rng):
    return sorted(found, key=lambda row: row["rub"])


def names(found, rng):
    numbers = rng.permutation(RUNS // 2)
    for row, number in zip(found, np.tile(numbers, 2), strict=True):
        row["run_id"] = f"run-{2 * number + row['rub']:06d}"
        row["seed"] = row["rub"] + 7
    return found


def zeros(found, rng):
    for row in found:
        if row["rub"]:
            row["casing_acc_0"][3] = 0.0
    return found


def loud(found, rng):
    """Record a channel in steps, three times as loud in rubs: it has fewer zeros there."""
    for row in found:
        row["casing_acc_0"] = np.round(np.array(row["casing_acc_0"]) * (18 if row["rub"] else 6)).tolist()
    return found


def loud_without_small_steps(found, rng):
    """As `loud`, and in rubs most samples one step off 0 are 0, as behind a threshold of noise."""
    for row in loud(found, rng):
        steps = np.array(row["casing_acc_0"])
        gone = (np.abs(steps) == 1) & (rng.random(steps.size) < 0.8) & row["rub"]
        row["casing_acc_0"] = np.where(gone, 0, steps).tolist()
    return found


def lengths(found, rng):
    for row in found:
        if row["rub"]:
            row["once_per_rev_s"] = row["once_per_rev_s"][:2]
    return found


def nulls(found, rng):
    for row in found:
        row["sample_rate_hz"] = None if row["rub"] else 25600.0
    return found


def second_of_two(found, rng):
    for number, row in enumerate(found):
        row["rub"] = bool(rng.random() < (0.75 if number % 2 == 0 else 0.25))
    return found


SILENT = (nothing, loud)
LEAKS = (order, names, zeros, loud_without_small_steps, lengths, nulls, second_of_two)


@pytest.mark.parametrize("plant", [*SILENT, *LEAKS])
def test_a_planted_leak_is_found_and_nothing_is_silent(plant, tmp_path):
    rng = np.random.default_rng(5)
    found, schema = rows(rng)
    path = tmp_path / "train-00000.parquet"
    pq.write_table(pa.Table.from_pylist(plant(found, rng), schema), path, row_group_size=4)
    told = verdict(facts_of([path]))
    assert told.found == (plant in LEAKS), told
    assert abs(told.chance - 0.5) < 0.1


def test_what_the_speed_tells_is_no_leak(tmp_path):
    rng = np.random.default_rng(6)
    found, schema = rows(rng)
    for row in found:
        row["rub"] = bool(row["once_per_rev_s"][1] < 60 / 10_000)
    path = tmp_path / "train-00000.parquet"
    pq.write_table(pa.Table.from_pylist(found, schema), path)
    told = verdict(facts_of([path]))
    assert told.score > 0.8
    assert told.chance > 0.7


def test_the_size_of_a_channel_is_no_leak(tmp_path):
    rng = np.random.default_rng(7)
    found, schema = rows(rng)
    for row in found:
        if not row["rub"]:
            row["casing_acc_0"] = [1.0] * len(row["casing_acc_0"])
    path = tmp_path / "train-00000.parquet"
    pq.write_table(pa.Table.from_pylist(found, schema), path, row_group_size=1)
    assert not verdict(facts_of([path])).found


def test_the_place_of_zeros_is_uniform_whatever_the_amplitude():
    rng = np.random.default_rng(8)
    for size in (20, 200):
        places = [zeros_among_near(np.round(size * rng.standard_normal(4000)), rng) for _ in range(400)]
        assert kstest(places, "uniform").pvalue > 0.01, size
    doubled = [zeros_among_near(np.round(50 * rng.standard_normal(4000) / 2) * 2, rng) for _ in range(400)]
    assert kstest(doubled, "uniform").pvalue > 0.01  # steps of 2
    assert zeros_among_near(np.zeros(10), rng) > 0.9
