import json

from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from rubgen.machine import load_machine
from rubgen.scenario import Operation, Scenario
from rubgen.scenario.scenario import scenario_dict


@given(speed=st.floats(min_value=1e-3, max_value=1e6), seed=st.integers(min_value=0, max_value=2**63 - 1))
def test_a_scenario_comes_back_from_json_with_every_bit(speed, seed):
    scenario = Scenario(machine=load_machine("zeng2019"), operation=Operation(speed_rpm=speed), seed=seed)
    text = json.dumps(scenario_dict(scenario), allow_nan=False)
    assert TypeAdapter(Scenario).validate_python(json.loads(text)) == scenario
