import json

import numpy as np
import pytest

from rubgen.errors import UserError
from rubgen.machine import load_machine
from rubgen.studies.onset import ONSET_RPM, tip_growth
from rubgen.studies.zeng2019 import fitting, search
from rubgen.studies.zeng2019.search import (
    FITTED,
    FRICTION,
    MASS,
    PRESET,
    TARGETS,
    Candidate,
    best,
    candidates,
    machine_of,
    score,
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
    assert score(PRESET, lambda _: right).fitted == score(PRESET, lambda _: right).predicted == 1
    failed = classes_of(["diverged"] * len(TARGETS), ["diverged"] * len(TARGETS))
    assert score(PRESET, lambda _: failed).fitted == 0
    half = words(TARGETS)
    half["blisk"][len(FITTED) :] = "diverged"
    found = score(PRESET, lambda _: half)
    assert (found.fitted, found.predicted) == (1, 0.5)


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


def test_the_search_writes_its_evidence(tmp_path, monkeypatch):
    monkeypatch.setattr(search, "classes", made_up_classes)
    found = fitting.fit(tmp_path, workers=1)
    assert found.best.candidate == Candidate(damping=0.05, mass=1.0, friction=0.0)
    assert found.best.fitted == 1
    text = found.page.read_text()
    assert "| best | 0.05 | 1 | 0 | 100 % | 100 % |" in text
    assert text.count("| 0.15 | 100 % | 100 % |") == 1
    assert load_machine(str(found.machine)).damping.lateral == 0.05
    assert len(json.loads((tmp_path / "fit" / "fit.json").read_text())) == found.made == 45
    assert fitting.fit(tmp_path, workers=1).made == 0


def test_a_wrong_directory_is_refused(tmp_path):
    (tmp_path / "mine").write_text("x")
    with pytest.raises(UserError, match="not made by rubgen reproduce"):
        fitting.fit(tmp_path)
