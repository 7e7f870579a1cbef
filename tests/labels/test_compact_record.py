import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from rubgen.labels import label
from rubgen.labels.compact_record import compact_record, in_record_precision, response_of
from rubgen.labels.to_json import labels_to_json
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.integrate import integrate
from rubgen.solver.response import Response
from rubgen.solver.wants import Wants
from rubgen.units import rev_per_min
from validation.verification.rotors.jeffcott import jeffcott_system

Respond = Callable[..., Response]


@pytest.fixture(scope="module")
def rub() -> Response:
    system = jeffcott_system()
    operation = Operation(speed_rpm=rev_per_min(system.speed), record_turns=64, steps_per_turn=256, settle_turns=60)
    return integrate(system, operation, ContactLaw(friction=0.1), Wants(companion=True))


def test_kept_arrays_bring_back_the_labels(respond: Respond, rub: Response) -> None:
    rng = np.random.default_rng(0)
    casing = 1e-5 * rng.standard_normal((64, 11))
    blisk = 1e-6 * rng.standard_normal((64, 114))
    made = respond(turns=64, blisk=blisk, casing=casing, casing_velocity=1e3 * casing, touches=rub.events)
    made = dataclasses.replace(
        made, companion_growth=rng.standard_normal(64), symmetry_states=rng.standard_normal((2, 2, 125))
    )
    again = dataclasses.replace(response_of(compact_record(made)), taps=made.taps)
    first, second = label(made), label(again)
    assert first.lyapunov is not None
    assert first.contact_zones > 0
    assert labels_to_json(first) == labels_to_json(second)


def test_what_labels_see_differs_by_single_precision(rub: Response) -> None:
    kept, tips = in_record_precision(rub), slice(0, 3 * rub.n_blades + 2)
    assert kept.section_q[:, tips] == pytest.approx(rub.section_q[:, tips], rel=1e-7)
    assert kept.section_v[:, -rub.n_casing :] == pytest.approx(rub.section_v[:, -rub.n_casing :], rel=1e-7)
    assert kept.events.impulse == pytest.approx(rub.events.impulse, rel=1e-7)
    assert np.array_equal(kept.events.start_step, rub.events.start_step)
    assert kept.taps is rub.taps


def test_kept_arrays_are_small(respond: Respond) -> None:
    size = sum(array.nbytes for array in compact_record(respond()).values())
    assert size == 500 * (134 * 4 + 8 + 4) + 72  # no touches, no companion


def test_keeping_twice_changes_nothing(rub: Response) -> None:
    first, second = compact_record(rub), compact_record(in_record_precision(rub))
    assert first.keys() == second.keys()
    for name, array in first.items():
        assert array.dtype == second[name].dtype
        assert np.array_equal(array, second[name], equal_nan=True)
