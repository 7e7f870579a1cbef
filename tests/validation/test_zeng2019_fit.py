import json
from pathlib import Path

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.machine import load_machine
from rubgen.machine.load import PRESETS
from validation.onset import ONSET_RPM, tip_growth
from validation.zeng2019.figures import figure09
from validation.zeng2019.fitting import fit as fitting
from validation.zeng2019.fitting import score as scoring
from validation.zeng2019.fitting import search
from validation.zeng2019.fitting.score import Score, always, best, score
from validation.zeng2019.fitting.search import (
    FITTED,
    FRICTION,
    MASS,
    PREDICTED,
    PRESET,
    TARGETS,
    Candidate,
    candidates,
    machine_of,
    toml_of,
)


def classes_of(blisk, casing):
    return {"blisk": np.array(blisk), "casing": np.array(casing)}


def words(runs):
    return classes_of([target.blisk for target in runs], [target.casing.replace("any", "static") for target in runs])


def test_the_presets_own_values_give_the_preset():
    assert machine_of(PRESET.damping, PRESET.mass) == load_machine("zeng2019")


def test_another_mass_keeps_the_ratio_of_springs_to_mass():
    light, preset = machine_of(0.10, 1.0).casing, load_machine("zeng2019").casing
    assert light.width_m / preset.width_m == pytest.approx(0.2)
    ratio = light.radial_support_stiffness_n_per_m / preset.radial_support_stiffness_n_per_m
    assert ratio == pytest.approx(0.2)
    assert light.radial_support_stiffness_n_per_m == light.circumferential_support_stiffness_n_per_m


def test_another_damping_keeps_the_onset_of_rub():
    """docs/preset-zeng2019.md gives 1.371e-2 kg m and 270.9 um for 5 %."""
    machine = machine_of(0.05, 5.0)
    assert machine.unbalance_kg_m == pytest.approx(1.371e-2, rel=1e-3)
    assert machine.casing.clearance_m == pytest.approx(270.9e-6, rel=1e-3)
    assert tip_growth(machine, ONSET_RPM) == pytest.approx(machine.casing.clearance_m, rel=1e-6)


def test_words_are_scored_apart_for_fit_and_prediction():
    right = words(TARGETS)
    every = Score(candidate=PRESET, fitted=scoring.words(FITTED), predicted=scoring.words(PREDICTED))
    assert score(PRESET, lambda _: right) == every
    failed = classes_of(["diverged"] * len(TARGETS), ["diverged"] * len(TARGETS))
    assert score(PRESET, lambda _: failed).fitted == 0
    half = words(TARGETS)
    half["blisk"][len(FITTED) :] = "diverged"
    found = score(PRESET, lambda _: half)
    assert (found.fitted, found.predicted) == (every.fitted, every.predicted / 2)


def test_chaos_everywhere_bears_out_what_is_called_chaotic():
    """Of 22 fitted words 16 say chaotic, of the 18 others 7."""
    chaotic = [sum((t.blisk == "chaotic") + (t.casing == "chaotic") for t in runs) for runs in (FITTED, PREDICTED)]
    assert list(always("chaotic")) == chaotic == [16, 7]
    assert always("period-1") == (6, 11)


def test_of_equals_the_one_nearest_to_the_preset_is_taken():
    near = Score(candidate=Candidate(damping=0.10, mass=1.0, friction=0.0), fitted=3, predicted=0)
    far = Score(candidate=Candidate(damping=0.05, mass=1.0, friction=0.0), fitted=3, predicted=9)
    assert best([far, near]) == near


def test_of_equals_the_preset_wins():
    right = words(TARGETS)
    every = candidates()
    assert every[0] == PRESET
    assert len(every) == len({(c.damping, c.mass, c.friction) for c in every}) == 3 * len(MASS) * len(FRICTION)
    assert best([score(one, lambda _: right) for one in every]).candidate == PRESET


def test_the_machine_found_is_a_machine(tmp_path):
    path = tmp_path / "fitted.toml"
    path.write_text(toml_of(Candidate(damping=0.10, mass=2.0, friction=0.02)), encoding="utf-8")
    machine, expected = load_machine(str(path)), machine_of(0.10, 2.0)
    assert machine.name == "zeng2019-fitted"
    assert machine.casing.width_m == pytest.approx(expected.casing.width_m, rel=1e-5)
    assert machine.disk == expected.disk


def made_up_classes(damping, mass, friction):
    """Only a light casing without friction does what the paper says, whatever the damping."""
    true = words(TARGETS)
    if mass > 2 or friction:
        true["casing"][:] = "diverged"
    return true


def made_up_room(damping):
    """A span that holds the preset's values, whatever the damping."""
    return {
        "unbalance": np.array([0.013, 0.015]),
        "clearance": np.array([270e-6, 274e-6]),
        "damping": np.array(damping),
    }


def test_the_search_writes_its_evidence(tmp_path, monkeypatch):
    monkeypatch.setattr(search, "classes", made_up_classes)
    monkeypatch.setattr(fitting, "room", made_up_room)
    monkeypatch.setattr(fitting, "COMPARED", (figure09.SECTION,))
    found = fitting.fit(tmp_path, workers=1)
    assert found.best.candidate == Candidate(damping=0.10, mass=1.0, friction=0.0)
    used, others = scoring.words(FITTED), scoring.words(PREDICTED)
    assert found.best.fitted == used
    text = found.page.read_text()
    assert f"`zeng2019-fitted` | 0.1 | 1 | 0 | {used} of {used} | {others} of {others} |" in text
    assert f"| 0.15 | {used} | {others} | within chance |" in text
    assert "| 0.02 | 13 | 9 | scores less |" in text
    assert "| 0.1 | 0.013 to 0.015 | 270.0 to 274.0 |" in text
    assert "| Figure 9 | The drawn shapes of the casing's eleven modes. | unknowable | unknowable |" in text
    assert "| chaotic everywhere |  |  |  | 16 of 22 | 7 of 18 |" in text
    assert "candidate matches more than chaos" in text
    assert load_machine(str(found.machine)).casing.width_m == pytest.approx(0.26662 / 5)
    assert len(json.loads((tmp_path / "fit" / "fit.json").read_text())) == 30
    assert found.made == 30 + 3 + 1
    assert fitting.fit(tmp_path, workers=1).made == 0


def test_the_preset_lies_in_the_room_that_the_facts_leave():
    """Unbalance and clearance of the preset meet both facts; the facts leave 15 % and 1.5 %."""
    found, preset = search.room(0.10), load_machine("zeng2019")
    assert found["unbalance"][0] < preset.unbalance_kg_m < found["unbalance"][1]
    assert found["clearance"][0] < preset.casing.clearance_m < found["clearance"][1]
    spans = [float(np.diff(found[name])[0] / found[name][0]) for name in ("unbalance", "clearance")]
    assert spans == pytest.approx([0.135, 0.0146], rel=0.05)


def test_the_fitted_preset_is_the_result_of_its_own_evidence():
    """What docs/zeng2019-fit.md calls `zeng2019-fitted` is what the preset holds."""
    page = (Path(__file__).parents[2] / "docs" / "zeng2019-fit.md").read_text(encoding="utf-8")
    row = next(line for line in page.splitlines() if line.startswith("| best without friction"))
    damping, mass, friction = (float(cell) for cell in row.split("|")[2:5])
    preset = (PRESETS / "zeng2019-fitted.toml").read_text(encoding="utf-8")
    assert preset == toml_of(Candidate(damping=damping, mass=mass, friction=friction))


def test_a_wrong_directory_is_refused(tmp_path):
    (tmp_path / "mine").write_text("x")
    with pytest.raises(UserError, match="not made by this command"):
        fitting.fit(tmp_path)
