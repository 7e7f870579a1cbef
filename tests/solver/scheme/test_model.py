"""A model does not change; all that changes is a state, and a model may have several."""

import numpy as np
import pytest

from rubgen.scenario import ContactLaw, Liner
from rubgen.solver.scheme.model import new_state
from rubgen.solver.speed.start import rub_free_stepper

LAW = ContactLaw(friction=0.1, liner=Liner(thickness_m=1e-3, wear_m2_per_n=4e-12, width_m=0.02, bins=240))


def arrays(record, name=""):
    """All arrays in a named tuple, by name."""
    for field, value in zip(record._fields, record, strict=True):
        if isinstance(value, np.ndarray):
            yield f"{name}.{field}", value
        elif hasattr(value, "_fields"):
            yield from arrays(value, f"{name}.{field}")


def test_no_array_of_a_model_can_be_written(small_system, turning):
    model = rub_free_stepper(turning(small_system(), "all"), LAW, 256).model
    found = dict(arrays(model))
    assert len(found) >= 50
    for name, array in found.items():
        assert not array.flags.writeable, name
    with pytest.raises(ValueError, match="read-only"):
        model.scheme.now[0, 0] = 1.0


def test_two_states_of_one_model_do_not_know_of_each_other(small_system, turning):
    """The same turn twice, the second time after another state of the model has made turns of its own."""
    system, opening = turning(small_system(speed=500.0), "film"), np.linspace(6e-4, 0, 258)
    ends = []
    for disturbed in (False, True):
        stepper = rub_free_stepper(system, LAW, 256)
        if disturbed:
            own, stepper.state = stepper.state, new_state(stepper.model)
            stepper.run_turn(np.full(258, 3e-4))
            stepper.state = own
        stepper.run_turn(opening)
        stepper.run_turn()
        assert stepper.result.summary[0] > 0
        assert stepper.state.wear.sums[0] > 0
        ends.append(
            [stepper.coordinates.now, stepper.state.works, stepper.state.support.works, stepper.state.wear.depth]
        )
    for one, other in zip(*ends, strict=True):
        np.testing.assert_array_equal(one, other)
