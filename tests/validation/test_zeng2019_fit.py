import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.machine.load import PRESETS
from validation.onset import ONSET_RPM, chord_inset, tip_growth
from validation.piece import Piece
from validation.zeng2019.fitting import candidate as candidates
from validation.zeng2019.fitting import fit as fitting
from validation.zeng2019.fitting.candidate import PRESET, Candidate, machine_of
from validation.zeng2019.fitting.evidence import EVIDENCE, read_evidence
from validation.zeng2019.fitting.machine_file import toml_of
from validation.zeng2019.fitting.page import page
from validation.zeng2019.fitting.room import room
from validation.zeng2019.fitting.score import Score, always, as_computed, balanced, best, interval, resampled, score
from validation.zeng2019.fitting.search import around, grid
from validation.zeng2019.fitting.targets import FITTED, PREDICTED, TARGETS, words

CHORDS = Candidate(surface="chords", mass=8.0)


def classes_of(blisk, casing):
    return {"blisk": np.array(blisk), "casing": np.array(casing)}


def true_classes():
    """What the paper says at every target."""
    return classes_of([t.blisk for t in TARGETS], [t.casing.replace("any", "static") for t in TARGETS])


def test_the_presets_own_values_give_the_preset():
    assert machine_of(PRESET) == load_machine("zeng2019")


def test_another_mass_keeps_the_ratio_of_springs_to_mass():
    light, preset = machine_of(Candidate(mass=1.0)).casing, load_machine("zeng2019").casing
    assert light.width_m / preset.width_m == pytest.approx(0.2)
    ratio = light.radial_support_stiffness_n_per_m / preset.radial_support_stiffness_n_per_m
    assert ratio == pytest.approx(0.2)
    assert light.radial_support_stiffness_n_per_m == light.circumferential_support_stiffness_n_per_m
    softer = machine_of(Candidate(springs=0.5)).casing
    assert softer.radial_support_stiffness_n_per_m == pytest.approx(0.5 * preset.radial_support_stiffness_n_per_m)
    assert softer.width_m == preset.width_m


def test_another_damping_keeps_the_onset_of_rub():
    """docs/preset-zeng2019.md gives 1.371e-2 kg m and 270.9 um for 5 %."""
    machine = machine_of(Candidate(damping=0.05))
    assert machine.unbalance_kg_m == pytest.approx(1.371e-2, rel=1e-3)
    assert machine.casing.clearance_m == pytest.approx(270.9e-6, rel=1e-3)
    assert tip_growth(machine, ONSET_RPM) == pytest.approx(machine.casing.clearance_m, rel=1e-6)


def test_chords_keep_the_air():
    smooth, chords = machine_of(Candidate(mass=8.0)), machine_of(CHORDS)
    assert chords.unbalance_kg_m == smooth.unbalance_kg_m
    air = chords.casing.clearance_m - chord_inset(chords)
    assert air == pytest.approx(smooth.casing.clearance_m, abs=1e-9)


def test_words_are_scored_apart_for_fit_and_held_out():
    right = score(PRESET, true_classes())
    assert (right.accuracy, right.held_out) == (1.0, 1.0)
    assert len(right.fitted) == len(words(FITTED)) == 22
    assert len(right.predicted) == len(words(PREDICTED)) == 18
    failed = score(PRESET, classes_of(["diverged"] * len(TARGETS), ["diverged"] * len(TARGETS)))
    assert failed.accuracy == 0
    half = true_classes()
    half["blisk"][len(FITTED) :] = "diverged"
    assert score(PRESET, half).accuracy == 1.0
    assert score(PRESET, half).held_out < 0.6


def test_one_motion_everywhere_scores_one_half():
    """Although 16 of the 22 words say chaotic."""
    assert Counter(words(FITTED)) == {"chaotic": 16, "period-1": 6}
    for motion in ("chaotic", "period-1"):
        assert always(motion, FITTED) == always(motion, PREDICTED) == 0.5


def test_a_balanced_accuracy_is_the_mean_of_both_hit_rates():
    hits, asked = np.array([[True, False, True, True, True]]), ["period-1", "period-1", *["chaotic"] * 3]
    assert balanced(hits, asked) == pytest.approx([(1 / 2 + 1) / 2])
    twice = np.array([0.0, 2.0, 1.0, 1.0, 1.0])
    assert balanced(hits, asked, twice) == pytest.approx([0.5])


def test_intervals_cover_the_score_and_shrink_to_it_where_all_words_agree():
    right, half = score(PRESET, true_classes()), true_classes()
    half["casing"][::2] = "diverged"
    drawn = resampled([right, score(PRESET, half)])
    assert interval(drawn[:, 0]) == (1.0, 1.0)
    low, high = interval(drawn[:, 1])
    assert low < score(PRESET, half).accuracy < high
    np.testing.assert_array_equal(drawn, resampled([right, score(PRESET, half)]))


def test_of_equals_the_one_nearest_to_the_preset_is_taken():
    near, far = (score(one, true_classes()) for one in (Candidate(mass=1.0), Candidate(mass=1.0, damping=0.05)))
    assert best([far, near]) == near
    assert best([far, near, score(PRESET, true_classes())]).candidate == PRESET


def test_the_machine_for_comparison_is_on_chords_without_friction_and_with_the_published_frequencies():
    wrong = classes_of(["diverged"] * len(TARGETS), ["diverged"] * len(TARGETS))
    tried = [PRESET, Candidate(surface="chords", friction=0.1), Candidate(surface="chords", springs=2.3)]
    scores = [*(score(one, true_classes()) for one in tried), score(CHORDS, wrong)]
    assert as_computed(scores).candidate == CHORDS


def test_the_grid_begins_with_the_preset_and_holds_each_candidate_once():
    every = grid()
    assert every[0] == PRESET
    assert len(every) == len(set(every)) == 2 * 7 * 3
    more = around(CHORDS)
    assert len(more) == len(set(more)) == 5 * 3 - 1
    assert not set(more) & set(every)


def test_the_machine_found_is_a_machine(tmp_path):
    path = tmp_path / "found.toml"
    path.write_text(toml_of(Candidate(mass=2.0, friction=0.02)), encoding="utf-8")
    machine, expected = load_machine(str(path)), machine_of(Candidate(mass=2.0))
    assert machine.name == "zeng2019-as-computed"
    assert machine.casing.width_m == pytest.approx(expected.casing.width_m, rel=1e-5)
    assert machine.disk == expected.disk


def made_up_classes(surface, mass, damping, friction, springs):
    """Only chords on a heavy casing do what the paper says, whatever the rest."""
    true = true_classes()
    if surface == "smooth" or mass != 8:
        true["casing"][:] = "diverged"
    return true


def made_up_room(damping):
    """A span that holds the preset's values, whatever the damping."""
    return {
        "unbalance": np.array([0.013, 0.015]),
        "clearance": np.array([270e-6, 274e-6]),
        "damping": np.array(damping),
    }


ROOMS = {damping: Piece(made_up_room, (damping,)) for damping in (0.05, 0.1, 0.15)}


def test_the_search_writes_its_evidence(tmp_path, monkeypatch):
    monkeypatch.setattr(candidates, "classes", made_up_classes)
    monkeypatch.setattr("validation.zeng2019.fitting.page.ROOMS", ROOMS)
    monkeypatch.setattr(fitting, "ROOMS", ROOMS)
    found = fitting.fit(tmp_path, workers=1)
    assert found.best.candidate == CHORDS
    text = found.page.read_text()
    assert "| `zeng2019-as-computed` | chords | 8.0 | 0.1 | 0.0 | 1.0 | 1.000 [1.00, 1.00] | 1.000 |" in text
    assert "| chaotic everywhere |  |  |  |  |  | 0.500 | 0.500 |" in text
    assert "On these words it is better." in text
    assert "the held-out words give 1.00, better than chaos everywhere." in text
    assert "| 0.1 | 0.013 to 0.015 | 270.0 to 274.0 |" in text
    assert load_machine(str(found.machine)).casing.width_m == pytest.approx(0.26662 * 8 / 5, rel=1e-5)
    kept = read_evidence(tmp_path / "fit" / "found.json")
    assert len(kept) == len(json.loads((tmp_path / "fit" / "found.json").read_text())) == 42 + 2 * 14
    assert as_computed(kept) == found.best
    assert found.made == 42 + 2 * 14 + 3
    assert fitting.fit(tmp_path, workers=1).made == 0


def test_the_preset_lies_in_the_room_that_the_facts_leave():
    """Unbalance and clearance of the preset meet both facts; the facts leave 15 % and 1.5 %."""
    found, preset = room(0.10), load_machine("zeng2019")
    assert found["unbalance"][0] < preset.unbalance_kg_m < found["unbalance"][1]
    assert found["clearance"][0] < preset.casing.clearance_m < found["clearance"][1]
    spans = [float(np.diff(found[name])[0] / found[name][0]) for name in ("unbalance", "clearance")]
    assert spans == pytest.approx([0.135, 0.0146], rel=0.05)


def test_the_preset_for_comparison_is_the_result_of_the_kept_search():
    """The evidence in the repository gives the machine file, and the page in docs/."""
    scores = read_evidence()
    assert EVIDENCE.exists()
    taken = as_computed(scores)
    assert toml_of(taken.candidate) == (PRESETS / "zeng2019-as-computed.toml").read_text(encoding="utf-8")
    text = (Path(__file__).parents[2] / "docs" / "zeng2019-fit.md").read_text(encoding="utf-8")
    made = page(scores, lambda piece: made_up_room(*piece.arguments))
    assert made.partition("The table shows the range")[0] == text.partition("The table shows the range")[0]
    assert isinstance(taken, Score)
    plain = [one for one in scores if (one.candidate.friction, one.candidate.springs) == (0.0, 1.0)]
    chords = [one for one in plain if one.candidate.surface == "chords"]
    equal = {one.candidate.mass for one in chords if one.accuracy > taken.accuracy - 1e-9}
    assert equal == {8.0, 10.0, 12.0}, "the first page says that these masses fit equally well"
