"""Runs in memory are those of the data set; failed runs are left out, and a recipe of failures ends."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

import rubgen
from rubgen import streaming
from rubgen.errors import RubgenError, UserError
from rubgen.scenario import parse_recipe


def test_the_stream_has_the_runs_of_the_set(small_set, short_records):
    data = rubgen.open(small_set.directory)
    for run_id, run in zip(data.ok.index, islice(rubgen.stream(small_set.recipe), 2), strict=False):
        assert run.scenario.run_id == run_id
        for name, signal in data.signals(run_id).items():
            assert np.array_equal(signal, run.recording.channels[name].values)
        assert run.labels.rub == data.runs.loc[run_id, "rub"]


def test_the_stream_goes_on_after_a_failed_run_and_beyond_the_number_of_runs(
    small_set, short_records, monkeypatch, rub_run
):
    def made(scenario):
        if scenario.index % 3 == 0:
            raise UserError("not possible")
        return rub_run.__class__(
            scenario=scenario, response=rub_run.response, recording=rub_run.recording, labels=rub_run.labels
        )

    monkeypatch.setattr(streaming, "simulate", made)
    numbers = [run.scenario.index for run in islice(rubgen.stream(small_set.recipe), 6)]
    assert numbers == [1, 2, 4, 5, 7, 8]


def test_a_recipe_of_failures_ends_with_the_last_reason(small_set, short_records, monkeypatch):
    def fails(scenario):
        raise UserError(f"run {scenario.index} is not possible")

    monkeypatch.setattr(streaming, "simulate", fails)
    with pytest.raises(
        RubgenError, match="64 runs failed one after the other; run-000063 refused: run 63 is not possible"
    ):
        next(rubgen.stream(small_set.recipe))


def test_a_recipe_that_is_not_allowed_is_refused_at_once(small_set, short_records):
    with pytest.raises(UserError, match="runs"):
        rubgen.stream({**small_set.recipe, "runs": 0})
    with pytest.raises(UserError, match="runs"):
        rubgen.stream(parse_recipe(small_set.recipe).model_copy(update={"runs": 0}))


def test_a_recipe_streams_as_its_values_do(small_set, short_records, monkeypatch, rub_run):
    monkeypatch.setattr(streaming, "simulate", lambda scenario: replace(rub_run, scenario=scenario))
    made = [next(rubgen.stream(each)).scenario for each in (small_set.recipe, parse_recipe(small_set.recipe))]
    assert made[0] == made[1]


def test_failures_in_between_do_not_end_the_stream(small_set, short_records, monkeypatch, rub_run):
    """Only 64 failures one after the other do: 63 and a good run, again and again, go on."""

    def made(scenario):
        if scenario.index % 64 != 63:
            raise UserError("not possible")
        return replace(rub_run, scenario=scenario)

    monkeypatch.setattr(streaming, "simulate", made)
    assert [run.scenario.index for run in islice(rubgen.stream(small_set.recipe), 3)] == [63, 127, 191]
