"""Memory is bounded before anything is built, and the message gives a number that would do."""

import re
from dataclasses import replace

import numpy as np
import pytest

from rubgen.cli import main
from rubgen.dataset.making.generate import generate
from rubgen.errors import UserError
from rubgen.machine import load_machine
from rubgen.machine.load import PRESETS
from rubgen.reduction import reduce
from rubgen.scenario import Reduction, load_recipe, make_scenario, parse_recipe
from rubgen.scenario.costs import coordinates, memory_problem, reduction_bytes, run_problem, steps_per_turn
from rubgen.solver.linear.stability import steps_per_turn as steps_of_model

MINIMAL = {"name": "a", "runs": 1, "machine": "zeng2019"}
RUN_UP = {"profile": "run-up", "end_speed_rpm": 12000}


def refusal(**tables):
    with pytest.raises(UserError) as caught:
        parse_recipe(MINIMAL | tables)
    return str(caught.value)


def test_coordinates_and_steps_are_those_of_the_model():
    scenario = make_scenario()
    model = reduce(scenario.machine, scenario.reduction)
    assert coordinates(scenario) == model.reduced_dof
    fast = replace(scenario, sensing=replace(scenario.sensing, sample_rate_hz=200_000.0))
    for each in (scenario, fast):
        system = model.at_speed(each.operation.speed_rad_per_s)
        assert steps_per_turn(each) == steps_of_model(system, 1024, each.sensing.fastest_hz)


@pytest.mark.filterwarnings("ignore::rubgen.errors.RubgenWarning")
@pytest.mark.parametrize(
    ("tables", "key"),
    [
        ({"output": {"signal_seconds": 500.0}, "simulation": {"record_turns": 100_000}}, "output.signal_seconds = 500"),
        ({"operation": RUN_UP | {"duration_s": 9e4}}, "operation.duration_s = 90000"),
        (
            {"machine": "zeng2019", "simulation": {"record_turns": 1_000_000}, "reduction": {"blisk_modes": 40}},
            "simulation.record_turns = 1000000",
        ),
    ],
    ids=["signals", "run-up", "sections"],
)
def test_a_run_beyond_the_memory_names_a_number_that_does(tables, key):
    text = refusal(**tables)
    assert key in text
    number = float(re.search(r"lower it to ([\d.]+)", text)[1])
    table, name = key.split(" ")[0].split(".")
    smaller = int(number) if name == "record_turns" else 0.99 * number
    fits = {**tables, table: {**tables[table], name: smaller}}
    parse_recipe(MINIMAL | fits)
    with pytest.raises(UserError, match="GB of memory"):
        parse_recipe(MINIMAL | {**tables, table: {**tables[table], name: type(smaller)(1.03 * number)}})


def test_a_machine_beyond_the_memory_names_a_number_that_does():
    machine = load_machine("zeng2019")
    fine = replace(machine, disk=replace(machine.disk, radial_elements=200, circumferential_elements=3600))
    text = memory_problem(fine, Reduction())
    assert "with 36 blades and 200 x 3600 elements of the disk; at most 4 GB: lower disk.radial_elements to 2" in text
    many = replace(machine, blades=replace(machine.blades, count=1000))
    assert "lower disk.circumferential_elements, or the number of blades" in memory_problem(many, Reduction())
    fine = replace(machine, disk=replace(machine.disk, radial_elements=200, circumferential_elements=288))
    radial = int(re.search(r"lower disk.radial_elements to (\d+)", memory_problem(fine, Reduction()))[1])
    fits = replace(machine, disk=replace(fine.disk, radial_elements=radial))
    assert memory_problem(fits, Reduction()) is None
    assert memory_problem(replace(fits, disk=replace(fits.disk, radial_elements=radial + 1)), Reduction())
    with pytest.raises(UserError, match=r"its reduction takes about .* GB of memory, with 36 blades and 200 x 288"):
        reduce(fine, Reduction())


@pytest.mark.parametrize("key", ["blade_modes", "disk_modes"])
def test_modes_beyond_the_memory_name_a_number_that_does(key):
    machine = load_machine("zeng2019")
    machine = replace(machine, blades=replace(machine.blades, count=120, elements=200))
    many = replace(Reduction(), **{key: 500})
    if key == "disk_modes":
        machine = replace(machine, blades=replace(machine.blades, count=450, elements=2))
    text = memory_problem(machine, many)
    assert text.startswith(f"reduction.{key} = 500: the reduction takes about ")
    fewer = int(re.search(r"GB; lower it to (\d+)$", text)[1])
    assert memory_problem(machine, replace(many, **{key: fewer})) is None
    assert memory_problem(machine, replace(many, **{key: fewer + 1}))


def test_what_is_shipped_is_far_from_the_limits():
    for scenario in (make_scenario(), load_recipe().scenario(0), make_scenario("zeng2019-fitted")):
        assert reduction_bytes(scenario.machine, scenario.reduction) < 0.4e9
        assert run_problem(scenario) is None


def test_the_file_of_a_machine_beyond_memory_or_factorisation_is_named(tmp_path, monkeypatch, capsys):
    file, text = tmp_path / "mine.toml", (PRESETS / "zeng2019.toml").read_text()
    file.write_text(text.replace("circumferential_elements = 72", "circumferential_elements = 3600"))
    for asked in (lambda: parse_recipe(MINIMAL | {"machine": str(file)}), lambda: make_scenario(file)):
        with pytest.raises(UserError, match=r"mine\.toml: its reduction takes about 8\.4 GB of memory") as caught:
            asked()
        assert str(caught.value).startswith(str(file))
    file.write_text(text)

    def fail(*_arguments):
        raise np.linalg.LinAlgError("no")

    monkeypatch.setattr("rubgen.reduction.reduced.cached_blisk", fail)
    with pytest.raises(UserError, match=rf"^{re.escape(str(file))}: its stiffness or mass cannot be factorised"):
        generate(MINIMAL | {"machine": str(file)}, tmp_path / "set", workers=1)
    for command in (["simulate", "--machine", str(file)], ["modes", str(file)]):
        with pytest.raises(SystemExit):
            main(command)
        assert f"rubgen: {file}: its stiffness or mass cannot be factorised" in capsys.readouterr().err


def test_a_matrix_that_cannot_be_factorised_names_machine_and_materials(monkeypatch):
    def fail(*_arguments):
        raise np.linalg.LinAlgError("233-th leading minor of the array is not positive definite")

    monkeypatch.setattr("rubgen.reduction.reduced.cached_blisk", fail)
    with pytest.raises(UserError) as caught:
        reduce(load_machine("zeng2019"), Reduction())
    assert str(caught.value) == (
        "machine zeng2019: its stiffness or mass cannot be factorised (233-th leading minor of the array is not "
        "positive definite); correct its sizes, stiffnesses or materials, which are disk 2.06e+11 Pa and 7850 kg/m3, "
        "blades 2.06e+11 Pa and 7850 kg/m3, casing 2.06e+11 Pa and 7850 kg/m3"
    )
