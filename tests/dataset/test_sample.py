"""The sample in datasets/ is small, sound, made from its recipe, and today's code makes its rub again."""

from pathlib import Path

import pyarrow.parquet as pq
import pytest

import rubgen
from rubgen.dataset.manifest import identity_of
from rubgen.dataset.remaking.regenerate import moved_labels, regenerate
from rubgen.io.parquet.words import with_words
from rubgen.scenario.load import RECIPES

SAMPLE = Path(__file__).parents[2] / "datasets/sample"


def test_the_sample_is_below_one_megabyte():
    assert sum(path.stat().st_size for path in SAMPLE.rglob("*") if path.is_file()) < 1_000_000


def test_the_sample_is_that_of_its_recipe_and_sound():
    identity = rubgen.open(SAMPLE).manifest.identity
    assert identity.same_recipe(identity_of(rubgen.load_recipe(RECIPES / "sample.toml")))
    assert rubgen.verify(SAMPLE) == []


def test_a_rub_of_the_sample_is_made_again():
    runs = rubgen.open(SAMPLE).runs
    regular = runs.index[runs["rub"] & (runs["motion"] == "period-1")]
    assert len(regular) > 0
    assert runs["rub"].nunique() == 2
    assert regenerate(SAMPLE, regular[0]).moved == []


ROUNDING = {
    "casing_acc_0_order_floors": lambda row: [2 * each for each in row],
    "blisk_x_fractional_amplitudes": lambda row: [3 * each for each in row],
    "blisk_x_order_phases_rad": lambda row: [row[0], row[1] + 1.0, *row[2:]],  # the blisk has no even orders
    "blisk_x_even_share": lambda share: 5 * share,
    "energy_residual": lambda share: 2 * share,
    "lyapunov_per_turn": lambda exponent: exponent * 1.0002,
}
MOVED = {
    "casing_acc_0_blade_passing": lambda row: [row[0] + 1.0, *row[1:]],
    "blisk_x_order_phases_rad": lambda row: [row[0] + 2e-6, *row[1:]],
    "blisk_x_even_share": lambda share: share + 2e-6,
    "contact_duty": lambda duty: duty * (1 + 2e-6),
    "lyapunov_per_turn": lambda exponent: 2 * exponent,
    "period": lambda period: period + 1,
}


@pytest.mark.parametrize(("changes", "moved"), [(ROUNDING, False), (MOVED, True)], ids=["rounding", "moved"])
def test_only_labels_beyond_rounding_count_as_moved(changes, moved):
    """The factors of ROUNDING were seen between two kinds of processor."""
    table = pq.read_table(SAMPLE / "runs.parquet").slice(1, 1)
    (row,) = with_words(table).to_pylist()
    assert (row["rub"], row["motion"]) == (True, "period-1")
    for name, change in changes.items():
        assert moved_labels(row | {name: change(row[name])}, row) == ([name] if moved else []), name


def test_amplitudes_of_a_chaotic_run_may_move_by_half():
    (row,) = with_words(pq.read_table(SAMPLE / "runs.parquet").slice(3, 1)).to_pylist()
    assert row["motion"] == "chaotic"
    largest = max(row["contact_force_orders"])
    for factor, moved in ((0.25, []), (0.6, ["contact_force_orders"])):
        orders = [row["contact_force_orders"][0] + factor * largest, *row["contact_force_orders"][1:]]
        assert moved_labels(row | {"contact_force_orders": orders}, row) == moved
    assert moved_labels(row | {"motion": "period-1"}, row) == ["motion"]
