"""Compute the masses of a blisk and of a blade from the machine's numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rubgen.machine.machine import BladeRow, Machine


def blisk_mass(machine: Machine) -> float:
    """Compute the mass of disk and blades in kg; blade cross-sections count as chord times thickness.

    Disk: 2 pi rho times the integral of r t(r), t linear from bore to rim; blades: rho L times the mean of the product
    of two linear functions. Blades that a fault has taken away count too. In the preset within 0.1 % of the
    finite-element model: tests/machine/test_mass.py.
    """
    disk, blades = machine.disk, machine.blades
    a, b = disk.bore_radius_m, disk.rim_radius_m
    slope = (disk.rim_thickness_m - disk.bore_thickness_m) / (b - a) if b > a else 0.0
    start = disk.bore_thickness_m - slope * a
    plate = 2 * math.pi * (start * (b**2 - a**2) / 2 + slope * (b**3 - a**3) / 3)
    return abs(plate) * disk.material.density_kg_per_m3 + blades.count * blade_mass(blades)


def blade_mass(blades: BladeRow) -> float:
    """Compute the mass of one blade in kg: cross-sections of chord times thickness, both linear in the radius."""
    c0, c1, t0, t1 = blades.root_chord_m, blades.tip_chord_m, blades.root_thickness_m, blades.tip_thickness_m
    cross_section = (2 * c0 * t0 + c0 * t1 + c1 * t0 + 2 * c1 * t1) / 6
    return cross_section * blades.length_m * blades.material.density_kg_per_m3
