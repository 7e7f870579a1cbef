"""Every column has one role, inputs are what sensors record, and classes have the same numbers everywhere."""

import json
from collections import Counter

import pyarrow as pa
import pytest

import datasets
from rubgen.io.columns import Role, scalar_columns, signal_columns
from rubgen.io.parquet.words import NUMBERS, with_words
from rubgen.io.parquet.write import run_table, schema
from rubgen.labels import MOTION_CLASSES, Motion
from rubgen.machine.faults.registry import FAULTS
from rubgen.sensors.load import load_sensor_set

SETS = ("default", "rig", "field", "field-cheap")


@pytest.mark.parametrize("name", SETS)
def test_every_column_has_one_role_in_the_file(name):
    sensors = load_sensor_set(name)
    columns = scalar_columns(sensors, surroundings=True, faults=FAULTS) + signal_columns(sensors, clean=True)
    types = schema(signals=True, clean=True, sensors=sensors, surroundings=True, faults=tuple(FAULTS))
    roles = {field.name: Role(field.metadata[b"role"].decode()) for field in types}
    assert roles == {column.name: column.role for column in columns}
    assert set(roles.values()) == set(Role)


@pytest.mark.parametrize("name", SETS)
def test_inputs_are_recorded_channels_and_events_alone(name):
    sensors = load_sensor_set(name)
    recorded = {sensor.name for sensor in sensors.sensors}
    columns = scalar_columns(sensors, surroundings=True, faults=FAULTS) + signal_columns(sensors, clean=True)
    inputs = {column.name for column in columns if column.role is Role.INPUT}
    events = {f"{sensor}{end}" for sensor in recorded for end in ("_s", "_blade")}
    assert inputs <= recorded | events
    assert not any("contact" in each or each.endswith(("_clean", "_true_m")) for each in inputs)
    assert all(column.role is not Role.INPUT for column in columns if column.nullable)


def test_neither_nulls_nor_lengths_of_inputs_give_rub_away(rub_run, free_run):
    tables = [run_table(run) for run in (rub_run, free_run)]
    inputs = [field.name for field in tables[0].schema if field.metadata[b"role"] == b"input"]
    assert len(inputs) > 10
    for name in inputs:
        touched, free = (table[name][0].as_py() for table in tables)
        assert touched is not None
        assert free is not None
        assert len(touched) == len(free), name


def test_numbers_of_motions_are_fixed():
    assert MOTION_CLASSES == {
        "period-1": 0, "period-k": 1, "quasi-periodic": 2, "chaotic": 3, "static": 4, "undecided": -1,
    }  # fmt: skip
    assert set(MOTION_CLASSES) == {motion.value for motion in Motion}
    assert NUMBERS["rub_extent"] == {"none": 0, "partial": 1, "full-annular": 2}
    assert NUMBERS["whirl"] == {"forward": 0, "backward": 1, "mixed": 2}


def test_datasets_reads_classes_and_words_come_back():
    features = datasets.Features.from_arrow_schema(schema(signals=True))
    for name, numbers in NUMBERS.items():
        known = {word: number for word, number in numbers.items() if number >= 0}
        assert {word: features[name].str2int(word) for word in known} == known
    assert features["change_motion_classes"].feature == features["motion"]
    assert features["proximity_x"].feature.dtype == "float32"
    table = pa.table({"motion": pa.array([0, -1, None, 9]), "whirl": ["mixed", None, None, "mixed"]})
    assert with_words(table)["motion"].to_pylist() == ["period-1", "undecided", None, "class 9"]
    assert with_words(table)["whirl"].to_pylist() == ["mixed", None, None, "mixed"]


def test_stratified_splits_of_a_set_with_failed_runs():
    """What `load_dataset` makes of the files: two sets have equal features, whichever classes and nulls they have."""
    motion = [*[0] * 8, *[3] * 8, *[-1] * 4]
    types = pa.schema([schema(signals=False).field("motion")], metadata=schema(signals=False).metadata)
    table = pa.table({"motion": pa.array(motion)}, schema=types)
    loaded = datasets.Dataset(table)
    assert loaded.features["motion"].names[3] == "chaotic"
    halves = loaded.train_test_split(test_size=0.5, stratify_by_column="motion", seed=1)
    assert Counter(halves["train"]["motion"]) == Counter(halves["test"]["motion"]) == {0: 4, 3: 4, -1: 2}
    failed = datasets.Dataset(pa.table({"motion": pa.array([None, None], pa.int64())}, schema=types))
    assert failed.features == loaded.features
    assert len(datasets.concatenate_datasets([loaded, failed])) == 22
    assert json.loads(types.field("motion").metadata[b"classes"]) == MOTION_CLASSES
