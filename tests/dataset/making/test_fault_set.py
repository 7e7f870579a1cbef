"""A set whose runs have a fault or none: columns, units, checks, card."""

import json

import pytest

import rubgen
from rubgen.dataset.checking.verify import verify
from rubgen.errors import RubgenWarning
from rubgen.scenario import parse_recipe

RECIPE = {
    "name": "faulty",
    "runs": 3,
    "machine": "zeng2019",
    "vary": {"clearance_m": 3e-3},
    "labels": {"lyapunov": False},
    "output": {"signal_seconds": 0.2, "formats": ["parquet"]},
    "faults": [
        {"kind": "bow", "share": 0.5, "bow_m": {"uniform": [1e-6, 1e-5]}},
        {"kind": "misalignment", "share": 0.4, "parallel_m": 5e-5},
    ],
}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("faults") / "set"
    with pytest.warns(RubgenWarning, match="no blade can reach the casing"):
        rubgen.generate(parse_recipe(RECIPE), folder, workers=1)
    return rubgen.open(folder)


def test_columns_name_the_faults_of_each_run(made):
    recipe = parse_recipe(RECIPE)
    rows = [made.row(f"run-{index:06d}") for index in range(3)]
    drawn = [{fault.kind: fault.severity for fault in recipe.scenario(index).machine.faults} for index in range(3)]
    assert len({tuple(each) for each in drawn}) > 1
    for row, faults in zip(rows, drawn, strict=True):
        assert sorted(row["faults"]) == sorted(faults)
        assert row["healthy"] == (not faults)
        assert (row["bow_m"], row["misalignment_m"]) == (faults.get("bow", 0.0), faults.get("misalignment", 0.0))
    assert made.runs.attrs["units"]["misalignment_m"] == "m"
    assert made.runs["healthy"].dtype == "boolean"


def test_nothing_is_wrong_with_it_and_its_files_say_what_columns_mean(made):
    assert verify(made.layout.root) == []
    assert "`misalignment_m`" in made.layout.card.read_text()
    records = json.loads(made.layout.croissant.read_text())["recordSet"]
    fields = {each["@id"]: each for record_set in records for each in record_set["field"]}
    assert fields["runs/faults"]["isArray"] is True
