import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from rubgen.labels import label
from rubgen.labels.kept import as_kept, keep, response_of
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver import integrate
from rubgen.solver.response import Response
from rubgen.studies.verification.jeffcott import jeffcott_system
Respond = Callable[..., Response]


@pytest.fixture(scope="module")
def rub() -> Response:
    system = jeffcott_system()
    operation = Operation(speed_rpm=system.speed * 30 / np.pi, record_turns=64, steps_per_turn=256, settle_turns=60)
    return integrate(system, operation, ContactLaw(friction=0.1), twin=True)


def test_kept_arrays_bring_back_the_labels(rub: Response) -> None:
    again = dataclasses.replace(response_of(keep(rub)), taps=rub.taps)
    first, second = label(rub), label(again)
    for field in dataclasses.fields(first):
        np.testing.assert_equal(getattr(first, field.name), getattr(second, field.name))


def test_what_labels_see_differs_by_single_precision(rub: Response) -> None:
    kept, tips = as_kept(rub), slice(0, 3 * rub.n_blades + 2)
    assert kept.section_q[:, tips] == pytest.approx(rub.section_q[:, tips], rel=1e-7)
    assert kept.section_v[:, -rub.n_casing :] == pytest.approx(rub.section_v[:, -rub.n_casing :], rel=1e-7)
    assert kept.events.impulse == pytest.approx(rub.events.impulse, rel=1e-7)
    assert np.array_equal(kept.events.start_step, rub.events.start_step)
    assert kept.taps is rub.taps


def test_kept_arrays_are_small(respond: Respond) -> None:
    size = sum(array.nbytes for array in keep(respond()).values())
    assert size == 500 * (134 * 4 + 8) + 56  # no touches, no twin


def test_keeping_twice_changes_nothing(rub: Response) -> None:
    first, second = keep(rub), keep(as_kept(rub))
    assert first.keys() == second.keys()
    for name, array in first.items():
        assert array.dtype == second[name].dtype
        assert np.array_equal(array, second[name])
