"""The contact forces with which the casing's modes are driven outside of an integration."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.solver.response import ContactEvents
from validation.ring_modes import contacts


def test_contacts_have_the_force_of_every_step_and_run_with_the_blade(make_synthetic_run):
    response = make_synthetic_run().response
    first, dt, force = response.record_steps - response.tail_steps, response.dt, np.zeros(response.tail_steps)
    force[1000:1010] = 400.0 + 30 * np.arange(10)
    light = force.sum() * dt
    force[1004:1008] += 4000.0
    force[5000:5003] = (100, 700, 200)
    none = np.zeros(3)
    touches = ContactEvents(
        blade=np.arange(3), start_step=first + np.array([1000, 1004, 5000]), steps=np.array([10, 4, 3]),
        angle=np.array([1.0, 4.0, 2.0]), impulse=np.array([light, 16_000 * dt, 1000 * dt]), friction_loss=none,
        normal_loss=none,
    )  # fmt: skip
    step, angle, normal = contacts(replace(response, taps=response.taps | {"contact_force": force}, events=touches))
    assert np.bincount(step, normal, force.size) == pytest.approx(force)
    alone = step >= 5000
    assert np.diff(angle[alone]) == pytest.approx(np.full(2, response.speed * dt), rel=1e-6)
    assert np.average(angle[alone], weights=normal[alone]) == pytest.approx(2.0, abs=1e-9)
    both = step == 1004
    assert normal[both] == pytest.approx(force[1004] * np.array([535, 4000]) / 4535)
    assert angle[both] == pytest.approx([1.0, 4.0], abs=0.1)
