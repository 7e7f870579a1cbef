"""A balanced set: the columns of its choice, its weights, and a run that is made again without screening."""

import numpy as np
import pytest

import rubgen
from rubgen.dataset.reading.replaying import scenario_of

RECIPE = {
    "name": "balanced",
    "seed": 4,
    "runs": 4,
    "machine": "zeng2019",
    "vary": {"speed_rpm": {"uniform": [9000, 10000]}, "clearance_m": {"uniform": [2e-4, 2e-3]}, "friction": 0.0},
    "balance": {"rub": 0.5, "tries": 3},
    "simulation": {"settle_turns": 60, "record_turns": 100},
    "labels": {"lyapunov": False},
    "output": {"formats": ["parquet"], "signal_seconds": 0.05},
}


@pytest.fixture(scope="module")
def balanced(module_with_short_records, tmp_path_factory):
    directory = tmp_path_factory.mktemp("balanced") / "set"
    rubgen.generate(RECIPE, directory, workers=1)
    return rubgen.open(directory)


def test_runs_are_in_the_class_that_they_were_drawn_for(balanced):
    good = balanced.ok
    assert len(good)
    assert (good["rub"].astype(bool) == (good["balance_cell"] == "rub")).all()
    assert [len(seen) for seen in balanced.runs["balance_seen"]] == [4] * 4
    assert [sum(seen) for seen in balanced.runs["balance_seen"]] == balanced.runs["balance_tries"].tolist()
    assert rubgen.verify(balanced.layout.root) == []


def test_a_run_without_a_candidate_is_refused_with_what_was_found(balanced):
    refused = balanced.runs[balanced.runs["status"] == "refused"]
    assert len(refused) == 1  # three tries are few where a seventh rubs
    assert refused["reason"].str.contains("none of 3 candidates is in the class 'rub'; found: 3 no rub").all()


def test_weights_are_natural_shares_over_those_of_the_set(balanced):
    table, weights = balanced.balance, balanced.weights
    seen = np.sum(list(balanced.runs["balance_seen"]), axis=0)
    natural = table.set_index("cell")["natural"]
    assert natural["rub"] == pytest.approx(seen[1] / seen[:2].sum())
    rubbing = balanced.ok["balance_cell"] == "rub"
    assert weights[rubbing.index[rubbing]].to_numpy() == pytest.approx(natural["rub"] / rubbing.mean())
    assert weights.isna().sum() == (balanced.runs["status"] != "ok").sum()


def test_a_run_is_made_again_from_its_recorded_candidate(balanced, monkeypatch):
    once = {run_id: balanced.recipe.scenario(number) for number, run_id in enumerate(balanced)}
    monkeypatch.setattr("rubgen.balancing.choose.screen", lambda *_, **__: pytest.fail("screened again"))
    for run_id in balanced.ok.index:
        assert scenario_of(balanced, run_id) == once[run_id]


def test_other_sensors_get_the_candidates_of_the_set_without_screening(balanced, monkeypatch, tmp_path):
    monkeypatch.setattr("rubgen.balancing.choose.screen", lambda *_, **__: pytest.fail("screened again"))
    rubgen.resense(balanced.layout.root, "field", tmp_path / "field", workers=1)
    other = rubgen.open(tmp_path / "field")
    same = ["status", "reason", "balance_cell", "balance_tries", "balance_seen", "rub", "speed_rpm", "clearance_m"]
    assert other.runs[same].astype(str).equals(balanced.runs[same].astype(str))
    assert rubgen.verify(other.layout.root) == []
