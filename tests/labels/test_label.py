import time
from collections.abc import Callable

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from rubgen.labels import Motion, label
from rubgen.labels.to_json import labels_to_json
from rubgen.solver.response import ContactEvents, Response

Respond = Callable[..., Response]
Events = Callable[..., ContactEvents]


def acceleration(turns: int, order: float = 2.0) -> np.ndarray:
    return 50 * np.cos(order * 2 * np.pi * np.arange(1 - turns * 256, 1) / 256)


def test_labels_of_a_run_with_two_zones(respond: Respond, events: Events) -> None:
    angles = np.repeat(np.deg2rad(np.linspace(-10, 10, 99)), 2) + np.tile([0.0, np.pi], 99)
    casing = np.ones((500, 11))
    response = respond(
        casing=casing,
        casing_velocity=casing,
        touches=events(angles, start=50 + 128 * np.arange(198), blades=7),
        taps={"casing_acc_0": acceleration(100)},
    )
    labels = label(response)
    assert labels.rub is True
    assert labels.contact_duty == pytest.approx(0.25)
    assert labels.impulse_per_turn == pytest.approx(1.5)
    assert labels.blades_touched == 7
    assert (labels.contact_zones, labels.contact_zones_symmetric) == (2, True)
    assert len(labels.contact_zone_centres) == len(labels.contact_zone_widths) == 2
    assert (labels.motion, labels.period) == (Motion.PERIOD_1, 1)
    assert labels.has_2fr is True
    assert labels.orders["casing_acc_0"].dominant == 2


def test_without_contact_there_is_no_2fr_whatever_the_casing_does(respond: Respond) -> None:
    labels = label(respond(contact=False, taps={"casing_acc_0": acceleration(100)}))
    assert (labels.rub, labels.has_2fr, labels.contact_duty, labels.blades_touched) == (False, False, 0.0, 0)
    assert (labels.contact_zones, labels.contact_zones_symmetric) == (0, None)
    assert (labels.motion_casing, labels.period_casing) == (Motion.STATIC, None)
    assert (labels.motion, labels.period) == (Motion.PERIOD_1, 1)


def test_labels_do_not_depend_on_the_length_of_the_tail(respond: Respond) -> None:
    noise = np.random.default_rng(0).standard_normal(137 * 256)
    long, short = (label(respond(taps={"casing_acc_0": tap})) for tap in (noise, noise[-100 * 256 :]))
    assert labels_to_json(long) == labels_to_json(short)


def test_labelling_500_turns_is_fast(respond: Respond) -> None:
    rng = np.random.default_rng(0)
    taps = {f"tap_{i}": rng.standard_normal(102_400) for i in range(10)} | {
        "casing_acc_0": rng.standard_normal(102_400)
    }
    casing = rng.standard_normal((500, 11))
    response = respond(
        blisk=1e-4 * rng.standard_normal((500, 114)), casing=casing, casing_velocity=casing, taps=taps, steps=1024
    )
    times = []
    for _ in range(3):
        with threadpool_limits(1, user_api="blas"):  # as the pipeline does: BLAS threads that wait burn time as well
            start = time.process_time()
            label(response)
            times.append(time.process_time() - start)
    assert min(times) < 0.9  # 0.3 s of processor time expected
