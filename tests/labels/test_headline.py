import pytest

from rubgen.labels.headline import headline
from rubgen.labels.to_json import labels_to_json


def changing(rubs, onset=7410.2, end=8200.0):
    return {"rub": any(rubs), "change_rub": rubs, "onset_speed_rpm": onset, "end_of_rub_speed_rpm": end}


@pytest.mark.parametrize(
    ("rubs", "expected"),
    [
        ([0], "run-up: no rub"),
        ([0, 1], "run-up: rub from 7,410 rev/min"),
        ([0, 1, 0, 1, 0], "run-up: rub from 7,410 to 8,200 rev/min"),
        ([1, 0], "run-up: rub until 8,200 rev/min"),
        ([1], "run-up: rub at its start and at its end"),
    ],
)
def test_a_run_up_says_from_which_speed_it_rubs(rubs, expected):
    assert headline(changing(rubs), "run-up") == expected


def test_a_steady_run_says_how_it_rubs_and_moves(rub_run, free_run):
    rubbing, free = (labels_to_json(run.labels) for run in (rub_run, free_run))
    assert headline(rubbing, "steady") == f"{rubbing['rub_extent']} rub, {rubbing['motion']}"
    assert headline(free, "steady").startswith("no rub, ")
    assert headline(rubbing | {"motion": "undecided"}, "steady").endswith("rub, motion undecided")
