import re
from dataclasses import replace

import pytest

from rubgen.errors import UserError
from rubgen.machine import load_machine, preset_names
from rubgen.machine.load import PRESETS, file_named, machine_id

TEXT = (PRESETS / "zeng2019.toml").read_text()
BAD = {
    "unknown key": (
        "count = 36",
        "count = 36\ncolour = 1",
        "blades.colour: unknown key; allowed: count, ",
    ),
    "misspelt": ("rim_radius_m", "rim_radus_m", "disk.rim_radus_m: unknown key; did you mean rim_radius_m?"),
    "negative clearance": (r"clearance_m = \S+", "clearance_m = -1e-4", "casing.clearance_m = -0.0001: "),
    "nan": (r"ovality_m = \S+", "ovality_m = nan", "casing.ovality_m = nan: must be a finite number; change the value"),
    "inf": (r"lateral_stiffness_n_per_m = \S+", "lateral_stiffness_n_per_m = inf", "disk_support.lateral_stiffness_n"),
    "damping above 1": (
        r"lateral = \S+",
        "lateral = 1.5",
        "damping.lateral = 1.5: must be at least 0 and below 1; 1.5 % is written 0.015",
    ),
    "no blade": ("count = 36", "count = 0", "blades.count = 0: must be at least 2 and at most 1,000; change the value"),
    "no rim": (r"rim_radius_m = .*\n", "", "disk.rim_radius_m: this key is missing; add it, at least 1e-07 and"),
    "zero density": (
        r"density_kg_per_m3 = 7850.0",
        "density_kg_per_m3 = 0.0",
        "density_kg_per_m3 = 0: must be at least ",
    ),
    "half a blade": ("count = 36", "count = 35.5", "blades.count = 35.5: "),
    "not TOML": ("count = 36", "count = ", "not TOML"),
    "a support without stiffness along Y": (
        r"\[disk_support\]",
        "[disk_support]\nlateral_stiffness_anisotropy = 1.0",
        "disk_support.lateral_stiffness_anisotropy = 1: must be above -1 and below 1; change the value",
    ),
    "a damper that pushes along X": (
        r"\[disk_support\]",
        "[disk_support]\nlateral_damping_anisotropy = -1.2",
        "disk_support.lateral_damping_anisotropy = -1.2: must be above -1 and below 1; change the value",
    ),
    "a film without clearance": (
        r"\[disk_support\]",
        "[disk_support]\nsqueeze_film = { radius_m = 0.1, length_m = 0.02, clearance_m = 0.0, viscosity_pa_s = 0.02 }",
        "disk_support.squeeze_film.clearance_m = 0: must be at least ",
    ),
    "gravity upward": (
        "unbalance_kg_m",
        "gravity_m_per_s2 = -9.81\nunbalance_kg_m",
        "gravity_m_per_s2 = -9.81: must be at least 0 and at most 10,000; change the value",
    ),
}


def test_preset_has_the_published_tip_radius():
    machine = load_machine("zeng2019")
    assert preset_names() == ["zeng2019", "zeng2019-as-computed", "zeng2019-fitted"]
    assert machine.blades.count == 36
    assert machine.tip_radius_m == pytest.approx(0.40)
    casing = machine.casing
    assert machine.casing_mean_radius_m == pytest.approx(0.4 + casing.clearance_m + casing.ovality_m / 2)


@pytest.mark.parametrize("case", BAD.values(), ids=BAD.keys())
def test_bad_machine_is_refused_in_one_line(case, tmp_path):
    old, new, message = case
    changed, count = re.subn(old, new, TEXT, count=1)
    assert count == 1
    path = tmp_path / "machine.toml"
    path.write_text(changed)
    with pytest.raises(UserError) as caught:
        load_machine(str(path))
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_machine_id_depends_on_every_value_and_on_nothing_else():
    machine = load_machine("zeng2019")
    again = load_machine(str(PRESETS / "zeng2019.toml"))
    assert machine_id(machine) == machine_id(again)
    assert machine_id(machine) != machine_id(replace(machine, unbalance_kg_m=1.45e-2))
    assert machine_id(machine) != machine_id(replace(machine, casing=replace(machine.casing, nodes=360)))
    assert machine_id(machine) != machine_id(replace(machine, gravity_m_per_s2=9.81))


def test_a_key_that_is_left_at_its_default_does_not_enter_the_machine_id(tmp_path):
    path = tmp_path / "machine.toml"
    path.write_text(TEXT.replace("unbalance_kg_m", "gravity_m_per_s2 = 0.0\nunbalance_kg_m"))
    assert machine_id(load_machine(str(path))) == machine_id(load_machine("zeng2019"))


def test_missing_machine_file_and_preset():
    with pytest.raises(UserError, match=r"none.toml: there is no such file; check the path"):
        load_machine("none.toml")
    with pytest.raises(UserError, match=r"'zeng': no such preset; did you mean zeng2019\?"):
        load_machine("zeng")


@pytest.mark.parametrize("start", ["", "machine fan: its "])
def test_a_problem_of_the_model_names_the_file_of_the_machine(tmp_path, start):
    with pytest.raises(UserError) as error, file_named("own.toml", tmp_path):
        raise UserError(f"{start}casing.nodes = 182: must be divisible by 4")
    its = "its " if start else ""
    assert str(error.value) == f"{tmp_path / 'own.toml'}: {its}casing.nodes = 182: must be divisible by 4"


def test_a_problem_of_something_else_and_of_a_preset_stays_as_it_is(tmp_path):
    for name, text in (("own.toml", "friction = 2: too much"), ("zeng2019", "casing.nodes = 182: no")):
        with pytest.raises(UserError) as error, file_named(name, tmp_path):
            raise UserError(text)
        assert str(error.value) == text
