"""Machines as they are built, from a hand's turbine to the last stage of a steam turbine, and none is doubted."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from rubgen.machine import Machine, Material, Mistuning, SqueezeFilm, load_machine
from rubgen.machine.mass import blisk_mass
from rubgen.scenario import parse_recipe

PRESET = load_machine("zeng2019")
STEEL, TITANIUM, ALUMINIUM, COMPOSITE, NICKEL = (
    Material(youngs_modulus_pa=modulus, poisson_ratio=poisson, density_kg_per_m3=density)
    for modulus, poisson, density in (
        (2.06e11, 0.3, 7850.0),
        (1.14e11, 0.33, 4430.0),
        (7.0e10, 0.33, 2700.0),
        (5.5e10, 0.28, 1600.0),
        (1.8e11, 0.3, 8200.0),
    )
)
SIZES = {  # tip radius m, length of the blades as a share of it, blades, tip speed m/s, of disk, blades and casing
    "turbine of a model jet": (0.035, 0.3, (19, 29), (250, 450), (NICKEL, NICKEL, STEEL)),
    "micro turbine": (0.008, 0.25, (8, 16), (150, 350), (STEEL, STEEL, STEEL)),
    "turbocharger": (0.03, 0.4, (9, 14), (200, 450), (NICKEL, ALUMINIUM, ALUMINIUM)),
    "compressor, first stage": (0.35, 0.45, (18, 40), (280, 450), (TITANIUM, TITANIUM, TITANIUM)),
    "compressor, last stage": (0.25, 0.1, (60, 100), (250, 380), (NICKEL, NICKEL, STEEL)),
    "gas turbine": (0.5, 0.25, (50, 90), (250, 420), (NICKEL, NICKEL, NICKEL)),
    "fan of an engine": (0.9, 0.65, (18, 36), (300, 460), (TITANIUM, COMPOSITE, ALUMINIUM)),
    "industrial fan": (1.2, 0.6, (8, 16), (60, 130), (STEEL, ALUMINIUM, STEEL)),
    "steam turbine, high pressure": (0.45, 0.12, (60, 110), (120, 220), (STEEL, STEEL, STEEL)),
    "steam turbine, last stage": (1.8, 0.6, (60, 100), (400, 700), (STEEL, TITANIUM, STEEL)),
}
TRIES = 3


def machine(size: str, rng: np.random.Generator) -> tuple[Machine, float]:
    """A machine of that size, and the speed of its tips in m/s."""
    tip, share, blades, speeds, (disk, blade, casing) = SIZES[size]
    tip *= rng.uniform(0.7, 1.4)
    length, count = share * tip * rng.uniform(0.8, 1.2), int(rng.integers(*blades))
    rim, pitch = tip - length, 2 * math.pi * tip / count
    chord = min(pitch * rng.uniform(0.6, 1.2), length)
    made = replace(
        PRESET,
        name=size,
        disk=replace(
            PRESET.disk,
            material=disk,
            bore_radius_m=rim * rng.uniform(0.1, 0.4),
            rim_radius_m=rim,
            bore_thickness_m=rim * rng.uniform(0.2, 0.5),
            rim_thickness_m=rim * rng.uniform(0.1, 0.3),
            circumferential_elements=2 * count,
        ),
        blades=replace(
            PRESET.blades,
            material=blade,
            count=count,
            length_m=length,
            root_chord_m=chord,
            tip_chord_m=chord * rng.uniform(0.7, 1.1),
            root_thickness_m=chord * rng.uniform(0.06, 0.15),
            tip_thickness_m=chord * rng.uniform(0.03, 0.08),
            root_angle_deg=rng.uniform(5, 60),
            tip_angle_deg=rng.uniform(40, 85),
            mistuning=Mistuning(relative_std=rng.uniform(0.002, 0.05), seed=int(rng.integers(100))),
        ),
        casing=replace(
            PRESET.casing,
            material=casing,
            thickness_m=tip * rng.uniform(0.002, 0.05),
            width_m=chord * rng.uniform(1, 4),
            clearance_m=tip * rng.uniform(3e-4, 1e-2),
            ovality_m=tip * rng.uniform(0, 0.02),
        ),
    )
    mass, spin = blisk_mass(made), rng.uniform(*speeds) / tip
    lateral = mass * (spin * rng.uniform(0.3, 3)) ** 2
    support = replace(
        PRESET.disk_support,
        lateral_stiffness_n_per_m=lateral,
        axial_stiffness_n_per_m=lateral * rng.uniform(0.1, 3),
        tilt_stiffness_nm_per_rad=lateral * rim**2 * rng.uniform(0.05, 1),
        torsion_stiffness_nm_per_rad=lateral * rim**2 * rng.uniform(0.01, 1),
        lateral_stiffness_anisotropy=rng.uniform(-0.3, 0.3),
        squeeze_film=SqueezeFilm(
            radius_m=0.4 * rim, length_m=0.15 * rim, clearance_m=0.4 * rim * 2e-3, viscosity_pa_s=rng.uniform(5e-3, 0.1)
        ),
    )
    grade = 10 ** rng.uniform(0.8, 2.5)  # balance grade G of ISO 21940 in mm/s, from 6.3 to a rotor that lost balance
    damping = {name: rng.uniform(0.001, 0.2) for name in ("lateral", "tilt", "axial", "torsion")}
    damping |= {name: rng.uniform(2e-4, 0.03) for name in ("blade", "casing")}
    return (
        replace(
            made,
            disk_support=support,
            damping=replace(PRESET.damping, **damping),
            unbalance_kg_m=mass * 1e-3 * grade / spin,
            unbalance_angle_deg=float(rng.integers(-180, 180)),
            gravity_m_per_s2=float(rng.choice([0.0, 9.81])),
        ),
        spin,
    )


@pytest.mark.parametrize("seed", range(TRIES))
@pytest.mark.parametrize("size", SIZES)
def test_a_sensible_machine_is_not_doubted(size, seed, monkeypatch):
    rng = np.random.default_rng([seed, list(SIZES).index(size)])
    made, spin = machine(size, rng)
    turn, rpm = spin / (2 * math.pi), spin * 30 / math.pi
    monkeypatch.setattr("rubgen.scenario.recipe.load_machine", lambda *_: made)
    wide = math.sin(math.radians(made.blades.tip_angle_deg)) * made.blades.tip_chord_m > 0.024  # as the rig's probes
    recipe = {
        "name": "a",
        "runs": 2,
        "machine": "m.toml",
        "vary": {
            "speed_rpm": {"uniform": [0.8 * rpm, rpm]},
            "friction": {"normal": {"mean": 0.1, "std": 0.05, "min": 0.0, "max": 0.3}},
            "clearance_m": {"uniform": [0.5 * made.casing.clearance_m, made.casing.clearance_m]},
        },
        "sensors": {"set": "rig" if wide else "default", "sample_rate_hz": max(25_600.0, 50 * turn)},
        "simulation": {"record_turns": 1000, "steps_per_turn": 2048},
        "output": {"signal_seconds": min(1.0, 400 / turn)},
        "contact": {
            "liner": {"thickness_m": 0.005 * made.tip_radius_m, "wear_m2_per_n": 1e-12, "width_m": made.casing.width_m},
        },
    }
    with warnings.catch_warnings(action="error"):
        parse_recipe(recipe)
