import json
import re
from dataclasses import replace

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from rubgen.errors import UserError
from rubgen.machine import Machine, Mistuning, load_machine
from rubgen.machine.load import PRESETS, machine_id

TEXT = (PRESETS / "zeng2019.toml").read_text()
PATTERN = ", ".join(["0.01", "-0.02"] * 18)
TWO = "must have pattern alone, or relative_std with its seed; give one of the two"
BAD = {
    "both": (f"pattern = [{PATTERN}]\nrelative_std = 0.02\nseed = 3", f"blades.mistuning: {TWO}"),
    "neither": ("", f"blades.mistuning = {{}}: {TWO}"),
    "no seed": ("relative_std = 0.02", f"blades.mistuning = {{ relative_std = 0.02 }}: {TWO}"),
    "seed of a pattern": (f"pattern = [{PATTERN}]\nseed = 3", f"blades.mistuning: {TWO}"),
    "too short": ("pattern = [0.01, 0.02]", "blades: mistuning.pattern has 2 values for count = 36; give one a blade"),
    "no stiffness": (
        "pattern = [-1.0]",
        "blades.mistuning.pattern.0 = -1: must be above -1 and at most 1; change the value",
    ),
    "nan": ("pattern = [nan]", "blades.mistuning.pattern.0 = nan: must be a finite number"),
    "empty": ("pattern = []", "blades.mistuning.pattern = []: "),
    "negative": ("relative_std = -0.1\nseed = 3", "blades.mistuning.relative_std = -0.1: must be at least 0"),
    "drawn away": ("relative_std = 0.9\nseed = 3", "no stiffness; lower relative_std"),
    "unknown key": ("std = 0.1\nseed = 3", "blades.mistuning.std: unknown key; did you mean "),
}


@pytest.fixture
def load(tmp_path):
    def with_mistuning(table):
        path = tmp_path / "machine.toml"
        path.write_text(re.sub(r"\n\[casing\]", f"\n[blades.mistuning]\n{table}\n\n[casing]", TEXT))
        return load_machine(str(path))

    return with_mistuning


@pytest.mark.parametrize("case", BAD.values(), ids=BAD.keys())
def test_bad_mistuning_is_refused_in_one_line(case, load, tmp_path):
    table, message = case
    with pytest.raises(UserError) as caught:
        load(table)
    assert str(caught.value).startswith(f"{tmp_path / 'machine.toml'}: blades")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_pattern_is_taken_as_it_stands(load):
    assert load(f"pattern = [{PATTERN}]").blades.stiffness_deviations == (0.01, -0.02) * 18
    assert load_machine("zeng2019").blades.stiffness_deviations == (0.0,) * 36


def test_draws_have_the_asked_deviation_and_follow_the_seed(load):
    drawn = load("relative_std = 0.02\nseed = 3").blades.stiffness_deviations
    assert drawn == load("relative_std = 0.02\nseed = 3").blades.stiffness_deviations
    assert drawn != load("relative_std = 0.02\nseed = 4").blades.stiffness_deviations
    many = np.array(Mistuning(relative_std=0.02, seed=3).deviations(20_000))
    # Four standard errors of the mean and of the standard deviation of 20,000 normal values.
    assert abs(many.mean()) < 4 * 0.02 / np.sqrt(20_000)
    assert abs(many.std() - 0.02) < 4 * 0.02 / np.sqrt(40_000)
    assert np.mean(np.abs(many) < 0.02) == pytest.approx(0.6827, abs=4 * np.sqrt(0.6827 * 0.3173 / 20_000))
    np.testing.assert_allclose(drawn, 2 * np.array(Mistuning(relative_std=0.01, seed=3).deviations(36)), rtol=1e-15)


def test_a_pattern_follows_the_number_of_blades(load):
    mistuned = load(f"pattern = [{PATTERN}]").blades
    with pytest.raises(ValidationError, match="has 36 values for count = 18"):
        replace(mistuned, count=18)


def test_mistuning_comes_back_from_json_with_every_bit_and_enters_the_machine_id(load):
    machine = load("relative_std = 0.02\nseed = 3")
    machine = replace(
        machine, blades=replace(machine.blades, mistuning=Mistuning(pattern=machine.blades.stiffness_deviations))
    )
    adapter = TypeAdapter(Machine)
    assert adapter.validate_python(json.loads(json.dumps(adapter.dump_python(machine, mode="json")))) == machine
    assert machine_id(machine) != machine_id(load_machine("zeng2019"))
