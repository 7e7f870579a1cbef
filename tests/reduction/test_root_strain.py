"""Blade-root strain and drive torque of the reduced model against statics: equilibrium fixes both."""

from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import load_machine
from rubgen.reduction import reduce
from rubgen.scenario import ContactLaw, Reduction
from rubgen.scenario.taps import DriveTorque, RootStrain
from rubgen.solver import Stepper

BLADE = 5


@pytest.fixture(scope="module")
def model():
    return reduce(load_machine("zeng2019"), Reduction())


def static_strains(model, force):
    """Strain at every root under a force (3,) on the tip of one blade along its axes, at rest."""
    load = np.zeros(len(model.blisk.K))
    load[3 * BLADE : 3 * BLADE + 3] = force
    return model.blisk.root_strain @ np.linalg.solve(model.stiffness(0.0), load)


def test_a_tip_load_bends_the_root_as_the_beam_formula_says(model):
    """A force along the normal of the root's section: M = F L about its chord, strain -M (h / 2) / (E c h^3 / 12)."""
    blades = model.machine.blades
    angle, force = np.deg2rad(blades.root_angle_deg), 10.0
    strains = static_strains(model, force * np.array([0, -np.sin(angle), np.cos(angle)]))
    inertia = blades.root_chord_m * blades.root_thickness_m**3 / 12
    moment = force * blades.length_m
    bent = -moment * blades.root_thickness_m / 2 / (blades.material.youngs_modulus_pa * inertia)
    assert strains[BLADE] == pytest.approx(bent, rel=1e-6)
    assert np.abs(np.delete(strains, BLADE)).max() < 1e-6 * abs(bent)


def test_a_load_along_the_chord_or_the_span_does_what_it_must(model):
    blades = model.machine.blades
    angle = np.deg2rad(blades.root_angle_deg)
    along_chord = static_strains(model, 10.0 * np.array([0, np.cos(angle), np.sin(angle)]))
    assert abs(along_chord[BLADE]) < 1e-10  # the fibre lies on the neutral axis
    area = blades.root_chord_m * blades.root_thickness_m
    pulled = static_strains(model, np.array([1e4, 0, 0]))
    assert pulled[BLADE] == pytest.approx(1e4 / blades.material.youngs_modulus_pa / area, rel=1e-4)


def test_taps_give_strain_and_drive_torque_of_a_held_load(model):
    """A constant tangential force on one tip at rest: no other torque acts about Z than that of the drive, F R."""
    load = np.zeros(len(model.blisk.K))
    load[3 * BLADE + 1] = 20.0
    system = model.at_speed(900.0)
    system = replace(system, recovery=replace(system.recovery, torsion_damping=0.0))
    taps = (RootStrain(name="strain", blade=BLADE), DriveTorque(name="drive"))
    stepper = Stepper(system, ContactLaw(), 1024, taps=taps)
    q = np.concatenate([np.linalg.solve(model.stiffness(0.0), load), np.zeros(system.n_casing)])
    stepper.set_state(q, q)
    stepper.run_turn(np.full(1026, 0.1))
    strain, torque = stepper.result.taps[:, 0]
    assert torque == pytest.approx(-20.0 * system.tip_radius, rel=1e-6)
    assert strain == pytest.approx(static_strains(model, [0, 20.0, 0])[BLADE], rel=1e-9)
    assert strain > 1e-6
