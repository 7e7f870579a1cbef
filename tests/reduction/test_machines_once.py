"""The blisk of a virtual machine is reduced once, whatever its runs vary."""

import pytest

from rubgen.reduction import cache, reduce
from rubgen.reduction.blisk import reduce_blisk
from rubgen.scenario import parse_recipe

RECIPE = {
    "name": "fleet",
    "machine": "zeng2019",
    "machines": {
        "count": 2,
        "runs_per_machine": 3,
        "vary": {"blade_count": 12, "blade_length_m": {"uniform": [0.14, 0.16]}},
    },
    "vary": {
        "speed_rpm": {"uniform": [6000, 7000]},
        "disk_support_stiffness_n_per_m": {"log_uniform": [1e8, 3e8]},
        "casing_thickness_m": {"uniform": [1.2e-3, 1.6e-3]},
        "ovality_m": {"uniform": [4e-3, 8e-3]},
    },
    "reduction": {"blade_modes": 1, "disk_modes": 1, "blisk_modes": 1},
}


def test_runs_of_a_machine_share_one_reduction(tmp_path, monkeypatch):
    """In any order of runs, and by a recipe of another process too: the cache on disk has it."""
    made = []

    def counted(*what):
        made.append(what)
        return reduce_blisk(*what)

    monkeypatch.setenv("RUBGEN_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "reduce_blisk", counted)
    recipe = parse_recipe(RECIPE)
    frequencies = {}
    for index in (0, 4, 1, 3, 2, 5):
        scenario = recipe.scenario(index)
        frequencies[index] = reduce(scenario.machine, scenario.reduction).blisk.blade_frequency
    assert len(made) == 2
    again = parse_recipe(RECIPE).scenario(5)
    reduce(again.machine, again.reduction)
    assert len(made) == 2
    assert frequencies[0] == frequencies[1] == frequencies[2]
    assert frequencies[3] == frequencies[4] == frequencies[5]
    assert frequencies[0] != pytest.approx(frequencies[3], rel=1e-6)
