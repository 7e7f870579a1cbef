from dataclasses import replace

import pytest

from rubgen.machine import load_machine
from validation.onset import fit_unbalance_and_clearance, tip_growth


def test_preset_stands_where_the_fit_puts_it():
    machine = load_machine("zeng2019")
    unbalance, clearance = fit_unbalance_and_clearance(machine)
    assert machine.unbalance_kg_m == pytest.approx(unbalance, rel=1e-4)
    assert machine.casing.clearance_m == pytest.approx(clearance, abs=5e-8)


def test_growth_without_unbalance_is_the_steady_centrifugal_one():
    """The independent model of the preset's reference found 109.6 um at 6,720 and 242.8 um at 10,000 rev/min."""
    machine = replace(load_machine("zeng2019"), unbalance_kg_m=0.0)
    assert tip_growth(machine, 6720.0) == pytest.approx(109.6e-6, rel=5e-3)
    assert tip_growth(machine, 10000.0) == pytest.approx(242.8e-6, rel=5e-3)
