"""Counts, severity, extent and whirl, against made touches and the closed form of an annular rub."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.labels import label
from rubgen.labels.contact.amounts import RubExtent, contact_amounts, rub_extent
from rubgen.labels.contact.zones import contact_zones
from rubgen.labels.motion.whirl import Whirl, WhirlDirection, whirl
from rubgen.labels.to_json import labels_to_json
from rubgen.scenario import ContactLaw, Operation
from rubgen.solver.integrate import integrate
from rubgen.units import STANDARD_GRAVITY, rev_per_min
from validation.verification.rotors.jeffcott import CLEARANCE, FRICTION, ROTOR_MASS, SPEED, annular_rub, jeffcott_system


def amounts(response):
    zones = contact_zones(response.events, steps_per_turn=response.steps_per_turn)
    steps = response.record_turns * response.steps_per_turn
    return contact_amounts(response, zones, record_steps=steps)


def test_counts_and_works_of_made_touches(respond, events):
    touches = events(np.tile([0.0, np.pi], 50), np.arange(100.0), blades=3)
    touches = replace(touches, friction_loss=-0.5 * np.arange(100.0))
    found = amounts(replace(respond(turns=50, touches=touches), blisk_mass=100.0, free_penetration=2e-5))
    assert found.touches == 100
    assert found.blade_touches.tolist() == [34, 33, 33] + [0] * 33
    np.testing.assert_allclose(found.blade_impulses[:3], [np.arange(b, 100, 3).sum() / 50 for b in range(3)])
    assert found.friction_work == pytest.approx(-0.5 * 99 * 100 / 2 / 50)
    turn = 1 / 150.0
    assert found.severity == pytest.approx(1.5 / (100.0 * STANDARD_GRAVITY * turn))
    assert (found.free_penetration, found.extent) == (2e-5, RubExtent.PARTIAL)


def test_what_is_not_known_is_null_and_without_contact_there_is_none(respond):
    plain = labels_to_json(label(respond(contact=False)))
    assert plain["contact_severity"] is plain["free_penetration_m"] is plain["whirl"] is plain["whirl_index"] is None
    assert (plain["rub_extent"], plain["contact_touches"]) == ("none", 0)
    assert plain["blade_touches"] == [0] * 36


def test_an_annular_rub_has_its_closed_form(respond):
    """A Jeffcott rotor that touches all the way round: force and friction work known, first order in dt."""
    operation = Operation(speed_rpm=rev_per_min(SPEED), record_turns=64, steps_per_turn=1024, settle_turns=150)
    run = integrate(jeffcott_system(), operation, ContactLaw(friction=FRICTION))
    found = amounts(replace(run, blisk_mass=ROTOR_MASS))
    assert found.extent is RubExtent.FULL_ANNULAR
    assert found.touches == 1
    exact = annular_rub()
    assert found.severity == pytest.approx(exact.force / (ROTOR_MASS * STANDARD_GRAVITY), rel=5e-4)
    per_turn = exact.force * 2 * np.pi / SPEED
    assert found.blade_impulses == pytest.approx([per_turn], rel=5e-4)
    slip_per_turn = 2 * np.pi * CLEARANCE  # the rotor's centre goes once round the ring
    assert found.friction_work == pytest.approx(-FRICTION * exact.force * slip_per_turn, rel=5e-4)


def test_a_rub_that_pauses_or_does_not_go_round_is_partial(events):
    round_about = contact_zones(events(np.linspace(0, 6.28, 400)), steps_per_turn=1024)
    arc = contact_zones(events(np.linspace(0, 4.0, 400)), steps_per_turn=1024)
    assert rub_extent(0.96, round_about) is RubExtent.FULL_ANNULAR
    assert rub_extent(0.94, round_about) is RubExtent.PARTIAL
    assert rub_extent(1.0, arc) is RubExtent.PARTIAL
    assert rub_extent(0.0, round_about) is RubExtent.NONE


def made_orbit(forward, backward, order=1.0, offset=0.0, turns=4):
    """Means over turns of p e^(i k theta) + n e^(-i k theta) + offset at unit speed."""
    theta = 2 * np.pi * np.arange(turns * 4096).reshape(turns, -1) / 4096
    wave = np.exp(1j * order * theta)
    r, v = forward * wave + backward / wave + offset, 1j * order * (forward * wave - backward / wave)
    parts = [r.real, r.imag, abs(r) ** 2, abs(v) ** 2, r.real * v.imag - r.imag * v.real]
    return np.stack([part.mean(axis=1) for part in parts], axis=1)


@pytest.mark.parametrize(
    ("forward", "backward", "index", "direction"),
    [
        (1e-4, 0.0, 1.0, WhirlDirection.FORWARD),
        (0.0, 1e-4, -1.0, WhirlDirection.BACKWARD),
        (1e-4, 1e-4j, 0.0, WhirlDirection.MIXED),
        (3e-4, 1e-4, 0.8, WhirlDirection.FORWARD),
        (1e-4, 2e-4j, -0.6, WhirlDirection.BACKWARD),
    ],
)
@pytest.mark.parametrize("offset", [0.0, 5e-4 - 2e-4j])
def test_whirl_of_circles_lines_and_ellipses(forward, backward, index, direction, offset):
    for order in (1.0, 0.25, 3.0):
        found = whirl(made_orbit(forward, backward, order, offset))
        assert found.index == pytest.approx(index, abs=1e-9)
        assert found.direction is direction


def test_a_disk_at_rest_does_not_whirl():
    assert whirl(np.zeros((5, 5))) is None
    assert whirl(np.zeros((0, 5))) is None
    assert whirl(made_orbit(1e-4, 0.0)) == Whirl(WhirlDirection.FORWARD, pytest.approx(1.0))
