import json

from rubgen.labels.registry import LABELS, TAP_LABELS
from rubgen.labels.to_json import labels_to_json


def test_labels_have_their_public_names(rub_run):
    taps = ["blisk_x", "casing_acc_0", "contact_force"]
    names = [label.name for label in LABELS]
    names += [f"{tap}_{label.ending}" for tap in taps for label in TAP_LABELS]
    assert list(labels_to_json(rub_run.labels)) == names


def test_labels_survive_json(rub_run, free_run):
    for run in (rub_run, free_run):
        plain = labels_to_json(run.labels)
        assert json.loads(json.dumps(plain, allow_nan=False)) == plain


def test_what_is_undefined_is_null(free_run):
    plain = labels_to_json(free_run.labels)
    assert plain["contact_force_even_share"] is None
    assert plain["contact_zones_symmetric"] is None
    assert plain["contact_zone_centres_rad"] == []
